// Plane walls grains bounce off. They may move as a given function of time (prescribed_motion.hpp).
#pragma once

#include "core/periodic_box.hpp"
#include "core/types.hpp"
#include "dem/material.hpp"
#include "dem/prescribed_motion.hpp"

#include <array>
#include <vector>

namespace thalweg::dem {

struct Plane {
  Vec3 point = Vec3::Zero();      // m, any point on it; of a wall that moves: at the start
  Vec3 normal = Vec3::UnitZ();    // unit, into the side where the grains are
  double friction = 0.0;          // against grains
  double rolling_friction = 0.0;  // against grains
  Vec3 velocity = Vec3::Zero();   // m/s
  Oscillation oscillation;        // on top of the velocity

  // Whether its place or its velocity changes with time: a velocity in its own plane alone changes neither.
  bool changes() const;
  // The wall as it is at one time (s), with the velocity of another.
  Plane at(double time, double time_of_velocity) const;
  double largest_normal_speed() const;  // m/s, at any time
};

// The faces in the order of all lists of them, as cases and figures name them.
inline constexpr std::array<const char*, 6> face_names{"x_low", "x_high", "y_low", "y_high", "bottom", "top"};

// The face of the box across `axis` (0, 1, 2) at its lower or upper end.
Plane face_plane(const PeriodicBox& box, int axis, bool upper, double friction, const Vec3& velocity = Vec3::Zero());

// Every non-periodic face of the box, with the walls' friction: x lower, x upper, y lower, ...
std::vector<Plane> face_planes(const PeriodicBox& box, const ContactParameters& contact);

// Throws InputError unless the normal is a unit vector, the frictions are not negative and the motion is possible.
void check(const Plane& plane);

}  // namespace thalweg::dem
