// Plane walls grains bounce off.
#pragma once

#include "core/periodic_box.hpp"
#include "core/types.hpp"
#include "dem/material.hpp"

#include <vector>

namespace thalweg::dem {

struct Plane {
  Vec3 point = Vec3::Zero();      // m, any point on it
  Vec3 normal = Vec3::UnitZ();    // unit, into the side where the grains are
  double friction = 0.0;          // against grains
  double rolling_friction = 0.0;  // against grains
  Vec3 velocity = Vec3::Zero();   // m/s of the wall's surface, in its plane: the plane itself stays where it is
};

// The face of the box across `axis` (0, 1, 2) at its lower or upper end.
Plane face_plane(const PeriodicBox& box, int axis, bool upper, double friction, const Vec3& velocity = Vec3::Zero());

// Every non-periodic face of the box, with the walls' friction: x lower, x upper, y lower, ...
std::vector<Plane> face_planes(const PeriodicBox& box, const ContactParameters& contact);

// Throws InputError unless the normal is a unit vector, the friction is not negative and the velocity is in the plane.
void check(const Plane& plane);

}  // namespace thalweg::dem
