#include "coupling/momentum_sample.hpp"

#include "lbm/flow_fields.hpp"

namespace thalweg::coupling {

namespace {

std::array<double, 6> components(const lbm::Symmetric<double>& s, double unit) {
  return {unit * s.xx, unit * s.yy, unit * s.zz, unit * s.xy, unit * s.xz, unit * s.yz};
}

// Of all ranks: sums of integers, so the same in any order.
std::vector<Vec3> over_ranks(const std::vector<FixedVec3>& of_block, const Block& block, int planes, double unit,
                             MPI_Comm communicator) {
  const auto heights = static_cast<std::size_t>(2 * planes + 1), first = static_cast<std::size_t>(2 * block.lower[2]);
  std::vector<std::int64_t> sums(3 * heights, 0);
  for (std::size_t h = 0; h < of_block.size(); ++h) {
    sums[3 * (first + h)] = of_block[h].x;
    sums[3 * (first + h) + 1] = of_block[h].y;
    sums[3 * (first + h) + 2] = of_block[h].z;
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_INT64_T, MPI_SUM, communicator);
  std::vector<Vec3> all(heights);
  for (std::size_t h = 0; h < heights; ++h)
    all[h] = FixedVec3{sums[3 * h], sums[3 * h + 1], sums[3 * h + 2]}.to_vec3() * unit;
  return all;
}

}  // namespace

template <typename Real>
MomentumBudget sample_momentum(lbm::Fluid<Real>& fluid, const Units& units, double reference,
                               const std::function<void(std::vector<FixedVec3>&)>& apply_links,
                               const MomentumSource::MomentumVisitor& visit) {
  const Index3 &n = fluid.indexing().size(), &from = fluid.block().lower;
  MomentumBudget budget;
  budget.on_top = fluid.wall_forces(reference)[5] * units.force();
  const double(&force)[3] = fluid.parameters().force;
  budget.driving = Vec3(force[0], force[1], force[2]) * (units.stress() / units.spacing);

  fluid.exchange_halo();
  fluid.apply_walls();
  std::vector<FixedVec3> by_height(static_cast<std::size_t>(2 * n[2] + 1));
  apply_links(by_height);
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const std::ptrdiff_t cell = fluid.indexing().index(x, y, z);
        if (!fluid.cells().is_fluid(cell)) continue;
        const lbm::MomentumFlux flux = lbm::momentum_flux(fluid, cell);
        visit({from[0] + x, from[1] + y, from[2] + z},
              {flux.density * units.density, flux.velocity * units.velocity(), components(flux.viscous, units.stress()),
               components(flux.subgrid, units.stress())});
      }
  budget.on_grains =
      over_ranks(by_height, fluid.block(), fluid.decomposition().cells()[2], units.force(), fluid.communicator());
  return budget;
}

template MomentumBudget sample_momentum(lbm::Fluid<float>&, const Units&, double,
                                        const std::function<void(std::vector<FixedVec3>&)>&,
                                        const MomentumSource::MomentumVisitor&);
template MomentumBudget sample_momentum(lbm::Fluid<double>&, const Units&, double,
                                        const std::function<void(std::vector<FixedVec3>&)>&,
                                        const MomentumSource::MomentumVisitor&);

}  // namespace thalweg::coupling
