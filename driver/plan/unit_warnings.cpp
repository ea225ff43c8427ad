#include "driver/plan/unit_warnings.hpp"

#include "driver/estimate/reference_grain.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace thalweg::driver {

namespace {

constexpr double largest_boulder = 0.5; // m; a bed of larger ones in a resolved flow is a bed in millimetres
constexpr double lightest_grain = 300.0;  // kg/m^3, of sediment in SI units
constexpr double roughest_contact = 1.5;  // 1; friction of dry solids is below, an angle in degrees above
constexpr int density_digits = 6;
constexpr double steepest_friction = 60.0;  // degrees

Warnings lengths_in_millimetres(const Case& c) {
  if (c.grains.empty() || c.system != SystemKind::resolved) return {};
  const double diameter = reference_grain(c).diameter;
  if (diameter <= largest_boulder) return {};
  return {
      fmt::format("The grains are {:.4g} m wide, which looks like millimetres: lengths are in m, and {:g} mm are "
                  "{:g} m.",
                  diameter, diameter, 1e-3 * diameter)};
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
      found.push_back({fmt::format("Grains of {:g} kg/m^3 (grains.{}) look like {:g} g/cm^3, which are {:g} kg/m^3",
                                   density, n, density, 1000.0 * density),
                       {{remedy, {}}}});
    }
  return found;
}

// Beside grains in kg/m^3. A gas so dense and with so little viscosity is under a pressure of tens of bars.
Warnings liquid_in_grams(const Case& c) {
  if (c.system != SystemKind::resolved || c.grains.empty() || reference_grain(c).density < lightest_grain ||
      c.fluid.density > densest_gas || c.fluid.kinematic_viscosity > thinnest_gas)
    return {};
  return {{fmt::format("A fluid of {0:g} kg/m^3 with the viscosity of a liquid looks like one of {0:g} g/cm^3, which "
                       "are {1:g} kg/m^3",
                       c.fluid.density, 1000.0 * c.fluid.density),
           {{{exact_change("fluid.density", 1000.0 * c.fluid.density, density_digits,
                           [](Case& other, double to) { other.fluid.density = to; })},
             {}}}}};
}

Warnings slope_in_degrees(const Case& c) {
  const double slope = c.gravity.vector ? 0.0 : std::abs(c.gravity.slope.value_or(0.0));
  if (slope <= steepest_bed || slope > steepest_friction || !c.filled_in.flow.empty()) return {};
  const double tangent = std::tan(*c.gravity.slope * std::numbers::pi / 180.0);
  return {
      {fmt::format("gravity.slope = {:g} is a bed at {:.3g} degrees, as the slope is the tangent of its angle; it "
                   "looks like an angle in degrees",
                   *c.gravity.slope, std::atan(slope) * 180.0 / std::numbers::pi),
       {{{exact_change("gravity.slope", tangent, 3, [](Case& other, double to) { other.gravity.slope = to; })}, {}}}}};
}

Warnings friction_in_degrees(const Case& c) {
  Warnings found;
  const auto look = [&](const char* key, double value, const Setter& set) {
    if (value <= roughest_contact || value > steepest_friction) return;
    const double tangent = std::tan(value * std::numbers::pi / 180.0);
    found.push_back({fmt::format("contact.{} = {:g} looks like an angle in degrees, and the coefficient is its tangent",
                                 key, value),
                     {{{exact_change(fmt::format("contact.{}", key), tangent, 3, set)}, {}}}});
  };
  if (c.grains.empty()) return found;
  look("friction", c.contact.friction, [](Case& other, double to) { other.contact.friction = to; });
  look("wall_friction", c.contact.wall_friction, [](Case& other, double to) { other.contact.wall_friction = to; });
  return found;
}

}  // namespace

std::vector<WarningRule> unit_rules() {
  return {lengths_in_millimetres, densities_in_grams, liquid_in_grams, slope_in_degrees, friction_in_degrees};
}

}  // namespace thalweg::driver
