#include "coupling/loads/load_averaging.hpp"

namespace thalweg::coupling {

std::vector<NamedChoice<LoadAveraging>> choices_of(LoadAveraging) {
  return {{LoadAveraging::extrapolated, "extrapolated", "from the last three exchanges, without lag"},
          {LoadAveraging::mean, "mean", "of the last two, as published; a bed may shake"}};
}

}  // namespace thalweg::coupling
