// The state of single grains and what acts on them, as rows that can be sent from rank to rank.
#pragma once

#include "core/state/profile.hpp"
#include "core/state/snapshot.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::analysis {

struct GrainRecord {
  enum Quantity { position, velocity, angular_velocity, fluid_force, fluid_couple, contact_force, quantities };

  GlobalId id = -1;
  std::array<double, 3 * quantities> values{};  // three of each quantity

  Vec3 operator[](Quantity q) const {
    const auto n = 3 * static_cast<std::size_t>(q);
    return {values[n], values[n + 1], values[n + 2]};
  }
  void set(Quantity q, const Vec3& v) { std::copy_n(v.data(), 3, values.begin() + 3 * q); }
};

// Names and units of the quantities, in their order. The couple of the fluid is its torque about the grain's centre.
inline const std::array<std::pair<std::string, std::string>, GrainRecord::quantities> recorded_quantities{
    {{"position", "m"},
     {"velocity", "m/s"},
     {"angular_velocity", "rad/s"},
     {"fluid_force", "N"},
     {"fluid_couple", "N m"},
     {"contact_force", "N"}}};

// Record of grain n of the view. The load of the fluid is the one applied during the step, zero without a fluid;
// contact forces are those at its end.
inline GrainRecord record_of(const GrainView& grains, std::size_t n) {
  GrainRecord record;
  record.id = grains.id[n];
  record.set(GrainRecord::position, grains.position[n]);
  record.set(GrainRecord::velocity, grains.velocity[n]);
  record.set(GrainRecord::angular_velocity, grains.angular_velocity[n]);
  if (!grains.fluid_force.empty()) record.set(GrainRecord::fluid_force, grains.fluid_force[n]);
  if (!grains.fluid_torque.empty()) record.set(GrainRecord::fluid_couple, grains.fluid_torque[n]);
  if (!grains.contact_force.empty()) record.set(GrainRecord::contact_force, grains.contact_force[n]);
  return record;
}

}  // namespace thalweg::analysis
