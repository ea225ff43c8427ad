#include "coupling/loads/momentum_budget.hpp"

#include "core/base/check.hpp"
#include "core/geometry/symmetric_pairs.hpp"
#include "core/sums/wide_sums_over_ranks.hpp"
#include "lbm/fluid/flow_fields.hpp"
#include "lbm/lattice/for_each_cell.hpp"

namespace thalweg::coupling {

namespace {

// A cell's share of a plane's sums, which are wide: planes may have any number of cells.
using CellSum = FixedPoint<40>;

// Columns of a plane of cells.
enum Column { cells, density = 1, flow = 2, flow_flux = 5, viscous = 11, subgrid = 17, columns = 23 };

void add(double term, WideSum& sum) { sum.add(CellSum::from(term)); }

void add_stress(const lbm::Symmetric<double>& s, WideSum* into) {
  const double components[6] = {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz};
  for (int p = 0; p < 6; ++p) add(components[p], into[p]);
}

void add_cell(const lbm::MomentumFlux& flux, WideSum* sums) {
  const Vec3& u = flux.velocity;
  sums[cells].add(1);
  add(flux.density, sums[density]);
  for (int a = 0; a < 3; ++a) add(flux.density * u[a], sums[flow + a]);
  for (int p = 0; p < 6; ++p)
    add(flux.density * u[symmetric_pairs[p][0]] * u[symmetric_pairs[p][1]], sums[flow_flux + p]);
  add_stress(flux.viscous, sums + viscous);
  add_stress(flux.subgrid, sums + subgrid);
}

PlaneMomentum in_si(const WideSum* sums, const Units& units) {
  const auto sum = [&](std::size_t column) { return sums[column].to_double(CellSum::bits); };
  PlaneMomentum plane;
  plane.cells = sums[cells].narrowed();
  plane.density = sum(density) * units.density;
  for (int a = 0; a < 3; ++a)
    plane.flow[a] = sum(flow + static_cast<std::size_t>(a)) * units.density * units.velocity();
  for (std::size_t p = 0; p < 6; ++p) {
    plane.flow_flux[p] = sum(flow_flux + p) * units.stress();
    plane.viscous[p] = sum(viscous + p) * units.stress();
    plane.subgrid[p] = sum(subgrid + p) * units.stress();
  }
  return plane;
}

template <typename Real>
std::vector<PlaneMomentum> planes_of(const lbm::Fluid<Real>& fluid, const Units& units) {
  const Index3& from = fluid.block().lower;
  const int planes = fluid.decomposition().cells()[2];
  std::vector<WideSum> sums(static_cast<std::size_t>(planes * columns));
  lbm::for_each_fluid_cell(fluid.cells(), [&](std::ptrdiff_t, const Index3& at) {
    add_cell(lbm::momentum_flux(fluid, at), &sums[(from[2] + at[2]) * columns]);
  });
  sum_over_ranks(fluid.communicator(), sums);
  std::vector<PlaneMomentum> all;
  for (int z = 0; z < planes; ++z) all.push_back(in_si(&sums[static_cast<std::size_t>(z * columns)], units));
  return all;
}

// entries: of a block, 2 n_z + 1 by half planes.
template <typename Real>
std::vector<Vec3> over_ranks(const std::vector<FixedVec3>& entries, const lbm::Fluid<Real>& fluid, double unit) {
  const auto first = static_cast<std::size_t>(2 * fluid.block().lower[2]),
             all = static_cast<std::size_t>(2 * fluid.decomposition().cells()[2] + 1);
  std::vector<FixedVec3> mine(all);
  std::copy(entries.begin(), entries.end(), mine.begin() + static_cast<std::ptrdiff_t>(first));
  std::vector<Vec3> sums = vectors_over_ranks(fluid.communicator(), mine);
  for (Vec3& sum : sums) sum *= unit;
  return sums;
}

}  // namespace

template <typename Real>
MomentumBudget momentum_budget_of(lbm::Fluid<Real>& fluid, const Units& units, double reference,
                                  const bodies::MomentumByHeight& given) {
  CHECK(given.on_grains.size() == static_cast<std::size_t>(2 * fluid.indexing().size()[2] + 1));
  MomentumBudget budget;
  budget.planes = planes_of(fluid, units);
  budget.on_grains = over_ranks(given.on_grains, fluid, units.force());
  budget.on_solids = over_ranks(given.on_solids, fluid, units.force());
  if (!given.on_obstacles.empty()) budget.on_obstacles = over_ranks(given.on_obstacles, fluid, units.force());
  std::vector<FixedVec3> on_sides(given.on_grains.size());
  budget.on_top = fluid.wall_forces(reference, &on_sides)[5] * units.force();
  budget.on_sides = over_ranks(on_sides, fluid, units.force());
  budget.driving = fluid.parameters().force * (units.stress() / units.spacing);
  return budget;
}

template MomentumBudget momentum_budget_of(lbm::Fluid<float>&, const Units&, double, const bodies::MomentumByHeight&);
template MomentumBudget momentum_budget_of(lbm::Fluid<double>&, const Units&, double, const bodies::MomentumByHeight&);

}  // namespace thalweg::coupling
