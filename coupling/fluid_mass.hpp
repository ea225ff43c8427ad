// Mass of the fluid. Covering and uncovering cells does not conserve it, so that it drifts; the drift can be taken back
// by adding the same density to all fluid cells, w_i (rho_0 - <rho>) to each population, which gives no momentum.
#pragma once

#include "coupling/hydrostatic.hpp"
#include "lbm/fluid_survey.hpp"

#include <algorithm>
#include <cstdint>

namespace thalweg::coupling {

// Mean over all fluid cells of rho - 1, less that of a fluid at rest. The same bits on any ranks.
inline double mean_density_deviation(const lbm::FluidSurvey& survey, const Hydrostatic& rest) {
  const auto cells = static_cast<double>(std::max<std::int64_t>(1, survey.totals.cells));
  return (survey.totals.mass_deviation - rest.gradient.dot(survey.lever)) / cells;
}

// Adds a density to every fluid cell of this rank.
template <typename Real>
void add_density(lbm::Fluid<Real>& fluid, double density);

}  // namespace thalweg::coupling
