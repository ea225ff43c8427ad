#include "lbm/lattice/d3q19.hpp"
#include "lbm/lattice/equilibrium.hpp"
#include "lbm/lattice/populations.hpp"

#include <gtest/gtest.h>

namespace thalweg::lbm::lattice_test {
namespace {

// The isotropy of the lattice: sum w = 1, sum w c_a c_b = delta_ab/3, fourth moment (1/9)(dd + dd + dd).
TEST(D3Q19, WeightsHaveIsotropicMoments) {
  const auto delta = [](int a, int b) { return a == b ? 1.0 : 0.0; };
  double zeroth = 0.0;
  for (int i = 0; i < 19; ++i) zeroth += D3Q19::weight(i);
  EXPECT_NEAR(zeroth, 1.0, 1e-15);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      double second = 0.0;
      for (int i = 0; i < 19; ++i) second += D3Q19::weight(i) * D3Q19::c[i][a] * D3Q19::c[i][b];
      EXPECT_NEAR(second, delta(a, b) / 3.0, 1e-15);
      for (int c = 0; c < 3; ++c)
        for (int d = 0; d < 3; ++d) {
          double fourth = 0.0;
          for (int i = 0; i < 19; ++i)
            fourth += D3Q19::weight(i) * D3Q19::c[i][a] * D3Q19::c[i][b] * D3Q19::c[i][c] * D3Q19::c[i][d];
          EXPECT_NEAR(fourth, (delta(a, b) * delta(c, d) + delta(a, c) * delta(b, d) + delta(a, d) * delta(b, c)) / 9.0,
                      1e-15);
        }
    }
}

TEST(D3Q19, OppositesAndMirrorsAreInvolutions) {
  for (int i = 0; i < 19; ++i) {
    const int o = D3Q19::opposite(i);
    EXPECT_EQ(D3Q19::opposite(o), i);
    for (int a = 0; a < 3; ++a) {
      EXPECT_EQ(D3Q19::c[o][a], -D3Q19::c[i][a]);
      const int m = D3Q19::mirror(i, a);
      EXPECT_EQ(D3Q19::mirror(m, a), i);
      EXPECT_EQ(D3Q19::c[m][a], -D3Q19::c[i][a]);
    }
  }
}

TEST(Equilibrium, CarriesDensityMomentumAndStress) {
  const double deviation = 0.03;
  const Vec3 u(0.04, -0.02, 0.05);
  double density = 0.0;
  Vec3 momentum = Vec3::Zero();
  double xy = 0.0, xx = 0.0;
  for (int i = 0; i < 19; ++i) {
    const double f = equilibrium_deviation(i, deviation, u);
    density += f;
    for (int a = 0; a < 3; ++a) momentum[a] += D3Q19::c[i][a] * f;
    xy += D3Q19::c[i][0] * D3Q19::c[i][1] * f;
    xx += D3Q19::c[i][0] * D3Q19::c[i][0] * f;
  }
  EXPECT_NEAR(density, deviation, 1e-15);
  EXPECT_NEAR((momentum - (1.0 + deviation) * u).norm(), 0.0, 1e-15);
  EXPECT_NEAR(xy, (1.0 + deviation) * u.x() * u.y(), 1e-15);
  EXPECT_NEAR(xx, deviation / 3.0 + (1.0 + deviation) * u.x() * u.x(), 1e-15);
}

// Each of the 19 slots that a sweep of a cell reads is a slot it writes, and no two cells share one.
TEST(Populations, SlotsOfTheTwoArrangementsBelongToOneCell) {
  Populations<double> p(CellIndexing({5, 4, 3}, 4));
  const std::ptrdiff_t cell = p.indexing().index(2, 2, 1);
  for (const Arrangement arrangement : {Arrangement::swapped, Arrangement::moved}) {
    p.set_arrangement(arrangement);
    for (int i = 0; i < 19; ++i) {
      // f_i that arrives at a cell is what the cell upstream holds as its post-collision f_i.
      const std::ptrdiff_t upstream = cell - p.indexing().offset(i);
      EXPECT_EQ(&p.incoming(i, cell), &p.post_collision(i, upstream));
    }
  }
}

}  // namespace
}  // namespace thalweg::lbm::lattice_test
