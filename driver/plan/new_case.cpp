#include "driver/plan/new_case.hpp"

#include "beds/packing/packing.hpp"
#include "core/base/error.hpp"
#include "core/base/shell_word.hpp"
#include "driver/cost/run_cost.hpp"
#include "driver/estimate/bed_flow.hpp"
#include "driver/estimate/drag_accuracy.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "driver/input/case_reader.hpp"
#include "driver/plan/case_warnings.hpp"
#include "driver/plan/check_report.hpp"
#include "driver/plan/solve.hpp"
#include "io/files/atomic_file.hpp"
#include "loop/progress.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

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

struct Grains {
  double smallest, median;  // m
};

Grains grains_of(const Experiment& experiment) {
  if (experiment.diameter) return {*experiment.diameter, *experiment.diameter};
  const std::vector<SievePoint>& sieve = experiment.sieve;
  std::size_t n = 1;
  while (n + 1 < sieve.size() && sieve[n].finer < 0.5) ++n;
  const double share = (0.5 - sieve[n - 1].finer) / (sieve[n].finer - sieve[n - 1].finer);
  return {sieve.front().size, sieve[n - 1].size * std::pow(sieve[n].size / sieve[n - 1].size, share)};
}

// The numbers of a case that are solved for.
struct Draft {
  double spacing, length, width;  // m
  double looseness = 1.0;         // of the grains as placed, over a loose packing
  bool log_profile = true;
  double from = 0.0, until = 1.0;            // s
  std::map<std::string, std::string> extra;  // keys that a remedy has added, "fluid.time_step": "5e-05"
};

double rounded(double value, int digits) { return std::stod(fmt::format("{:.{}g}", value, digits)); }

// m, the least whole number of cells of at least this length.
double whole(double length, double spacing) { return std::ceil(length / spacing * (1.0 - 1e-9)) * spacing; }

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
  const bool narrow = experiment.width && draft.width < 3.0 * median;
  return draft.looseness * median * (experiment.layers * beds::settled_bed / (narrow ? 0.5 : 0.54) + 0.25);
}

std::string yaml_of(const Experiment& experiment, const Draft& draft) {
  const Grains grains = grains_of(experiment);
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
                      experiment.fluid_density, experiment.viscosity, extra_of(draft, "fluid"));
  text += fmt::format("gravity: {{magnitude: {:g}{}}}   # m/s^2\n", experiment.gravity,
                      experiment.slope ? fmt::format(", slope: {:g}", *experiment.slope) : std::string());
  text += "flow: " + flow_text(experiment) +
          "   # of the bed that the grains make; check prints the slope and the height\n";
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
  const double excess = experiment.density / experiment.fluid_density - 1.0;
  return std::sqrt(grains_of(experiment).median / (excess * experiment.gravity));
}

// Start, beginning of the means and end, by the flow of the case.
void plan_time(const Case& c, const Experiment& experiment, Draft& draft) {
  constexpr double grain_times_to_settle = 20.0, grain_times_a_turnover = 20.0;
  const FlowEstimate flow = flow_estimate(c);
  draft.log_profile = !flow.laminar;
  const double of_grains = grain_time(experiment);
  const double turnover = flow.laminar ? 0.0 : flow.depth / flow.friction_velocity;
  const double developed = flow.laminar ? flow.spin_up : turnover;
  const double window =
      standard_of(experiment.accuracy).window * std::max(turnover, grain_times_a_turnover * of_grains);
  draft.from = rounded(1.1 * std::max(developed, grain_times_to_settle * of_grains), 2);
  draft.until = rounded(draft.from + 1.1 * window, 2);
}

// Takes over what a remedy asks for; what a draft has no place for is left to its case.
void take_over(const Remedy& remedy, const Experiment& experiment, Draft& draft) {
  for (const Change& change : remedy) {
    if (change.key == "domain.spacing") {
      draft.spacing = std::stod(change.value);
    } else if (change.key == "run.until") {
      draft.until = std::stod(change.value);
    } else if (change.key.starts_with("analysis.") && change.key.ends_with(".from")) {
      draft.from = std::max(draft.from, std::stod(change.value));
    } else if (change.key.starts_with("fluid.") || change.key.starts_with("contact.")) {
      draft.extra[change.key] = change.value;
    } else {
      throw InputError(
          fmt::format("the experiment would need {}: {}, which thalweg new does not choose; take less "
                      "extreme numbers, or write the case by hand.",
                      change.key, change.value));
    }
  }
  draft.length = whole(draft.length, draft.spacing);
  draft.width = experiment.width ? draft.width : whole(draft.width, draft.spacing);
}

Draft first_draft(const Experiment& experiment) {
  const Standard standard = standard_of(experiment.accuracy);
  const Grains grains = grains_of(experiment);
  Draft draft{};
  draft.spacing = grains.smallest / standard.cells;
  // Between walls the width is given, and a whole number of cells.
  if (experiment.width) draft.spacing = *experiment.width / std::ceil(*experiment.width / draft.spacing * (1.0 - 1e-9));
  draft.length = whole(standard.length * grains.median, draft.spacing);
  draft.width = experiment.width.value_or(whole(standard.width * grains.median, draft.spacing));
  return draft;
}

// A smaller box; false where there is none.
bool shrink(const Experiment& experiment, Draft& draft) {
  const double median = grains_of(experiment).median;
  const bool longer = draft.length > shortest_box * median / shrinking;
  const bool wider = !experiment.width && draft.width > narrowest_box * median / shrinking;
  if (longer) draft.length = whole(shrinking * draft.length, draft.spacing);
  if (wider) draft.width = whole(shrinking * draft.width, draft.spacing);
  return longer || wider;
}

double seconds_on(const Case& c, int cores, double bandwidth) {
  return cost_of(c, bandwidth).core_seconds / (cores == 1 ? 1.0 : efficiency * cores);
}

void refuse_missing(const Experiment& e) {
  if (!e.diameter && e.sieve.empty())
    throw InputError("the grains have no size: give --diameter in m, for example 0.005, or --sieve.");
  if (e.diameter && !e.sieve.empty()) throw InputError("the size of the grains is given twice: --diameter or --sieve.");
  if (e.shields_number.has_value() + e.slope.has_value() + e.depth.has_value() != 2)
    throw InputError("the flow needs two of --shields, --slope and --depth (m of water above the bed).");
  if (e.density <= 1.001 * e.fluid_density)
    throw InputError(
        fmt::format("grains of {:g} kg/m^3 make no bed in a fluid of {:g}: give a larger --density in kg/m^3.",
                    e.density, e.fluid_density));
}

// The draft as a case of the file, once its grains fit and no warning is left that a number mends.
Case without_warnings(const Experiment& experiment, const std::filesystem::path& path, Draft& draft) {
  constexpr double looser = 1.1, loosest = 2.0;
  for (int round = 0; round < most_rounds; ++round) {
    io::write_text_atomically(path, yaml_of(experiment, draft));
    Case c = read_case(path);
    const Remedy remedy = solve(c).changes;
    if (!remedy.empty()) {
      take_over(remedy, experiment, draft);
      continue;
    }
    try {
      refuse_impossible_grains(c);
      return c;
    } catch (const InputError&) {  // they do not fit
      draft.looseness *= looser;
      if (draft.looseness > loosest) throw;
    }
  }
  throw InputError("no spacing and step suit this experiment without a warning: take less extreme numbers.");
}

Case solved(const Experiment& experiment, const std::filesystem::path& path, double bandwidth) {
  Draft draft = first_draft(experiment);
  draft.until = 1e3 * grain_time(experiment);  // longer than the flow takes to develop
  io::write_text_atomically(path, yaml_of(experiment, draft));
  plan_time(read_case(path), experiment, draft);
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

std::vector<SievePoint> parse_sieve(const std::string& text) {
  const InputError wrong(
      fmt::format("--sieve {} is no grading curve: write sieves in m and the share of the mass that passes each, "
                  "rising from 0 to 1, "
                  "for example 0.002:0,0.004:0.5,0.008:1.",
                  text));
  std::vector<SievePoint> points;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) {
    SievePoint point;
    int end = 0;
    if (std::sscanf(part.c_str(), "%lf:%lf%n", &point.size, &point.finer, &end) != 2 ||
        end != static_cast<int>(part.size()))
      throw wrong;
    const bool rises = points.empty() ? point.finer == 0.0 && point.size > 0.0
                                      : point.size > points.back().size && point.finer >= points.back().finer;
    if (!rises) throw wrong;
    points.push_back(point);
  }
  if (points.size() < 2 || points.back().finer != 1.0) throw wrong;
  return points;
}

std::vector<std::string> write_new_case(const Experiment& experiment, const std::filesystem::path& path,
                                        double bandwidth) {
  refuse_missing(experiment);
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored))
    throw InputError(fmt::format("{} exists: give another file.", path.string()));
  try {
    const Case c = solved(experiment, path, bandwidth);
    const Index3 cells = cells_of(c.domain);
    std::vector<std::string> remarks{fmt::format(
        "{}: {} grains in {} x {} x {} cells to {:g} s, about {} on {} core{}", path.string(), grain_count(c), cells[0],
        cells[1], cells[2], c.run.until, loop::clock_text(seconds_on(c, experiment.cores, bandwidth)), experiment.cores,
        experiment.cores == 1 ? "" : "s")};
    remarks.push_back("follows: " + c.filled_in.flow);
    if (const std::string drag = drag_text(c); !drag.empty())
      remarks.push_back(fmt::format("accuracy {}: drag {}", standard_of(experiment.accuracy).name, drag));
    for (const std::string& warning : warnings(c)) remarks.push_back("warning: " + warning);
    remarks.push_back("next: thalweg check " + shell_word(path.string()));
    return remarks;
  } catch (...) {
    std::filesystem::remove(path, ignored);
    throw;
  }
}

}  // namespace thalweg::driver
