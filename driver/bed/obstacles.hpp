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

// m, those of supplies among them; 0 without.
double longest_free_grain(const Case& c);

struct Obstacles {
  std::vector<analysis::SphereInBed> spheres;  // at the start, in order of id; members of clumps among them
  double volume_of_grains = 0.0;               // m^3, of all of them one by one, as grain_volume() counts them
};
Obstacles obstacles_of(const Case& c);

// Held grains of the bed that lie between two heights, a clump as the sphere of its volume.
struct HeldLayer {
  double lower, upper;  // m
  double diameter;      // m
  double volume;        // m^3, of all of them
};

// What a case holds at the start; of disks none. The layers are of the grains that are no obstacles: each that has a
// position, and the others as their populations are spread over a region or, from a file, over the heights that have
// the same mean and deviation.
struct HeldGrains {
  Obstacles obstacles;
  std::vector<HeldLayer> layers;
};
HeldGrains held_grains_of(const Case& c);

// Their volume (m^3) below layers + 1 heights from the floor of the box to its top: of each layer that of as many
// sheets of spheres as it is diameters high, at least one.
std::vector<double> held_below(const Case& c, const std::vector<HeldLayer>& held, int layers);

// Volume (m^3) of the solids that stand still below layers + 1 heights from the floor of the box to its top, as
// analysis::BedObstacles has it; places where several overlap count once. Empty: there are none.
using SolidsBelow = std::function<std::vector<double>(int layers)>;
SolidsBelow solids_below(const Case& c);

// m^3, of all grains, with overlaps counted once.
double solid_volume(const Case& c);

}  // namespace thalweg::driver
