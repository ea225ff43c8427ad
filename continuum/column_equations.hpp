// The two-phase column in one dimension (Zhang et al. 2022, section 3; docs/theory.md): z from a floor upwards, x
// downhill, everything uniform in x and y, no net flux of volume along z: w_f = -phi w_s/(1 - phi).
//
//   d phi/dt                   = -dJ/dz
//   phi rho_s dU_s/dt          = phi rho_s g_x - K (U_s - U_f) + d tau_s/dz
//   (1 - phi) rho_f dU_f/dt    = (1 - phi) rho_f g_x + K (U_s - U_f) + d/dz[(eta + eta_t) dU_f/dz]
//   J = -(1 - phi) D dphi/dz - (1 - phi)/C (phi (rho_s - rho_f) g_z + dp/dz),   K = phi (1 - phi) C,   C = 18 eta F/d^2
//
// with D = eta_t/(rho_f Sigma_s), tau_s and p of the grains (granular_rheology.hpp), F at |dU| = |(U_s - U_f, u_d)|. J
// is the z momentum of both phases without their inertia. Floor: no flux, no slip. Top: no flux, no stress.
//
// Finite volumes of one height: phi, U_s, U_f in the middle of a cell, fluxes on faces, central differences of second
// order; phi in the settling flux is the upper cell's with van Albada's limited slope, without which steps in phi ring.
// The unknowns are, cell by cell from the floor, S (m), U_s, U_f (m/s): S is the volume of grains per area below the
// cell's upper face, so that phi is its difference and the volume of all grains is conserved to the last bit.
#pragma once

#include "continuum/column_parameters.hpp"

#include <span>
#include <vector>

namespace thalweg::continuum {

// State at the middles of cells.
struct ColumnState {
  std::vector<double> fraction;        // phi
  std::vector<double> grain_velocity;  // U_s, m/s
  std::vector<double> fluid_velocity;  // U_f, m/s
};

// Fluxes at the faces, from the floor to the top: cells + 1 values.
struct ColumnFluxes {
  std::vector<double> grain_flux;      // J, m/s
  std::vector<double> grain_stress;    // tau_s, Pa
  std::vector<double> fluid_stress;    // tau_f, Pa
  std::vector<double> eddy_viscosity;  // eta_t, Pa s
  std::vector<double> drift_velocity;  // u_d, m/s
};

class ColumnEquations {
public:
  static constexpr int unknowns_per_cell = 3;
  static constexpr int half_bandwidth = 2 * unknowns_per_cell + 2;  // rates depend on two cells on either side

  // The drift velocity, a ratio of slope and solid fraction, is -D grad phi/(phi + dilute), or it would be noise.
  static constexpr double dilute = 1e-3;

  explicit ColumnEquations(const ColumnParameters& parameters);

  int size() const { return unknowns_per_cell * parameters_.cells; }
  const ColumnParameters& parameters() const { return parameters_; }

  // The time derivatives of the unknowns.
  void rates(std::span<const double> unknowns, std::span<double> rates) const;

  std::vector<double> unknowns_of(const ColumnState& state) const;
  const ColumnState& state_of(std::span<const double> unknowns) const;    // until the next call of this object
  const ColumnFluxes& fluxes_of(std::span<const double> unknowns) const;  // the same
  const std::vector<double>& pressures_of(std::span<const double> unknowns) const;  // p, Pa, at cell middles; the same
  std::vector<double> drag_of(std::span<const double> unknowns) const;  // K (U_f - U_s), N/m^3, on the grains

  // The drag in a cell, of the unknowns of the latest call.
  struct CellDrag {
    double function, reynolds;  // F, Re_d
  };
  CellDrag drag_in(std::size_t cell) const;

private:
  void find_pressures() const;
  void find_fluxes() const;
  void find_flux_between(int lower) const;  // finds that of the face above the cell
  double upwinded_fraction(int lower) const;
  double fraction_around(std::size_t cell) const;
  double drag_speed(double along, double drift) const;  // m/s, of Re_d
  double drag_speed_in(std::size_t cell) const;         // m/s
  double drag_rate_in(int cell) const;

  ColumnParameters parameters_;
  double slowest_;  // m/s, below which the drag function no longer changes with the velocity along the bed alone
  // Filled anew by every call.
  mutable ColumnState state_;
  mutable ColumnFluxes fluxes_;
  mutable std::vector<double> pressure_, grain_rate_;  // of cells: Pa; of faces: dU_s/dz, 1/s
};

}  // namespace thalweg::continuum
