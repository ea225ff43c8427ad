#include "dem/motion/walls.hpp"

#include "core/base/error.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace thalweg::dem {

namespace {

PrescribedMotion motion_of(const Plane& plane) {
  PrescribedMotion motion;
  motion.velocity = plane.velocity;
  motion.oscillation = plane.oscillation;
  return motion;
}

void check_plate(const PlateExtent& plate, const Vec3& normal) {
  const Vec3& a = plate.along;
  if (!(std::abs(a.norm() - 1.0) < 1e-12) || !(std::abs(a.dot(normal)) < 1e-12))
    throw InputError(fmt::format("The direction ({:g}, {:g}, {:g}) of a plate must have length 1 and lie in its plane.",
                                 a[0], a[1], a[2]));
  if (!(plate.half_length > 0.0 && plate.half_width > 0.0))
    throw InputError(fmt::format("A plate reaches {:g} m along and {:g} m across its direction; both must be positive.",
                                 plate.half_length, plate.half_width));
}

}  // namespace

bool Plane::changes() const {
  const bool moves = plate ? !velocity.isZero(0.0) : velocity.dot(normal) != 0.0;
  return moves || oscillation.swings();
}

WallView Plane::seen_as_plate(Vec3 from_point, const PeriodicBox& box) const {
  for (int axis = 0; axis < 3; ++axis)
    if (box.periodic[axis]) from_point[axis] -= box.size[axis] * std::round(from_point[axis] / box.size[axis]);
  const Vec3 across = normal.cross(plate->along);
  const double height = from_point.dot(normal), u = from_point.dot(plate->along), v = from_point.dot(across);
  const double past_end = u - std::clamp(u, -plate->half_length, plate->half_length);
  const double past_side = v - std::clamp(v, -plate->half_width, plate->half_width);
  if (past_end == 0.0 && past_side == 0.0) return {std::abs(height), height < 0.0 ? Vec3(-normal) : normal};
  const Vec3 from_edge = height * normal + past_end * plate->along + past_side * across;
  const double distance = from_edge.norm();
  return {distance, from_edge / distance};
}

Plane Plane::at(double time, double time_of_velocity) const {
  const PrescribedMotion motion = motion_of(*this);
  Plane now = *this;
  now.point = motion.place(point, time);
  now.velocity = motion.velocity_of(point, time_of_velocity);
  return now;
}

double Plane::largest_speed() const {
  const PrescribedMotion motion = motion_of(*this);
  return plate ? motion.largest_speed(0.0) : motion.largest_speed_along(normal);
}

double Plane::moved_since(const Plane& earlier) const {
  const Vec3 way = point - earlier.point;
  return plate ? way.norm() : std::abs(way.dot(normal));
}

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
  if (plane.plate) check_plate(*plane.plate, n);
  check(motion_of(plane));
}

void check_images(const Plane& plane, const PeriodicBox& box, double largest_radius) {
  if (!plane.plate) return;
  const PlateExtent& plate = *plane.plate;
  const Vec3 across = plane.normal.cross(plate.along);
  for (int axis = 0; axis < 3; ++axis) {
    const double u = std::abs(plate.along[axis]), v = std::abs(across[axis]), w = std::abs(plane.normal[axis]);
    const bool askew = std::max({std::min(u, v), std::min(u, w), std::min(v, w)}) > 1e-9;
    const double reach = u * plate.half_length + v * plate.half_width;
    if (box.periodic[axis] && askew && reach + largest_radius > 0.5 * box.size[axis])
      throw InputError(fmt::format(
          "A plate askew to the periodic axis {} reaches {:g} m to either side of its middle; with a grain of radius "
          "{:g} m that must be less than half the box, {:g} m, or the plate be turned along the axis.",
          "xyz"[axis], reach, largest_radius, 0.5 * box.size[axis]));
  }
}

}  // namespace thalweg::dem
