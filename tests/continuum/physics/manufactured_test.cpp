// A manufactured solution of the column: sources make given profiles of phi, U_s and U_f its steady state, and the
// discrete steady state comes to them with the square of the cell.
#include "continuum/column_equations.hpp"
#include "continuum/stiff_integrator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace thalweg::continuum::manufactured_test {
namespace {

constexpr double height = 0.02;  // m

double wave(double z) { return std::numbers::pi * z / height; }

// Profiles with no slip below, no shear at the top, and curvature zero at both ends.
double grain_speed(double z) { return 0.3 * (z / height + std::sin(wave(z)) / std::numbers::pi); }
double grain_rate(double z) { return 0.3 / height * (1.0 + std::cos(wave(z))); }
double fluid_speed(double z) { return 1.5 * grain_speed(z); }
double fluid_rate(double z) { return 1.5 * grain_rate(z); }
double fraction(double z) { return 0.35 + 0.15 * std::cos(wave(z)); }
double fraction_slope(double z) { return -0.15 * std::numbers::pi / height * std::sin(wave(z)); }

ColumnParameters parameters_of(int cells) {
  ColumnParameters parameters;
  parameters.gravity_x = 0.1;
  parameters.gravity_z = 9.8;
  parameters.cells = cells;
  parameters.spacing = height / cells;
  parameters.closures.turbulence.smallest_mixing_length = 0.05;  // reached nowhere: the floor is a corner
  parameters.closures.turbulence.mixing_length_factor = 30.0;
  return parameters;
}

// The right-hand sides of the differential equations, from the closures and derivatives of them.
class Continuous {
public:
  explicit Continuous(const ColumnParameters& parameters) : p_(parameters) {}

  double flux(double z) const {
    const double n = 1.0 - fraction(z), push = p_.mixture.excess_density() * p_.gravity_z * fraction(z);
    const double slope = derivative([this](double at) { return pressure(at); }, z);
    return -n * diffusivity(z) * fraction_slope(z) - n / rate(z) * (push + slope);
  }
  double grain_acceleration(double z) const {
    const double push = derivative([this](double at) { return grain_stress(at); }, z) / fraction(z);
    return p_.gravity_x + (push - (1.0 - fraction(z)) * drag(z)) / p_.mixture.grain_density;
  }
  double fluid_acceleration(double z) const {
    const double push = derivative([this](double at) { return fluid_stress(at); }, z) / (1.0 - fraction(z));
    return p_.gravity_x + (push + fraction(z) * drag(z)) / p_.mixture.fluid_density;
  }

  double grain_stress(double z) const {
    return granular_stress(p_.closures.rheology, p_.mixture, fraction(z), pressure(z), grain_rate(z));
  }
  double fluid_stress(double z) const { return (p_.mixture.viscosity + eddy(z)) * fluid_rate(z); }

private:
  // Derivative of fourth order.
  static double derivative(const std::function<double(double)>& f, double z) {
    const double h = 1e-4 * height;
    return (8.0 * (f(z + h) - f(z - h)) - f(z + 2.0 * h) + f(z - 2.0 * h)) / (12.0 * h);
  }
  double eddy(double z) const {
    return eddy_viscosity(p_.closures.turbulence, p_.mixture, p_.closures.rheology.densest_fraction, fraction(z),
                          fluid_rate(z));
  }
  double diffusivity(double z) const { return drift_diffusivity(p_.closures.turbulence, p_.mixture, eddy(z)); }
  double rate(double z) const {
    const double drift = -diffusivity(z) * fraction_slope(z) / (fraction(z) + ColumnEquations::dilute);
    return drag_rate(p_.closures.drag, p_.mixture, fraction(z), std::hypot(grain_speed(z) - fluid_speed(z), drift));
  }
  double drag(double z) const { return rate(z) * (grain_speed(z) - fluid_speed(z)); }
  double pressure(double z) const {
    return flow_pressure(p_.closures.rheology, p_.mixture, fraction(z), grain_rate(z));
  }

  ColumnParameters p_;
};

struct Errors {
  double fraction = 0.0, grains = 0.0, fluid = 0.0;  // root mean squares: 1, m/s, m/s
};

ColumnState given_state(const ColumnParameters& parameters) {
  ColumnState state;
  for (int i = 0; i < parameters.cells; ++i) {
    const double z = (i + 0.5) * parameters.spacing;
    state.fraction.push_back(fraction(z));
    state.grain_velocity.push_back(grain_speed(z));
    state.fluid_velocity.push_back(fluid_speed(z));
  }
  return state;
}

Errors errors_of(int cells) {
  const ColumnParameters parameters = parameters_of(cells);
  const ColumnEquations equations(parameters);
  const Continuous exact(parameters);
  const double dz = parameters.spacing;
  const ColumnState state = given_state(parameters);
  std::vector<double> sources;
  for (int i = 0; i < cells; ++i) {
    const double z = (i + 0.5) * dz;
    sources.insert(sources.end(), {i + 1 < cells ? exact.flux(z + 0.5 * dz) : 0.0, -exact.grain_acceleration(z),
                                   -exact.fluid_acceleration(z)});
  }
  std::vector<double> unknowns = equations.unknowns_of(state);
  std::vector<Tolerance> tolerances;
  for (int i = 0; i < cells; ++i) tolerances.insert(tolerances.end(), {{0.0, 1e-8 * dz}, {1e-7, 1e-9}, {1e-7, 1e-9}});
  StiffIntegrator integrator(ColumnEquations::half_bandwidth, tolerances,
                             [&](std::span<const double> y, std::span<double> rates) {
                               equations.rates(y, rates);
                               for (std::size_t i = 0; i < rates.size(); ++i) rates[i] += sources[i];
                             });
  integrator.advance(unknowns, 20.0);
  const ColumnState& found = equations.state_of(unknowns);
  Errors errors;
  for (std::size_t i = 0; i < found.fraction.size(); ++i) {
    errors.fraction += std::pow(found.fraction[i] - state.fraction[i], 2) / cells;
    errors.grains += std::pow(found.grain_velocity[i] - state.grain_velocity[i], 2) / cells;
    errors.fluid += std::pow(found.fluid_velocity[i] - state.fluid_velocity[i], 2) / cells;
  }
  return {std::sqrt(errors.fraction), std::sqrt(errors.grains), std::sqrt(errors.fluid)};
}

// Errors of the fluxes of the given profiles on the faces between cells: root mean squares, m/s, Pa and Pa.
Errors flux_errors_of(int cells) {
  const ColumnParameters parameters = parameters_of(cells);
  const ColumnEquations equations(parameters);
  const Continuous exact(parameters);
  const ColumnFluxes& found = equations.fluxes_of(equations.unknowns_of(given_state(parameters)));
  Errors errors;
  for (std::size_t face = 1; face + 1 < found.grain_flux.size(); ++face) {
    const double z = static_cast<double>(face) * parameters.spacing;
    errors.fraction += std::pow(found.grain_flux[face] - exact.flux(z), 2) / cells;
    errors.grains += std::pow(found.grain_stress[face] - exact.grain_stress(z), 2) / cells;
    errors.fluid += std::pow(found.fluid_stress[face] - exact.fluid_stress(z), 2) / cells;
  }
  return {std::sqrt(errors.fraction), std::sqrt(errors.grains), std::sqrt(errors.fluid)};
}

TEST(Column, FluxesOfSecondOrder) {
  const Errors coarse = flux_errors_of(80), fine = flux_errors_of(160);
  EXPECT_NEAR(std::log2(coarse.fraction / fine.fraction), 2.0, 0.1);
  EXPECT_NEAR(std::log2(coarse.grains / fine.grains), 2.0, 0.1);
  EXPECT_NEAR(std::log2(coarse.fluid / fine.fluid), 2.0, 0.1);
}

// The errors of the solution fall at least as fast; of different signs, they partly cancel on grids as fine as these.
TEST(Column, ManufacturedSolution) {
  const Errors coarse = errors_of(40), fine = errors_of(80);
  EXPECT_GT(std::log2(coarse.fraction / fine.fraction), 1.8);
  EXPECT_GT(std::log2(coarse.grains / fine.grains), 1.8);
  EXPECT_GT(std::log2(coarse.fluid / fine.fluid), 1.8);
  EXPECT_LT(fine.fraction, 0.01 * 0.35);  // of its mean
  EXPECT_LT(fine.grains, 0.01 * 0.3);     // of its largest value
}

}  // namespace
}  // namespace thalweg::continuum::manufactured_test
