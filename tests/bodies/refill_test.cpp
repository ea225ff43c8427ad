// The populations of a cell that a grain has uncovered, in a fluid whose populations are known.
#include "bodies/refill.hpp"

#include "bodies/links/link_builder.hpp"
#include "bodies/map/body_map.hpp"
#include "core/parallel/mpi_session.hpp"
#include "lbm/lattice/equilibrium.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::bodies::refill_test {
namespace {

using lbm::D3Q19;

// Half the force, which is in populations after a collision.
double half_force(int i, const Vec3& force) {
  return 1.5 * D3Q19::weight(i) *
         (D3Q19::c[i][0] * force.x() + D3Q19::c[i][1] * force.y() + D3Q19::c[i][2] * force.z());
}

Vec3 flow(const Index3& cell) { return {0.02 + 1e-3 * cell[2], -0.01 + 5e-4 * cell[0], 3e-4 * cell[1]}; }
double density(const Index3& cell) { return 1e-3 * cell[0] - 4e-4 * cell[1] + 2e-4 * cell[2]; }

// A sphere of 3 cells goes from `before` to where `body` is, and the cells that it leaves are filled.
RefillTotals move_sphere(lbm::Fluid<double>& fluid, const Decomposition& decomposition, MPI_Comm communicator,
                         const Hydrostatic& rest, const Vec3& before, const LinkBody& body) {
  BodyMap map(decomposition, fluid.block(), fluid.cells());
  map.begin_update();
  const BodySlot slot = map.add(0, 3.0);
  map.remap(slot, before);
  map.settle();
  map.begin_update();
  map.remap(slot, body.centre);
  const std::vector<CellChange> changes = map.settle();
  std::vector<LinkBody> bodies{body};
  const std::vector<double> surrounding(1, 0.0);
  return Refill(decomposition, communicator).fill(fluid, changes, rest, surrounding, bodies);
}

LinkBody body_at(const Vec3& centre) {
  LinkBody body;
  body.centre = centre;
  return body;
}

lbm::FaceConditions floor_and_top() {
  lbm::FaceConditions faces;
  faces[4].type = faces[5].type = lbm::FaceType::no_slip;
  return faces;
}

class UncoveredCells : public ::testing::Test {
protected:
  const Decomposition upright_{{16, 16, 16}, 1.0, {true, true, false}, {1, 1, 1}};  // between floor and top
};

// A sphere of 3 cells moves on by 0.8 cells. Every cell it leaves has neighbours on many ranks and across a periodic
// face. The density is the mean over the neighbours that were fluid before, to round-off of the fixed-point
// sums (2^-45 a neighbour).
TEST_F(UncoveredCells, HaveTheMeanDensityOfTheirNeighboursAndTheVelocityOfTheBody) {
  const Index3 cells{16, 16, 16};
  const std::array<bool, 3> periodic{true, true, true};
  const Decomposition decomposition(cells, 1.0, periodic, Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD)));
  lbm::CollisionParameters parameters;
  parameters.force[0] = 2e-4;
  parameters.force[2] = -1e-4;
  const Vec3 force(2e-4, 0.0, -1e-4);
  lbm::Fluid<double> fluid(decomposition, MPI_COMM_WORLD, parameters, {});
  const Index3 n = fluid.indexing().size(), from = fluid.block().lower;
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const Index3 global{from[0] + x, from[1] + y, from[2] + z};
        for (int i = 0; i < 19; ++i)
          fluid.populations().post_collision(i, fluid.indexing().index(x, y, z)) =
              lbm::equilibrium_deviation(i, density(global), flow(global)) + half_force(i, force);
      }
  const Vec3 before(7.9, 15.7, 8.1), after(8.6, 15.9, 7.8);
  LinkBody body = body_at(after);
  body.velocity = Vec3(0.7, 0.2, -0.3) * 0.05;
  body.angular_velocity = Vec3(0.001, -0.002, 0.003);
  const RefillTotals totals = move_sphere(fluid, decomposition, MPI_COMM_WORLD, {}, before, body);

  // The plain answer, from global coordinates.
  const auto offset = [&](const Index3& cell, const Vec3& centre) {
    Vec3 d = Vec3(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5) - centre;
    for (int a = 0; a < 3; ++a) d[a] -= cells[a] * std::round(d[a] / cells[a]);
    return d;
  };
  const auto inside = [&](const Index3& cell, const Vec3& centre) { return offset(cell, centre).norm() < 3.0; };
  std::int64_t filled = 0;
  Vec3 momentum = Vec3::Zero();
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const Index3 cell{from[0] + x, from[1] + y, from[2] + z};
        if (!inside(cell, before) || inside(cell, after)) continue;
        ++filled;
        const Vec3 velocity = body.velocity + body.angular_velocity.cross(offset(cell, after));
        double mean = 0.0;
        int count = 0;
        for (int i = 1; i < 19; ++i) {
          Index3 next;
          for (int a = 0; a < 3; ++a) next[a] = (cell[a] + D3Q19::c[i][a] + cells[a]) % cells[a];
          if (inside(next, before) || inside(next, after)) continue;
          mean += density(next);
          ++count;
        }
        if (count > 0) mean /= count;
        for (int i = 0; i < 19; ++i) {
          const double expected = lbm::equilibrium_deviation(i, mean, velocity) + half_force(i, force);
          const double value = fluid.populations().post_collision(i, fluid.indexing().index(x, y, z));
          ASSERT_NEAR(value, expected, 1e-12) << cell[0] << " " << cell[1] << " " << cell[2] << " direction " << i;
          for (int a = 0; a < 3; ++a) momentum[a] += D3Q19::c[i][a] * value;
        }
      }
  EXPECT_EQ(totals.cells, filled);
  EXPECT_NEAR((totals.momentum - momentum).norm(), 0.0, 1e-12);
  EXPECT_GT(sum_over_ranks(MPI_COMM_WORLD, filled), 20);
}

// A sphere that is taken away leaves cells whose neighbours it had covered as well. Nothing around them tells their
// density, which is that at rest.
TEST_F(UncoveredCells, WithoutFluidBesideThemHaveTheDensityAtRest) {
  lbm::Fluid<double> fluid(upright_, MPI_COMM_SELF, {}, floor_and_top());
  const Hydrostatic rest{Vec3(0.0, 0.0, -3e-4), Vec3(8.0, 8.0, 8.0)};
  move_sphere(fluid, upright_, MPI_COMM_SELF, rest, Vec3(4.5, 8.5, 4.5), body_at(Vec3(11.5, 8.5, 11.5)));
  double density = 0.0;
  for (int i = 0; i < 19; ++i) density += fluid.populations().post_collision(i, fluid.indexing().index(4, 8, 4));
  EXPECT_NEAR(density, 3e-4 * 3.5, 1e-15);
}

// Under its full weight water at rest has another density at every height. A cell with more fluid below than above it
// still gets that of its own, and no mass is brought.
TEST_F(UncoveredCells, HaveTheDensityOfTheirHeightInWaterAtRest) {
  lbm::CollisionParameters parameters;
  parameters.force[2] = -1e-4;
  lbm::Fluid<double> fluid(upright_, MPI_COMM_SELF, parameters, floor_and_top());
  const Hydrostatic rest = hydrostatic_under(Vec3(0.0, 0.0, -1e-4), upright_);
  fluid.initialise([&](const Vec3& position) { return lbm::FluidState{rest.deviation(position), Vec3::Zero()}; });
  const RefillTotals totals =
      move_sphere(fluid, upright_, MPI_COMM_SELF, rest, Vec3(8.3, 8.5, 7.6), body_at(Vec3(8.1, 8.6, 8.5)));
  ASSERT_GT(totals.cells, 10);
  // Exact to the rounding of the mean over at most 18 neighbours and of 19 populations.
  EXPECT_NEAR(LatticeFixed::to_double(totals.mass), 0.0, static_cast<double>(totals.cells) * 0x1p-44);
}

}  // namespace
}  // namespace thalweg::bodies::refill_test
