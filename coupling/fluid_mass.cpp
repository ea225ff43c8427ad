#include "coupling/fluid_mass.hpp"

#include <cmath>

namespace thalweg::coupling {

template <typename Real>
double add_density(lbm::Fluid<Real>& fluid, double density) {
  if (sizeof(Real) == sizeof(float) && std::abs(density) < 1e-7) return 0.0;
  lbm::Populations<Real>& populations = fluid.populations();
  const Index3& n = fluid.indexing().size();
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const std::ptrdiff_t cell = fluid.indexing().index(x, y, z);
        if (!fluid.cells().is_fluid(cell)) continue;
        for (int i = 0; i < lbm::D3Q19::directions; ++i)
          populations.post_collision(i, cell) += static_cast<Real>(lbm::D3Q19::weight(i) * density);
      }
  return density;
}

template double add_density(lbm::Fluid<float>&, double);
template double add_density(lbm::Fluid<double>&, double);

}  // namespace thalweg::coupling
