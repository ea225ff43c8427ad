// Keys of the motion of walls and rigid assemblies of grains (prescribed_motion.hpp).
#pragma once

#include "core/base/types.hpp"
#include "core/keys/section_visitor.hpp"
#include "dem/motion/prescribed_motion.hpp"

#include <optional>

namespace thalweg::dem {

struct RotationKeys {
  Vec3 point = Vec3::Zero();      // m, on the axis, at the start
  Vec3 axis = Vec3::UnitY();      // any length but zero
  double angular_velocity = 0.0;  // rad/s
  bool operator==(const RotationKeys&) const = default;
};

// Keys of a population that moves as one rigid body.
struct MotionKeys {
  Vec3 velocity = Vec3::Zero();  // m/s
  std::optional<Oscillation> oscillation;
  std::optional<RotationKeys> rotation;  // about an axis that moves along
  bool operator==(const MotionKeys&) const = default;
};

void describe(SectionVisitor& visit, Oscillation& oscillation);
void describe(SectionVisitor& visit, MotionKeys& motion);

PrescribedMotion prescribed_motion(const MotionKeys& motion);

}  // namespace thalweg::dem
