// How cells that a grain has uncovered get their populations; the equations are in refill.hpp.
#pragma once

#include "core/named_choice.hpp"

#include <vector>

namespace thalweg::coupling {

enum class RefillRule { equilibrium, grad };
std::vector<NamedChoice<RefillRule>> choices_of(RefillRule);  // its words in a case file

}  // namespace thalweg::coupling
