#include "beds/population/wall_keys.hpp"

#include "core/keys/key_error.hpp"

#include <cmath>

namespace thalweg::beds {

static void describe(SectionVisitor& visit, PlateKeys& plate) {
  visit.vec3("along", plate.along,
             {.meaning = "direction of its length, in the plane of the wall; need not be a unit vector"});
  visit.real("length", plate.length,
             {.unit = "m",
              .meaning = "in this direction, half on either side of point",
              .required = true,
              .above = 0.0,
              .example = 0.05});
  visit.real("width", plate.width,
             {.unit = "m",
              .meaning = "across this direction, half on either side of point",
              .required = true,
              .above = 0.0,
              .example = 0.02});
  visit.require(!plate.along.isZero(0.0), "along", "a direction cannot be zero; give for example [1, 0, 0]");
}

void describe(SectionVisitor& visit, WallKeys& wall) {
  visit.vec3("point", wall.point,
             {.unit = "m",
              .meaning = "a point on the plane at the start, for a plate its centre",
              .required = true,
              .example = 0.0});
  visit.vec3("normal", wall.normal,
             {.meaning = "towards the side with the grains, for a plate either way; need not be a unit vector",
              .required = true});
  visit.real("friction", wall.friction, {.meaning = "default: contact.wall_friction", .at_least = 0.0, .example = 0.3});
  visit.real("rolling_friction", wall.rolling_friction,
             {.meaning = "default: contact.wall_rolling_friction", .at_least = 0.0, .example = 0.05});
  visit.vec3("velocity", wall.velocity, {.unit = "m/s", .meaning = "constant"});
  visit.section("oscillation", wall.oscillation, {.meaning = "added to the velocity"});
  visit.section("plate", wall.plate,
                {.meaning = "only this part of the plane, with grains on both sides and round its edges"});
  visit.require(!wall.normal.isZero(0.0), "normal", "a direction cannot be zero; give for example [0, 0, 1]");
}

void check(const WallKeys& wall) {
  constexpr double rounded = 1e-3;  // numbers with a few digits are welcome
  if (wall.plate && !(std::abs(wall.plate->along.normalized().dot(wall.normal.normalized())) < rounded))
    throw KeyError("plate.along", "a plate lies in the plane of its wall; give a direction at right angles to normal");
}

void check_for_disks(const WallKeys& wall, double y) {
  if (wall.normal.y() != 0.0) throw KeyError("normal", "disks move in the plane x-z; give a normal with 0 along y");
  if (wall.velocity.y() != 0.0)
    throw KeyError("velocity", "disks move in the plane x-z; give a vector in m/s with 0 along y");
  if (wall.oscillation && wall.oscillation->amplitude.y() != 0.0)
    throw KeyError("oscillation.amplitude", "disks move in the plane x-z; give a vector in m with 0 along y");
  if (!wall.plate) return;
  // An edge across y would push disks out of their plane.
  if (wall.plate->along.y() != 0.0)
    throw KeyError("plate.along", "disks move in the plane x-z; give a direction with 0 along y");
  if (!(std::abs(y - wall.point.y()) < 0.5 * wall.plate->width))
    throw KeyError("plate.width", "disks are in the middle of the box; give a width in m that reaches there");
}

dem::Plane plane_of(const WallKeys& wall, const dem::ContactParameters& contact) {
  dem::Plane plane;
  plane.point = wall.point;
  plane.normal = wall.normal.normalized();
  plane.friction = wall.friction.value_or(contact.wall_friction);
  plane.rolling_friction = wall.rolling_friction.value_or(contact.wall_rolling_friction);
  plane.velocity = wall.velocity;
  plane.oscillation = wall.oscillation.value_or(dem::Oscillation{});
  if (wall.plate) {
    const Vec3& along = wall.plate->along;
    const Vec3 in_plane = (along - along.dot(plane.normal) * plane.normal).normalized();
    plane.plate = {in_plane, 0.5 * wall.plate->length, 0.5 * wall.plate->width};
  }
  return plane;
}

}  // namespace thalweg::beds
