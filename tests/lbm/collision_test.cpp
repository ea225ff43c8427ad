#include "lbm/collision.hpp"
#include "lbm/equilibrium.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace thalweg::lbm {
namespace {

struct Moments {
  double density = 0.0;
  Vec3 momentum = Vec3::Zero();
};

Moments moments_of(const double (&f)[19]) {
  Moments m;
  for (int i = 0; i < 19; ++i) {
    m.density += f[i];
    for (int a = 0; a < 3; ++a) m.momentum[a] += D3Q19::c[i][a] * f[i];
  }
  return m;
}

class Collision : public ::testing::Test {
protected:
  void SetUp() override {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> noise(-0.002, 0.002);
    const Vec3 velocity(0.05, -0.03, 0.02);
    for (int i = 0; i < 19; ++i) f[i] = equilibrium_deviation(i, 0.01, velocity) + noise(generator);
    parameters.relaxation_time = 0.52;
    parameters.force[0] = 3e-4;
    parameters.force[1] = -2e-4;
    parameters.force[2] = 1e-4;
  }
  double f[19];
  CollisionParameters parameters;
};

TEST_F(Collision, ConservesMassAndAddsExactlyTheForce) {
  const Moments before = moments_of(f);
  collide<false>(f, parameters);
  const Moments after = moments_of(f);
  EXPECT_NEAR(after.density, before.density, 1e-16);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(after.momentum[a] - before.momentum[a], parameters.force[a], 1e-16);
}

// The pairwise evaluation against the formula as it stands in the literature, term by term.
TEST_F(Collision, AgreesWithTheFormulaWrittenOut) {
  const Moments m = moments_of(f);
  const double rho = 1.0 + m.density;
  const Vec3 force(parameters.force[0], parameters.force[1], parameters.force[2]);
  const Vec3 u = (m.momentum + 0.5 * force) / rho;
  double pi[3][3] = {}, q = 0.0;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      for (int i = 0; i < 19; ++i)
        pi[a][b] += D3Q19::c[i][a] * D3Q19::c[i][b] * (f[i] - equilibrium_deviation(i, m.density, u));
      pi[a][b] += 0.5 * (u[a] * force[b] + u[b] * force[a]);
      q += pi[a][b] * pi[a][b];
    }
  q = std::sqrt(q);
  parameters.smagorinsky_constant = 0.27;
  const double tau0 = parameters.relaxation_time, cs2 = 0.27 * 0.27;
  const double tau = 0.5 * (tau0 + std::sqrt(tau0 * tau0 + 18.0 * std::sqrt(2.0) * cs2 * q / rho));
  // tau = tau_0 + 3 C_s^2 |S| with |S| = sqrt(2 S:S) = sqrt(2) 3 Q/(2 rho tau): the closed form solves its own equation.
  EXPECT_NEAR(tau - tau0, 3.0 * cs2 * std::sqrt(2.0) * 3.0 * q / (2.0 * rho * tau), 1e-15);

  double expected[19];
  for (int i = 0; i < 19; ++i) {
    const Vec3 c(D3Q19::c[i][0], D3Q19::c[i][1], D3Q19::c[i][2]);
    const double guo = (1.0 - 0.5 / tau) * D3Q19::weight(i) * (3.0 * (c - u).dot(force) + 9.0 * c.dot(u) * c.dot(force));
    expected[i] = f[i] - (f[i] - equilibrium_deviation(i, m.density, u)) / tau + guo;
  }
  const CellStress<double> stress = collide<true>(f, parameters);
  for (int i = 0; i < 19; ++i) EXPECT_NEAR(f[i], expected[i], 1e-15);
  EXPECT_NEAR(stress.xy, pi[0][1], 1e-15);
  EXPECT_NEAR(stress.xz, pi[0][2], 1e-15);
  EXPECT_NEAR(stress.yz, pi[1][2], 1e-15);
  EXPECT_NEAR(stress.inverse_rho_tau, 1.0 / (rho * tau), 1e-14);
}

}  // namespace
}  // namespace thalweg::lbm
