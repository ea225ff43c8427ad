// Excess mass of the fluid (mass_account.hpp), from a look at all of it, and how to change it.
#pragma once

#include "coupling/hydrostatic.hpp"
#include "lbm/fluid_survey.hpp"

#include <algorithm>
#include <cstdint>

namespace thalweg::coupling {

struct ExcessMass {
  double sum = 0.0;  // over all fluid cells of all ranks, of rho less that of the fluid at rest
  std::int64_t cells = 0;

  double mean() const { return sum / static_cast<double>(std::max<std::int64_t>(1, cells)); }
};

inline ExcessMass excess_mass(const lbm::FluidSurvey& survey, const Hydrostatic& rest) {
  return {survey.totals.mass_deviation - rest.gradient.dot(survey.lever), survey.totals.cells};
}

// Adds a density to every fluid cell of this rank, w_i of it to each population, which gives no momentum. Returns what
// was added: nothing where it would drown in the round-off of single storage, below 1e-7.
template <typename Real>
double add_density(lbm::Fluid<Real>& fluid, double density);

}  // namespace thalweg::coupling
