// Diagnostics of a fluid from a survey of the lattice, in the units of a run.
#pragma once

#include "core/base/units.hpp"
#include "core/state/location.hpp"
#include "core/state/system.hpp"
#include "lbm/fluid/fluid_survey.hpp"

#include <optional>
#include <string>
#include <vector>

namespace thalweg::coupling {

// largest_lattice_velocity (1) and largest_fluid_speed (m/s); infinite where a cell is broken.
std::vector<Diagnostic> speed_diagnostics(const lbm::FluidSurvey& survey, const Units& units);

// Appends smallest_density_deviation and largest_density_deviation (of rho/rho_0 - 1, with the hydrostatic part of full
// gravity), and fast_cell_fraction: the share of fluid cells with a lattice velocity above FluidSurvey::fast (all 1).
void add_extremes(const lbm::FluidSurvey& survey, std::vector<Diagnostic>& diagnostics);

// Appends fluid_momentum_x, _y, _z (kg m/s). force: lattice units, on a cell; half of it is in the survey's sums
// already, which are those after the collision.
void add_momentum(const lbm::FluidSurvey& survey, const Vec3& force, const Units& units,
                  std::vector<Diagnostic>& diagnostics);

// Location of the extreme value of a diagnostic: largest_lattice_velocity or one of add_extremes(). If cells are
// broken, the first of them for any name; empty for other names.
std::optional<Location> location_in_fluid(const lbm::FluidSurvey& survey, const Units& units,
                                          const std::string& diagnostic);

}  // namespace thalweg::coupling
