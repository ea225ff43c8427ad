// The part of a case that its observers, and the frames of its grains, may know.
#pragma once

#include "analysis/observer/run_context.hpp"
#include "driver/case/case.hpp"

namespace thalweg::driver {

analysis::RunContext run_context(const Case& c);

// Facts for the frames of the grains.
PopulationIds population_ids(const Case& c);
io::GrainOutputFacts grain_output_facts(const Case& c);

}  // namespace thalweg::driver
