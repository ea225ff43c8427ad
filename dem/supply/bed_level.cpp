#include "dem/supply/bed_level.hpp"

#include "core/geometry/triangle_crossing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace thalweg::dem {

namespace {

constexpr double steepest = 1e-6;  // vertical component of the normal: walls that are steeper have no top
constexpr double slack = 1e-9;     // of the box, by which a point may be off a plate

// Where a vertical line goes through a wall; none: nowhere, or it comes from beyond the wall.
std::optional<double> height_of(const Plane& wall, const Vec3& line, const PeriodicBox& box) {
  if (std::abs(wall.normal.z()) < steepest || (!wall.plate && wall.normal.z() < 0.0)) return std::nullopt;
  // From the nearest image of a plate, however far it has travelled.
  const Vec3 off = wall.plate ? box.difference(line, box.wrapped_from_afar(wall.point)) : Vec3(line - wall.point);
  const double height = wall.point.z() - off.head<2>().dot(wall.normal.head<2>()) / wall.normal.z();
  if (wall.plate && wall.seen_from(Vec3(line.x(), line.y(), height), box).distance > slack * box.size.maxCoeff())
    return std::nullopt;
  return height;
}

// Calls visit(height) for the heights (m) at which the vertical line from the floor to a point goes through an image of
// a solid.
template <typename Visit>
void for_each_crossing(const PlacedSolid& placed, const SolidSurface& surface, const Vec3& from, const Vec3& shift,
                       Visit visit) {
  const Vec3 top = from - shift, floor(top.x(), top.y(), -shift.z());
  if (surface.rounding() > 0.0) {
    const Vec3 centre = placed.in_space(0.5 * (surface.lower() + surface.upper()));
    const double aside = (top - centre).head<2>().squaredNorm(), square = surface.rounding() * surface.rounding();
    if (aside < square) visit(centre.z() + std::sqrt(square - aside) + shift.z());
    return;
  }
  for (const std::array<Vec3, 3>& triangle : surface.triangles_along(placed.in_solid(top), placed.in_solid(floor))) {
    Corners turned;  // z, x, y: so that the line is along the first axis
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 corner = placed.in_space(triangle[k]);
      turned[k] = Vec3(corner.z(), corner.x(), corner.y());
    }
    if (const auto hit = crossing(turned, top.x(), top.y())) visit(hit->x + shift.z());
  }
}

}  // namespace

double level_of_surroundings(const Vec3& from, const Surroundings& around) {
  double level = 0.0;
  const auto take = [&](double height) {
    if (height <= from.z()) level = std::max(level, height);
  };
  for (const Plane& wall : around.walls)
    if (const std::optional<double> height = height_of(wall, from, around.box)) take(*height);
  const Vec3 middle(from.x(), from.y(), 0.5 * from.z());
  for (std::size_t n = 0; n < around.placed.size(); ++n)
    for_each_image(around.placed[n], around.box, middle, middle.z(), [&](const Vec3& shift) {
      for_each_crossing(around.placed[n], *around.solids[n].surface, from, shift, take);
    });
  return level;
}

double level_of_grains(const Vec3& axis, double radius, const GrainStore& store, std::span<const std::size_t> slots,
                       const PeriodicBox& box) {
  double level = 0.0;
  for (const std::size_t s : slots) {
    const double apart = radius + store.radius[s];
    if (box.difference(store.position[s], axis).head<2>().squaredNorm() < apart * apart)
      level = std::max(level, store.position[s].z() + store.radius[s]);
  }
  return level;
}

}  // namespace thalweg::dem
