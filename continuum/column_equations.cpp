#include "continuum/column_equations.hpp"

#include "core/base/check.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::continuum {

namespace {

// Solid fractions within this of zero are smoothly made positive, since closures have kinks there.
constexpr double no_grains = 1e-5;
// Weight of the mean over a cell and its neighbours; where phi changes little, it adds half its square to the inertia.
constexpr double share_of_neighbours = 0.02;
constexpr double slowest_over_shear = 0.036;  // shear speed of the mixture

double positive(double fraction) { return 0.5 * (fraction + std::hypot(fraction, no_grains)); }

double mean(double a, double b) { return 0.5 * (a + b); }

// Differences in phi of this size are smoothed no more: they are noise to a limiter that knows no scale.
constexpr double smooth_difference = 1e-4;

// Half of van Albada's slope between two differences; zero where they differ in sign.
double half_limited(double a, double b) {
  const double product = a * b;
  return product > 0.0 ? 0.5 * product * (a + b) / (a * a + b * b + smooth_difference * smooth_difference) : 0.0;
}

}  // namespace

std::vector<NamedChoice<DriftSign>> choices_of(DriftSign) {
  return {
      {DriftSign::diffusive, "diffusive", "U_s - U_f - u_d: from many grains to few"},
      {DriftSign::printed, "printed", "U_s - U_f + u_d: as in the paper, from few to many, which has no steady state"}};
}

std::vector<NamedChoice<DragSpeed>> choices_of(DragSpeed) {
  return {{DragSpeed::total, "total", "|(U_s - U_f, u_d)|, as in the paper"},
          {DragSpeed::streamwise, "streamwise", "|U_s - U_f|"}};
}

ColumnEquations::ColumnEquations(const ColumnParameters& parameters)
    : parameters_(parameters), slowest_(slowest_over_shear * parameters.shear_speed()) {
  const auto cells = static_cast<std::size_t>(parameters.cells);
  for (std::vector<double>* values : {&state_.fraction, &state_.grain_velocity, &state_.fluid_velocity, &pressure_})
    values->assign(cells, 0.0);
  for (std::vector<double>* values : {&fluxes_.grain_flux, &fluxes_.grain_stress, &fluxes_.fluid_stress,
                                      &fluxes_.eddy_viscosity, &fluxes_.drift_velocity, &grain_rate_})
    values->assign(cells + 1, 0.0);
}

std::vector<double> ColumnEquations::unknowns_of(const ColumnState& state) const {
  CHECK(state.fraction.size() == state_.fraction.size());
  CHECK(state.grain_velocity.size() == state.fraction.size() && state.fluid_velocity.size() == state.fraction.size());
  std::vector<double> unknowns;
  double below = 0.0;
  for (std::size_t i = 0; i < state.fraction.size(); ++i) {
    below += state.fraction[i] * parameters_.spacing;
    unknowns.insert(unknowns.end(), {below, state.grain_velocity[i], state.fluid_velocity[i]});
  }
  return unknowns;
}

const ColumnState& ColumnEquations::state_of(std::span<const double> unknowns) const {
  CHECK(unknowns.size() == static_cast<std::size_t>(size()));
  double below = 0.0;
  for (std::size_t i = 0; i < state_.fraction.size(); ++i) {
    const double* cell = unknowns.data() + unknowns_per_cell * i;
    state_.fraction[i] = (cell[0] - below) / parameters_.spacing;
    below = cell[0];
    state_.grain_velocity[i] = cell[1];
    state_.fluid_velocity[i] = cell[2];
  }
  return state_;
}

const ColumnFluxes& ColumnEquations::fluxes_of(std::span<const double> unknowns) const {
  state_of(unknowns);
  find_pressures();
  find_fluxes();
  return fluxes_;
}

const std::vector<double>& ColumnEquations::pressures_of(std::span<const double> unknowns) const {
  state_of(unknowns);
  find_pressures();
  return pressure_;
}

// Uses the shear rate in the middle of the cell, the mean of those on its faces.
void ColumnEquations::find_pressures() const {
  const Rheology& rheology = parameters_.closures.rheology;
  const double dz = parameters_.spacing;
  const std::vector<double>& u = state_.grain_velocity;
  const std::size_t cells = u.size();
  grain_rate_[0] = u[0] / (0.5 * dz);
  for (std::size_t i = 1; i < cells; ++i) grain_rate_[i] = (u[i] - u[i - 1]) / dz;
  grain_rate_[cells] = 0.0;
  for (std::size_t i = 0; i < cells; ++i) {
    const double fraction = positive(state_.fraction[i]);
    pressure_[i] =
        flow_pressure(rheology, parameters_.mixture, fraction, std::abs(mean(grain_rate_[i], grain_rate_[i + 1]))) +
        elastic_pressure(rheology, fraction);
  }
}

// Grains settle, so the upwind cell is the upper one.
double ColumnEquations::upwinded_fraction(int lower) const {
  const auto upper = static_cast<std::size_t>(lower) + 1;
  const std::vector<double>& phi = state_.fraction;
  const double slope =
      upper + 1 < phi.size() ? half_limited(phi[upper] - phi[upper - 1], phi[upper + 1] - phi[upper]) : 0.0;
  return phi[upper] - slope;
}

void ColumnEquations::find_flux_between(int lower) const {
  const auto i = static_cast<std::size_t>(lower), face = i + 1;
  const Closures& closures = parameters_.closures;
  const Mixture& mixture = parameters_.mixture;
  const double dz = parameters_.spacing, densest = closures.rheology.densest_fraction;
  const double phi = positive(mean(state_.fraction[i], state_.fraction[i + 1])), n = 1.0 - phi;
  const double fluid_rate = (state_.fluid_velocity[i + 1] - state_.fluid_velocity[i]) / dz;
  const double eddy = eddy_viscosity(closures.turbulence, mixture, densest, phi, fluid_rate);
  const double diffusivity =
      drift_diffusivity(closures.turbulence, mixture, eddy) * (closures.drift == DriftSign::diffusive ? 1.0 : -1.0);
  const double slope = (state_.fraction[i + 1] - state_.fraction[i]) / dz;
  const double drift = -diffusivity * slope / (phi + dilute);
  const double along = mean(state_.grain_velocity[i] - state_.fluid_velocity[i],
                            state_.grain_velocity[i + 1] - state_.fluid_velocity[i + 1]);
  const double rate = drag_rate(closures.drag, mixture, phi, drag_speed(along, drift));
  const double weight = upwinded_fraction(lower) * mixture.excess_density() * parameters_.gravity_z;
  fluxes_.eddy_viscosity[face] = eddy;
  fluxes_.drift_velocity[face] = drift;
  fluxes_.grain_flux[face] = -n * diffusivity * slope - n / rate * (weight + (pressure_[i + 1] - pressure_[i]) / dz);
  fluxes_.fluid_stress[face] = (mixture.viscosity + eddy) * fluid_rate;
  fluxes_.grain_stress[face] =
      granular_stress(closures.rheology, mixture, phi, mean(pressure_[i], pressure_[i + 1]), grain_rate_[face]);
}

void ColumnEquations::find_fluxes() const {
  const Closures& closures = parameters_.closures;
  const double floor_rate = state_.fluid_velocity[0] / (0.5 * parameters_.spacing);
  const double phi = positive(state_.fraction[0]);
  fluxes_.eddy_viscosity[0] =
      eddy_viscosity(closures.turbulence, parameters_.mixture, closures.rheology.densest_fraction, phi, floor_rate);
  fluxes_.fluid_stress[0] = (parameters_.mixture.viscosity + fluxes_.eddy_viscosity[0]) * floor_rate;
  fluxes_.grain_stress[0] = granular_stress(closures.rheology, parameters_.mixture, phi, pressure_[0], grain_rate_[0]);
  for (int lower = 0; lower + 1 < parameters_.cells; ++lower) find_flux_between(lower);
}

double ColumnEquations::drag_speed(double along, double drift) const {
  return std::hypot(along, parameters_.closures.speed == DragSpeed::total ? drift : slowest_);
}

// The solid fraction that the stress on the faces accelerates: in a cell with hardly any grains beside one with many,
// some of the neighbours' too.
double ColumnEquations::fraction_around(std::size_t i) const {
  const std::vector<double>& phi = state_.fraction;
  const std::size_t below = i > 0 ? i - 1 : 0, above = std::min(i + 1, phi.size() - 1);
  return std::hypot(positive(phi[i]), share_of_neighbours * positive(0.25 * (phi[below] + 2.0 * phi[i] + phi[above])));
}

double ColumnEquations::drag_speed_in(std::size_t cell) const {
  const double drift = mean(fluxes_.drift_velocity[cell], fluxes_.drift_velocity[cell + 1]);
  return drag_speed(state_.grain_velocity[cell] - state_.fluid_velocity[cell], drift);
}

double ColumnEquations::drag_rate_in(int cell) const {
  const auto i = static_cast<std::size_t>(cell);
  return drag_rate(parameters_.closures.drag, parameters_.mixture, positive(state_.fraction[i]), drag_speed_in(i));
}

ColumnEquations::CellDrag ColumnEquations::drag_in(std::size_t cell) const {
  const double fraction = positive(state_.fraction[cell]);
  const double reynolds = drag_reynolds(parameters_.mixture, fraction, drag_speed_in(cell));
  return {drag_function(parameters_.closures.drag, fraction, reynolds), reynolds};
}

void ColumnEquations::rates(std::span<const double> unknowns, std::span<double> rates) const {
  CHECK(rates.size() == unknowns.size());
  fluxes_of(unknowns);
  const double dz = parameters_.spacing, rho_s = parameters_.mixture.grain_density,
               rho_f = parameters_.mixture.fluid_density;
  for (int cell = 0; cell < parameters_.cells; ++cell) {
    const auto i = static_cast<std::size_t>(cell);
    const double phi = positive(state_.fraction[i]), n = 1.0 - phi;
    const double drag = drag_rate_in(cell) * (state_.grain_velocity[i] - state_.fluid_velocity[i]);
    const double grain_push = (fluxes_.grain_stress[i + 1] - fluxes_.grain_stress[i]) / dz;
    const double fluid_push = (fluxes_.fluid_stress[i + 1] - fluxes_.fluid_stress[i]) / dz;
    double* rate = rates.data() + unknowns_per_cell * i;
    rate[0] = -fluxes_.grain_flux[i + 1];
    rate[1] = parameters_.gravity_x + (grain_push / fraction_around(i) - n * drag) / rho_s;
    rate[2] = parameters_.gravity_x + (fluid_push / n + phi * drag) / rho_f;
  }
}

std::vector<double> ColumnEquations::drag_of(std::span<const double> unknowns) const {
  fluxes_of(unknowns);
  std::vector<double> drag;
  for (int cell = 0; cell < parameters_.cells; ++cell) {
    const auto i = static_cast<std::size_t>(cell);
    const double phi = positive(state_.fraction[i]);
    drag.push_back(phi * (1.0 - phi) * drag_rate_in(cell) * (state_.fluid_velocity[i] - state_.grain_velocity[i]));
  }
  return drag;
}

}  // namespace thalweg::continuum
