#include "driver/plan/flow_report.hpp"

#include "driver/bed/bed_flow.hpp"
#include "driver/bed/reference_grain.hpp"
#include "driver/estimate/contact_estimate.hpp"
#include "driver/estimate/drag_accuracy.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "driver/estimate/settling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace thalweg::driver {

namespace {

using Lines = std::vector<std::string>;

constexpr double fully_placed = 0.95;  // share of the floor from which grains need not spread

std::string on_lattice(const Case& c, double speed) {
  const double lattice = speed / units_of(c).velocity();
  return fmt::format("{:.3g} cells per step, Mach number {:.3g} (accurate below 0.17)", lattice,
                     lattice * std::sqrt(3.0));
}

void add_speed(const Case& c, const FlowEstimate& flow, Lines& lines) {
  if (flow.speed > 0.0)
    lines.push_back(fmt::format("flow       up to about {:.3g} m/s ({}): {}", flow.speed, words_of(flow.cause),
                                on_lattice(c, flow.speed)));
  else
    lines.push_back("flow       " + std::string(words_of(FlowCause::none)));
}

// The times by which a run is to be planned.
void add_times(const Case& c, const FlowEstimate& flow, Lines& lines) {
  if (flow.drive == FlowCause::none) return;
  const double own =
      flow.laminar ? flow.depth * flow.depth / c.fluid.kinematic_viscosity : flow.depth / flow.friction_velocity;
  const char* name = flow.laminar ? "H^2/nu" : "H/u*";
  lines.push_back(fmt::format(
      "times      {} {:.3g} s, H/U {:.3g} s with U {:.3g} m/s ({}); from rest the flow takes about {:.3g} s; the run "
      "lasts {:.3g} {}",
      name, own, flow.depth / flow.bulk_velocity, flow.bulk_velocity, flow.laminar ? "laminar" : "turbulent",
      flow.spin_up, c.run.until / own, name));
}

// "no slope" where even a vertical one would not give it.
std::string slope_text(const FlowNumbers& flow, double shields) {
  const double slope = slope_for(flow, shields);
  return fmt::format("{} for {:g}", std::isfinite(slope) ? fmt::format("{:.3g}", slope) : "no slope", shields);
}

void add_slope(const FlowNumbers& flow, Lines& lines) {
  lines.push_back(fmt::format("Shields    {:.4g} from {} and slope", flow.shields_depth,
                              flow.top_drags ? "half the depth (the top holds the other half)" : "depth") +
                  (flow.side_walls > 0 ? fmt::format("; {:.4g} from the hydraulic radius between the side walls",
                                                     flow.shields_hydraulic)
                                       : ""));
  lines.push_back(fmt::format("slope      is {:.4g} times the Shields number at this depth: {}, {}",
                              flow.slope / flow.shields_hydraulic, slope_text(flow, 0.03), slope_text(flow, 0.1)));
  lines.push_back(fmt::format("Reynolds   {:.4g} of a grain at the friction velocity {:.3g} m/s",
                              flow.particle_reynolds, flow.friction_velocity));
}

// Shields number of a flow that a mean velocity, a moving top or an inlet drives; not a number for others.
double shields_of_other_drive(const Case& c, const FlowEstimate& flow) {
  const ReferenceGrain grain = reference_grain(c);
  const double g = gravity_vector(c.gravity).norm(), excess = grain.density / c.fluid.density - 1.0;
  if (!(g > 0.0) || excess <= neutral_density || flow.drive == FlowCause::none || flow.drive == FlowCause::slope)
    return FlowNumbers::unknown;
  return flow.friction_velocity * flow.friction_velocity / (excess * g * grain.diameter);
}

void add_other_drive(const Case& c, const FlowEstimate& flow, Lines& lines) {
  const double shields = shields_of_other_drive(c, flow);
  if (std::isnan(shields)) return;
  lines.push_back(fmt::format("Shields    about {:.4g} by {}, {} flow; the run measures it (analysis.bed_surface)",
                              shields, words_of(flow.drive), flow.laminar ? "laminar" : "turbulent"));
  lines.push_back(fmt::format("Reynolds   {:.4g} of a grain at the friction velocity {:.3g} m/s",
                              flow.friction_velocity * reference_grain(c).diameter / c.fluid.kinematic_viscosity,
                              flow.friction_velocity));
}

// The share of the floor that the regions of the populations cover together, as far as they lie side by side; the
// grains spread from there over all of it.
double placed_share(const Case& c) {
  using Sides = std::array<double, 4>;  // m
  std::set<Sides> covered;
  for (const beds::Population& population : c.grains) {
    const auto& region = population.placement.region;
    if (!region) return 1.0;
    covered.insert({region->lower.x(), region->lower.y(), region->upper.x(), region->upper.y()});
  }
  double area = 0.0;
  for (const Sides& sides : covered) area += (sides[2] - sides[0]) * (sides[3] - sides[1]);
  return std::min(1.0, area / (c.domain.size.x() * c.domain.size.y()));
}

// Empty where the grains make no bed of at least their diameter, or half of it where some are held.
std::string bed_text(const Case& c) {
  if (c.grains.empty() || c.disks || periodic_axes(c.domain)[2] || gravity_vector(c.gravity).z() >= 0.0) return {};
  if (has_fluid(c) && !std::isfinite(flow_numbers(c).depth)) return {};
  const double height = settled_height(c), diameter = reference_grain(c).diameter;
  const bool any_held =
      std::any_of(c.grains.begin(), c.grains.end(), [](const beds::Population& grains) { return grains.held(); });
  if (height < (any_held ? 0.5 : 1.0) * diameter) return {};
  if (!has_free_grains(c))
    return fmt::format("bed        reaches up to about {:.3g} m ({:.3g} diameters), where its grains are held", height,
                       height / diameter);
  const double placed = placed_share(c);
  return fmt::format("bed        settles at about {:.3g} m ({:.3g} diameters, solid fraction {:.3g}){}", height,
                     height / diameter, settled_fraction(c),
                     placed < fully_placed
                         ? fmt::format("; placed over {:.2g} % of the floor, it spreads", 100.0 * placed)
                         : std::string());
}

// Pa, on the bed, as far as it follows from the case; not a number where it does not.
double stress_on_bed(const Case& c) {
  const FlowNumbers numbers = flow_numbers(c);
  if (!std::isfinite(numbers.depth)) return numbers.depth;
  const FlowEstimate flow = flow_estimate(c);
  const double of_drive =
      flow.drive == FlowCause::none || flow.drive == FlowCause::slope ? 0.0 : flow.friction_velocity;
  const double speed = std::isfinite(numbers.friction_velocity) ? numbers.friction_velocity : of_drive;
  return speed > 0.0 ? c.fluid.density * speed * speed : std::numeric_limits<double>::quiet_NaN();
}

// Of several densities: the reference grain stands for all, and each population has a Shields number of its own, that
// of its median size and its density.
void add_densities(const Case& c, Lines& lines) {
  struct Own {
    double shields;
    std::string text;
  };
  const double stress = stress_on_bed(c), g = gravity_vector(c.gravity).norm();
  std::vector<Own> numbers;
  bool mixed = false;
  const auto populations = free_populations(c);
  for (const std::size_t p : populations) {
    const beds::Population& grains = c.grains[p];
    mixed = mixed || grains.density != c.grains[populations.front()].density;
    const double weight = (grains.density - c.fluid.density) * g * grains.diameter;
    if (!floats(c, grains))
      numbers.push_back({stress / weight, fmt::format("{:.3g} for grains.{} ({:g} kg/m^3, {:.4g} m)", stress / weight,
                                                      p, grains.density, grains.diameter)});
  }
  if (!has_free_grains(c) || !mixed || numbers.empty() || !std::isfinite(stress)) return;
  const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end(),
                                                 [](const Own& a, const Own& b) { return a.shields < b.shields; });
  const ReferenceGrain reference = reference_grain(c);
  lines.push_back(fmt::format(
      "densities  several: Shields number {:.3g} and q* are those of the reference grain; of the populations by "
      "themselves {}{}",
      stress / ((reference.density - c.fluid.density) * g * reference.diameter), least->text,
      least == most ? "" : " to " + most->text));
}

void add_stress_at_base(const Case& c, Lines& lines) {
  if (const double ratio = stress_ratio_at_base(c); ratio > 0.0)
    lines.push_back(fmt::format(
        "base       of the bed: the slope requires a shear stress of {:.3g} times the normal stress; {} sustain about "
        "{:.3g}{}",
        ratio, only_friction_holds_the_bed(c) ? "grains of this friction" : "spheres held by this friction alone",
        bulk_friction(c), only_friction_holds_the_bed(c) ? "" : ", and these grains more"));
}

}  // namespace

Lines fluid_lines(const Case& c) {
  Lines lines;
  if (!has_fluid(c)) return lines;
  const Units units = units_of(c);
  lines.push_back(fmt::format("fluid      {:g} kg/m^3, {:g} m^2/s; relaxation time 1/2 + {:.3g}; {:g} s a step",
                              c.fluid.density, c.fluid.kinematic_viscosity, relaxation_time(c) - 0.5, units.time_step));
  if (c.fluid.bulk_relaxation_time.value_or(0.0) > 0.0)
    lines.push_back(
        fmt::format("sound      damped by a bulk viscosity of {:.3g} m^2/s, {:.3g} times the shear viscosity",
                    bulk_viscosity(c), bulk_viscosity(c) / c.fluid.kinematic_viscosity));
  if (c.run.ramp > 0.0)
    lines.push_back(fmt::format("gravity    rises to its full value during the first {:g} s, {:.3g} steps", c.run.ramp,
                                c.run.ramp / units.time_step));
  const FlowEstimate flow = flow_estimate(c);
  add_speed(c, flow, lines);
  add_times(c, flow, lines);
  return lines;
}

double expected_shields_number(const Case& c) {
  const FlowNumbers numbers = flow_numbers(c);
  if (std::isfinite(numbers.shields_hydraulic) || !std::isfinite(numbers.depth)) return numbers.shields_hydraulic;
  return shields_of_other_drive(c, flow_estimate(c));
}

Lines bed_lines(const Case& c) {
  Lines lines;
  if (!c.grains.empty()) lines.push_back("reference  " + reference_text(c));
  const FlowNumbers numbers = flow_numbers(c);
  if (std::isfinite(numbers.galileo)) {
    lines.push_back(
        fmt::format("density    ratio {:.4g}; Galileo number {:.4g}", numbers.density_ratio, numbers.galileo));
    if (const double falling = settling_velocity(c); falling > 0.0)
      lines.push_back(fmt::format("fall       of a single grain through the fluid at rest: {:.3g} m/s", falling));
  }
  if (const std::string drag = drag_text(c); !drag.empty()) lines.push_back("drag       " + drag);
  if (const std::string bed = bed_text(c); !bed.empty())
    lines.push_back(bed + (std::isfinite(numbers.depth)
                               ? fmt::format(", {:.3g} m of flow above, slope {:g}", numbers.depth, numbers.slope)
                               : std::string()));
  if (std::isfinite(numbers.shields_depth))
    add_slope(numbers, lines);
  else if (std::isfinite(numbers.depth))
    add_other_drive(c, flow_estimate(c), lines);
  if (has_fluid(c)) add_densities(c, lines);
  add_stress_at_base(c, lines);
  return lines;
}

}  // namespace thalweg::driver
