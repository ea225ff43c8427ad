// From a case to what its observers may know of it.
#pragma once

#include "analysis/run_facts.hpp"
#include "driver/case.hpp"

namespace thalweg::driver {

analysis::RunFacts run_facts(const Case& c);

}  // namespace thalweg::driver
