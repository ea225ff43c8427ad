// Keys of a face of the box, in SI units, and the boundary condition that follows on the lattice.
#pragma once

#include "core/base/units.hpp"
#include "core/keys/section_visitor.hpp"
#include "dem/motion/motion_keys.hpp"
#include "lbm/walls/boundary.hpp"

#include <array>
#include <optional>

namespace thalweg::coupling {

struct FaceKeys {
  lbm::FaceType type = lbm::FaceType::no_slip;
  double coefficient = lbm::derived_slip_coefficient;  // slip law of the wall: U+ at the wall
  bool of_first_cell = false;                          // slip law of the wall: lbm::slip_coefficient_at instead
  double slip_length = 0.0;                            // m, navier_slip
  Vec3 velocity = Vec3::Zero();                        // m/s, moving and velocity_inlet
  std::optional<double> recycling_plane = {};          // m along the normal, velocity_inlet; none: uniform velocity
  double pressure = 0.0;                               // Pa above the reference, pressure_outlet
  std::optional<dem::Oscillation> oscillation = {};    // moving; dry grains only

  // True if it carries the boundary layer of a smooth wall.
  bool obeys_the_law_of_the_wall() const { return lbm::traits_of(type).is_smooth; }
  // True if it exerts shear on a flow along it.
  bool drags() const { return lbm::traits_of(type).drags; }
  bool has_velocity() const { return lbm::traits_of(type).has_velocity; }
  bool operator==(const FaceKeys& other) const;  // ignores keys that the type does not use
};

void describe(SectionVisitor& visit, FaceKeys& face);

// Boundary conditions in the order of lbm::FaceConditions.
lbm::FaceConditions conditions_of(const std::array<FaceKeys, 6>& faces, const Units& units);

}  // namespace thalweg::coupling
