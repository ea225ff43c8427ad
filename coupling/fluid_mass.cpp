#include "coupling/fluid_mass.hpp"

namespace thalweg::coupling {

template <typename Real>
void add_density(lbm::Fluid<Real>& fluid, double density) {
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
}

template void add_density(lbm::Fluid<float>&, double);
template void add_density(lbm::Fluid<double>&, double);

}  // namespace thalweg::coupling
