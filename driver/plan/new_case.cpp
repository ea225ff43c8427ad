#include "driver/plan/new_case.hpp"

#include "beds/packing/packing.hpp"
#include "core/base/error.hpp"
#include "core/base/shell_word.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/case/limit_text.hpp"
#include "driver/cost/run_cost.hpp"
#include "driver/estimate/contact_estimate.hpp"
#include "driver/estimate/drag_accuracy.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "driver/input/case_reader.hpp"
#include "driver/plan/check_report.hpp"
#include "driver/plan/solve.hpp"
#include "driver/warnings/case_warnings.hpp"
#include "io/files/atomic_file.hpp"
#include "loop/progress.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace thalweg::driver {

namespace {

// Requirements of an accuracy. Drag on a grain alone at Re 1000: +98, +41 and +15 % with these cells
// (benchmarks/validation/sphere_drag_curve). Lengths in diameters, the window in H/u* of turbulent flow.
struct Standard {
  const char* name;
  double cells, length, width, window;
};

Standard standard_of(Accuracy accuracy) {
  switch (accuracy) {
    case Accuracy::look:
      return {"look", 6.0, 12.0, 6.0, 5.0};
    case Accuracy::measure:
      return {"measure", 10.0, 24.0, 10.0, 20.0};
    case Accuracy::publish:
      return {"publish", 15.0, 24.0, 12.0, 40.0};
  }
  return {};
}

constexpr double shortest_box = 8.0, narrowest_box = 4.0;  // diameters
constexpr double shrinking = 0.85;                         // of a box that takes too long, in one go
constexpr double efficiency = 0.7;                         // of several cores
constexpr int most_rounds = 30;

// The numbers of a case that are solved for.
struct Draft {
  double spacing, length, width;  // m
  double looseness = 1.0;         // of the grains as placed, over a loose packing
  bool log_profile = true;
  double from = 0.0, until = 1.0;            // s
  std::map<std::string, std::string> extra;  // keys beside those of the flow in water, "fluid.time_step": "5e-05"
};

double rounded(double value, int digits) { return std::stod(fmt::format("{:.{}g}", value, digits)); }

double rounded_up(double value, int digits) { return std::stod(at_least_text(value, digits)); }

// m, the least whole number of cells of at least this length.
double whole(double length, double spacing) { return std::ceil(length / spacing * (1.0 - 1e-9)) * spacing; }

// m, the whole number of cells nearest to this length.
double nearest(double length, double spacing) { return std::round(length / spacing) * spacing; }

std::string flow_text(const Experiment& experiment) {
  std::vector<std::string> keys;
  if (experiment.shields_number) keys.push_back(fmt::format("shields_number: {:g}", *experiment.shields_number));
  if (experiment.depth) keys.push_back(fmt::format("depth: {:g}", *experiment.depth));
  return fmt::format("{{{}}}", fmt::join(keys, ", "));
}

std::string diameter_text(const Experiment& experiment) {
  if (experiment.diameter) return fmt::format("    diameter: {:g}                    # m\n", *experiment.diameter);
  std::vector<std::string> sizes, finer;
  for (const SievePoint& point : experiment.sieve) {
    sizes.push_back(fmt::format("{:g}", point.size));
    finer.push_back(fmt::format("{:g}", point.finer));
  }
  return fmt::format("    diameter:\n      sieve:\n        sizes: [{}]   # m\n        finer: [{}]   # 1, by mass\n",
                     fmt::join(sizes, ", "), fmt::join(finer, ", "));
}

std::string extra_of(const Draft& draft, const std::string& section) {
  std::string text;
  for (const auto& [key, value] : draft.extra)
    if (key.starts_with(section + ".")) text += fmt::format("  {}: {}\n", key.substr(section.size() + 1), value);
  return text;
}

// m, in which the grains are placed: a loose packing, with the gaps that floor and lid of the region leave.
double packed_height(const Experiment& experiment, const Draft& draft, double median) {
  const PeriodicBox box{Vec3(draft.length, draft.width, 0.0), {true, !experiment.width, false}};
  const double placed = experiment.width && draft.width < 3.0 * median ? 0.5 : 0.54;  // solid fraction
  const double looser = beds::settled_fraction(box, median, false) / placed;
  constexpr double at_least = 1.02;  // times the bed, which the region must hold
  return draft.looseness * median * std::max(experiment.layers * looser + 0.25, at_least * experiment.layers);
}

std::string yaml_of(const Experiment& experiment, const Draft& draft) {
  const GrainSizes grains = sizes_of(experiment);
  const double span = draft.until - draft.from;
  const std::string flow = experiment.shields_number ? fmt::format("Shields number {:g}", *experiment.shields_number)
                                                     : fmt::format("slope {:g}", *experiment.slope);
  std::string text =
      "# Written by thalweg new. All values in SI units; `thalweg defaults` explains every key, and `thalweg check`\n"
      "# says what follows from them.\n";
  text += fmt::format("system: resolved\nname: Grains of {:.3g} m, {}\n", grains.median, flow);
  text += fmt::format(
      "domain:\n  size: [{:.9g}, {:.9g}]   # m: streamwise and across; the height follows from the flow\n"
      "  spacing: {:.9g}   # m: {:.3g} cells across the smallest grain\n"
      "  boundaries: {{x: periodic, y: {}, bottom: no_slip, top: free_slip}}\n",
      draft.length, draft.width, draft.spacing, grains.smallest / draft.spacing,
      experiment.width ? "law_of_the_wall" : "periodic");
  text += fmt::format("fluid:\n  density: {:g}   # kg/m^3\n  kinematic_viscosity: {:g}   # m^2/s\n{}",
                      experiment.fluid_density(), experiment.viscosity, extra_of(draft, "fluid"));
  text += fmt::format("gravity: {{magnitude: {:g}{}}}   # m/s^2\n", experiment.gravity,
                      experiment.slope ? fmt::format(", slope: {:g}", *experiment.slope) : std::string());
  text += "flow: " + flow_text(experiment) + "   # over the settled bed; check prints the slope and the height\n";
  text += fmt::format(
      "grains:\n  - fill: {{layers: {:g}}}   # diameters of settled bed\n{}    density: {:g}   # kg/m^3\n"
      "    # All of the floor, and as high as they need: with another domain.size, change the first two numbers, too.\n"
      "    placement: {{pattern: dense, region: {{lower: [0, 0, 0], upper: [{:.9g}, {:.9g}, {:.4g}]}}}}\n",
      experiment.layers, diameter_text(experiment), experiment.density, draft.length, draft.width,
      packed_height(experiment, draft, grains.median));
  if (draft.log_profile)
    text += "initial: {fluid: {log_profile: {perturbation: {amplitude: 1}}}}   # near the developed flow\n";
  text +=
      "contact:\n  restitution: 0.93   # 1, of a dry collision\n  friction: 0.5   # 1\n" + extra_of(draft, "contact");
  if (const std::string keys = extra_of(draft, "coupling"); !keys.empty()) text += "coupling:\n" + keys;
  text += fmt::format("run: {{until: {:g}}}   # s\n", draft.until);
  text += fmt::format(
      "output:\n  series: {{every: {:g}}}   # s\n  grains: {{every: {:g}}}\n"
      "  fluid: {{every: {:g}, region: slice_y, fields: [velocity, pressure, grain_id]}}\n"
      "  checkpoint: {{every: {:g}, keep: 2}}\n",
      rounded(span / 200.0, 1), rounded(span / 50.0, 1), rounded(span / 20.0, 1), rounded(draft.until / 8.0, 1));
  text += fmt::format(
      "analysis:   # means begin once the flow has developed\n  transport_rate: {{from: {0:g}}}\n"
      "  bed_surface: {{from: {0:g}}}\n  grain_profiles: {{from: {0:g}}}\n  fluid_statistics: {{from: {0:g}}}\n",
      draft.from);
  return text;
}

// s, sqrt(d/((s - 1) g)): a grain under its weight in the fluid crosses its diameter in about this time.
double grain_time(const Experiment& experiment) {
  const double excess = experiment.density / experiment.fluid_density() - 1.0;
  return std::sqrt(sizes_of(experiment).median / (excess * experiment.gravity));
}

// Start, beginning of the means and end, by the flow of the case. Grains in a slow flow respond more slowly than by
// their weight, and their window is at least a share of the time before it.
void plan_time(const Case& c, const Experiment& experiment, Draft& draft) {
  constexpr double grain_times_to_settle = 20.0, grain_times_a_turnover = 20.0, least_share = 0.25;
  const FlowEstimate flow = flow_estimate(c);
  draft.log_profile = !flow.laminar;
  const double of_grains = grain_time(experiment);
  const double turnover = flow.laminar ? 0.0 : flow.depth / flow.friction_velocity;
  const double developed = flow.laminar ? flow.spin_up : turnover;
  const double before = std::max(developed, grain_times_to_settle * of_grains);
  const double window =
      std::max(standard_of(experiment.accuracy).window * std::max(turnover, grain_times_a_turnover * of_grains),
               least_share * before);
  draft.from = rounded_up(1.1 * before, 2);
  draft.until = draft.from + rounded_up(1.1 * window, 2);
}

constexpr const char* no_case =
    "no spacing, step and contacts fit this experiment without a warning: give less extreme numbers.";

// What to say where the bed would slide as a whole. change: of the key that the case of the experiment has.
std::string too_steep(const Experiment& experiment, const Change& change) {
  const std::string sliding = "on a slope so steep the bed would slide as a whole: give ";
  if (experiment.shields_number && experiment.depth)
    return sliding + fmt::format("--shields {} or less, or more --depth in m.", change.value);
  if (experiment.shields_number) return sliding + "a smaller --slope.";
  return sliding + fmt::format("--slope {} or less.", change.value);
}

// m, of the water above the bed; where it follows, H from R = H W/(2 H + W) between side walls.
double depth_of(const Experiment& e) {
  if (e.depth) return *e.depth;
  const double product = (e.density / e.fluid_density() - 1.0) * sizes_of(e).median * *e.shields_number;
  const double radius = product / std::sin(std::atan(*e.slope));
  return e.width ? radius * *e.width / (*e.width - 2.0 * radius) : radius;
}

// The grains are placed more loosely than they settle.
void refuse_low_box(const Experiment& experiment, const Draft& draft) {
  const double median = sizes_of(experiment).median, bed = experiment.layers * median;
  const double needed = packed_height(experiment, draft, median) - bed;
  if (needed < depth_of(experiment) - draft.spacing) return;
  throw InputError(fmt::format(
      "{:g} layers of grains are placed up to {:.2g} m above the bed that they settle to, and so above the surface of "
      "{:.2g} m of water: give {}, or fewer --layers.",
      experiment.layers, needed, depth_of(experiment),
      experiment.depth ? fmt::format("--depth {:.2g} or more", 1.05 * (needed + draft.spacing)) : "a smaller --slope"));
}

// Whole cells of about this length and width (m), which the experiment may give.
void set_sides(const Experiment& experiment, double length, double width, Draft& draft) {
  const double narrowest = 2.5 * sizes_of(experiment).largest;  // of a periodic box
  const auto side = [&](const std::optional<double>& given, double chosen) {
    return given ? nearest(*given, draft.spacing) : whole(std::max(chosen, narrowest), draft.spacing);
  };
  draft.length = side(experiment.length, length);
  draft.width = experiment.width ? *experiment.width : side(experiment.periodic_width, width);
}

// Takes over what a remedy asks for; what a draft has no place for is left to its case.
void take_over(const Remedy& remedy, const Experiment& experiment, Draft& draft) {
  for (const Change& change : remedy) {
    if (change.key == "domain.spacing") {
      draft.spacing = std::stod(change.value);
    } else if (change.key == "run.until") {
      draft.until = std::stod(change.value);
    } else if (change.key.starts_with("analysis.") && change.key.ends_with(".from")) {
      const double later = std::max(0.0, std::stod(change.value) - draft.from);
      draft.from += later;
      draft.until += later;
    } else if (change.key == "gravity.slope" || change.key == "flow.shields_number") {
      throw InputError(too_steep(experiment, change));
    } else if (change.key.starts_with("fluid.") || change.key.starts_with("contact.") ||
               change.key.starts_with("coupling.")) {
      draft.extra[change.key] = change.value;
    } else {
      throw InputError(no_case);
    }
  }
  set_sides(experiment, draft.length, draft.width, draft);
}

Draft first_draft(const Experiment& experiment) {
  const Standard standard = standard_of(experiment.accuracy);
  const GrainSizes grains = sizes_of(experiment);
  Draft draft{};
  draft.spacing = grains.smallest / standard.cells;
  // Between walls the width is given, and a whole number of cells.
  if (experiment.width) draft.spacing = *experiment.width / std::ceil(*experiment.width / draft.spacing * (1.0 - 1e-9));
  set_sides(experiment, standard.length * grains.median, standard.width * grains.median, draft);
  return draft;
}

// A smaller box; false where there is none.
bool shrink(const Experiment& experiment, Draft& draft) {
  const double median = sizes_of(experiment).median, before = draft.length * draft.width;
  const double length = std::max(shortest_box * median, shrinking * draft.length);
  const double width = std::max(narrowest_box * median, shrinking * draft.width);
  set_sides(experiment, std::min(length, draft.length), std::min(width, draft.width), draft);
  return draft.length * draft.width < before * (1.0 - 1e-9);
}

double seconds_on(const Case& c, int cores, double bandwidth) {
  return cost_of(c, bandwidth).core_seconds / (cores == 1 ? 1.0 : efficiency * cores);
}

// The draft as a case of the file, once its grains fit and no warning is left that a number mends.
Case without_warnings(const Experiment& experiment, const std::filesystem::path& path, Draft& draft) {
  constexpr double looser = 1.1, loosest = 2.0;
  for (int round = 0; round < most_rounds; ++round) {
    refuse_low_box(experiment, draft);
    io::write_text_atomically(path, yaml_of(experiment, draft));
    Case c = read_case(path);
    const Remedy remedy = solve(c).changes;
    if (!remedy.empty()) {
      take_over(remedy, experiment, draft);
      continue;
    }
    if (stress_ratio_at_base(c) > bulk_friction(c))  // on any slope
      throw InputError("with so large a Shields number the bed would slide as a whole: give a smaller --shields.");
    try {
      refuse_impossible_grains(c);
      return c;
    } catch (const InputError&) {  // they do not fit
      draft.looseness *= looser;
      if (draft.looseness > loosest) throw;
    }
  }
  throw InputError(no_case);
}

// Drag on grains in a slow flow is within some percent with these, and off by tens of them without
// (benchmarks/validation/simple_cubic_arrays); less viscous flows are unstable with them.
void choose_models(const Case& c, Draft& draft) {
  constexpr double viscous_excess = 0.03;
  if (!flow_estimate(c).laminar || relaxation_time(c) - 0.5 < viscous_excess) return;
  draft.extra["fluid.collision"] = "trt";
  draft.extra["fluid.subgrid_model"] = "none";
  draft.extra["coupling.links"] = "cli";
}

Case solved(const Experiment& experiment, const std::filesystem::path& path, double bandwidth) {
  Draft draft = first_draft(experiment);
  draft.until = 1e3 * grain_time(experiment);  // longer than the flow takes to develop
  refuse_low_box(experiment, draft);
  io::write_text_atomically(path, yaml_of(experiment, draft));
  const Case first = read_case(path);
  plan_time(first, experiment, draft);
  choose_models(first, draft);
  Case c = without_warnings(experiment, path, draft);
  while (experiment.hours && seconds_on(c, experiment.cores, bandwidth) > 3600.0 * *experiment.hours) {
    if (!shrink(experiment, draft))
      throw InputError(fmt::format(
          "even in the smallest box the run takes about {}, more than --hours {:g}: give more hours or cores, {}.",
          loop::clock_text(seconds_on(c, experiment.cores, bandwidth)), *experiment.hours,
          experiment.accuracy == Accuracy::look ? "or less water" : "or a lower --accuracy"));
    c = without_warnings(experiment, path, draft);
  }
  return c;
}

}  // namespace

std::vector<std::string> write_new_case(const Experiment& experiment, const std::filesystem::path& path,
                                        double bandwidth) {
  check_experiment(experiment);
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored))
    throw InputError(fmt::format("{} exists: give another file.", path.string()));
  std::filesystem::path draft = path;  // beside the file, which is there once it is whole
  draft += fmt::format(".draft.{}", ::getpid());
  try {
    const Case c = solved(experiment, draft, bandwidth);
    io::write_text_atomically(path, io::read_text(draft));
    std::filesystem::remove(draft, ignored);
    const Index3 cells = cells_of(c.domain);
    std::vector<std::string> remarks{fmt::format(
        "{}: {} grains in {} x {} x {} cells to {:g} s, about {} on {} core{}", path.string(), grain_count(c), cells[0],
        cells[1], cells[2], c.run.until, loop::clock_text(seconds_on(c, experiment.cores, bandwidth)), experiment.cores,
        experiment.cores == 1 ? "" : "s")};
    remarks.push_back("follows: " + c.filled_in.flow.text);
    if (const std::string drag = drag_text(c); !drag.empty())
      remarks.push_back(fmt::format("accuracy {}: drag {}", standard_of(experiment.accuracy).name, drag));
    for (const std::string& warning : warnings(c)) remarks.push_back("warning: " + warning);
    remarks.push_back("next: thalweg check " + shell_word(path.string()));
    return remarks;
  } catch (...) {
    std::filesystem::remove(draft, ignored);
    throw;
  }
}

}  // namespace thalweg::driver
