#include "analysis/observer/run_facts.hpp"

#include <algorithm>

namespace thalweg::analysis {

bool is_held(const std::vector<HeldGrains>& held, GlobalId id) {
  return std::any_of(held.begin(), held.end(),
                     [id](const HeldGrains& some) { return id >= some.first && id < some.end; });
}

std::vector<HeldGrains> GrainFacts::held() const {
  std::vector<HeldGrains> found;
  for (const Population& population : populations)
    if (population.held) found.push_back({population.first, population.end});
  return found;
}

bool GrainFacts::any_clumps() const {
  return std::any_of(populations.begin(), populations.end(), [](const Population& some) { return some.clumps; });
}

}  // namespace thalweg::analysis
