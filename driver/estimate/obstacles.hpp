// Grains of a case that are no grains of its bed but obstacles which stand in it, such as a sill, a pier or a boulder:
// of the populations that are held and placed by positions
//
//   - those that overlap, by more than a twentieth of the smaller diameter: a body built of spheres,
//   - those at least twice as long as the longest free grain.
//
// A place where several overlap counts once. Solids that stand still are obstacles, too. The bed is what is left, in
// the room that the obstacles leave.
#pragma once

#include "analysis/bed/union_of_spheres.hpp"
#include "driver/case/case.hpp"

#include <functional>
#include <vector>

namespace thalweg::driver {

struct Obstacles {
  std::vector<analysis::SphereInBed> spheres;  // at the start, in order of id; members of clumps among them
  double volume_of_grains = 0.0;               // m^3, of all of them one by one, as grain_volume() counts them
};
Obstacles obstacles_of(const Case& c);

// Volume (m^3) of the solids that stand still below layers + 1 heights from the floor of the box to its top, as
// analysis::BedObstacles has it; places where several overlap count once. Empty: there are none.
using SolidsBelow = std::function<std::vector<double>(int layers)>;
SolidsBelow solids_below(const Case& c);

// m^3, of all grains, with overlaps counted once.
double solid_volume(const Case& c);

}  // namespace thalweg::driver
