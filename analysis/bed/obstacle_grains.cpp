#include "analysis/bed/obstacle_grains.hpp"

#include <algorithm>
#include <utility>

namespace thalweg::analysis {

ObstacleGrains::ObstacleGrains(std::vector<GlobalId> ids) : ids_(std::move(ids)) {}

bool ObstacleGrains::has(GlobalId id) const { return std::binary_search(ids_.begin(), ids_.end(), id); }

bool ObstacleGrains::are_the_bed(const Snapshot& snapshot) const {
  return any() && static_cast<std::int64_t>(ids_.size()) == snapshot.grains.global_count;
}

std::vector<char> ObstacleGrains::in_the_bed(const Snapshot& snapshot) const {
  if (!any() || are_the_bed(snapshot)) return {};
  std::vector<char> found;
  for (const GlobalId id : snapshot.grains.id) found.push_back(has(id) ? 1 : 0);
  return found;
}

}  // namespace thalweg::analysis
