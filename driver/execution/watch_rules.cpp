#include "driver/execution/watch_rules.hpp"

#include "dem/laws/contact_laws.hpp"
#include "dem/laws/liquid_bridge.hpp"
#include "dem/motion/grain_volume.hpp"
#include "driver/bed/supplied_grains.hpp"
#include "driver/case/solid_setup.hpp"
#include "driver/estimate/contact_estimate.hpp"
#include "driver/estimate/contact_stiffness.hpp"
#include "driver/estimate/flow_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace thalweg::driver {

using loop::WatchLimits;
using loop::WatchRule;

namespace {

constexpr double never = std::numeric_limits<double>::infinity();

// Lattice velocities: the case reader accepts up to 0.173, a true Mach number of 0.3; the method breaks down about 0.3.
constexpr double fast_lattice_velocity = 0.2, broken_lattice_velocity = 0.3;
constexpr double most_fast_cells = 1e-3;

// Mean density: a deviation of a per mille does not matter; a closed box of water that deviates by 1 % is no longer
// that water.
constexpr double least_density_warning = 1e-3, largest_density_warning = 1e-2, stop_over_warning = 10.0;
// A velocity head at 0.173 cells a step is 3/2 0.173^2 = 4.5 %: what an open channel may lose or gain along its way.
constexpr double open_density_warning = 0.05, open_density_stop = 0.2;

// Density of a cell: a flow of 0.173 cells a step that starts or stops at once sends out a wave of sqrt(3) 0.173 = 0.3.
constexpr double largest_wave = 0.3, emptiest = 0.5, fullest = 1.0;

constexpr double suspicious_overlap = 0.1, impossible_overlap = 0.5;  // diameters
constexpr double suspicious_speed = 2.0, impossible_speed = 5.0;      // times the expected

auto always(double warn, double stop) {
  return [limits = WatchLimits{std::min(warn, stop), stop}](const std::vector<Diagnostic>&) { return limits; };
}

double oscillation_speed(const std::optional<dem::Oscillation>& oscillation) {
  return oscillation ? 2.0 * std::numbers::pi * oscillation->frequency * oscillation->amplitude.norm() : 0.0;
}

bool is_open(const Case& c) {
  return std::any_of(c.domain.faces.begin(), c.domain.faces.end(),
                     [](const coupling::FaceKeys& face) { return lbm::is_open(face.type); });
}

// rho/rho_0 - 1 of a pressure in Pa: p = c_s^2 rho, c_s^2 = (dx/dt)^2/3.
double density_of_pressure(const Case& c, double pressure) {
  const double velocity = units_of(c).velocity();
  return 3.0 * pressure / (c.fluid.density * velocity * velocity);
}

double outlet_deviation(const Case& c) {
  double largest = 0.0;
  for (const coupling::FaceKeys& face : c.domain.faces)
    if (face.type == lbm::FaceType::pressure_outlet)
      largest = std::max(largest, std::abs(density_of_pressure(c, face.pressure)));
  return largest;
}

// Density deviation of a fluid at rest: outlet pressure plus half the hydrostatic difference.
double deviation_at_rest(const Case& c) {
  double deviation = outlet_deviation(c);
  if (c.gravity.mode == GravityMode::full)
    deviation +=
        0.5 * density_of_pressure(c, c.fluid.density * std::abs(gravity_vector(c.gravity).z()) * c.domain.size[2]);
  return deviation;
}

// Submerged weight over cross-section of the lightest free population, Pa: (rho_s - rho) g (pi d^3/6)/(pi d^2/4) = 2/3
// (rho_s - rho) g d. Infinite if no population is free.
double weight_over_section(const Case& c) {
  double least = never;
  for (const beds::Population& grains : c.grains) {
    const double excess = std::abs(grains.density - c.fluid.density);
    if (grains.held() || excess == 0.0) continue;
    least = std::min(least, 2.0 / 3.0 * excess * gravity_vector(c.gravity).norm() * grains.smallest_diameter());
  }
  return least > 0.0 ? least : never;
}

// The largest speed of a population, a wall and what it throws, a solid or a supply, by what the case says; m/s.
double largest_given_speed(const Case& c) {
  double largest = speed_off_walls(c);
  for (const beds::Population& grains : c.grains)
    largest = std::max({largest, given_speed(c, grains), grains.figures.fastest});
  for (const coupling::FaceKeys& face : c.domain.faces)
    if (face.has_velocity()) largest = std::max(largest, face.velocity.norm() + oscillation_speed(face.oscillation));
  for (const beds::WallKeys& wall : c.walls)
    largest = std::max(largest, wall.velocity.norm() + oscillation_speed(wall.oscillation));
  for (const SolidCase& solid : c.solids) largest = std::max(largest, largest_speed(solid));
  return std::max(largest, fastest_supply(c));
}

// m/s, that a liquid bridge gives the smallest grain which it pulls to another or a wall: sqrt(2 W/m), with W the work
// of its largest force, 2 pi gamma cos(theta) d, over the whole distance at which it breaks.
double speed_of_bridges(const Case& c) {
  if (!c.contact.liquid_bridge) return 0.0;
  const dem::LiquidBridge bridge(*c.contact.liquid_bridge);
  double largest = 0.0;
  for (const beds::Population& grains : c.grains) {
    const double radius = 0.5 * grains.smallest_diameter(), mass = grains.density * dem::grain_volume(radius, 0.0);
    largest = std::max(largest, std::sqrt(2.0 * bridge.pull(0.0, radius) * bridge.rupture_distance() / mass));
  }
  return largest;
}

// Speed that grains from a bed file may gain as their overlaps relax: overlap times the contact frequency, m/s.
double speed_of_overlaps(const Case& c) {
  double speed = 0.0;
  for (const beds::Population& grains : c.grains)
    if (grains.from_file())
      speed = std::max(speed, grains.placement.largest_overlap.value_or(beds::PlacementKeys::bed_overlap) *
                                  grains.largest_diameter() * std::numbers::pi / shortest_contact(c));
  return speed;
}

// m/s: the same of grains that touch where they are placed, up to rounding; all that moves grains at rest without
// weight.
double speed_of_rounding(const Case& c) {
  constexpr double overlap = 1e-9;  // diameters
  double largest = 0.0;
  for (const beds::Population& grains : c.grains) largest = std::max(largest, grains.largest_diameter());
  return overlap * largest * std::numbers::pi / shortest_contact(c);
}

// True if some sink lets grains come in again further up along this axis, with the motion that they had: at the same
// height, so never for the vertical axis.
bool leads_back_up(const Case& c, Eigen::Index axis) {
  const double gravity = gravity_vector(c.gravity)[axis];
  return axis != 2 && std::any_of(c.sinks.begin(), c.sinks.end(), [&](const beds::SinkKeys& sink) {
           if (!sink.recirculation || sink.recirculation->velocity) return false;
           const beds::RegionKeys &out = sink.region, &in = sink.recirculation->region;
           return gravity > 0.0 ? in.lower[axis] < out.upper[axis] : in.upper[axis] > out.lower[axis];
         });
}

// m/s. Through walled boxes: sqrt(2 sum |g_a| L_a); along periodic axes, and those along which a sink leads back up, a
// dry grain is accelerated as long as the run lasts. In a fluid no faster than the terminal speed at a drag coefficient
// of 0.4, the least a sphere has below the drag crisis (Clift, Grace and Weber 1978), on top of what the fluid does.
double fall_speed(const Case& c) {
  const std::array<bool, 3> periodic = periodic_axes(c.domain);
  const Vec3 gravity = gravity_vector(c.gravity);
  double head = 0.0, unlimited = 0.0, fastest = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double g = std::abs(gravity[axis]);
    if (periodic[a] || leads_back_up(c, axis))
      unlimited += g * c.run.until;
    else
      head += g * c.domain.size[axis];
  }
  if (!has_fluid(c)) return std::sqrt(2.0 * head) + unlimited;
  for (const beds::Population& grains : c.grains) {
    const double excess = std::abs(grains.density / c.fluid.density - 1.0);
    fastest = std::max(fastest, std::sqrt(4.0 / 3.0 * excess * gravity.norm() * grains.largest_extent() / 0.4));
  }
  return fastest;
}

double expected_flow_speed(const Case& c) {
  if (!has_fluid(c)) return 0.0;
  double speed =
      std::max(estimated_velocity(c), c.fluid.mean_velocity ? std::abs(c.fluid.mean_velocity->velocity) : 0.0);
  if (c.initial.fluid.uniform) speed = std::max(speed, c.initial.fluid.uniform->norm());
  if (c.initial.fluid.linear_profile) speed = std::max(speed, c.initial.fluid.linear_profile->velocity.norm());
  return speed;
}

void add_fluid_rules(const Case& c, std::vector<WatchRule>& rules) {
  using Side = WatchRule::Side;
  const double step = fluid_time_step(c), rest = deviation_at_rest(c);
  const std::string shorter_step = fmt::format("shorten fluid.time_step (it is {:.4g} s)", step);
  const WatchLimits mean = mean_density_limits(c);
  rules.push_back({"largest_lattice_velocity", Side::above, always(fast_lattice_velocity, broken_lattice_velocity),
                   "the largest velocity of the fluid in cells per step",
                   "The flow is too fast for the step, or the collision has become unstable: " + shorter_step +
                       ", or see docs/stability.md for fluid.collision and fluid.subgrid_model."});
  rules.push_back({"fast_cell_fraction", Side::above, always(most_fast_cells, never),
                   "the share of fluid cells that move at more than 0.15 cells per step",
                   "The flow is too fast for the step: " + shorter_step + "."});
  rules.push_back({"mean_density_deviation", Side::either, always(mean.warn, mean.stop),
                   "the deviation of the fluid's mean density",
                   is_open(c) ? "Inlets and outlets do not balance: check the velocities and pressures in "
                                "domain.boundaries, or " +
                                    shorter_step + "."
                   : c.grains.empty()
                       ? "The collision has become unstable, or rounding adds up: " + shorter_step +
                             ", or set fluid.precision: double."
                       : "Grains take more mass from the fluid than their links can return, or the collision has "
                         "become unstable: " +
                             shorter_step +
                             "; mass_by_links and the columns beside it in series.csv show where the mass goes."});
  const std::string waves =
      "Pressure waves of this size come from a flow or grains that start or stop abruptly, or from an unstable "
      "collision: begin with a smoother state (initial, grains.0.velocity), or " +
      shorter_step + ".";
  rules.push_back({"smallest_density_deviation", Side::below,
                   always(std::min(rest + largest_wave, 0.9 * emptiest), emptiest),
                   "the smallest density of a cell, less the reference,", waves});
  rules.push_back({"largest_density_deviation", Side::above,
                   always(std::min(rest + largest_wave, 0.9 * fullest), fullest),
                   "the largest density of a cell, less the reference,", waves});
}

enum class Contacts { softer, stiffer };

// The change of the key that the case gives, or of the duration that it leaves open.
std::string change_of_contacts(const Case& c, Contacts to) {
  const bool softer = to == Contacts::softer;
  if (goes_by_duration(c))
    return fmt::format("give a {} contact.duration than {:.3g} s", softer ? "longer" : "shorter", contact_duration(c));
  return dem::with_spring_law(c.contact.law, [&](auto spring) {
    return fmt::format("{} contact.{}", softer ? "lower" : "raise", decltype(spring)::type::stiffness_key);
  });
}

void add_grain_rules(const Case& c, std::vector<WatchRule>& rules) {
  using Side = WatchRule::Side;
  const double expected = expected_grain_speed(c);
  rules.push_back(
      {"largest_grain_speed", Side::above,
       [expected, taken = 0.0,
        unknown = c.initial.takes(InitialField::grains)](const std::vector<Diagnostic>& diagnostics) mutable {
         // Grains of another run bring their speeds along, which show when the rule is first asked.
         if (std::exchange(unknown, false)) taken = find_diagnostic(diagnostics, "largest_grain_speed").value_or(0.0);
         const double speed = expected + taken + find_diagnostic(diagnostics, "largest_fluid_speed").value_or(0.0);
         return WatchLimits{suspicious_speed * speed, impossible_speed * speed};
       },
       "the largest speed of a grain",
       fmt::format(
           "Neither the flow, nor free fall, nor what the case itself moves explains this speed; the contacts or "
           "the fluid load of the grain must cause it: check overlaps at the start, or shorten {} or {}.",
           has_fluid(c) ? "fluid.time_step" : "run.time_step", change_of_contacts(c, Contacts::softer))});
  if (has_fluid(c)) {
    const double unit = units_of(c).velocity();
    rules.push_back({"largest_grain_speed", Side::above,
                     always(fast_lattice_velocity * unit, broken_lattice_velocity * unit),
                     "the largest speed of a grain",
                     fmt::format("A grain that crosses more than {:g} cells a step is too fast for the flow around it: "
                                 "shorten fluid.time_step.",
                                 fast_lattice_velocity)});
  }
  double allowed = 0.0;
  for (const beds::Population& grains : c.grains)
    if (grains.from_file())
      allowed = std::max(allowed, grains.placement.largest_overlap.value_or(beds::PlacementKeys::bed_overlap));
  rules.push_back({"largest_overlap", Side::above,
                   always(std::max(suspicious_overlap, 2.0 * allowed), std::max(impossible_overlap, 2.0 * allowed)),
                   "the largest overlap of a grain with another or with a wall in diameters",
                   fmt::format("The contacts are too soft for the load or the speed, or grains were placed into each "
                               "other: {}, or check grains.0.placement.",
                               change_of_contacts(c, Contacts::stiffer))});
}

}  // namespace

double expected_grain_speed(const Case& c) {
  const double speed = fall_speed(c) + largest_given_speed(c) + expected_flow_speed(c) + fastest_model_fluid(c) +
                       speed_of_overlaps(c) + speed_of_bridges(c);
  return std::max(speed, speed_of_rounding(c));
}

WatchLimits mean_density_limits(const Case& c) {
  if (is_open(c)) return {outlet_deviation(c) + open_density_warning, outlet_deviation(c) + open_density_stop};
  const double weight = density_of_pressure(c, weight_over_section(c));
  const double warn = std::clamp(weight, least_density_warning, largest_density_warning);
  return {warn, stop_over_warning * warn};
}

std::vector<WatchRule> watch_rules(const Case& c) {
  std::vector<WatchRule> rules;
  if (has_fluid(c)) add_fluid_rules(c, rules);
  if (!c.grains.empty()) add_grain_rules(c, rules);
  return rules;
}

}  // namespace thalweg::driver
