#include "analysis/observer/transport_scales.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::analysis {

namespace {

constexpr double share_that_counts_as_moving = 0.01;

}  // namespace

double TransportScales::weight() const {
  return (fluid_density > 0.0 ? std::abs(grain_density / fluid_density - 1.0) : 1.0) * gravity;
}

double TransportScales::flux() const { return std::sqrt(weight() * grain_diameter) * grain_diameter; }

double TransportScales::fall_speed() const { return flux() > 0.0 ? flux() / grain_diameter : 1.0; }

double TransportScales::moving_speed() const {
  if (model_fluid_speed > 0.0) return share_that_counts_as_moving * model_fluid_speed;
  double speed = flux() / grain_diameter;
  if (kinematic_viscosity > 0.0)
    speed = std::min(speed, weight() * grain_diameter * grain_diameter / (18.0 * kinematic_viscosity));
  return share_that_counts_as_moving * speed;
}

TransportScales transport_scales(const RunContext& run) {
  TransportScales scales{run.grains->reference_diameter, run.grains->reference_density, 0.0, run.gravity.norm()};
  if (run.fluid) {
    scales.fluid_density = run.fluid->density;
    scales.kinematic_viscosity = run.fluid->kinematic_viscosity;
  }
  if (run.model_fluid) {
    scales.gravity = run.model_fluid->gravity;
    scales.model_fluid_speed = run.model_fluid->speed;
  }
  return scales;
}

void describe_moving_speed(SectionVisitor& visit, std::optional<double>& moving_speed) {
  visit.real("moving_speed", moving_speed,
             {.unit = "m/s",
              .meaning = "faster grains count as moving; default: 1 % of the smaller of sqrt((s - 1) g d) and Stokes' "
                         "settling speed; without a fluid of sqrt(g d), in a model fluid of v_0",
              .at_least = 0.0,
              .example = 1e-3});
}

std::optional<std::string> fast_moving_speed(const char* section, const std::optional<double>& moving_speed,
                                             const RunContext& run) {
  if (!moving_speed || !run.fluid || !run.grains) return std::nullopt;
  const TransportScales scales = transport_scales(run);
  constexpr double lightest = 0.5;  // s - 1; grains that hardly sink are moved by slow water, too
  if (!(scales.weight() >= lightest * scales.gravity) || scales.flux() == 0.0) return std::nullopt;
  // A sphere settles no faster: a drag coefficient of 0.4.
  const double settling = std::sqrt(4.0 / (3.0 * 0.4)) * scales.flux() / scales.grain_diameter;
  if (*moving_speed <= settling) return std::nullopt;
  return fmt::format(
      "analysis.{0}.moving_speed = {1:g} m/s is more than grains of {2:g} m settle with, at most {3:.2g} m/s, so that "
      "hardly any count as moving: consider analysis.{0}.moving_speed: {4:.2g}, which is the default.",
      section, *moving_speed, scales.grain_diameter, settling, scales.moving_speed());
}

}  // namespace thalweg::analysis
