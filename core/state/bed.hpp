// The grains at the end of a run, from which another run can start.
#pragma once

#include "core/base/types.hpp"

#include <array>
#include <memory>
#include <vector>

namespace thalweg {

// The body that the members of a clump stand for.
struct BedBody {
  double volume = 0.0;                                    // m^3
  Vec3 from_first = Vec3::Zero();                         // m, from the centre of the first member to its own
  Vec3 moments = Vec3::Zero();                            // m^5, about its principal axes, at 1 kg/m^3
  std::array<double, 4> orientation{1.0, 0.0, 0.0, 0.0};  // w, x, y, z: a unit quaternion from these axes to space
  bool operator==(const BedBody&) const = default;
};

struct BedGrain {
  GlobalId id = 0;
  double radius = 0.0;                   // m
  double density = 0.0;                  // kg/m^3
  Vec3 position = Vec3::Zero();          // m
  Vec3 velocity = Vec3::Zero();          // m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s
  GlobalId clump = -1;                   // id of the clump it is a member of; members follow each other
  // Of the first member of a clump; none: the clump is the union of its members.
  std::shared_ptr<const BedBody> body = {};

  bool operator==(const BedGrain& other) const {
    return id == other.id && radius == other.radius && density == other.density && position == other.position &&
           velocity == other.velocity && angular_velocity == other.angular_velocity && clump == other.clump &&
           (body && other.body ? *body == *other.body : body == other.body);
  }
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
