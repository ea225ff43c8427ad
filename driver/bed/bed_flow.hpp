// A flow over a bed of grains driven by the slope: depth, Shields number, slope, as far as they follow from the case
// alone.
#pragma once

#include "driver/case/case.hpp"

#include <limits>

namespace thalweg::driver {

// Grains heavier than the fluid by less than this fraction of its density make no bed: that is rounding.
inline constexpr double neutral_density = 1e-6;

// True for those, and for lighter ones; without a fluid for none.
bool floats(const Case& c, const beds::Population& grains);

// Shields number and depth follow Zhang et al. 2022: tau_b = rho_f g_x H far from side walls, rho_f g_x H W/(2 H + W)
// between two of them, rho_f g_x H W/(H + W) beside one, and tau* = tau_b / ((rho_s - rho_f) g d). g_x is the part of
// gravity along the bed, g times the sine of its angle. Under a top that drags, H is half the depth: what lies above
// the middle weighs on the top. Not a number where a case lacks what a number needs: without a slope down along x,
// which is periodic, and where the top or a side wall moves along x there is no Shields number.
struct FlowNumbers {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double slope = unknown;              // tangent of the bed's angle
  double bed_height = unknown;         // m: settled_height()
  double depth = unknown;              // m: from there to the top
  double hydraulic_radius = unknown;   // m: H W/(n H + W) beside n side walls
  int side_walls = 0;                  // n, 0 to 2
  bool top_drags = false;              // and takes half of the stress
  double shields_depth = unknown;      // tau* of the depth-slope product
  double shields_hydraulic = unknown;  // tau* of the hydraulic radius
  double friction_velocity = unknown;  // m/s, of shields_hydraulic
  double particle_reynolds = unknown;  // u_tau d / nu
  double galileo = unknown;            // sqrt((s - 1) g d^3) / nu
  double density_ratio = unknown;      // s
};
FlowNumbers flow_numbers(const Case& c);

// The slope, a tangent, with which the hydraulic radius R gives the Shields number, the reverse of shields_hydraulic:
// sin = tau* (s - 1) d / R. Infinite where no slope is steep enough.
double slope_for(const FlowNumbers& flow, double shields);

// Solid fraction: less is no bed but a suspension, or grains that still fall. Random loose packing has 0.55 (beds
// between near walls 0.5).
inline constexpr double loosest_bed = 0.4;

// m, of the grains that sink, settled at settled_fraction() in the room that obstacles and scattered held grains leave
// (obstacles.hpp), or on the surface of held grains that make a bed; 0 without gravity across the bed. Where no grain
// sinks, the surface of what is held as the run measures it, or 0 where that makes no bed.
double settled_height(const Case& c);

// True if gravity along an axis (0: x, 1: y) drives a flow: between periodic or open faces. Walls balance it by
// pressure.
bool drives_flow(const Case& c, int axis);

// True if a velocity_inlet at a face across an axis (0: x, 1: y) sets how much flows along it: pressure then balances
// gravity along it, as between walls.
bool inlet_sets_flow(const Case& c, int axis);

// Pa, of any pressure_outlet, above or below the pressure at which the fluid starts; 0 without.
double largest_outlet_pressure(const Case& c);

// Number of side walls (faces across y) that exert drag, 0 to 2.
int side_walls(const Case& c);

// True for a wall that slides along x.
bool moves_along_x(const coupling::FaceKeys& face);

// True if a side wall moves along x, and takes no share that follows from the hydraulic radius.
bool side_walls_move(const Case& c);

// True if the top or a side wall moves along x, so that not the slope alone drives the water.
bool walls_drive(const Case& c);

// m, of a depth (m): half of it under a top that drags and holds the other half.
double held_by_the_bed(const Case& c, double depth);

// m, of a flow of this depth (m): H W/(n H + W) beside n such side walls, with half the depth under a top that drags.
double hydraulic_radius(const Case& c, double depth);

// m, of the flow that has this hydraulic radius (m); infinite where none is so deep.
double depth_of(const Case& c, double hydraulic_radius);

// m, of the flow that has this Shields number on the slope of the case, which leads down along x.
double hydraulic_radius_with(const Case& c, double shields);

// m, in whole cells, of a box with a flow of this depth (m) above the settled bed.
double box_height(const Case& c, double depth);

// Solid fraction of a settled bed: that of beds::settled_fraction(), or what a fill says of its population; without the
// obstacles that stand in it.
double settled_fraction(const Case& c);

}  // namespace thalweg::driver
