// Walls grains bounce off: planes, with the grains on one side, and plates, parts of planes with two sides and edges.
// They may move as a given function of time (prescribed_motion.hpp).
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"
#include "dem/laws/material.hpp"
#include "dem/motion/prescribed_motion.hpp"

#include <array>
#include <optional>
#include <vector>

namespace thalweg::dem {

// Extent of a plate: how far a plane goes from its middle, along one direction in the plane and across it. A plate has
// no thickness. In a periodic box it has images; one as long as the box has no ends there.
struct PlateExtent {
  Vec3 along = Vec3::UnitX();  // unit, normal to the plane's normal
  double half_length = 0.0;    // m, along it
  double half_width = 0.0;     // m, across it
};

// A wall as a grain sees it.
struct WallView {
  double distance;  // m, of the nearest point of the wall; of a plane negative beyond it
  Vec3 normal;      // unit, from there to the grain
};

struct Plane {
  Vec3 point = Vec3::Zero();      // m, any point on it, of a plate its middle; of a wall that moves: at the start
  Vec3 normal = Vec3::UnitZ();    // unit, into the side where the grains are; of a plate either way
  double friction = 0.0;          // against grains
  double rolling_friction = 0.0;  // against grains
  Vec3 velocity = Vec3::Zero();   // m/s
  Oscillation oscillation;        // on top of the velocity
  std::optional<PlateExtent> plate;
  // True for a rough floor: at rest, with normal +z. A free grain that touches it does not move along it but may turn,
  // as if a force at its centre held it. At most one wall may be rough.
  bool rough = false;

  WallView seen_from(const Vec3& position, const PeriodicBox& box) const {
    const Vec3 from_point = position - point;
    return plate ? seen_as_plate(from_point, box) : WallView{from_point.dot(normal), normal};
  }
  // True if its position or velocity changes with time; a constant velocity of a plane within itself changes neither.
  bool changes() const;
  // The wall as it is at one time (s), with the velocity of another.
  Plane at(double time, double time_of_velocity) const;
  double largest_speed() const;                    // m/s, upper bound of the speed at which it approaches grains
  double moved_since(const Plane& earlier) const;  // m: no grain is nearer or further by more than this

private:
  WallView seen_as_plate(Vec3 from_point, const PeriodicBox& box) const;
};

// Names of the faces in cases and diagnostics, in the order of all lists of faces.
inline constexpr std::array<const char*, 6> face_names{"x_low", "x_high", "y_low", "y_high", "bottom", "top"};

// The face of the box across `axis` (0, 1, 2) at its lower or upper end. velocity: m/s.
Plane face_plane(const PeriodicBox& box, int axis, bool upper, double friction, const Vec3& velocity = Vec3::Zero());

// Every non-periodic face of the box, with the walls' friction: x lower, x upper, y lower, ...
std::vector<Plane> face_planes(const PeriodicBox& box, const ContactParameters& contact);

// Throws InputError unless the normal is a unit vector, the frictions are not negative, the motion is possible and a
// plate has positive lengths along its plane.
void check(const Plane& plane);

// Throws InputError if the nearest image of a plate is not sure to be the one whose middle is nearest: each of its
// edges must be along or across every periodic axis, or half of the plate and a grain (m) must fit into half of the
// box.
void check_images(const Plane& plane, const PeriodicBox& box, double largest_radius);

}  // namespace thalweg::dem
