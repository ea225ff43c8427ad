#include "driver/warnings/case_warnings.hpp"

#include "core/geometry/periodic_box.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/case/limit_text.hpp"
#include "driver/estimate/contact_estimate.hpp"
#include "driver/estimate/drag_accuracy.hpp"
#include "driver/estimate/filled_in.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "driver/estimate/settling.hpp"
#include "driver/estimate/stability.hpp"
#include "driver/input/run_context.hpp"
#include "driver/warnings/boundary_warnings.hpp"
#include "driver/warnings/column_warnings.hpp"
#include "driver/warnings/consistent_remedy.hpp"
#include "driver/warnings/contact_warnings.hpp"
#include "driver/warnings/drive_warnings.hpp"
#include "driver/warnings/plan_warnings.hpp"
#include "driver/warnings/remedy.hpp"
#include "driver/warnings/shape_warnings.hpp"
#include "driver/warnings/solid_warnings.hpp"
#include "driver/warnings/unit_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::driver {

namespace {

constexpr double limit_rounding = 1e-9;  // of a number that is chosen to be at its limit

// The largest velocity expected, cells a step.
double expected_lattice_velocity(const Case& c) { return flow_estimate(c).speed / units_of(c).velocity(); }

Warnings fast_flow(const Case& c) {
  const FlowEstimate flow = flow_estimate(c);
  const double lattice_velocity = flow.speed / units_of(c).velocity();
  if (!(lattice_velocity * (1.0 - limit_rounding) > accurate_lattice_velocity)) return {};
  return {{fmt::format("The flow may reach about {:.2g} m/s ({}), which is {:.3g} cells per step; results are accurate "
                       "below {:g}, and a start above 0.173 is refused",
                       flow.speed, words_of(flow.cause), lattice_velocity, accurate_lattice_velocity),
           {{{fluid_step_change(accurate_lattice_velocity * c.domain.spacing / flow.speed, 2, Rounding::down)}, {}}},
           "a shorter step with finer cells"}};
}

Warnings compression(const Case& c) {
  const double compression =
      3.0 * std::abs(gravity_vector(c.gravity).z()) / units_of(c).acceleration() * c.domain.size[2] / c.domain.spacing;
  if (c.gravity.mode != GravityMode::full || !(compression * (1.0 - limit_rounding) > largest_compression)) return {};
  const Change step =
      fluid_step_change(fluid_time_step(c) * std::sqrt(largest_compression / compression), 2, Rounding::down);
  const Change mode =
      word_change("gravity.mode", "reduced", [](Case& other) { other.gravity.mode = GravityMode::reduced; });
  return {{fmt::format("The weight of the fluid compresses it by {:.2g} % from top to bottom", 100.0 * compression),
           {{{step}, {}}, {{mode}, {}}}}};
}

// The constant of another model goes with it.
Remedy subgrid_changes(const Case& c, const char* word, lbm::SubgridModel model) {
  Remedy changes{word_change("fluid.subgrid_model", word, [model](Case& other) { other.fluid.subgrid_model = model; })};
  if (c.fluid.smagorinsky_constant)
    changes.push_back(word_change("fluid.smagorinsky_constant", "null",
                                  [](Case& other) { other.fluid.smagorinsky_constant.reset(); }));
  return changes;
}

Change collision_change(const char* word, lbm::CollisionModel model) {
  return word_change("fluid.collision", word, [model](Case& other) { other.fluid.collision = model; });
}

Change trt_change() { return collision_change("trt", lbm::CollisionModel::trt); }

// Changes the excess of the relaxation time over 1/2 through the time step.
Change excess_change(const Case& c, double excess, Rounding rounding) {
  return fluid_step_change(fluid_time_step(c) * excess / (relaxation_time(c) - 0.5), 2, rounding);
}

// Excess from which both trt and bgk are stable and accurate without a subgrid model.
constexpr double calm_excess = 0.03;

bool smagorinsky(const Case& c) { return c.fluid.subgrid().model() == lbm::SubgridModel::smagorinsky; }

Warnings unstable_collision(const Case& c) {
  const double excess = relaxation_time(c) - 0.5, fastest = expected_lattice_velocity(c);
  const double stable = stable_lattice_velocity(c.fluid.collision, excess);
  if (c.fluid.subgrid().on() || (stable > 0.0 && fastest <= stable)) return {};
  return {
      {fmt::format("The relaxation time is only {:.2g} above 1/2 and there is no subgrid model; the chosen collision "
                   "was stable there {}",
                   excess,
                   stable == 0.0 ? std::string("at no velocity") : fmt::format("up to {:g} cells per step", stable)),
       {{subgrid_changes(c, "qr", lbm::SubgridModel::qr), {}}, {{excess_change(c, calm_excess, Rounding::up)}, {}}}}};
}

// With trt the odd modes relax in Lambda/(tau - 1/2) steps, about 20 at this excess. Where they hardly do they hide the
// strain in the second moments, from which shear rate and eddy viscosity follow (docs/stability.md).
constexpr double least_excess_of_trt = 0.01;

Warnings slow_odd_modes(const Case& c) {
  const double excess = relaxation_time(c) - 0.5;
  if (c.fluid.collision != lbm::CollisionModel::trt || excess >= least_excess_of_trt * (1.0 - limit_rounding))
    return {};
  Remedy by_default{collision_change("trt_at_bodies", lbm::CollisionModel::trt_at_bodies)};
  if (!c.fluid.subgrid().on())
    for (const Change& change : subgrid_changes(c, "qr", lbm::SubgridModel::qr)) by_default.push_back(change);
  return {{fmt::format("The relaxation time is only {:.2g} above 1/2: with trt everywhere the odd modes hardly relax "
                       "there, and shear rate, eddy viscosity and slip of walls come out wrong",
                       excess),
           {{by_default, {}}, {{excess_change(c, least_excess_of_trt, Rounding::up)}, {}}}}};
}

// With trt everywhere, and cli at bodies, steady flow does not depend on the relaxation time; drag was measured up
// to 1.94 (benchmarks/validation/simple_cubic_arrays).
Warnings long_relaxation(const Case& c) {
  const bool exact = c.fluid.collision == lbm::CollisionModel::trt &&
                     ((c.grains.empty() && c.solids.empty()) || c.coupling.links == bodies::LinkRule::cli);
  const double excess = relaxation_time(c) - 0.5, longest = exact ? 1.45 : 1.0;
  if (excess * (1.0 - limit_rounding) <= longest) return {};
  return {{fmt::format("The relaxation time, {:.2g}, is so large that walls and grains lose accuracy", excess + 0.5),
           {{{excess_change(c, longest, Rounding::down)}, {}}},
           "a shorter fluid.time_step"}};
}

Change bulk_change(double steps) {
  return exact_change("fluid.bulk_relaxation_time", steps, 3,
                      [](Case& other, double to) { other.fluid.bulk_relaxation_time = to; });
}

Warnings bulk_relaxation(const Case& c) {
  const double bulk = c.fluid.bulk_relaxation_time.value_or(0.0), excess = relaxation_time(c) - 0.5;
  const bool eddies = c.fluid.subgrid().on();
  if (!eddies && c.fluid.collision == lbm::CollisionModel::trt && bulk > 0.0 && excess < 0.0299)
    return {{fmt::format("With a bulk relaxation time of its own and no subgrid model, the collision trt is unstable "
                         "at a relaxation time only {:.2g} above 1/2",
                         excess),
             {{{bulk_change(0.0)}, {}}, {{collision_change("bgk", lbm::CollisionModel::bgk)}, {}}}}};
  // The largest stable stream at tau - 1/2 = 0.003, where the subgrid model brings water (docs/stability.md), to 5 %.
  const double calm = 0.17 / std::sqrt(bulk), fastest = expected_lattice_velocity(c);
  if (!lbm::traits_of(c.fluid.collision).is_bgk_in_bulk || bulk <= 1.0 || excess >= 0.003 || fastest <= calm) return {};
  return {{fmt::format("With a bulk relaxation time of {:g} steps a stream faster than about {:.2g} cells per step "
                       "grows stripes, and this one may reach {:.2g}",
                       bulk, calm, fastest),
           {{{bulk_change(1.0)}, {}}}}};
}

// The maps of docs/stability.md end there.
constexpr double least_mapped_excess = 1e-4;

// Finer cells and a step that keep the flow's cells a step, and bring the relaxation time as far above 1/2 as this.
Remedy finer_cells_and_step(const Case& c, double excess) {
  constexpr double margin = 0.99;
  const double finer = margin * c.domain.spacing * (relaxation_time(c) - 0.5) / excess;
  const Change spacing = spacing_change(c, std::min(finer, c.domain.spacing));
  const Case after = changed(c, {spacing});
  if (c.filled_in.time_step) return {spacing};  // the step follows
  return {spacing, fluid_step_change(fluid_time_step(c) * after.domain.spacing / c.domain.spacing, 3, Rounding::down)};
}

Warnings unmapped_relaxation(const Case& c) {
  const double excess = relaxation_time(c) - 0.5;
  if (!c.fluid.subgrid().on() || excess >= least_mapped_excess * (1.0 - limit_rounding)) return {};
  return {{fmt::format("The relaxation time is only {:.2g} above 1/2, and stability has not been tested below {:g} "
                       "(docs/stability.md)",
                       excess, least_mapped_excess),
           {{{excess_change(c, least_mapped_excess, Rounding::up)}, {}},
            {finer_cells_and_step(c, least_mapped_excess), {}}},
           "finer cells"}};
}

Warnings laminar_flow(const Case& c) {
  const FlowEstimate flow = flow_estimate(c);
  const double falling = settling_velocity(c) * largest_size(c) / c.fluid.kinematic_viscosity;
  const bool slow_grains = flow.drive == FlowCause::none && falling > 0.0 && falling < 10.0;
  if (!smagorinsky(c) || !(slow_grains || (flow.drive != FlowCause::none && flow.laminar))) return {};
  return {
      {fmt::format("The flow is laminar (Reynolds number {:.3g}) and Smagorinsky's model would add to its viscosity",
                   slow_grains ? falling : flow.bulk_velocity * flow.depth / c.fluid.kinematic_viscosity),
       {{subgrid_changes(c, "qr", lbm::SubgridModel::qr), {}}}}};
}

// Where the depth follows from the slope and a Shields number, water on a gentler slope is deeper.
void set_slope(Case& c, double slope) {
  c.gravity.slope = slope;
  if (const std::optional<double> shields = c.filled_in.flow.shields_number)
    c.domain.size.z() = box_height(c, depth_of(c, hydraulic_radius_with(c, *shields)));
}

// By the key that the case has: where the slope follows from a Shields number, that one.
Change slope_change(const Case& c, double slope) {
  if (c.filled_in.flow.slope) {
    const FlowNumbers flow = flow_numbers(c);
    const double share = std::sin(std::atan(slope)) / std::sin(std::atan(flow.slope));
    return number_change("flow.shields_number", share * flow.shields_hydraulic, 2, Rounding::down,
                         [](Case& other, double to) { other.gravity.slope = slope_for(flow_numbers(other), to); });
  }
  if (!c.gravity.vector)
    return number_change("gravity.slope", slope, 2, slope < 0.0 ? Rounding::up : Rounding::down, set_slope);
  const Vec3 gravity = *c.gravity.vector;
  const std::string along = (slope < 0.0 ? at_least_text : at_most_text)(slope * -gravity.z(), 2);
  return word_change("gravity.vector", fmt::format("[{}, {:.9g}, {:.9g}]", along, gravity.y(), gravity.z()),
                     [x = std::stod(along)](Case& other) { other.gravity.vector->x() = x; });
}

// The steepest slope with which the stress ratio at the base of the bed is no larger: in proportion, or where the depth
// changes with it by bisection; 0: there is none.
double slope_with_ratio(const Case& c, double ratio) {
  if (!c.filled_in.flow.shields_number)
    return gravity_vector(c.gravity).x() / -gravity_vector(c.gravity).z() * ratio / stress_ratio_at_base(c);
  const auto holds = [&](double slope) {
    Case other = c;
    set_slope(other, slope);
    return stress_ratio_at_base(other) <= ratio;
  };
  return steepest_slope(*c.gravity.slope, holds);
}

Warnings sliding_bed(const Case& c) {
  if (c.system != SystemKind::grains && c.system != SystemKind::resolved) return {};
  if (!only_friction_holds_the_bed(c)) return {};
  const double ratio = stress_ratio_at_base(c), held = bulk_friction(c);
  if (!(ratio > held)) return {};
  const double slope = slope_with_ratio(c, held);
  if (slope == 0.0)
    return {{fmt::format("The Shields number requires a shear stress of {:.2g} times the normal stress at the base of "
                         "the bed, on gentle slopes as well, and grains of this friction sustain about {:.2g}, so the "
                         "bed slides as a whole",
                         ratio, held),
             {},
             "a smaller flow.shields_number"}};
  return {{fmt::format("The slope requires a shear stress of {:.2g} times the normal stress at the base of the bed, "
                       "and grains of this friction sustain about {:.2g}, so the bed slides as a whole",
                       ratio, held),
           {{{slope_change(c, slope)}, {}}},
           "a smaller slope"}};
}

// Fewer cells than this across a grain do not resolve the flow around it.
constexpr double barely_resolved = 5.0;

Warnings coarse_cells(const Case& c) {
  const double cells = narrowest_grain(c) / c.domain.spacing, fewest = c.coupling.fewest_cells_per_diameter;
  if (c.grains.empty() || cells >= fewest * (1.0 - whole_number_tolerance)) return {};
  const Change finer = spacing_change(c, narrowest_grain(c) / fewest);
  const Case after = changed(c, {finer});
  const Change step =
      fluid_step_change(fluid_time_step(c) * after.domain.spacing / c.domain.spacing, 3, Rounding::down);
  const double no_more = std::floor(10.0 * cells * (1.0 + whole_number_tolerance)) / 10.0;  // 5.9 of 5.998
  const Change accepted = number_change("coupling.fewest_cells_per_diameter", no_more, 6, Rounding::down,
                                        [](Case& other, double to) { other.coupling.fewest_cells_per_diameter = to; });
  return {{fmt::format("The smallest grain is only {:g} cells across{}; drag {} (docs/accuracy.md)", no_more,
                       cells < barely_resolved ? ", which does not resolve the flow around it" : "", drag_text(c)),
           {{c.filled_in.time_step ? Remedy{finer} : Remedy{finer, step}, {}}, {{accepted}, "accept it with "}},
           "finer cells"}};
}

// Only grains that sink make a bed.
Warnings floating_grains(const Case& c) {
  Warnings found;
  const auto free = free_populations(c);
  const bool there_is_a_bed =
      std::any_of(free.begin(), free.end(), [&](std::size_t p) { return !floats(c, c.grains[p]); });
  if (gravity_vector(c.gravity).z() >= 0.0 || c.gravity.mode == GravityMode::balanced) return found;
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    if (!c.grains[n].held() && floats(c, c.grains[n]))
      found.push_back(
          fmt::format("Grains of {:g} kg/m^3 (grains.{}) are no heavier than the fluid of {:g} kg/m^3: they {}.",
                      c.grains[n].density, n, c.fluid.density,
                      there_is_a_bed ? "are no part of the bed, and have no Shields number"
                                     : "make no bed, and there is no Shields number"));
  return found;
}

Warnings late_supplies(const Case& c) {
  Warnings found;
  for (std::size_t n = 0; n < c.supplies.size(); ++n)
    if (c.supplies[n].from >= c.run.until)
      found.push_back(fmt::format(
          "The supply supplies.{0} begins at {1:g} s, and the run ends at {2:g} s without any of its grains: "
          "give an earlier supplies.{0}.from, or a later run.until.",
          n, c.supplies[n].from, c.run.until));
  return found;
}

// Drag of dense arrays at ten cells a diameter, without a subgrid model: with bgk 56 % too high at tau - 1/2 = 0.02 and
// 19 % too low at 0.5; with trt and bouzidi 4 % too low at 0.1 and 15 % at 0.5
// (benchmarks/validation/simple_cubic_arrays).
Warnings inexact_links(const Case& c) {
  const double excess = (relaxation_time(c) - 0.5) * (1.0 - limit_rounding);
  const bool bgk = c.fluid.collision == lbm::CollisionModel::bgk,
             trt = lbm::traits_of(c.fluid.collision).is_trt_near_bodies,
             bouzidi = c.coupling.links == bodies::LinkRule::bouzidi;
  if (c.grains.empty() || smagorinsky(c) || excess < 0.0299) return {};
  if (!bgk && !(trt && bouzidi && excess > accurate_excess_near_bodies)) return {};
  Remedy remedy;
  if (bgk) remedy.push_back(trt_change());
  remedy.push_back(
      word_change("coupling.links", "cli", [](Case& other) { other.coupling.links = bodies::LinkRule::cli; }));
  return {{fmt::format("In a dense bed with {}, drag depends on the relaxation time and is off by tens of percent",
                       bgk ? "bgk" : "bouzidi links"),
           {{remedy, {}}}}};
}

// A step must be short against what a single grain in the fluid covers: a twentieth of a diameter.
Warnings fast_model_fluid(const Case& c) {
  if (c.system != SystemKind::model_fluid) return {};
  const double fastest = fastest_model_fluid(c), longest = 0.05 * mean_grain(c).diameter / fastest;
  if (*c.run.time_step <= longest) return {};
  return {
      {fmt::format(
           "The fluid around a single grain moves at {:.3g} m/s, which is more than a twentieth of a diameter per step",
           fastest),
       {{{number_change("run.time_step", longest, 2, Rounding::down,
                        [](Case& other, double step) { other.run.time_step = step; })},
         {}}}}};
}

// Seepage with one relaxation time, which hardly flows: speed over the right one in random beds, by cells across a
// grain, with tau - 1/2 below 0.001 (benchmarks/validation/seepage).
double seepage_speed(double cells) {
  constexpr double few = 6.25, some = 10.0, many = 16.0;
  constexpr double with_few = 0.005, with_some = 0.084, with_many = 0.47;
  const auto between = [cells](double from, double with_from, double to, double with_to) {
    return with_from * std::pow(with_to / with_from, (cells - from) / (to - from));
  };
  if (cells > many) return 1.0;
  return cells < few    ? with_few
         : cells < some ? between(few, with_few, some, with_some)
                        : between(some, with_some, many, with_many);
}

Warnings slow_seepage(const Case& c) {
  constexpr std::int64_t fewest_grains = 20;  // that make a bed
  if (c.fluid.collision != lbm::CollisionModel::bgk || relaxation_time(c) - 0.5 > 1e-3 ||
      grain_count(c) < fewest_grains)
    return {};
  const double speed = seepage_speed(smallest_diameter(c) / c.domain.spacing);
  if (speed >= 1.0) return {};
  return {{fmt::format("With bgk, water seeps through a dense bed at about {:.1g} times the right speed", speed),
           {{{collision_change("trt_at_bodies", lbm::CollisionModel::trt_at_bodies)}, {}}}}};
}

Warnings of_sentences(const std::vector<std::string>& sentences) { return {sentences.begin(), sentences.end()}; }

Warnings observer_warnings(const Case& c) { return of_sentences(warnings(c.analysis.observers, run_context(c))); }
Warnings drives(const Case& c) { return of_sentences(drive_warnings(c)); }

template <Warnings (*rule)(const Case&)>
Warnings with_fluid(const Case& c) {
  return has_fluid(c) ? rule(c) : Warnings{};
}

// Rules in the order of their weight: case_warnings.hpp. Where lengths are in another unit, the others would advise to
// refine what is a thousand times too large.
std::vector<WarningRule> rules_for(const Case& c) {
  std::vector<WarningRule> rules = unit_rules();
  if (has_other_lengths(c)) return rules;
  for (const WarningRule rule : {drives,
                                 large_solids,
                                 absent_solids,
                                 with_fluid<swapped_floor>,
                                 with_fluid<inlets>,
                                 with_fluid<recycling>,
                                 with_fluid<beds_at_inlets>,
                                 with_fluid<outlets>,
                                 with_fluid<outlet_pressures>,
                                 with_fluid<floating_grains>,
                                 unlike_clumps,
                                 late_supplies,
                                 sliding_bed,
                                 with_fluid<other_start>,
                                 with_fluid<fast_flow>,
                                 with_fluid<compression>,
                                 with_fluid<unstable_collision>,
                                 with_fluid<slow_odd_modes>,
                                 with_fluid<long_relaxation>,
                                 with_fluid<unmapped_relaxation>,
                                 with_fluid<bulk_relaxation>,
                                 fast_model_fluid,
                                 with_fluid<laminar_flow>,
                                 with_fluid<coarse_cells>,
                                 with_fluid<slow_seepage>,
                                 with_fluid<inexact_links>,
                                 overlap_warnings,
                                 rebound_warnings,
                                 observer_warnings})
    rules.push_back(rule);
  for (const std::vector<WarningRule>& more : {column_rules(), plan_rules()})
    rules.insert(rules.end(), more.begin(), more.end());
  return rules;
}

}  // namespace

std::vector<std::string> warnings(const Case& c) {
  std::vector<std::string> found = ConsistentRemedies(c, rules_for(c)).sentences();
  if (has_other_lengths(c)) return found;
  const std::vector<std::string> solids = solids_in_the_lattice(c);
  found.insert(found.begin(), solids.begin(), solids.end());
  return found;
}

Remedy first_remedy(const Case& c) { return ConsistentRemedies(c, rules_for(c)).first(); }

}  // namespace thalweg::driver
