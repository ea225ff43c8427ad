#include "beds/packing/random_places.hpp"

#include "core/base/counter_random.hpp"

#include <fmt/format.h>

namespace thalweg::beds {

Vec3 random_place(const PeriodicBox& box, const GrainsToPlace& grains, std::int64_t number, unsigned attempt) {
  const Region& region = grains.region;
  Vec3 place;
  for (unsigned axis = 0; axis < 3; ++axis) {
    if (region.plane && axis == 1) {
      place[1] = 0.5 * (region.lower[1] + region.upper[1]);
      continue;
    }
    const double margin = wraps(box, region, static_cast<int>(axis)) ? 0.0 : grains.radius(number) + grains.clearance;
    const double free = region.upper[axis] - region.lower[axis] - 2.0 * margin;
    place[axis] = region.lower[axis] + margin +
                  free * uniform_random(grains.seed, static_cast<std::uint64_t>(number), 3u * attempt + axis);
  }
  return box.wrapped(place);
}

bool has_room_at_random(const PeriodicBox& box, const GrainsToPlace& grains) {
  for (int axis = 0; axis < 3; ++axis) {
    if (wraps(box, grains.region, axis) || (grains.region.plane && axis == 1)) continue;
    const double extent = grains.region.upper[axis] - grains.region.lower[axis];
    if (extent - 2.0 * (grains.largest_radius + grains.clearance) < 0.0) return false;
  }
  return true;
}

InputError too_many_at_random(const GrainsToPlace& grains, std::int64_t placed) {
  const Vec3 extent = grains.region.upper - grains.region.lower;
  return InputError(
      fmt::format("{} grains do not fit at random in {:g} x {:g} x {:g} m: {} did; use fewer or smaller "
                  "grains, a larger region, or another placement.pattern (dense or uniform).",
                  grains.count, extent.x(), extent.y(), extent.z(), placed));
}

}  // namespace thalweg::beds
