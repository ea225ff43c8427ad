// Scales of sediment transport: what makes a rate dimensionless, and the speed above which a grain counts as moving.
#pragma once

#include "analysis/observer/observer_keys.hpp"

#include <optional>
#include <string>

namespace thalweg::analysis {

struct TransportScales {
  double grain_diameter;             // m, of the reference grain
  double grain_density;              // kg/m^3, of the reference grain
  double fluid_density = 0.0;        // kg/m^3; 0: dry grains
  double gravity = 0.0;              // m/s^2, magnitude; in a model fluid the reduced one
  double kinematic_viscosity = 0.0;  // m^2/s; 0: no fluid that has one
  double model_fluid_speed = 0.0;    // m/s, v_0 of a model fluid

  double weight() const;      // m/s^2, |s - 1| g; without a fluid g
  double flux() const;        // sqrt(|s - 1| g d^3), m^2/s; without a fluid sqrt(g d^3)
  double fall_speed() const;  // m/s: sqrt(|s - 1| g d), without a fluid sqrt(g d); 1 m/s where that is zero
  // m/s: 1 % of the lower of sqrt(|s - 1| g d) and Stokes' settling speed |s - 1| g d^2/(18 nu); without a fluid of
  // sqrt(g d), in a model fluid of v_0.
  double moving_speed() const;
  bool have_q_star() const { return fluid_density > 0.0 && flux() > 0.0; }
};
TransportScales transport_scales(const RunContext& run);  // of a run with grains

// The key moving_speed (m/s), whose default is that of the scales.
void describe_moving_speed(SectionVisitor& visit, std::optional<double>& moving_speed);

// A warning where grains in a fluid count as moving only if they are as fast as they could settle; else nothing.
std::optional<std::string> fast_moving_speed(const char* section, const std::optional<double>& moving_speed,
                                             const RunContext& run);

}  // namespace thalweg::analysis
