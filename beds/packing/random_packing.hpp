// Packings at random. The place of each grain depends on the others, so the ranks work together. Places do not depend
// on the number of ranks; no rank has more than the grains around its block.
#pragma once

#include "beds/packing/packing.hpp"
#include "beds/packing/packing_domain.hpp"
#include "core/base/types.hpp"
#include "dem/clumps/placed_sphere.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace thalweg::beds {

struct GrainsToPlace {
  Region region;
  std::int64_t count;                          // numbered from 0 on
  std::function<double(std::int64_t)> radius;  // m, of a number
  double largest_radius;                       // m
  double clearance;                            // m, surface to the region's faces that are not periodic
  std::uint64_t seed;
};

// Sphere that grains keep clear of. Each has a number of its own, the same on all ranks.
struct Obstacle {
  dem::PlacedSphere sphere;
  std::int64_t number;
};

struct PlacedGrain {
  std::int64_t number;
  Vec3 centre;  // m, wrapped
  bool operator<(const PlacedGrain& other) const { return number < other.number; }
};

// The grains that this rank knows (packing_domain.hpp), in order of their numbers. obstacles: those that it knows.
// Collective. Throws InputError on every rank if the grains do not fit.
//
// Each grain is put anywhere, again and again until it is clear of all others and of the obstacles (random sequential
// addition). Beyond about a third of the volume that gets hard. Each rank decides about the places in its block. All
// grains of a size class try at once, the largest first, each class down to 0.95 of the one before; of two in each
// other's way the one with the lower number goes first.
std::vector<PlacedGrain> random_packing(const PackingDomain& ranks, const GrainsToPlace& grains,
                                        std::span<const Obstacle> obstacles);

// Packing for beds and suspensions that fill up to 0.6 of the volume: grains start at random and are pushed apart, in
// proportion to their overlaps, until none overlap (after W. S. Jodrey and E. M. Tory, Phys. Rev. A 32 (1985) 2347).
// Nearest neighbours are then at least a diameter apart, most of them little more.
std::vector<PlacedGrain> dense_packing(const PackingDomain& ranks, const GrainsToPlace& grains,
                                       std::span<const Obstacle> obstacles);

// Packings in one process: centres (m), one for each radius (m).
std::vector<Vec3> random_packing(const PeriodicBox& box, const Region& region, std::span<const double> radii,
                                 double clearance, std::uint64_t seed,
                                 std::span<const dem::PlacedSphere> obstacles = {});
std::vector<Vec3> dense_packing(const PeriodicBox& box, const Region& region, std::span<const double> radii,
                                double clearance, std::uint64_t seed,
                                std::span<const dem::PlacedSphere> obstacles = {});

}  // namespace thalweg::beds
