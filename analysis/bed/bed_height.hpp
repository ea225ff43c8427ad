// The height of a bed by its solid fraction: where, seen from above, a mean over a layer of height b first reaches half
// of the bulk value.
//
//   phi(z)   = [C(z + b/2) - C(z - b/2)] / [R(z + b/2) - R(z - b/2)]
//   phi_bulk = (C_50 - C_10) / [R(z_50) - R(z_10)]       z_n: height below which n % of all grains' volume lies
//
// C(z): volume of grains below z and above the floor, exact. R(z) = A z - O(z): room for them, with the plan A of the
// box and the volume O of obstacles below z (union_of_spheres.hpp, core/geometry/mesh_volume.hpp), such as a sill or a
// pier, which are no grains of the bed.
//
// The bulk is thus the lower half of the grains without the layers at the floor. A block of uniform solid fraction with
// a flat top has its height exactly. Near floor and top phi is the mean over the part of the layer inside the box.
#pragma once

#include <span>

namespace thalweg::analysis {

// C and O at equally spaced heights from the floor of the box to its top, m^3.
struct VolumeBelow {
  std::span<const double> volume;
  double spacing;                         // m
  double area;                            // m^2
  std::span<const double> obstacle = {};  // empty: there are none
};

// A window is ten of these layers high.
inline constexpr int thin_layers_a_window = 10;
// Number of thin layers in a box of this height (m), at least one.
int thin_layers(double box_height, double window);

// m^3, of obstacles above a height (m).
double obstacles_above(const VolumeBelow& below, double height);

// phi_bulk; 0 without grains.
double bulk_solid_fraction(const VolumeBelow& below);

// The height in m, linear between heights of `below`; 0 without grains. half_window: b/2 in spacings.
double bed_height(const VolumeBelow& below, int half_window);

}  // namespace thalweg::analysis
