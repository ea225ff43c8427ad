#include "driver/warnings/unit_warnings.hpp"

#include "driver/bed/reference_grain.hpp"
#include "driver/warnings/boundary_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace thalweg::driver {

namespace {

constexpr double lightest_grain = 300.0;  // kg/m^3, of sediment in SI units
constexpr double roughest_contact = 1.5;  // 1; friction of dry solids is below, an angle in degrees above
constexpr double widest_cell = 0.05;      // m
constexpr double most_cells = 1e11, fewest_cells_across = 10.0;       // 1: of a box in metres
constexpr double lightest_liquid = 500.0, thickest_liquid = 1e-2;     // kg/m^3, m^2/s
constexpr double lightest_water = 990.0, heaviest_water = 1030.0;     // kg/m^3, fresh and of the sea
constexpr double thinnest_water = 0.88e-3, thickest_water = 1.15e-3;  // Pa s, from 25 to 15 degrees
constexpr double weakest_on_earth = 9.0, strongest_on_earth = 10.0;   // m/s^2
constexpr double thickest_fluid = 0.1;                                // m^2/s
constexpr int density_digits = 6;
constexpr double steepest_friction = 60.0;  // degrees

// m, of grains that are wider than any in SI units.
std::optional<double> diameter_of_boulders(const Case& c) {
  std::optional<double> diameter;
  if (c.system == SystemKind::resolved && !c.grains.empty())
    diameter = beds::median_by_mass(represented_sizes(c), c.disks.has_value());
  if (c.system == SystemKind::continuum) diameter = c.continuum.grains.diameter;
  return diameter && *diameter > largest_boulder ? diameter : std::nullopt;
}

Warnings lengths_in_millimetres(const Case& c) {
  const std::optional<double> boulders = diameter_of_boulders(c);
  if (!boulders) return {};
  const double diameter = *boulders;
  return {fmt::format(
      "The grains are {:.4g} m wide, which looks like millimetres: lengths are in m, and {:g} mm is {:g} m.", diameter,
      diameter, 1e-3 * diameter)};
}

// The key beside grains in metres; they scale what is estimated, as if they were so wide.
Warnings reference_in_millimetres(const Case& c) {
  if (c.system != SystemKind::resolved || c.grains.empty() || diameter_of_boulders(c)) return {};
  const double diameter = c.analysis.reference_diameter.value_or(0.0);
  if (diameter <= largest_boulder) return {};
  return {{fmt::format("analysis.reference_diameter = {0:g} m looks like {0:g} mm, which is {1:g} m", diameter,
                       1e-3 * diameter),
           {{{exact_change("analysis.reference_diameter", 1e-3 * diameter, 6,
                           [](Case& other, double to) { other.analysis.reference_diameter = to; })},
             {}}}}};
}

// A liquid in SI units in cells so wide: metres of it cannot be resolved.
Warnings box_in_millimetres(const Case& c) {
  if (!has_fluid(c) || c.domain.spacing < widest_cell || c.fluid.density < lightest_liquid ||
      c.fluid.kinematic_viscosity > thickest_liquid)
    return {};
  return {fmt::format(
      "The box of {:g} x {:g} x {:g} m has cells {:g} m wide, which looks like millimetres: lengths are in m, and "
      "domain.spacing: {:g} mm is {:g} m.",
      c.domain.size.x(), c.domain.size.y(), c.domain.size.z(), c.domain.spacing, c.domain.spacing,
      1e-3 * c.domain.spacing)};
}

// A box in millimetres of cells in metres: more than any machine holds, and enough of them a thousand times smaller.
Warnings many_cells_in_millimetres(const Case& c) {
  const Vec3 cells = c.domain.size / c.domain.spacing;
  if (!has_fluid(c) || !box_in_millimetres(c).empty() || cells.prod() < most_cells ||
      1e-3 * std::min(cells.x(), cells.y()) < fewest_cells_across)
    return {};
  return {
      fmt::format("The box of {:g} x {:g} x {:g} m has {:.2g} cells of {:g} m, which looks like millimetres: lengths "
                  "are in m, and domain.size: {:g} mm is {:g} m.",
                  c.domain.size.x(), c.domain.size.y(), c.domain.size.z(), cells.prod(), c.domain.spacing,
                  c.domain.size.x(), 1e-3 * c.domain.size.x())};
}

// unit: of length; in_a_metre: how many of them are.
Warnings gravity_in(const Case& c, const char* unit, double in_a_metre) {
  const Vec3 gravity = gravity_vector(c.gravity);
  const double in_metres = gravity.norm() / in_a_metre;
  if (in_metres < weakest_on_earth || in_metres > strongest_on_earth) return {};
  const Change change = c.gravity.vector
                            ? word_change("gravity.vector",
                                          fmt::format("[{:.9g}, {:.9g}, {:.9g}]", gravity.x() / in_a_metre,
                                                      gravity.y() / in_a_metre, gravity.z() / in_a_metre),
                                          [=](Case& other) { other.gravity.vector = gravity / in_a_metre; })
                            : exact_change("gravity.magnitude", in_metres, 6,
                                           [](Case& other, double to) { other.gravity.magnitude = to; });
  return {{fmt::format("Gravity of {0:g} m/s^2 looks like {0:g} {1}/s^2, which is {2:g} m/s^2", gravity.norm(), unit,
                       in_metres),
           {{{change}, {}}},
           "the value in m/s^2"}};
}
Warnings gravity_in_centimetres(const Case& c) { return gravity_in(c, "cm", 100.0); }
Warnings gravity_in_millimetres(const Case& c) { return gravity_in(c, "mm", 1000.0); }

// Water has 1 mm^2/s, and nothing that flows 0.1 m^2/s.
Warnings viscosity_in_square_millimetres(const Case& c) {
  const bool column = c.system == SystemKind::continuum;
  const double viscosity = column ? c.continuum.fluid.kinematic_viscosity : c.fluid.kinematic_viscosity,
               density = column ? c.continuum.fluid.density : c.fluid.density;
  if (!(column || has_fluid(c)) || density < lightest_liquid || viscosity < thickest_fluid) return {};
  return {{fmt::format("A kinematic viscosity of {0:g} m^2/s looks like {0:g} mm^2/s, which is {1:g} m^2/s", viscosity,
                       1e-6 * viscosity),
           {{{exact_change("fluid.kinematic_viscosity", 1e-6 * viscosity, 6,
                           [column](Case& other, double to) {
                             (column ? other.continuum.fluid.kinematic_viscosity : other.fluid.kinematic_viscosity) =
                                 to;
                           })},
             {}}}}};
}

// Water has 1e-3 Pa s; oils so viscous are lighter, and glycerine is heavier.
Warnings viscosity_in_pascal_seconds(const Case& c) {
  const bool column = c.system == SystemKind::continuum;
  const double viscosity = column ? c.continuum.fluid.kinematic_viscosity : c.fluid.kinematic_viscosity,
               density = column ? c.continuum.fluid.density : c.fluid.density;
  if (!(column || has_fluid(c)) || viscosity < thinnest_water || viscosity > thickest_water ||
      density < lightest_water || density > heaviest_water)
    return {};
  return {fmt::format(
      "A kinematic viscosity of {0:g} m^2/s looks like that of water in Pa s, which divided by the density is {1:g} "
      "m^2/s: give that as fluid.kinematic_viscosity, unless the fluid is so viscous.",
      viscosity, viscosity / density)};
}

Warnings densities_in_grams(const Case& c) {
  Warnings found;
  if (c.system != SystemKind::resolved) return found;  // others may be dimensionless
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    if (const double density = c.grains[n].density; density < lightest_solid) {
      Remedy remedy{exact_change(fmt::format("grains.{}.density", n), 1000.0 * density, density_digits,
                                 [n](Case& other, double to) { other.grains[n].density = to; })};
      if (c.fluid.density < lightest_solid)
        remedy.push_back(exact_change("fluid.density", 1000.0 * c.fluid.density, density_digits,
                                      [](Case& other, double to) { other.fluid.density = to; }));
      found.push_back({fmt::format("Grains of {:g} kg/m^3 (grains.{}) look like {:g} g/cm^3, which is {:g} kg/m^3",
                                   density, n, density, 1000.0 * density),
                       {{remedy, {}}}});
    }
  return found;
}

Warnings column_in_grams(const Case& c) {
  if (c.system != SystemKind::continuum || c.continuum.grains.density >= lightest_solid) return {};
  const double grains = c.continuum.grains.density, fluid = c.continuum.fluid.density;
  return {{fmt::format("Grains of {0:g} kg/m^3 look like {0:g} g/cm^3, which is {1:g} kg/m^3", grains, 1000.0 * grains),
           {{{exact_change("grains.density", 1000.0 * grains, density_digits,
                           [](Case& other, double to) { other.continuum.grains.density = to; }),
              exact_change("fluid.density", 1000.0 * fluid, density_digits,
                           [](Case& other, double to) { other.continuum.fluid.density = to; })},
             {}}}}};
}

// Beside grains in kg/m^3. A gas so dense and with so little viscosity is under a pressure of tens of bars.
Warnings liquid_in_grams(const Case& c) {
  if (c.system != SystemKind::resolved || c.grains.empty() || reference_grain(c).density < lightest_grain ||
      c.fluid.density > densest_gas || c.fluid.kinematic_viscosity > thinnest_gas)
    return {};
  return {{fmt::format("A fluid of {0:g} kg/m^3 with the viscosity of a liquid looks like one of {0:g} g/cm^3, which "
                       "is {1:g} kg/m^3",
                       c.fluid.density, 1000.0 * c.fluid.density),
           {{{exact_change("fluid.density", 1000.0 * c.fluid.density, density_digits,
                           [](Case& other, double to) { other.fluid.density = to; })},
             {}}}}};
}

Warnings slope_in_degrees(const Case& c) {
  const double slope = c.gravity.vector ? 0.0 : std::abs(c.gravity.slope.value_or(0.0));
  if (slope <= steepest_bed || slope > steepest_friction || !c.filled_in.flow.text.empty()) return {};
  const double tangent = std::tan(*c.gravity.slope * std::numbers::pi / 180.0);
  return {
      {fmt::format("gravity.slope = {:g} is a bed at {:.3g} degrees, as the slope is the tangent of the angle; the "
                   "number looks like an angle in degrees",
                   *c.gravity.slope, std::atan(slope) * 180.0 / std::numbers::pi),
       {{{exact_change("gravity.slope", tangent, 3, [](Case& other, double to) { other.gravity.slope = to; })}, {}}}}};
}

// Angles in radians that are more than a turn.
Warnings angles_in_degrees(const Case& c) {
  Warnings found;
  const auto look = [&](const std::string& key, double value, const Setter& set) {
    if (std::abs(value) <= 2.0 * std::numbers::pi * (1.0 + 1e-6)) return;
    const double angle = value * std::numbers::pi / 180.0;
    found.push_back({fmt::format("{} = {:g} is in radians, {:.3g} turns, and looks like an angle in degrees", key,
                                 value, value / (2.0 * std::numbers::pi)),
                     {{{exact_change(key, angle, 6, set)}, {}}}});
  };
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    if (c.grains[n].orientation)
      look(fmt::format("grains.{}.orientation.angle", n), c.grains[n].orientation->angle,
           [n](Case& other, double to) { other.grains[n].orientation->angle = to; });
    if (c.grains[n].motion && c.grains[n].motion->oscillation)
      look(fmt::format("grains.{}.motion.oscillation.phase", n), c.grains[n].motion->oscillation->phase,
           [n](Case& other, double to) { other.grains[n].motion->oscillation->phase = to; });
  }
  for (std::size_t n = 0; n < c.solids.size(); ++n)
    if (c.solids[n].motion && c.solids[n].motion->oscillation)
      look(fmt::format("solids.{}.motion.oscillation.phase", n), c.solids[n].motion->oscillation->phase,
           [n](Case& other, double to) { other.solids[n].motion->oscillation->phase = to; });
  for (std::size_t n = 0; n < c.walls.size(); ++n)
    if (c.walls[n].oscillation)
      look(fmt::format("walls.{}.oscillation.phase", n), c.walls[n].oscillation->phase,
           [n](Case& other, double to) { other.walls[n].oscillation->phase = to; });
  for (std::size_t face = 0; face < c.domain.faces.size(); ++face)
    if (c.domain.faces[face].oscillation)
      look(face_key(c.domain, face) + ".oscillation.phase", c.domain.faces[face].oscillation->phase,
           [face](Case& other, double to) { other.domain.faces[face].oscillation->phase = to; });
  return found;
}

Warnings friction_in_degrees(const Case& c) {
  Warnings found;
  const auto look = [&](const std::string& key, const std::optional<double>& value, const Setter& set) {
    if (!value || *value <= roughest_contact || *value > steepest_friction) return;
    const double tangent = std::tan(*value * std::numbers::pi / 180.0);
    found.push_back(
        {fmt::format("{} = {:g} looks like an angle in degrees, but the coefficient is its tangent", key, *value),
         {{{exact_change(key, tangent, 3, set)}, {}}}});
  };
  if (c.grains.empty()) return found;
  look("contact.friction", c.contact.friction, [](Case& other, double to) { other.contact.friction = to; });
  look("contact.wall_friction", c.contact.wall_friction,
       [](Case& other, double to) { other.contact.wall_friction = to; });
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    if (c.grains[n].contact)
      look(fmt::format("grains.{}.contact.friction", n), c.grains[n].contact->friction,
           [n](Case& other, double to) { other.grains[n].contact->friction = to; });
  for (std::size_t n = 0; n < c.solids.size(); ++n)
    look(fmt::format("solids.{}.friction", n), c.solids[n].friction,
         [n](Case& other, double to) { other.solids[n].friction = to; });
  return found;
}

}  // namespace

bool has_other_lengths(const Case& c) {
  return !lengths_in_millimetres(c).empty() || !reference_in_millimetres(c).empty() || !box_in_millimetres(c).empty() ||
         !many_cells_in_millimetres(c).empty();
}

std::vector<WarningRule> unit_rules() {
  return {lengths_in_millimetres,
          reference_in_millimetres,
          viscosity_in_pascal_seconds,
          box_in_millimetres,
          many_cells_in_millimetres,
          gravity_in_centimetres,
          gravity_in_millimetres,
          viscosity_in_square_millimetres,
          densities_in_grams,
          column_in_grams,
          liquid_in_grams,
          slope_in_degrees,
          friction_in_degrees,
          angles_in_degrees};
}

}  // namespace thalweg::driver
