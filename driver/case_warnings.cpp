#include "driver/case_warnings.hpp"

#include "driver/bed_flow.hpp"
#include "driver/case_checks.hpp"
#include "driver/contact_estimate.hpp"
#include "driver/drag_accuracy.hpp"
#include "driver/drive_warnings.hpp"
#include "driver/flow_estimate.hpp"
#include "driver/limit_text.hpp"
#include "driver/run_facts.hpp"
#include "driver/solid_setup.hpp"
#include "driver/stability.hpp"

#include <fmt/format.h>

#include <cmath>

namespace thalweg::driver {

namespace {

using Warnings = std::vector<std::string>;

// The largest velocity expected, cells a step.
double expected_lattice_velocity(const Case& c) {
  return c.fluid.expected_velocity.value_or(flow_estimate(c).speed) / units_of(c).velocity();
}

void warn_of_fast_flow(const Case& c, Warnings& found) {
  const FlowEstimate flow = flow_estimate(c);
  const double lattice_velocity = flow.speed / units_of(c).velocity();
  // The estimate is an upper one: it has to contradict what the user expects, by a quarter.
  const double expected = c.fluid.expected_velocity.value_or(0.0);
  if (!(lattice_velocity > 0.1) || flow.speed < 1.25 * expected) return;
  const std::string remedy = c.fluid.time_step ? fmt::format("a fluid.time_step of at most {} s",
                                                             at_most_text(0.1 * c.domain.spacing / flow.speed, 2))
                                               : fmt::format("a fluid.expected_velocity of {:.2g} m/s", flow.speed);
  found.push_back(fmt::format(
      "The flow may reach about {:.2g} m/s ({}), which is {:.2g} cells a step{}; results are "
      "accurate below 0.1 and the limit is 0.173: consider {}.",
      flow.speed, words_of(flow.cause), lattice_velocity,
      expected > 0.0 ? fmt::format(" and {:.2g} times fluid.expected_velocity", flow.speed / expected) : std::string(),
      remedy));
}

void warn_of_compression(const Case& c, Warnings& found) {
  const double compression =
      3.0 * std::abs(gravity_vector(c.gravity).z()) / units_of(c).acceleration() * c.domain.size[2] / c.domain.spacing;
  if (c.gravity.mode != GravityMode::full || !(compression > 0.05)) return;
  found.push_back(
      fmt::format("The weight of the fluid compresses it by {:.2g} % from top to bottom: consider a fluid.time_step "
                  "of at most {} s or gravity.mode: reduced.",
                  100.0 * compression, at_most_text(fluid_time_step(c) * std::sqrt(0.05 / compression), 2)));
}

void warn_of_collision(const Case& c, Warnings& found) {
  const double excess = relaxation_time(c) - 0.5, fastest = expected_lattice_velocity(c);
  const double stable = stable_lattice_velocity(c.fluid.collision, excess);
  const bool eddies = c.fluid.smagorinsky_constant > 0.0,
             regularised = c.fluid.collision == lbm::CollisionModel::regularised;
  if ((!eddies || regularised) && (stable == 0.0 || fastest > stable))
    found.push_back(fmt::format(
        "The relaxation time is only {:.2g} above 1/2{}; the collision {} was stable there {}: consider {}{}.", excess,
        eddies ? "" : " and there is no subgrid model", regularised ? "'regularised'" : "chosen",
        stable == 0.0 ? std::string("at no velocity") : fmt::format("up to {:g} cells a step", stable),
        eddies ? "" : "fluid.smagorinsky_constant: 0.27",
        regularised ? (eddies ? "fluid.collision: trt" : " and fluid.collision: trt") : ""));
  if (excess > 1.0)
    found.push_back(
        fmt::format("The relaxation time, {:.2g}, is so large that walls and grains lose accuracy: consider a "
                    "shorter fluid.time_step.",
                    excess + 0.5));
}

void warn_of_bulk_relaxation(const Case& c, Warnings& found) {
  const double bulk = c.fluid.bulk_relaxation_time.value_or(0.0), excess = relaxation_time(c) - 0.5;
  const bool eddies = c.fluid.smagorinsky_constant > 0.0;
  if (!eddies && c.fluid.collision == lbm::CollisionModel::trt && bulk > 0.0 && excess < 0.0299)
    found.push_back(
        fmt::format("With a bulk relaxation time of its own and no subgrid model the collision trt is unstable at a "
                    "relaxation time only {:.2g} above 1/2: consider fluid.collision: bgk or "
                    "fluid.bulk_relaxation_time: 0.",
                    excess));
  // The largest stable stream at tau - 1/2 = 0.003, where the subgrid model brings water (docs/stability.md), to 5 %.
  const double calm = 0.17 / std::sqrt(bulk), fastest = expected_lattice_velocity(c);
  if (lbm::bgk_in_the_open(c.fluid.collision) && bulk > 1.0 && excess < 0.003 && fastest > calm)
    found.push_back(
        fmt::format("With a bulk relaxation time of {:g} steps a stream faster than about {:.2g} cells a step "
                    "grows stripes, and this one may reach {:.2g}: consider fluid.bulk_relaxation_time: 1.",
                    bulk, calm, fastest));
}

// The maps of docs/stability.md end there.
constexpr double least_mapped_excess = 1e-4;

void warn_of_unmapped_relaxation(const Case& c, Warnings& found) {
  const double excess = relaxation_time(c) - 0.5;
  if (c.fluid.smagorinsky_constant > 0.0 && excess < least_mapped_excess * (1.0 - 1e-9))
    found.push_back(
        fmt::format("The relaxation time is only {:.2g} above 1/2, and stability has not been tested below {:g} "
                    "(docs/stability.md): "
                    "consider finer cells, or a fluid.time_step of {:.2g} s if the flow allows it.",
                    excess, least_mapped_excess, fluid_time_step(c) * least_mapped_excess / excess));
}

void warn_of_laminar_flow(const Case& c, Warnings& found) {
  const FlowEstimate flow = flow_estimate(c);
  const double falling = settling_velocity(c) * largest_diameter(c) / c.fluid.kinematic_viscosity;
  const bool slow_grains = flow.drive == FlowCause::none && falling > 0.0 && falling < 10.0;
  if (c.fluid.smagorinsky_constant == 0.0 || !(slow_grains || (flow.drive != FlowCause::none && flow.laminar))) return;
  found.push_back(
      fmt::format("The flow is laminar (Reynolds number {:.3g}) and the subgrid model would add to its "
                  "viscosity: consider fluid.smagorinsky_constant: 0 and fluid.collision: trt.",
                  slow_grains ? falling : flow.bulk_velocity * flow.depth / c.fluid.kinematic_viscosity));
}

void warn_of_sliding_bed(const Case& c, Warnings& found) {
  const double ratio = stress_ratio_at_base(c), held = bulk_friction(c.contact.friction);
  if (ratio > held)
    found.push_back(fmt::format(
        "The slope requires a shear stress of {:.2g} times the normal stress at the base of the bed, and grains of "
        "this friction sustain about {:.2g}, so that the bed slides as a whole: consider a "
        "gravity.slope of at most {}.",
        ratio, held, at_most_text(gravity_vector(c.gravity).x() / -gravity_vector(c.gravity).z() * held / ratio, 2)));
}

constexpr double deep_under_weight = 0.01, deep_in_impact = 0.05;

// Under weight a linear contact overlaps by the inverse of its stiffness, in an impact by the inverse of its root; one
// of Hertz by the powers 2/3 and 2/5 of the inverse modulus.
std::string stiffer_contact(const Case& c, const Overlaps& overlaps) {
  const bool linear = c.contact.law == dem::Law::linear;
  const double factor = std::max(std::pow(overlaps.under_weight / deep_under_weight, linear ? 1.0 : 1.5),
                                 std::pow(overlaps.in_impact / deep_in_impact, linear ? 2.0 : 2.5));
  return linear ? fmt::format("contact.normal_stiffness: {:.2g}", 1.05 * factor * c.contact.normal_stiffness)
                : fmt::format("contact.youngs_modulus: {:.2g}", 1.05 * factor * c.contact.youngs_modulus);
}

void warn_of_overlap(const Case& c, Warnings& found) {
  const Overlaps overlaps = expected_overlaps(c);
  if (overlaps.under_weight <= deep_under_weight && overlaps.in_impact <= deep_in_impact) return;
  found.push_back(fmt::format(
      "Grains would overlap by {:.2g} % of a diameter under the weight of the bed and {:.2g} % in an impact at {:.2g} "
      "m/s: consider a stiffer contact, for example {}.",
      100.0 * overlaps.under_weight, 100.0 * overlaps.in_impact, overlaps.speed, stiffer_contact(c, overlaps)));
}

constexpr double suspiciously_long = 10.0;  // boxes; a file in millimetres is a thousand times too large

void warn_of_large_solids(const Case& c, Warnings& found) {
  for (std::size_t n = 0; n < c.solids.size(); ++n) {
    const SolidCase& solid = c.solids[n];
    if (solid.stl.empty()) continue;
    const coupling::Extent extent = extent_of(solid);
    const Vec3 boxes = (extent.upper - extent.lower).cwiseQuotient(c.domain.size);
    int axis = 0;
    if (boxes.maxCoeff(&axis) <= suspiciously_long) continue;
    found.push_back(
        fmt::format("The surface solids.{} is {:.4g} m long along {}, {:.3g} times the box: if its file is in "
                    "millimetres, consider "
                    "solids.{}.scale: {:g}.",
                    n, extent.upper[axis] - extent.lower[axis], axis_name[axis], boxes[axis], n, 1e-3 * solid.scale));
  }
}

// Fewer cells than this across a grain do not resolve the flow around it.
constexpr double barely_resolved = 5.0;

void warn_of_coarse_cells(const Case& c, Warnings& found) {
  const double cells = smallest_diameter(c) / c.domain.spacing, fewest = c.coupling.fewest_cells_per_diameter;
  if (c.grains.empty() || cells >= fewest * (1.0 - whole_number_tolerance)) return;
  found.push_back(
      fmt::format("The smallest grain is only {:.2g} cells across{}; its drag is {} (docs/accuracy.md): consider a "
                  "domain.spacing of {:.6g} m, or accept it with coupling.fewest_cells_per_diameter: {:g}.",
                  cells, cells < barely_resolved ? ", which does not resolve the flow around it" : "", drag_text(c),
                  spacing_below(c.domain, smallest_diameter(c) / fewest), std::floor(10.0 * cells) / 10.0));
}

// The fluid resists a sudden motion of a sphere with 3.8 dx/d of the displaced mass, and the load, extrapolated in
// time, is stable up to 1.15 times the mass of the grain (coupling/load_rule.hpp); the mean load was stable down to
// half the fluid's density.
void warn_of_grains(const Case& c, Warnings& found) {
  for (const dem::Population& population : c.grains) {
    const double least = c.coupling.load_rule() == coupling::LoadRule::mean
                             ? 0.5
                             : 3.8 / 1.15 * c.domain.spacing / population.smallest_diameter();
    if (!c.coupling.virtual_mass && !population.fixed && !population.prescribed_velocity &&
        population.density < least * c.fluid.density)
      found.push_back(
          fmt::format("Grains of {} kg/m^3 are so light that the explicit coupling may become unstable: consider "
                      "coupling.virtual_mass: {{}}.",
                      population.density));
  }
}

// Only grains that sink make a bed.
void warn_of_floating_grains(const Case& c, Warnings& found) {
  if (gravity_vector(c.gravity).z() >= 0.0 || c.gravity.mode == GravityMode::balanced) return;
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    if (!c.grains[n].held() && c.grains[n].density <= (1.0 + neutral_density) * c.fluid.density)
      found.push_back(
          fmt::format("Grains of {:g} kg/m^3 (grains.{}) are no heavier than the fluid of {:g} kg/m^3: they "
                      "make no bed, and there is no Shields number.",
                      c.grains[n].density, n, c.fluid.density));
}

// Drag of dense arrays at ten cells a diameter, without a subgrid model: with bgk 56 % too high at tau - 1/2 = 0.02 and
// 19 % too low at 0.5; with trt and bouzidi 4 % too low at 0.1 and 15 % at 0.5
// (benchmarks/validation/simple_cubic_arrays).
void warn_of_links(const Case& c, Warnings& found) {
  const double excess = relaxation_time(c) - 0.5;
  const bool bgk = c.fluid.collision == lbm::CollisionModel::bgk, trt = lbm::trt_beside_bodies(c.fluid.collision),
             bouzidi = c.coupling.links == lbm::LinkRule::bouzidi;
  if (c.grains.empty() || c.fluid.smagorinsky_constant > 0.0 || excess < 0.0299) return;
  if (bgk || (trt && bouzidi && excess > 0.15))
    found.push_back(
        fmt::format("In a dense bed with {}, drag depends on the relaxation time and is off by tens of percent: "
                    "consider {}coupling.links: cli.",
                    bgk ? "fluid.collision: bgk" : "coupling.links: bouzidi", bgk ? "fluid.collision: trt and " : ""));
}

// A step must be short against what a single grain in the fluid covers: a twentieth of a diameter.
void warn_of_model_fluid(const Case& c, Warnings& found) {
  const double fastest = fastest_model_fluid(c), longest = 0.05 * mean_grain(c).diameter / fastest;
  if (*c.run.time_step > longest)
    found.push_back(
        fmt::format("The fluid around a single grain moves at {:.3g} m/s, which is more than a twentieth of a "
                    "diameter a step: consider a run.time_step of at most {} s.",
                    fastest, at_most_text(longest, 2)));
}

// Nothing is written more often than once a step.
void warn_of_frequent_output(const Case& c, Warnings& found) {
  const double step = step_time(c);
  const auto warn = [&](const std::string& key, double every) {
    if (every > 0.0 && every < step * (1.0 - 1e-9))
      found.push_back(
          fmt::format("output.{} = {:g} s is less than a step of {:.3g} s: it is written in every step; "
                      "consider a longer interval.",
                      key, every, step));
  };
  warn("series.every", c.output.series.every);
  warn("fluid.every", c.output.fluid.every);
  warn("grains.every", c.output.grains.every);
  warn("checkpoint.every", c.output.checkpoint.every);
}

}  // namespace

std::vector<std::string> warnings(const Case& c) {
  Warnings found = warnings(c.analysis.observers, run_facts(c));
  for (const std::string& warning : drive_warnings(c)) found.push_back(warning);
  if (c.system == SystemKind::model_fluid) warn_of_model_fluid(c, found);
  if (c.system == SystemKind::grains || c.system == SystemKind::resolved) {
    warn_of_overlap(c, found);
    warn_of_sliding_bed(c, found);
  }
  if (!has_fluid(c)) return found;
  for (const auto warn : {warn_of_fast_flow, warn_of_compression, warn_of_collision, warn_of_unmapped_relaxation,
                          warn_of_bulk_relaxation, warn_of_laminar_flow, warn_of_large_solids, warn_of_coarse_cells,
                          warn_of_grains, warn_of_floating_grains, warn_of_links})
    warn(c, found);
  return found;
}

std::vector<std::string> warnings_of_plan(const Case& c) {
  Warnings found;
  warn_of_frequent_output(c, found);
  if (c.run.ramp > c.run.until)
    found.push_back(
        fmt::format("Gravity rises until {:g} s and the run ends at {:g} s: consider a shorter run.ramp or a later "
                    "run.until.",
                    c.run.ramp, c.run.until));
  const FlowEstimate flow = flow_estimate(c);
  if (flow.drive == FlowCause::none) return found;
  const bool developed =
      c.initial.takes(InitialField::fluid) || c.initial.fluid.log_profile || c.initial.fluid.linear_profile;
  const double turnover = flow.laminar ? 0.0 : flow.depth / flow.friction_velocity;
  const double needed = developed ? turnover : flow.spin_up;
  if (c.run.until < needed)
    found.push_back(
        fmt::format("The run ({:g} s) is too short for the flow to develop: {}; consider a later "
                    "run.until or a developed start (initial).",
                    c.run.until,
                    developed ? fmt::format("one turnover H/u* takes {:.2g} s", turnover)
                              : fmt::format("from rest that takes about {:.2g} s", flow.spin_up)));
  if (!c.initial.fluid.log_profile) return found;
  const double given = c.initial.fluid.log_profile->shear_velocity, ratio = given / flow.friction_velocity;
  constexpr double meant_to_be_slow = 0.25;  // in a run that is too short for the flow anyway
  if (flow.still_gaining && ratio < meant_to_be_slow) return found;
  if (ratio < 0.8 || ratio > 1.25)
    found.push_back(
        fmt::format("The flow starts with a shear velocity of {:.3g} m/s and is driven ({}) towards {:.3g} "
                    "m/s: consider initial.fluid.log_profile.shear_velocity: {:.3g}.",
                    given, words_of(flow.drive), flow.friction_velocity, flow.friction_velocity));
  return found;
}

}  // namespace thalweg::driver
