#include "dem/motion/motion_keys.hpp"

namespace thalweg::dem {

void describe(SectionVisitor& visit, Oscillation& oscillation) {
  visit.vec3("amplitude", oscillation.amplitude,
             {.unit = "m",
              .meaning = "moves by amplitude [sin(2 pi frequency t + phase) - sin(phase)]",
              .required = true,
              .example = 1e-3});
  visit.real("frequency", oscillation.frequency,
             {.unit = "Hz", .meaning = "oscillations per second", .required = true, .above = 0.0, .example = 20.0});
  visit.real("phase", oscillation.phase, {.unit = "rad", .meaning = "at the start; pi/2 begins at rest"});
}

static void describe(SectionVisitor& visit, RotationKeys& rotation) {
  visit.vec3("point", rotation.point,
             {.unit = "m", .meaning = "on the axis, at the start", .required = true, .example = 0.03});
  visit.vec3("axis", rotation.axis, {.meaning = "direction of the axis; need not be a unit vector"});
  visit.real("angular_velocity", rotation.angular_velocity,
             {.unit = "rad/s", .meaning = "right-handed about the axis", .required = true, .example = 6.28});
  visit.require(!rotation.axis.isZero(0.0), "axis", "a direction cannot be zero; give for example [0, 1, 0]");
}

void describe(SectionVisitor& visit, MotionKeys& motion) {
  visit.vec3("velocity", motion.velocity, {.unit = "m/s", .meaning = "constant"});
  visit.section("oscillation", motion.oscillation, {.meaning = "added to the velocity"});
  visit.section("rotation", motion.rotation, {.meaning = "about an axis that moves with the body"});
}

PrescribedMotion prescribed_motion(const MotionKeys& keys) {
  PrescribedMotion motion;
  motion.velocity = keys.velocity;
  motion.oscillation = keys.oscillation.value_or(Oscillation{});
  if (!keys.rotation) return motion;
  motion.centre = keys.rotation->point;
  motion.axis = keys.rotation->axis.normalized();
  motion.angular_velocity = keys.rotation->angular_velocity;
  return motion;
}

}  // namespace thalweg::dem
