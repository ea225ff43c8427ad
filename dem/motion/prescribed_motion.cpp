#include "dem/motion/prescribed_motion.hpp"

#include "core/base/error.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace thalweg::dem {

namespace {

double angular_frequency(const Oscillation& o) { return 2.0 * std::numbers::pi * o.frequency; }

Vec3 turned(const Vec3& arm, const Vec3& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return c * arm + s * axis.cross(arm) + (1.0 - c) * axis.dot(arm) * axis;
}

}  // namespace

bool PrescribedMotion::moves() const {
  return oscillation.swings() || angular_velocity != 0.0 || !velocity.isZero(0.0);
}

Vec3 PrescribedMotion::displacement(double time) const {
  const double swing =
      std::sin(angular_frequency(oscillation) * time + oscillation.phase) - std::sin(oscillation.phase);
  return velocity * time + oscillation.amplitude * swing;
}

Mat3 PrescribedMotion::turn(double time) const {
  return Eigen::AngleAxisd(angular_velocity * time, axis).toRotationMatrix();
}

Vec3 PrescribedMotion::place(const Vec3& at_start, double time) const {
  if (angular_velocity == 0.0) return at_start + displacement(time);
  return displacement(time) + centre + turned(at_start - centre, axis, angular_velocity * time);
}

Vec3 PrescribedMotion::velocity_of(const Vec3& at_start, double time) const {
  const double w = angular_frequency(oscillation);
  const Vec3 straight = velocity + w * std::cos(w * time + oscillation.phase) * oscillation.amplitude;
  if (angular_velocity == 0.0) return straight;
  return straight + spin().cross(turned(at_start - centre, axis, angular_velocity * time));
}

double PrescribedMotion::largest_speed(double distance) const {
  return velocity.norm() + angular_frequency(oscillation) * oscillation.amplitude.norm() +
         std::abs(angular_velocity) * distance;
}

double PrescribedMotion::largest_speed_along(const Vec3& direction) const {
  return std::abs(velocity.dot(direction)) +
         angular_frequency(oscillation) * std::abs(oscillation.amplitude.dot(direction));
}

void check(const PrescribedMotion& m) {
  const Oscillation& o = m.oscillation;
  if (!m.velocity.allFinite() || !o.amplitude.allFinite() || !m.centre.allFinite() ||
      !std::isfinite(m.angular_velocity) || !std::isfinite(o.phase))
    throw InputError("A prescribed motion holds a number that is not finite; give finite SI values.");
  if (!(o.frequency >= 0.0) || !std::isfinite(o.frequency))
    throw InputError(
        fmt::format("The frequency of a prescribed motion is {:g} Hz; it must be zero or positive.", o.frequency));
  if (!(std::abs(m.axis.norm() - 1.0) < 1e-12))
    throw InputError(fmt::format("The axis ({:g}, {:g}, {:g}) of a prescribed motion has length {:g}; it must be 1.",
                                 m.axis[0], m.axis[1], m.axis[2], m.axis.norm()));
}

}  // namespace thalweg::dem
