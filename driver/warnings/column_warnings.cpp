#include "driver/warnings/column_warnings.hpp"

#include <fmt/format.h>

#include <cmath>

namespace thalweg::driver {

namespace {

Change bed_change(double diameters) {
  return number_change("column.bed", diameters, 2, Rounding::up,
                       [](Case& other, double to) { other.continuum.column.bed = to; });
}

Change to_slope(double slope) {
  return number_change("gravity.slope", slope, 2, Rounding::down,
                       [](Case& other, double to) { other.gravity.slope = to; });
}

// Stresses in a bed at rest that is so deep, over the pressure of the grains at its floor (granular_fluidity.hpp).
struct RatioAtFloor {
  double of_water, of_weight;  // shear stress on the bed's surface, at this depth; of the bed itself, at any
  double sum() const { return of_water + of_weight; }
};

RatioAtFloor ratio_at_floor(const continuum::SystemParameters& parameters) {
  const continuum::ColumnParameters& column = parameters.column;
  const continuum::Mixture& mixture = column.mixture;
  const double phi = column.closures.rheology.densest_fraction, bed = parameters.bed_cells * column.spacing;
  const double density = phi * mixture.grain_density + (1.0 - phi) * mixture.fluid_density;
  const double weight = phi * mixture.excess_density() * column.gravity_z;
  return {mixture.fluid_density * column.gravity_x * parameters.depth / (weight * bed),
          density * column.gravity_x / weight};
}

// The steepest slope on which the ratio is no larger, by bisection, as the depth may change with it; 0: there is none.
double gentler_slope(const Case& c, double ratio) {
  const auto holds = [&](double slope) {
    Case other = c;
    other.gravity.slope = slope;
    return ratio_at_floor(column_of(other)).sum() <= ratio;
  };
  return steepest_slope(*c.gravity.slope, holds);
}

// The whole bed flows where its floor cannot hold it: what is found then depends on how thick it is.
Warnings sliding_column(const Case& c) {
  if (c.system != SystemKind::continuum) return {};
  const continuum::SystemParameters parameters = column_of(c);
  const RatioAtFloor ratio = ratio_at_floor(parameters);
  const double held = parameters.column.closures.rheology.static_friction;
  if (ratio.sum() <= held) return {};
  std::vector<Advice> advice;
  if (ratio.of_weight < held)
    advice.push_back({{bed_change(c.continuum.column.bed * ratio.of_water / (held - ratio.of_weight))}, {}});
  if (const double slope = c.gravity.vector ? 0.0 : gentler_slope(c, held); slope > 0.0)
    advice.push_back({{to_slope(slope)}, {}});
  return {{fmt::format("At the floor of the bed at rest the shear stress is {:.2g} times the pressure of the grains, "
                       "which begin to flow at {:.2g} (closures.rheology.static_friction), so the bed flows as a whole",
                       ratio.sum(), held),
           std::move(advice), "a smaller slope"}};
}

// The closures of the water are those of a flow that is deep against a grain.
Warnings shallow_water(const Case& c) {
  if (c.system != SystemKind::continuum) return {};
  constexpr double rounding = 1e-9;
  const continuum::SystemParameters parameters = column_of(c);
  const double share = parameters.depth / parameters.column.mixture.diameter;
  if (share >= 1.0 - rounding) return {};
  std::vector<Advice> advice;
  const continuum::HeightKeys& column = c.continuum.column;
  if (column.depth) {
    advice.push_back({{number_change("column.depth", parameters.column.mixture.diameter, 3, Rounding::up,
                                     [](Case& other, double to) { other.continuum.column.depth = to; })},
                      {}});
  } else {
    if (!c.gravity.vector)  // the depth goes with the inverse of the sine
      advice.push_back({{to_slope(std::tan(std::asin(share * std::sin(std::atan(*c.gravity.slope)))))}, {}});
    advice.push_back({{number_change("column.shields_number", *column.shields_number / share, 3, Rounding::up,
                                     [](Case& other, double to) { other.continuum.column.shields_number = to; })},
                      {}});
  }
  return {
      {fmt::format("The water over the bed is only {:.2g} diameters deep, and its closures are those of a flow that "
                   "is deep against a grain",
                   share),
       std::move(advice), "deeper water"}};
}

}  // namespace

std::vector<WarningRule> column_rules() { return {sliding_column, shallow_water}; }

}  // namespace thalweg::driver
