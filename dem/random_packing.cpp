#include "dem/random_packing.hpp"

#include "dem/random_places.hpp"
#include "dem/sphere_cells.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace thalweg::dem {

namespace {

// Those of all ranks, on every rank.
std::vector<Obstacle> known_to_all(const PlacingRanks& ranks, std::span<const Obstacle> known) {
  struct Row {
    std::int64_t number;
    double position[3], radius;
  };
  std::vector<Row> rows;
  for (const Obstacle& obstacle : known) {
    const Vec3 at = ranks.box().wrapped(obstacle.sphere.position);
    rows.push_back({obstacle.number, {at.x(), at.y(), at.z()}, obstacle.sphere.radius});
  }
  std::vector<Obstacle> all;
  for (const Row& row : ranks.to_all(std::move(rows))) all.push_back({{Vec3(row.position), row.radius}, row.number});
  return all;
}

}  // namespace

std::vector<PlacedGrain> placed_one_by_one(const PlacingRanks& ranks, const GrainsToPlace& grains,
                                           std::span<const Obstacle> obstacles) {
  const std::vector<Obstacle> all = known_to_all(ranks, obstacles);
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
    } while (cells.overlaps(sphere) || ranks.blocked(sphere.position, sphere.radius));
    cells.add(sphere);
    if (ranks.knows(sphere.position)) placed.push_back({order[n], sphere.position});
  }
  std::sort(placed.begin(), placed.end());
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
