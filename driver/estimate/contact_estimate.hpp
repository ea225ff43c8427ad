// Overlaps of the grains of a case under load, and sliding of the bed as a whole: estimates for `thalweg check`.
#pragma once

#include "driver/case/case.hpp"

#include <optional>

namespace thalweg::driver {

// Overlaps of the softest contact between two grains of a population, or with walls that have a stiffness of their own
// (linear law), over their diameter; 0 without grains.
struct Overlaps {
  // At the base of the settled bed: each grain carries the weight above its own d^2, a clump that above the square of
  // its nominal diameter on one member.
  double under_weight;
  double in_impact;  // without damping, of two free grains (on a wall as hard as they are sqrt 2 more), or of one with
                     // a softer wall, at `speed`
  // m/s, of a fall, through the fluid or dry from the top of the box onto the bed, or as given: of grains, of what
  // meets them, or off moving walls.
  double speed;
};
Overlaps expected_overlaps(const Case& c);

// m/s, of grains at rest that a face or a wall throws as it moves along its normal, or a body of grains as it moves
// along an axis that is not periodic: after an elastic impact twice as fast as it. What moves in its own plane, or
// turns, carries grains along. 0: none moves so.
double speed_off_walls(const Case& c);

// Overlaps, in diameters, from which they count as large.
inline constexpr double deep_under_weight = 0.01, deep_in_impact = 0.05;

// Factor by which a stiffness that is to keep overlaps small exceeds the least.
inline constexpr double stiffness_margin = 1.02;

// N/m: the normal stiffness of the section contact, of the linear law, with which the overlaps of the populations that
// have none of their own are smaller, by this margin; 0 where nothing presses.
double least_stiffness(const Case& c);

// 1: below this Stokes number the fluid stops every grain that touches another (Joseph et al. 2001).
inline constexpr double least_stokes_number_of_a_rebound = 10.0;

// Duration of the shortest contact, and of sound around the narrowest free grain, in fluid steps. A shorter contact
// reverses the grain without its added mass, and the grain loses momentum to that water
// (benchmarks/validation/rebound_in_water). None without grains in a fluid, or where none of them can rebound.
struct ReboundTimes {
  double contact, around;
};
std::optional<ReboundTimes> rebound_times(const Case& c);

// Coefficients of restitution of dry collisions that follow from the damping (kg/s) of a linear contact, whatever the
// speed: of the lightest and the heaviest two grains of a population that are free, and of one of them with a wall.
// None where the case gives the restitution itself.
struct DryRestitution {
  double least, most, least_at_wall, most_at_wall;
};
std::optional<DryRestitution> dry_restitution(const Case& c);

// Shear stress over normal stress between the grains at the base of a settled bed, where gravity along x drives water
// and grains: with the pores full of water and H of it above, as far as the bed holds it,
//   [rho_f H + (rho_f + phi (rho_s - rho_f)) h] g_x / [phi (rho_s - rho_f) h g_z],
// and dry g_x/g_z. 0 where nothing drives the bed, where side walls carry it, for less than two layers, and without
// grains that are free.
double stress_ratio_at_base(const Case& c);

// The ratio that spheres of this friction coefficient hold at most: 0.105 to 0.405, simulations of slow shear by
// Chialvo, Sun and Sundaresan (2012), table I, linear between its entries.
double bulk_friction(double friction);

// That of the free grains, of the mean of their coefficients by volume.
double bulk_friction(const Case& c);

// False of clumps and of grains with rolling friction or liquid bridges, which hold more than bulk_friction.
bool only_friction_holds_the_bed(const Case& c);

}  // namespace thalweg::driver
