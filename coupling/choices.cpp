// The words that the coupling's options have in a case file.
#include "coupling/load_rule.hpp"
#include "coupling/refill_rule.hpp"

namespace thalweg::coupling {

std::vector<NamedChoice<LoadRule>> choices_of(LoadRule) {
  return {{LoadRule::extrapolated, "extrapolated", "from the last three exchanges, without lag"},
          {LoadRule::mean, "mean", "of the last two, as published; a bed may shake"}};
}

std::vector<NamedChoice<RefillRule>> choices_of(RefillRule) {
  return {{RefillRule::equilibrium, "equilibrium", ""},
          {RefillRule::grad, "grad", "with the mean stress of the neighbours"}};
}

}  // namespace thalweg::coupling
