// Excess mass of the fluid (mass_budget.hpp), from a survey of all of it, and how to change it. Lattice units.
#pragma once

#include "bodies/map/hydrostatic.hpp"
#include "lbm/fluid/fluid_survey.hpp"

#include <algorithm>
#include <cstdint>

namespace thalweg::coupling {

struct ExcessMass {
  double sum = 0.0;  // over all fluid cells of all ranks, of rho less that of the fluid at rest
  std::int64_t cells = 0;

  double mean() const { return sum / static_cast<double>(std::max<std::int64_t>(1, cells)); }
};

inline ExcessMass excess_mass(const lbm::FluidSurvey& survey, const bodies::Hydrostatic& rest) {
  return {survey.totals.mass_deviation - rest.gradient.dot(survey.lever), survey.totals.cells};
}

// Steps between two corrections of the mass of the whole fluid, which round-off and non-conserving walls and solids
// change.
inline constexpr std::int64_t steps_between_mass_corrections = 200;

inline bool corrects_mass_at(std::int64_t step) { return step > 0 && step % steps_between_mass_corrections == 0; }

// Adds a density to every fluid cell of this rank, to the populations at rest: no momentum. Returns what was added:
// nothing where it would drown in the round-off of single storage, below 1e-8.
template <typename Real>
double add_density(lbm::Fluid<Real>& fluid, double density);

// Brings the excess of all ranks from `now` to `kept`. Returns the mass added, the same on every rank.
template <typename Real>
double restore_excess(lbm::Fluid<Real>& fluid, const ExcessMass& now, double kept);

}  // namespace thalweg::coupling
