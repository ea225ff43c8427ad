#include "dem/walls.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace thalweg::dem {

namespace {

PrescribedMotion motion_of(const Plane& plane) {
  PrescribedMotion motion;
  motion.velocity = plane.velocity;
  motion.oscillation = plane.oscillation;
  return motion;
}

}  // namespace

bool Plane::changes() const {
  return velocity.dot(normal) != 0.0 || (oscillation.frequency > 0.0 && !oscillation.amplitude.isZero(0.0));
}

Plane Plane::at(double time, double time_of_velocity) const {
  const PrescribedMotion motion = motion_of(*this);
  Plane now = *this;
  now.point = motion.place(point, time);
  now.velocity = motion.velocity_of(point, time_of_velocity);
  return now;
}

double Plane::largest_normal_speed() const { return motion_of(*this).largest_speed_along(normal); }

Plane face_plane(const PeriodicBox& box, int axis, bool upper, double friction, const Vec3& velocity) {
  Plane plane;
  plane.normal = Vec3::Zero();
  plane.normal[axis] = upper ? -1.0 : 1.0;
  if (upper) plane.point[axis] = box.size[axis];
  plane.friction = friction;
  plane.velocity = velocity;
  return plane;
}

std::vector<Plane> face_planes(const PeriodicBox& box, const ContactParameters& contact) {
  std::vector<Plane> planes;
  for (int axis = 0; axis < 3; ++axis) {
    if (box.periodic[axis]) continue;
    for (const bool upper : {false, true}) {
      planes.push_back(face_plane(box, axis, upper, contact.wall_friction));
      planes.back().rolling_friction = contact.wall_rolling_friction;
    }
  }
  return planes;
}

void check(const Plane& plane) {
  const Vec3& n = plane.normal;
  if (!(std::abs(n.norm() - 1.0) < 1e-12))
    throw InputError(fmt::format("The normal ({:g}, {:g}, {:g}) of a wall has length {:g}; it must be 1.", n[0], n[1],
                                 n[2], n.norm()));
  if (!(plane.friction >= 0.0))
    throw InputError(fmt::format("The friction of a wall is {:g}; it must be zero or positive.", plane.friction));
  if (!(plane.rolling_friction >= 0.0))
    throw InputError(
        fmt::format("The rolling friction of a wall is {:g}; it must be zero or positive.", plane.rolling_friction));
  check(motion_of(plane));
}

}  // namespace thalweg::dem
