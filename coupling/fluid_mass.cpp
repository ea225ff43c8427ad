#include "coupling/fluid_mass.hpp"

#include "core/fixed_point.hpp"

#include <cmath>

namespace thalweg::coupling {

namespace {

using CellSum = FixedPoint<36>;  // as the fluid's totals

template <typename Real, typename Visit>
void for_each_fluid_cell(const lbm::Fluid<Real>& fluid, Visit visit) {
  const Index3& n = fluid.indexing().size();
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const std::ptrdiff_t cell = fluid.indexing().index(x, y, z);
        if (fluid.cells().is_fluid(cell)) visit(cell, Index3{x, y, z});
      }
}

}  // namespace

template <typename Real>
ExcessMass excess_mass(const lbm::Fluid<Real>& fluid, const Hydrostatic& rest) {
  const Index3& lower = fluid.block().lower;
  std::int64_t sums[2] = {0, 0};
  for_each_fluid_cell(fluid, [&](std::ptrdiff_t cell, const Index3& at) {
    const Vec3 position(lower[0] + at[0] + 0.5, lower[1] + at[1] + 0.5, lower[2] + at[2] + 0.5);
    sums[0] += CellSum::from(fluid.populations().density_deviation(cell) - rest.deviation(position));
    ++sums[1];
  });
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_INT64_T, MPI_SUM, fluid.communicator());
  return {CellSum::to_double(sums[0]), sums[1]};
}

template <typename Real>
double add_density(lbm::Fluid<Real>& fluid, double density) {
  if (sizeof(Real) == sizeof(float) && std::abs(density) < 1e-7) return 0.0;
  lbm::Populations<Real>& populations = fluid.populations();
  for_each_fluid_cell(fluid, [&](std::ptrdiff_t cell, const Index3&) {
    for (int i = 0; i < lbm::D3Q19::directions; ++i)
      populations.post_collision(i, cell) += static_cast<Real>(lbm::D3Q19::weight(i) * density);
  });
  return density;
}

template ExcessMass excess_mass(const lbm::Fluid<float>&, const Hydrostatic&);
template ExcessMass excess_mass(const lbm::Fluid<double>&, const Hydrostatic&);
template double add_density(lbm::Fluid<float>&, double);
template double add_density(lbm::Fluid<double>&, double);

}  // namespace thalweg::coupling
