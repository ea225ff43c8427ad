#include "coupling/system/fluid_mass.hpp"

#include "lbm/lattice/for_each_cell.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::coupling {

template <typename Real>
double add_density(lbm::Fluid<Real>& fluid, double density) {
  if (sizeof(Real) == sizeof(float) && std::abs(density) < 1e-8) return 0.0;
  lbm::Populations<Real>& populations = fluid.populations();
  lbm::for_each_fluid_cell(fluid.cells(), [&](std::ptrdiff_t cell, const Index3&) {
    populations.post_collision(0, cell) += static_cast<Real>(density);
  });
  return density;
}

template <typename Real>
double restore_excess(lbm::Fluid<Real>& fluid, const ExcessMass& now, double kept) {
  const double cells = static_cast<double>(std::max<std::int64_t>(1, now.cells));
  return cells * add_density(fluid, (kept - now.sum) / cells);
}

template double add_density(lbm::Fluid<float>&, double);
template double add_density(lbm::Fluid<double>&, double);
template double restore_excess(lbm::Fluid<float>&, const ExcessMass&, double);
template double restore_excess(lbm::Fluid<double>&, const ExcessMass&, double);

}  // namespace thalweg::coupling
