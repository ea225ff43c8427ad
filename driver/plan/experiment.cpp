#include "driver/plan/experiment.hpp"

#include "core/base/error.hpp"
#include "core/geometry/hydraulic_radius.hpp"
#include "driver/case/limit_text.hpp"
#include "driver/warnings/unit_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace thalweg::driver {

namespace {

constexpr double largest_cobble = 0.1;                   // m; water around larger ones takes too many cells
constexpr double most_diameters = 500.0, longest = 1.0;  // of a side of the box that is not in millimetres; m
constexpr double thinnest_bed = 0.5;                     // diameters
constexpr double water = 1e-3;                           // Pa s
constexpr double narrowest_periodic = 2.0;               // diameters of the largest grain
constexpr double margin = 1.005;                         // of a side over the grains

[[noreturn]] void refuse(const std::string& sentence) { throw InputError(sentence); }

void refuse_missing(const Experiment& e) {
  if (!e.diameter && e.sieve.empty())
    refuse("the grains have no size: give --diameter in m, for example 0.005, or --sieve.");
  if (e.diameter && !e.sieve.empty()) refuse("the size of the grains is given twice: --diameter or --sieve.");
  if (e.shields_number.has_value() + e.slope.has_value() + e.depth.has_value() != 2)
    refuse("the flow needs two of --shields, --slope and --depth (m of water above the bed).");
  if (e.width && e.periodic_width)
    refuse("the width is given twice: --width between side walls, or --periodic-width without walls.");
}

void refuse_length_in_millimetres(const char* option, const std::optional<double>& value, double diameter) {
  if (!value || *value < longest || *value < most_diameters * diameter) return;
  refuse(
      fmt::format("{0} {1:g} is in m, {2:.0f} diameters of the grains, which is too much to resolve: if it is in "
                  "millimetres, give {0} {3:g}.",
                  option, *value, *value / diameter, 1e-3 * *value));
}

void refuse_other_units(const Experiment& e) {
  const GrainSizes sizes = sizes_of(e);
  const char* size = e.diameter ? "--diameter" : "--sieve";
  if (sizes.median > largest_cobble)
    refuse(fmt::format("{} is in m, and grains of {:.3g} m look like millimetres: {:.3g} mm is {:.3g} m.", size,
                       sizes.median, sizes.median, 1e-3 * sizes.median));
  refuse_length_in_millimetres("--depth", e.depth, sizes.median);
  refuse_length_in_millimetres("--width", e.width, sizes.median);
  refuse_length_in_millimetres("--periodic-width", e.periodic_width, sizes.median);
  refuse_length_in_millimetres("--length", e.length, sizes.median);
  if (e.density < lightest_solid)
    refuse(fmt::format("--density is in kg/m^3, and {0:g} looks like g/cm^3: give --density {1:g}.", e.density,
                       1e3 * e.density));
  if (e.fluid_density() < densest_gas && e.viscosity < thinnest_gas)
    refuse(
        fmt::format("--fluid-density is in kg/m^3, and {0:g} with the viscosity of a liquid looks like g/cm^3: give "
                    "--fluid-density {1:g}.",
                    e.fluid_density(), 1e3 * e.fluid_density()));
  if (!e.given_fluid_density && e.viscosity > 0.5 * water && e.viscosity < 2.0 * water)
    refuse(
        fmt::format("--viscosity is the kinematic viscosity in m^2/s, and {0:g} looks like that of water in Pa s: give "
                    "--viscosity {1:g}, or for a fluid so viscous its --fluid-density, too.",
                    e.viscosity, e.viscosity / e.fluid_density()));
  if (e.slope && *e.slope > steepest_bed)
    refuse(fmt::format(
        "--slope is the tangent of the bed's angle, and {:g} is {:.2g} degrees: if it is in degrees, "
        "give --slope {:.3g}.",
        *e.slope, std::atan(*e.slope) * 180.0 / std::numbers::pi, std::tan(*e.slope * std::numbers::pi / 180.0)));
  if (e.layers < thinnest_bed)
    refuse(fmt::format(
        "--layers is the thickness of the bed in diameters, and {:g} is less than one layer: give --layers {:g}.",
        e.layers, std::max(1.0, std::round(e.layers / sizes.median))));
}

// Boxes that cannot hold the grains, or no flow over them.
void refuse_narrow(const Experiment& e) {
  const GrainSizes sizes = sizes_of(e);
  if (e.density <= 1.001 * e.fluid_density())
    refuse(fmt::format("grains of {:g} kg/m^3 make no bed in a fluid of {:g}: give a larger --density in kg/m^3.",
                       e.density, e.fluid_density()));
  const auto look = [](const char* option, const std::optional<double>& value, double least, const char* what) {
    if (value && *value < least)
      refuse(fmt::format("{0} {1:g} is less than {2}: give at least {0} {3}, in m.", option, *value, what,
                         at_least_text(least, 3)));
  };
  look("--depth", e.depth, margin * sizes.median, "a diameter of the grains");
  look("--width", e.width, margin * sizes.largest, "the largest grain");
  look("--periodic-width", e.periodic_width, margin * narrowest_periodic * sizes.largest,
       "two diameters of the largest grain");
  look("--length", e.length, margin * narrowest_periodic * sizes.largest, "two diameters of the largest grain");
}

// tau* = sin R/((s - 1) d), R = H W/(2 H + W) between side walls, has no solution.
void refuse_impossible_flow(const Experiment& e) {
  if (!e.shields_number) return;
  const double product = (e.density / e.fluid_density() - 1.0) * sizes_of(e).median * *e.shields_number;
  if (e.depth) {
    const double radius = e.width ? thalweg::hydraulic_radius(*e.depth, *e.width, 2) : *e.depth;
    if (product >= radius)
      refuse(
          fmt::format("under --depth {:g} m of water no slope gives --shields {:g}: give a smaller Shields number "
                      "or more water.",
                      *e.depth, *e.shields_number));
  } else if (const double radius = product / std::sin(std::atan(*e.slope)); e.width && 2.0 * radius >= *e.width) {
    refuse(
        fmt::format("between walls --width {:g} m apart --slope {:g} does not give --shields {:g} however deep the "
                    "water: give a smaller Shields number, a steeper slope or a wider channel.",
                    *e.width, *e.slope, *e.shields_number));
  }
}

}  // namespace

GrainSizes sizes_of(const Experiment& experiment) {
  if (experiment.diameter) return {*experiment.diameter, *experiment.diameter, *experiment.diameter};
  const std::vector<SievePoint>& sieve = experiment.sieve;
  std::size_t n = 1;
  while (n + 1 < sieve.size() && sieve[n].finer < 0.5) ++n;
  const double share = (0.5 - sieve[n - 1].finer) / (sieve[n].finer - sieve[n - 1].finer);
  // Of several sieves that let nothing pass, or all, one bounds the grains.
  const auto smallest = std::find_if(sieve.rbegin(), sieve.rend(), [](const SievePoint& p) { return p.finer == 0.0; });
  const auto largest = std::find_if(sieve.begin(), sieve.end(), [](const SievePoint& p) { return p.finer == 1.0; });
  return {smallest->size, sieve[n - 1].size * std::pow(sieve[n].size / sieve[n - 1].size, share), largest->size};
}

std::vector<SievePoint> parse_sieve(const std::string& text) {
  const InputError wrong(
      fmt::format("--sieve {} is not a grading curve: write sieves in m and the share of the mass that passes each, "
                  "rising from 0 to 1, for example 0.002:0,0.004:0.5,0.008:1.",
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

void check_experiment(const Experiment& experiment) {
  refuse_missing(experiment);
  refuse_other_units(experiment);
  refuse_narrow(experiment);
  refuse_impossible_flow(experiment);
}

}  // namespace thalweg::driver
