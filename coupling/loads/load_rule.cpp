#include "coupling/loads/load_rule.hpp"

namespace thalweg::coupling {

std::vector<NamedChoice<LoadRule>> choices_of(LoadRule) {
  return {{LoadRule::extrapolated, "extrapolated", "from the last three exchanges, without lag"},
          {LoadRule::mean, "mean", "of the last two, as published; a bed may shake"}};
}

}  // namespace thalweg::coupling
