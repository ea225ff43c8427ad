#include "dem/contact/solid.hpp"

#include "core/base/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::dem {

namespace {

// Largest distance (m) of the surface from a point.
double farthest_from(const SolidSurface& surface, const Vec3& point) {
  return (surface.upper() - point).cwiseAbs().cwiseMax((surface.lower() - point).cwiseAbs()).norm();
}

}  // namespace

void check(const Solid& solid) {
  if (!solid.surface) throw InputError("A solid has no surface; give it one.");
  if (!(solid.friction >= 0.0 && solid.rolling_friction >= 0.0))
    throw InputError(
        fmt::format("The friction of a solid is {:g} and its rolling friction {:g}; neither may be negative.",
                    solid.friction, solid.rolling_friction));
  check(solid.motion);
}

double largest_speed_of(const Solid& solid) {
  return solid.motion.largest_speed(farthest_from(*solid.surface, solid.motion.centre));
}

PlacedSolid::PlacedSolid(const Solid& solid, double time, double time_of_velocity)
    : turns_(solid.motion.turns()),
      angle_(solid.motion.angular_velocity * time),
      pivot_(solid.motion.centre),
      centre_(solid.motion.centre + solid.motion.displacement(time)),
      velocity_(solid.motion.velocity_of(solid.motion.centre, time_of_velocity)),
      spin_(solid.motion.spin()),
      reach_(farthest_from(*solid.surface, solid.motion.centre)) {
  const Vec3 way = centre_ - pivot_;
  lower_ = solid.surface->lower() + way;
  upper_ = solid.surface->upper() + way;
  if (!turns_) return;
  turn_ = solid.motion.turn(time);
  const Vec3 middle = 0.5 * (solid.surface->lower() + solid.surface->upper());
  const Vec3 half = 0.5 * (solid.surface->upper() - solid.surface->lower());
  const Vec3 now = in_space(middle), reach = turn_.cwiseAbs() * half;
  lower_ = now - reach;
  upper_ = now + reach;
}

Vec3 PlacedSolid::in_solid(const Vec3& point) const {
  if (!turns_) return point - (centre_ - pivot_);
  return pivot_ + turn_.transpose() * (point - centre_);
}

Vec3 PlacedSolid::in_space(const Vec3& point) const {
  if (!turns_) return point + (centre_ - pivot_);
  return centre_ + turn_ * (point - pivot_);
}

double PlacedSolid::moved_since(const PlacedSolid& earlier) const {
  return (centre_ - earlier.centre_).norm() + std::abs(angle_ - earlier.angle_) * reach_;
}

}  // namespace thalweg::dem
