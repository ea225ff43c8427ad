#include "analysis/observer/run_context.hpp"

#include <algorithm>

namespace thalweg::analysis {

bool is_held(const std::vector<HeldGrains>& held, GlobalId id) {
  return std::any_of(held.begin(), held.end(),
                     [id](const HeldGrains& some) { return id >= some.first && id < some.end; });
}

std::vector<HeldGrains> GrainContext::held() const {
  std::vector<HeldGrains> found;
  for (const PopulationContext& population : populations)
    if (population.held) found.push_back({population.first, population.end});
  return found;
}

bool GrainContext::any_free() const {
  return std::any_of(populations.begin(), populations.end(), [](const PopulationContext& some) { return !some.held; });
}

bool GrainContext::any_clumps() const {
  return std::any_of(populations.begin(), populations.end(), [](const PopulationContext& some) { return some.clumps; });
}

GlobalId GrainContext::first_member(GlobalId id) const {
  for (const PopulationContext& some : populations)
    if (id >= some.first && id < some.end) return id - (id - some.first) % some.members;
  return id;
}

}  // namespace thalweg::analysis
