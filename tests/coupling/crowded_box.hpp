// Boxes full of grains that cross rank borders and periodic faces all the time, and the ways to cut them.
#pragma once

#include "tests/coupling/water_box.hpp"

#include <cmath>
#include <vector>

namespace thalweg::coupling {

inline std::vector<Index3> layouts_of(int ranks) {
  std::vector<Index3> layouts;
  for (int x = 1; x <= ranks; ++x)
    for (int y = 1; x * y <= ranks; ++y)
      if (ranks % (x * y) == 0) layouts.push_back({x, y, ranks / (x * y)});
  return layouts;
}

// Two of them, cut as differently as can be, where all would take too long.
inline std::vector<Index3> two_layouts_of(int ranks) {
  const std::vector<Index3> all = layouts_of(ranks);
  return {all[all.size() / 2], all.back()};
}

inline FluidInitialState swirl(const Vec3& p) {
  return {0.0, Vec3(0.4 + 0.1 * std::sin(500.0 * p.z()), 0.1 * std::sin(300.0 * p.x()), 0.1 * std::cos(400.0 * p.y()))};
}

inline WaterBox crowded(const Index3& cells, const std::array<bool, 3>& periodic, int count, double distance) {
  WaterBox box;
  box.cells = cells;
  box.periodic = periodic;
  box.spacing = 5e-3 / 6.0;
  box.gravity = Vec3(1.0, 0.3, -9.0);
  box.sub_steps = 20;
  box.initial = swirl;
  const Index3 places{static_cast<int>(cells[0] * box.spacing / distance),
                      static_cast<int>(cells[1] * box.spacing / distance),
                      static_cast<int>(cells[2] * box.spacing / distance)};
  for (int k = 0; k < count; ++k) {
    const Index3 at{k % places[0], k / places[0] % places[1], k / (places[0] * places[1])};
    const Vec3 wobble(std::sin(1.0 + k), std::sin(2.0 + 3.0 * k), std::sin(5.0 * k));
    box.seeds.push_back(glass_sphere(k, distance * Vec3(at[0] + 0.5, at[1] + 0.5, at[2] + 0.5) + 1e-4 * wobble,
                                     0.5 * Vec3(std::cos(2.0 * k), std::sin(3.0 * k), std::cos(7.0 * k))));
  }
  return box;
}

// Turning clumps in place of the grains.
inline WaterBox crowded_pebbles(const Index3& cells, const std::array<bool, 3>& periodic, int count, double distance) {
  WaterBox box = crowded(cells, periodic, count, distance);
  GlobalId id = 0;
  for (const dem::GrainSeed& seed : box.seeds) {
    box.clumps.push_back(
        glass_clump(id, pebble(), seed.position, seed.velocity, 60.0 * Vec3(std::cos(id), std::sin(id), 0.5)));
    id += 3;
  }
  box.seeds.clear();
  return box;
}

}  // namespace thalweg::coupling
