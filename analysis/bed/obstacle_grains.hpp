// Grains that are obstacles in a bed, such as the spheres of a sill or a boulder, by their ids.
#pragma once

#include "core/state/snapshot.hpp"

#include <vector>

namespace thalweg::analysis {

class ObstacleGrains {
public:
  explicit ObstacleGrains(std::vector<GlobalId> ids = {});  // ascending

  bool any() const { return !ids_.empty(); }
  bool has(GlobalId id) const;
  bool are_the_bed(const Snapshot& snapshot) const;  // they are all the grains
  // Of each grain here, whether it is an obstacle in a bed of others; empty where there is no such grain.
  std::vector<char> in_the_bed(const Snapshot& snapshot) const;

private:
  std::vector<GlobalId> ids_;
};

}  // namespace thalweg::analysis
