#include "dem/random_packing.hpp"

#include "core/counter_random.hpp"
#include "dem/random_places.hpp"
#include "dem/sphere_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace thalweg::dem {

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
                  "grains, a larger region, or another placement.pattern: uniform, or dense.",
                  grains.count, extent.x(), extent.y(), extent.z(), placed));
}

namespace {

// Of all ranks, in order of their numbers, on every rank.
std::vector<Obstacle> gathered(const PlacingRanks& ranks, std::span<const Obstacle> known) {
  struct Row {
    std::int64_t number;
    double position[3], radius;
  };
  std::vector<Row> own;
  for (const Obstacle& obstacle : known) {
    const Vec3 at = ranks.box().wrapped(obstacle.sphere.position);
    if (ranks.owns(at)) own.push_back({obstacle.number, {at.x(), at.y(), at.z()}, obstacle.sphere.radius});
  }
  std::vector<Obstacle> all;
  for (const Row& row : ranks.gathered(own)) all.push_back({{Vec3(row.position), row.radius}, row.number});
  return all;
}

}  // namespace

std::vector<PlacedGrain> placed_one_by_one(const PlacingRanks& ranks, const GrainsToPlace& grains,
                                           std::span<const Obstacle> obstacles) {
  const std::vector<Obstacle> all = gathered(ranks, obstacles);
  if (!has_room_at_random(ranks.box(), grains)) throw too_many_at_random(grains, 0);
  double largest = grains.largest_radius;
  for (const Obstacle& obstacle : all) largest = std::max(largest, obstacle.sphere.radius);
  SphereCells cells(ranks.box(), largest);
  for (const Obstacle& obstacle : all) cells.add(obstacle.sphere);
  std::vector<std::int64_t> order(static_cast<std::size_t>(grains.count));
  std::iota(order.begin(), order.end(), std::int64_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return grains.radius(a) > grains.radius(b); });

  std::vector<PlacedGrain> placed;
  for (std::size_t n = 0; n < order.size(); ++n) {
    Sphere sphere{Vec3::Zero(), grains.radius(order[n])};
    unsigned attempt = 0;
    do {
      if (attempt == most_attempts_at_random) throw too_many_at_random(grains, static_cast<std::int64_t>(n));
      sphere.position = random_place(ranks.box(), grains, order[n], attempt++);
    } while (cells.overlaps(sphere));
    cells.add(sphere);
    if (ranks.knows(sphere.position)) placed.push_back({order[n], sphere.position});
  }
  std::sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
  return placed;
}

std::vector<PlacedGrain> random_packing(const PlacingRanks& ranks, const GrainsToPlace& grains,
                                        std::span<const Obstacle> obstacles) {
  check_region(ranks.box(), grains.region);
  if (grains.count == 0) return {};
  const auto own = std::count_if(obstacles.begin(), obstacles.end(), [&](const Obstacle& obstacle) {
    return ranks.owns(ranks.box().wrapped(obstacle.sphere.position));
  });
  constexpr std::int64_t few = 100'000;
  const bool few_spheres = grains.count + ranks.sum(own) <= few;
  return few_spheres ? placed_one_by_one(ranks, grains, obstacles) : placed_together(ranks, grains, obstacles);
}

namespace {

// What a packing of several ranks makes for one process.
std::vector<Vec3> packed_alone(const auto& packing, const PeriodicBox& box, const Region& region,
                               std::span<const double> radii, double clearance, std::uint64_t seed,
                               std::span<const Sphere> obstacles) {
  if (radii.empty()) return {};
  std::vector<Obstacle> numbered;
  for (const Sphere& sphere : obstacles) numbered.push_back({sphere, static_cast<std::int64_t>(numbered.size())});
  const GrainsToPlace grains{region,
                             static_cast<std::int64_t>(radii.size()),
                             [radii](std::int64_t number) { return radii[static_cast<std::size_t>(number)]; },
                             *std::max_element(radii.begin(), radii.end()),
                             clearance,
                             seed};
  std::vector<Vec3> centres;
  for (const PlacedGrain& grain : packing(PlacingRanks(box), grains, numbered)) centres.push_back(grain.centre);
  return centres;
}

}  // namespace

std::vector<Vec3> random_packing(const PeriodicBox& box, const Region& region, std::span<const double> radii,
                                 double clearance, std::uint64_t seed, std::span<const Sphere> obstacles) {
  const auto packing = [](const auto&... of) { return random_packing(of...); };
  return packed_alone(packing, box, region, radii, clearance, seed, obstacles);
}

std::vector<Vec3> dense_packing(const PeriodicBox& box, const Region& region, std::span<const double> radii,
                                double clearance, std::uint64_t seed, std::span<const Sphere> obstacles) {
  const auto packing = [](const auto&... of) { return dense_packing(of...); };
  return packed_alone(packing, box, region, radii, clearance, seed, obstacles);
}

}  // namespace thalweg::dem
