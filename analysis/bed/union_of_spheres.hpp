// The volume of the box that spheres fill together, each place counted once however many of them overlap there:
//
//   O(z) = integral from 0 to z of a(z') dz'      a(z'): area of the union of their sections at the height z'
//
// a is the length of the union of chords along x, exact, times the width of a row; rows and heights follow the midpoint
// rule, twenty to a radius of the smallest sphere but at most 500 to a side of the box. Of one sphere O is right to
// 1e-3.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"

#include <array>
#include <span>
#include <vector>

namespace thalweg::analysis {

struct SphereInBed {
  GlobalId id;
  std::array<double, 3> centre;  // m, inside the box
  double radius;                 // m
};

// O (m^3) at `layers` + 1 heights from the floor of the box to its top, which are no periodic faces. The same bits for
// spheres in the same order.
std::vector<double> union_below(const PeriodicBox& box, std::span<const SphereInBed> spheres, int layers);

}  // namespace thalweg::analysis
