#include "driver/case_sections.hpp"

// Sections of walls besides the faces, and of what moves as a given function of time.
namespace thalweg {

void describe(SectionVisitor& visit, OscillationCase& oscillation) {
  visit.vec3("amplitude", oscillation.amplitude,
             {.unit = "m",
              .meaning = "moves by amplitude [sin(2 pi frequency t + phase) - sin(phase)]",
              .required = true,
              .example = 1e-3});
  visit.real("frequency", oscillation.frequency,
             {.unit = "Hz", .meaning = "swings a second", .required = true, .above = 0.0, .example = 20.0});
  visit.real("phase", oscillation.phase, {.unit = "rad", .meaning = "at the start; pi/2 begins at rest"});
}

static void describe(SectionVisitor& visit, RotationCase& rotation) {
  visit.vec3("point", rotation.point,
             {.unit = "m", .meaning = "on the axis, at the start", .required = true, .example = 0.03});
  visit.vec3("axis", rotation.axis, {.meaning = "along the axis, of any length"});
  visit.real("angular_velocity", rotation.angular_velocity,
             {.unit = "rad/s", .meaning = "right-handed about the axis", .required = true, .example = 6.28});
  visit.require(!rotation.axis.isZero(0.0), "axis", "a direction cannot be zero; give for example [0, 1, 0]");
}

void describe(SectionVisitor& visit, MotionCase& motion) {
  visit.vec3("velocity", motion.velocity, {.unit = "m/s", .meaning = "constant"});
  visit.section("oscillation", motion.oscillation, {.meaning = "on top of the velocity"});
  visit.section("rotation", motion.rotation, {.meaning = "about an axis that moves along"});
}

static void describe(SectionVisitor& visit, PlateCase& plate) {
  visit.vec3("along", plate.along, {.meaning = "direction of its length in the plane of the wall, of any length"});
  visit.real("length", plate.length,
             {.unit = "m",
              .meaning = "along it, half on either side of point",
              .required = true,
              .above = 0.0,
              .example = 0.05});
  visit.real("width", plate.width,
             {.unit = "m",
              .meaning = "across it, half on either side of point",
              .required = true,
              .above = 0.0,
              .example = 0.02});
  visit.require(!plate.along.isZero(0.0), "along", "a direction cannot be zero; give for example [1, 0, 0]");
}

void describe(SectionVisitor& visit, WallCase& wall) {
  visit.vec3(
      "point", wall.point,
      {.unit = "m", .meaning = "on the plane, of a plate its middle, at the start", .required = true, .example = 0.0});
  visit.vec3("normal", wall.normal,
             {.meaning = "into the side of the grains, of a plate either way; of any length", .required = true});
  visit.real("friction", wall.friction,
             {.meaning = "contact.wall_friction where not given", .at_least = 0.0, .example = 0.3});
  visit.real("rolling_friction", wall.rolling_friction,
             {.meaning = "contact.wall_rolling_friction where not given", .at_least = 0.0, .example = 0.05});
  visit.vec3("velocity", wall.velocity, {.unit = "m/s", .meaning = "constant"});
  visit.section("oscillation", wall.oscillation, {.meaning = "on top of the velocity"});
  visit.section("plate", wall.plate,
                {.meaning = "only this part of the plane, with grains on both sides and round its edges"});
  visit.require(!wall.normal.isZero(0.0), "normal", "a direction cannot be zero; give for example [0, 0, 1]");
}

}  // namespace thalweg
