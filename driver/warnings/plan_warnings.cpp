#include "driver/warnings/plan_warnings.hpp"

#include "beds/packing/packing.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/bed/reference_grain.hpp"
#include "driver/case/limit_text.hpp"
#include "driver/estimate/filled_in.hpp"
#include "driver/estimate/flow_drive.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "driver/estimate/settling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace thalweg::driver {

namespace {

// Nothing is written more often than once a step.
Warnings frequent_output(const Case& c) {
  Warnings found;
  const double step = step_time(c);
  const auto look = [&](const std::string& key, double every, const Setter& set) {
    if (every > 0.0 && every < step * (1.0 - 1e-9))
      found.push_back({fmt::format("output.{} = {:g} s is less than a step of {:.3g} s, so it is written in every step",
                                   key, every, step),
                       {{{number_change("output." + key, step, 3, Rounding::up, set)}, {}}}});
  };
  look("series.every", c.output.series.every, [](Case& other, double to) { other.output.series.every = to; });
  look("fluid.every", c.output.fluid.every, [](Case& other, double to) { other.output.fluid.every = to; });
  look("grains.every", c.output.grains.every, [](Case& other, double to) { other.output.grains.every = to; });
  for (std::size_t n = 0; n < c.output.fluid_parts.size(); ++n)
    look(fmt::format("fluid_parts.{}.every", n), c.output.fluid_parts[n].every,
         [n](Case& other, double to) { other.output.fluid_parts[n].every = to; });
  for (std::size_t n = 0; n < c.output.grain_parts.size(); ++n)
    look(fmt::format("grain_parts.{}.every", n), c.output.grain_parts[n].every,
         [n](Case& other, double to) { other.output.grain_parts[n].every = to; });
  look("checkpoint.every", c.output.checkpoint.every,
       [](Case& other, double to) { other.output.checkpoint.every = to; });
  return found;
}

// Frames at the start alone, and no row: nothing is written before the first interval has passed.
Warnings rare_output(const Case& c) {
  Warnings found;
  const auto look = [&](const std::string& key, double every, const char* what, const Setter& set) {
    if (every > c.run.until * (1.0 + 1e-9))
      found.push_back({fmt::format("output.{} = {:g} s is longer than the run of {:g} s, so there is {}", key, every,
                                   c.run.until, what),
                       {{{number_change("output." + key, c.run.until, 3, Rounding::down, set)}, {}}}});
  };
  constexpr const char* frame = "no frame after that of the start";
  look("series.every", c.output.series.every, "no row after that of the start",
       [](Case& other, double to) { other.output.series.every = to; });
  if (has_fluid(c)) {
    look("fluid.every", c.output.fluid.every, frame, [](Case& other, double to) { other.output.fluid.every = to; });
    for (std::size_t n = 0; n < c.output.fluid_parts.size(); ++n)
      look(fmt::format("fluid_parts.{}.every", n), c.output.fluid_parts[n].every, frame,
           [n](Case& other, double to) { other.output.fluid_parts[n].every = to; });
  }
  if (!c.grains.empty()) {
    look("grains.every", c.output.grains.every, frame, [](Case& other, double to) { other.output.grains.every = to; });
    for (std::size_t n = 0; n < c.output.grain_parts.size(); ++n)
      look(fmt::format("grain_parts.{}.every", n), c.output.grain_parts[n].every, frame,
           [n](Case& other, double to) { other.output.grain_parts[n].every = to; });
  }
  return found;
}

Change until_change(double least) {
  return number_change("run.until", least, 2, Rounding::up, [](Case& other, double to) { other.run.until = to; });
}

Warnings long_ramp(const Case& c) {
  if (c.run.ramp <= c.run.until) return {};
  const Change shorter = number_change("run.ramp", 0.5 * c.run.until, 2, Rounding::down,
                                       [](Case& other, double to) { other.run.ramp = to; });
  return {{fmt::format("Gravity rises until {:g} s, but the run ends at {:g} s", c.run.ramp, c.run.until),
           {{{shorter}, {}}, {{until_change(2.0 * c.run.ramp)}, {}}}}};
}

// True for observers that average from a time on; those of events have times, too.
template <typename Keys>
constexpr bool averages = requires(Keys keys) {
  keys.from;
}
&&!std::is_same_v<Keys, analysis::EntrainmentKeys>;

bool starts_developed(const Case& c) {
  return c.initial.takes(InitialField::fluid) || c.initial.fluid.log_profile || c.initial.fluid.linear_profile;
}

// The log law that a turbulent flow under a free surface comes to.
std::vector<Advice> developed_start(const Case& c, const FlowEstimate& flow) {
  const bool suits =
      flow.drive == FlowCause::slope || flow.drive == FlowCause::mean_velocity || flow.drive == FlowCause::inlet;
  if (!suits || flow.laminar || c.domain.faces[top].drags() || c.initial.fluid.count() > 0) return {};
  const Change start = word_change("initial.fluid.log_profile", "{}", [](Case& other) {
    other.initial.fluid.log_profile.emplace();
    other.filled_in.profile = {true, true, true};
  });
  return {{{start}, "a start near the developed flow, "}};
}

// s, the turnover of the largest eddies, H/u*; 0 in a laminar flow.
double turnover(const FlowEstimate& flow) { return flow.laminar ? 0.0 : flow.depth / flow.friction_velocity; }

// s, after which a flow that takes this time (s) under its full drive has developed: gravity may rise first.
double after_ramp(const Case& c, const FlowEstimate& flow, double time) {
  return flow.drive == FlowCause::slope ? c.run.ramp + time : std::max(c.run.ramp, time);
}

// "", or how long of a time gravity rises.
std::string ramp_text(const Case& c, const FlowEstimate& flow) {
  return c.run.ramp > 0.0 && flow.drive == FlowCause::slope ? fmt::format(" after a ramp of {:g} s", c.run.ramp) : "";
}

bool any_averages(const Case& c) {
  bool any = false;
  c.analysis.observers.for_each([&](const auto& keys) {
    using Keys = typename std::decay_t<decltype(keys)>::value_type;
    if constexpr (averages<Keys>) any = any || keys;
  });
  return any;
}

Warnings short_run(const Case& c) {
  const FlowEstimate flow = flow_estimate(c);
  if (flow.drive == FlowCause::none) return {};
  if (starts_developed(c)) {
    const double needed = after_ramp(c, flow, turnover(flow));
    if (flow.laminar || c.run.until >= needed) return {};
    return {{fmt::format("The run ({:g} s) is shorter than one turnover of the largest eddies{}, H/u* = {:.2g} s",
                         c.run.until, ramp_text(c, flow), turnover(flow)),
             {{{until_change(needed)}, {}}},
             "a later run.until"}};
  }
  const double needed = after_ramp(c, flow, flow.spin_up);
  if (c.run.until >= needed) return {};
  constexpr double with_averages = 2.0;  // as long again, so that they can begin when the flow has developed
  std::vector<Advice> advice{{{until_change(any_averages(c) ? with_averages * needed : needed)}, {}}};
  for (const Advice& start : developed_start(c, flow)) advice.push_back(start);
  return {{fmt::format("The run ({:g} s) is too short for the flow to develop, which takes about {:.2g} s from rest{}",
                       c.run.until, flow.spin_up, ramp_text(c, flow)),
           advice, "a later run.until or a developed start (initial)"}};
}

// s, from which on the flow is that of its drive: once gravity has its full value, from rest when it has developed,
// from a profile after one turnover of the largest eddies.
double developed_after(const Case& c) {
  const FlowEstimate flow = flow_estimate(c);
  if (flow.drive == FlowCause::none) return 0.0;
  if (c.initial.takes(InitialField::fluid)) return c.run.ramp;
  return after_ramp(c, flow, starts_developed(c) ? turnover(flow) : flow.spin_up);
}

Warnings early_averages(const Case& c) {
  const double developed = developed_after(c);
  if (developed >= c.run.until) return {};  // short_run() says so
  Remedy later;
  std::string early;
  c.analysis.observers.for_each([&](const auto& keys) {
    using Keys = typename std::decay_t<decltype(keys)>::value_type;
    if constexpr (averages<Keys>) {
      if (!keys || keys->from >= developed * (1.0 - 1e-9)) return;
      early += fmt::format("{}analysis.{}.from: {:g}", early.empty() ? "" : ", ", Keys::section, keys->from);
      later.push_back(number_change(fmt::format("analysis.{}.from", Keys::section), developed, 2, Rounding::up,
                                    [](Case& other, double to) { other.analysis.observers.of<Keys>()->from = to; }));
    }
  });
  if (later.empty()) return {};
  return {
      {fmt::format("Averages begin before the flow has developed, which takes about {:.2g} s ({})", developed, early),
       {{later, {}}},
       "later ones and a longer run"}};
}

// Water at rest that an inlet sets going in the first step is a water hammer: its pressure is rho c_s u.
Warnings sudden_inlet(const Case& c) {
  const coupling::FaceKeys* inlet = inlet_of(c);
  const bool at_rest = c.initial.fluid.count() == 0 && !c.initial.takes(InitialField::fluid);
  if (!inlet || !at_rest) return {};
  const double compression = std::sqrt(3.0) * std::abs(inlet->velocity.x()) / units_of(c).velocity();
  if (!has_free_grains(c) && compression <= largest_compression) return {};
  std::vector<Advice> advice = developed_start(c, flow_estimate(c));
  for (Advice& start : advice) start.lead.clear();
  const Vec3 v = inlet->velocity;
  const Change uniform = word_change("initial.fluid.uniform", fmt::format("[{:g}, {:g}, {:g}]", v.x(), v.y(), v.z()),
                                     [v](Case& other) { other.initial.fluid.uniform = v; });
  if (advice.empty()) advice.push_back({{uniform}, {}});
  return {{fmt::format("The fluid starts at rest and the inlet accelerates it to {:.3g} m/s within a step, an impact "
                       "that {}",
                       v.norm(),
                       has_free_grains(c) ? "throws the grains about"
                                          : fmt::format("compresses it by {:.2g} %", 100.0 * compression)),
           advice, "a start with the velocity of the inlet"}};
}

bool settles(const Case& c, const beds::Population& grains) {
  return !grains.held() && !grains.from_file() && !c.initial.takes(InitialField::grains) &&
         grains.placement.positions.empty() && !floats(c, grains);
}

// Solid fraction in the region of a population, of all that settle.
double fraction_around(const Case& c, const beds::Population& grains) {
  const beds::RegionKeys here = region_of(c, grains);
  double fraction = 0.0;
  for (const beds::Population& other : c.grains) {
    if (!settles(c, other)) continue;
    const beds::RegionKeys there = region_of(c, other);
    const Vec3 common = (here.upper.cwiseMin(there.upper) - here.lower.cwiseMax(there.lower)).cwiseMax(0.0);
    fraction += other.volume() / (there.upper - there.lower).prod() * common.prod() / (here.upper - here.lower).prod();
  }
  return std::min(fraction, beds::densest_bed);
}

// 1, of the speed of a single grain: what many have that settle together (Richardson and Zaki 1954). reynolds: of the
// single grain.
double hindrance(double fraction, double reynolds) {
  const double exponent = reynolds < 0.2     ? 4.65
                          : reynolds < 1.0   ? 4.35 * std::pow(reynolds, -0.03)
                          : reynolds < 500.0 ? 4.45 * std::pow(reynolds, -0.1)
                                             : 2.39;
  return std::pow(1.0 - fraction, exponent);
}

// s, in which the highest grains of a population reach the loosest bed that they may make, the finest of them last.
double settling_time(const Case& c, const beds::Population& grains) {
  constexpr double loose = beds::settled_bed / 0.55;  // the height of random loose packing over the settled one
  const double fall = std::max(0.0, region_of(c, grains).upper.z() - loose * settled_height(c)),
               gravity = -gravity_vector(c.gravity).z();
  if (!has_fluid(c)) return std::sqrt(2.0 * fall / gravity);
  const double finest = grains.finest(), viscosity = c.fluid.kinematic_viscosity;
  const double speed = settling_velocity(finest, grains.density / c.fluid.density, gravity, viscosity);
  return fall / (speed * hindrance(fraction_around(c, grains), speed * finest / viscosity));
}

Warnings unsettled_grains(const Case& c) {
  const bool falls = gravity_vector(c.gravity).z() < 0.0 && !periodic_axes(c.domain)[2];
  if (!(c.system == SystemKind::resolved || c.system == SystemKind::grains) || c.grains.empty() || !falls || c.disks ||
      settled_height(c) < reference_grain(c).diameter)
    return {};
  double longest = 0.0;
  for (const beds::Population& grains : c.grains)
    if (settles(c, grains)) longest = std::max(longest, settling_time(c, grains));
  if (longest <= c.run.until) return {};
  return {{fmt::format("The highest grains fall for about {:.2g} s, but the run ends before, at {:g} s", longest,
                       c.run.until),
           {{{until_change(longest)}, {}}},
           "a later run.until"}};
}

// m/s, of the log profile that the case would be given if it left its shear velocity open.
double fitting_shear_velocity(Case c) {
  c.filled_in.profile.shear_velocity = true;
  fill_in(c);
  return *c.initial.fluid.log_profile->shear_velocity;
}

}  // namespace

Warnings other_start(const Case& c) {
  const FlowEstimate flow = flow_estimate(c);
  if (flow.drive == FlowCause::none || !c.initial.fluid.log_profile || c.filled_in.profile.shear_velocity) return {};
  const double given = *c.initial.fluid.log_profile->shear_velocity, fitting = fitting_shear_velocity(c),
               ratio = given / fitting;
  if (given == fitting) return {};
  constexpr double meant_to_be_slow = 0.25;  // in a run that is too short for the flow anyway
  if ((flow.still_gaining && ratio < meant_to_be_slow) || (ratio >= 0.8 && ratio <= 1.25)) return {};
  const Change start = exact_change("initial.fluid.log_profile.shear_velocity", fitting, 3, [](Case& other, double to) {
    other.initial.fluid.log_profile->shear_velocity = to;
    other.filled_in.profile.shear_velocity = false;
  });
  return {{fmt::format("The flow starts with a shear velocity of {:.3g} m/s, and a log profile of the flow that it is "
                       "driven towards ({}) has {:.3g} m/s",
                       given, words_of(flow.drive), fitting),
           {{{start}, {}}},
           "a start with the shear velocity it is driven towards, and the step that suits it"}};
}

std::vector<WarningRule> plan_rules() {
  return {short_run, early_averages, sudden_inlet, unsettled_grains, long_ramp, frequent_output, rare_output};
}

}  // namespace thalweg::driver
