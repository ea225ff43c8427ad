// Keys of walls for the grains besides the faces of the box (walls.hpp).
#pragma once

#include "core/base/types.hpp"
#include "core/keys/section_visitor.hpp"
#include "dem/laws/contact_parameters.hpp"
#include "dem/motion/motion_keys.hpp"
#include "dem/motion/walls.hpp"

#include <optional>

namespace thalweg::beds {

// Keys of a plate, a wall around its point with two sides and edges.
struct PlateKeys {
  Vec3 along = Vec3::UnitX();  // in the plane of the wall; any length but zero
  double length = 0.0;         // m, along it
  double width = 0.0;          // m, across it
  bool operator==(const PlateKeys&) const = default;
};

// A plane wall besides the faces of the box, or a plate.
struct WallKeys {
  Vec3 point = Vec3::Zero();               // m
  Vec3 normal = Vec3::UnitZ();             // into the side of the grains; any length but zero
  std::optional<double> friction;          // else contact.wall_friction
  std::optional<double> rolling_friction;  // else contact.wall_rolling_friction
  Vec3 velocity = Vec3::Zero();            // m/s
  std::optional<dem::Oscillation> oscillation;
  std::optional<PlateKeys> plate;
  bool operator==(const WallKeys&) const = default;
};

void describe(SectionVisitor& visit, WallKeys& wall);

// Throw KeyError unless a plate lies in its wall, and unless disks in the plane x-z at this y (m) stay in it.
void check(const WallKeys& wall);
void check_for_disks(const WallKeys& wall, double y);

// contact: with the friction of walls that have none of their own.
dem::Plane plane_of(const WallKeys& wall, const dem::ContactParameters& contact);

}  // namespace thalweg::beds
