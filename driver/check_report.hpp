// `thalweg check`: what a case means, whether it is resolved and stable, and what it costs.
#pragma once

#include "driver/case.hpp"

#include <string>
#include <vector>

namespace thalweg::driver {

// The numbers behind the report, for a flow over a bed of grains driven by the slope. Shields number and depth follow
// Zhang et al. 2022: tau_b = rho_f g S H far from side walls, rho_f g S H W/(2 H + W) between two of them, and
// tau* = tau_b / ((rho_s - rho_f) g d). Not a number where a case lacks what a number needs.
struct FlowNumbers {
  double slope;             // tangent of the bed's angle
  double bed_height;        // m: the grains settled at a solid fraction of settled_fraction
  double depth;             // m: from there to the top
  double hydraulic_radius;  // m: H W/(2 H + W) between side walls, H without
  bool side_walls;
  double shields_depth;      // tau* of the depth-slope product
  double shields_hydraulic;  // tau* of the hydraulic radius
  double friction_velocity;  // m/s, of shields_hydraulic
  double particle_reynolds;  // u_tau d / nu
  double galileo;            // sqrt((s - 1) g d^3) / nu
  double density_ratio;      // s
  static constexpr double settled_fraction = 0.6;
};
FlowNumbers flow_numbers(const Case& c);

// What a run needs.
struct Cost {
  double cells;
  double steps;
  double cell_updates;
  double grain_steps;   // grains times sub-steps
  double memory;        // bytes, all ranks together
  double core_seconds;  // one core, see check_report
};
// bandwidth: bytes/s of one core's memory (machine.hpp).
Cost cost_of(const Case& c, double bandwidth);

// Whole report, one text a line. Throws InputError where the case cannot be run (grains that do not fit, a grain step
// too long for the contacts).
std::vector<std::string> check_report(const Case& c, double bandwidth);

}  // namespace thalweg::driver
