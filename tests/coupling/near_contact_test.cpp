// Patches of a grain's surface that other grains hide: the paper's links there, and what they are good for.
#include "coupling/hidden_links.hpp"

#include "core/mpi_session.hpp"
#include "lbm/equilibrium.hpp"
#include "lbm/fluid.hpp"
#include "tests/coupling/water_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

namespace thalweg::coupling::near_contact_test {
namespace {

using lbm::D3Q19;

struct Sphere {
  Vec3 centre, velocity, spin;
  double radius;
};

struct Load {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
};

// By definition: every lattice line from a cell of one sphere into a cell of another, distances by bisection.
std::vector<Load> loads_by_definition(const std::vector<Sphere>& spheres, const Index3& cells, bool galilean) {
  const auto from = [&](const Vec3& p, const Sphere& s) {
    Vec3 d = p - s.centre;
    for (int a = 0; a < 3; ++a) d[a] -= cells[a] * std::round(d[a] / cells[a]);
    return d;
  };
  const auto owner = [&](const Vec3& p) {
    for (std::size_t s = 0; s < spheres.size(); ++s)
      if (from(p, spheres[s]).norm() < spheres[s].radius) return static_cast<int>(s);
    return -1;
  };
  const auto motion = [&](const Vec3& p, int s) {
    return Vec3(spheres[s].velocity + spheres[s].spin.cross(from(p, spheres[s])));
  };
  std::vector<Load> loads(spheres.size());
  for (int z = 0; z < cells[2]; ++z)
    for (int y = 0; y < cells[1]; ++y)
      for (int x = 0; x < cells[0]; ++x)
        for (int i = 1; i < 19; ++i) {
          const Vec3 at(x + 0.5, y + 0.5, z + 0.5), c(D3Q19::c[i][0], D3Q19::c[i][1], D3Q19::c[i][2]);
          const int q = owner(at), p = owner(at + c);
          if (q < 0 || p < 0 || p == q) continue;
          double low = 0.0, high = 1.0;
          for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (low + high);
            (from(at + middle * c, spheres[p]).norm() < spheres[p].radius ? high : low) = middle;
          }
          const double delta = high, weight = D3Q19::weight(i);
          const int back = D3Q19::opposite(i);
          const Vec3 wall = motion(at + delta * c, p);
          const double incident = lbm::equilibrium_deviation(i, 0.0, motion(at, q));
          const double returned =
              delta < 0.5
                  ? 2 * delta * incident + (1 - 2 * delta) * lbm::equilibrium_deviation(i, 0.0, motion(at - c, q)) -
                        6 * weight * c.dot(wall)
                  : incident / (2 * delta) +
                        (1 - 1 / (2 * delta)) * lbm::equilibrium_deviation(back, 0.0, motion(at, q)) -
                        3 / delta * weight * c.dot(wall);
          Vec3 momentum = (incident + returned) * c;
          if (galilean) momentum -= (incident - returned) * wall;
          loads[p].force += momentum;
          loads[p].torque += from(at + delta * c, spheres[p]).cross(momentum);
        }
  return loads;
}

class HiddenLinksTest : public ::testing::TestWithParam<lbm::MomentumExchange> {};

// Touching and overlapping spheres, one pair across the periodic faces. Fixed-point sums: 2^-45 a link.
TEST_P(HiddenLinksTest, CarryWhatTheDefinitionSaysOnAnyRanks) {
  const Index3 cells{16, 14, 12};
  const std::vector<Sphere> spheres{{Vec3(0.6, 7.1, 5.2), Vec3(0.03, -0.01, 0.02), Vec3(0.002, 0.004, -0.003), 3.0},
                                    {Vec3(6.3, 6.3, 5.9), Vec3(-0.02, 0.02, 0.01), Vec3(-0.005, 0.001, 0.002), 3.1},
                                    {Vec3(11.9, 9.4, 4.6), Vec3(0.01, 0.03, -0.04), Vec3(0.001, -0.002, 0.006), 3.2}};
  const Decomposition decomposition(cells, 1.0, {true, true, true},
                                    Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD)));
  lbm::Fluid<double> fluid(decomposition, MPI_COMM_WORLD, {}, {});
  GrainMap map(decomposition, fluid.block(), fluid.cells());
  HiddenLinkOptions options;
  options.moving = true;
  HiddenLinks links(decomposition, fluid.block(), fluid.cells(), options, GetParam());
  std::vector<lbm::LinkBody> bodies(spheres.size());
  map.begin_update();
  for (std::size_t s = 0; s < spheres.size(); ++s) {
    map.place(map.add(static_cast<GlobalId>(s), {spheres[s].radius}), spheres[s].centre);
    bodies[s].centre = spheres[s].centre;
    bodies[s].velocity = spheres[s].velocity;
    bodies[s].angular_velocity = spheres[s].spin;
  }
  map.settle();
  links.update(map);
  links.apply(map.shapes(), bodies, nullptr);
  const auto expected = loads_by_definition(spheres, cells, GetParam() == lbm::MomentumExchange::galilean_invariant);
  EXPECT_GT(sum_over_ranks(MPI_COMM_WORLD, static_cast<std::int64_t>(links.count())), 40);
  for (std::size_t s = 0; s < spheres.size(); ++s)
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(sum_over_ranks(MPI_COMM_WORLD, bodies[s].force.to_vec3()[a]), expected[s].force[a], 1e-11);
      EXPECT_NEAR(sum_over_ranks(MPI_COMM_WORLD, bodies[s].torque.to_vec3()[a]), expected[s].torque[a], 1e-11);
    }
}

INSTANTIATE_TEST_SUITE_P(BothExchanges, HiddenLinksTest,
                         ::testing::Values(lbm::MomentumExchange::galilean_invariant,
                                           lbm::MomentumExchange::classical));

// Grains that touch, moving along with the fluid. The weights taken out of every link leave no false attraction at
// rest, but of a moving fluid the dynamic pressure, of the order of rho U^2 on the hidden patches; with the paper's
// links nothing is left but round-off.
TEST(NearContact, GrainsThatDriftTogetherFeelNothingWithThePapersLinks) {
  for (const bool paper : {false, true})
    for (const lbm::MomentumExchange exchange :
         {lbm::MomentumExchange::galilean_invariant, lbm::MomentumExchange::classical}) {
      WaterBox box;
      box.viscosity = 2e-5;
      box.smagorinsky_constant = 0.0;
      box.links.momentum_exchange = exchange;
      box.paper_near_contact = paper;
      const Vec3 velocity(0.35, -0.21, 0.13);
      box.fluid_velocity = velocity;
      const Vec3 first(0.0251, 0.0007, 0.0096);
      box.seeds = {glass_sphere(0, first, velocity), glass_sphere(1, first + Vec3(-3.6e-3, 3.5e-3, 0.0), velocity),
                   glass_sphere(2, first + Vec3(-3.5e-3, 1.0e-3, 4.3e-3), velocity)};
      for (dem::GrainSeed& seed : box.seeds) seed.motion = dem::Motion::fixed;
      const auto system =
          make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
      const double scale = 0.5 * 1000.0 * velocity.squaredNorm() * std::numbers::pi * std::pow(2.5e-3, 2);
      double largest = 0.0;
      for (int step = 0; step < 60; ++step) {
        system->advance();
        const dem::GrainStore& store = system->grains().store();
        for (std::size_t g = 0; g < store.owned; ++g) largest = std::max(largest, store.load_force[g].norm() / scale);
      }
      largest = max_over_ranks(MPI_COMM_WORLD, largest);
      if (paper) {
        EXPECT_LT(largest, 1e-10);
      } else {
        EXPECT_GT(largest, 1e-3);
        EXPECT_LT(largest, 1.0);
      }
    }
}

}  // namespace
}  // namespace thalweg::coupling::near_contact_test
