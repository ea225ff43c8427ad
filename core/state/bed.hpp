// The grains at the end of a run, from which another run can start.
#pragma once

#include "core/base/types.hpp"

#include <array>
#include <vector>

namespace thalweg {

struct BedGrain {
  GlobalId id = 0;
  double radius = 0.0;                   // m
  double density = 0.0;                  // kg/m^3
  Vec3 position = Vec3::Zero();          // m
  Vec3 velocity = Vec3::Zero();          // m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s
  GlobalId clump = -1;                   // id of the clump it is a member of; members follow each other
  bool operator==(const BedGrain&) const = default;
};

struct Bed {
  Vec3 box = Vec3::Zero();  // m
  std::array<bool, 3> periodic{};
  double time = 0.0;             // s, of the run that wrote it
  double disk_thickness = 0.0;   // m; 0: spheres
  double fastest = 0.0;          // m/s, speed of the fastest grain, where velocities are not kept
  std::vector<BedGrain> grains;  // in order of id; a rank has its share of them
};

}  // namespace thalweg
