#include "lbm/collision/collision.hpp"

#include "tests/lbm/collision_formulas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace thalweg::lbm::collision_test {
namespace {

class Collision : public ::testing::Test {
protected:
  void SetUp() override {
    fill_noisy(f, 3);
    parameters.relaxation_time = 0.52;
    parameters.force[0] = 3e-4;
    parameters.force[1] = -2e-4;
    parameters.force[2] = 1e-4;
  }
  double f[19];
  CollisionParameters parameters;
};

template <CollisionModel model>
void expect_conservation(double (&f)[19], const CollisionParameters& parameters) {
  const Sums before = sums_of(f);
  collide<model, SubgridModel::smagorinsky>(f, parameters);
  const Sums after = sums_of(f);
  EXPECT_NEAR(after.density, before.density, 1e-16);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(after.momentum[a] - before.momentum[a], parameters.force[a], 1e-16);
}

// Exact to a few units in the last place of populations of the order of 0.05.
TEST_F(Collision, ConservesMassAndAddsExactlyTheForce) {
  parameters.subgrid = Subgrid::smagorinsky(0.2);
  expect_conservation<CollisionModel::bgk>(f, parameters);
  expect_conservation<CollisionModel::trt>(f, parameters);
  expect_conservation<CollisionModel::trt_at_bodies>(f, parameters);
}

TEST_F(Collision, MomentsAgreeWithTheFormulasWrittenOut) {
  parameters.subgrid = Subgrid::smagorinsky(0.27);
  const WrittenOut w(f, parameters);
  const CellMoments<double> m = moments_of<SubgridModel::smagorinsky>(f, CollisionConstants<double>(parameters));
  EXPECT_NEAR(m.pi.xx, w.pi(0, 0), 1e-15);
  EXPECT_NEAR(m.pi.yy, w.pi(1, 1), 1e-15);
  EXPECT_NEAR(m.pi.zz, w.pi(2, 2), 1e-15);
  EXPECT_NEAR(m.pi.xy, w.pi(0, 1), 1e-15);
  EXPECT_NEAR(m.pi.xz, w.pi(0, 2), 1e-15);
  EXPECT_NEAR(m.pi.yz, w.pi(1, 2), 1e-15);
  EXPECT_NEAR(m.omega, 1.0 / w.tau, 1e-15);
  // tau = tau_0 + 3 C_s^2 |S| with |S| = sqrt(2 S:S) = sqrt(2) 3 Q/(2 rho tau): the closed form solves its own
  // equation.
  const double cs2 = 0.27 * 0.27;
  EXPECT_NEAR(1.0 / m.omega - parameters.relaxation_time,
              3.0 * cs2 * std::sqrt(2.0) * 3.0 * w.pi.norm() / (2.0 * (1.0 + w.deviation) * w.tau), 1e-15);
}

TEST_F(Collision, BgkAgreesWithTheFormulaWrittenOut) {
  for (const double cs : {0.0, 0.27}) {
    parameters.subgrid = Subgrid::smagorinsky(cs);
    const WrittenOut w(f, parameters);
    double g[19];
    std::copy(f, f + 19, g);
    if (cs > 0.0)
      collide<CollisionModel::bgk, SubgridModel::smagorinsky>(g, parameters);
    else
      collide<CollisionModel::bgk, SubgridModel::none>(g, parameters);
    for (int i = 0; i < 19; ++i)
      EXPECT_NEAR(g[i], f[i] - (f[i] - w.equilibrium[i]) / w.tau + (1.0 - 0.5 / w.tau) * w.guo[i], 1e-15);
  }
}

TEST_F(Collision, TrtAgreesWithTheFormulaWrittenOut) {
  parameters.subgrid = Subgrid::smagorinsky(0.27);
  parameters.magic_parameter = 0.21;
  const WrittenOut w(f, parameters);
  const double even_rate = 1.0 / w.tau, odd_rate = 1.0 / (0.5 + 0.21 / (w.tau - 0.5));
  double g[19];
  std::copy(f, f + 19, g);
  collide<CollisionModel::trt, SubgridModel::smagorinsky>(g, parameters);
  for (int i = 0; i < 19; ++i) {
    const int o = D3Q19::opposite(i);
    const auto even = [&](const double* v) { return 0.5 * (v[i] + v[o]); };
    const auto odd = [&](const double* v) { return 0.5 * (v[i] - v[o]); };
    const double expected = f[i] - even_rate * (even(f) - even(w.equilibrium)) -
                            odd_rate * (odd(f) - odd(w.equilibrium)) + (1.0 - 0.5 * even_rate) * even(w.guo) +
                            (1.0 - 0.5 * odd_rate) * odd(w.guo);
    EXPECT_NEAR(g[i], expected, 1e-15);
  }
}

// A bulk relaxation time of its own changes the trace of the second moment after the collision, which is the one of
// equilibrium and half force, u.F, and (1 - 1/tau_b) tr Pi; mass, momentum and all that has no trace stay.
template <CollisionModel model, SubgridModel subgrid>
void expect_only_the_trace_differs(const double (&f)[19], CollisionParameters parameters, double tau_b) {
  const WrittenOut w(f, parameters);
  double with[19], without[19];
  std::copy(f, f + 19, with);
  std::copy(f, f + 19, without);
  const double omega = collide<model, subgrid>(without, parameters).omega;
  parameters.bulk_relaxation_time = tau_b;
  // Both have the same rate, though not the same norm of Pi.
  parameters.subgrid = Subgrid::none();
  parameters.relaxation_time = 1.0 / omega;
  collide<model, SubgridModel::none, true>(with, parameters);
  const double trace = w.pi.trace();
  double change[3][3] = {};
  for (int i = 0; i < 19; ++i)
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) change[a][b] += D3Q19::c[i][a] * D3Q19::c[i][b] * (with[i] - without[i]);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(change[a][b], a == b ? (omega - 1.0 / tau_b) * trace / 3.0 : 0.0, 2e-16);
  const Sums before = sums_of(without), after = sums_of(with);
  EXPECT_NEAR(after.density, before.density, 1e-16);
  EXPECT_NEAR((after.momentum - before.momentum).norm(), 0.0, 1e-16);
  double equilibrium_trace = 0.0, after_trace = 0.0;
  for (int i = 1; i < 19; ++i) {
    equilibrium_trace += D3Q19::length_squared(i) * w.equilibrium[i];
    after_trace += D3Q19::length_squared(i) * with[i];
  }
  EXPECT_NEAR(after_trace, equilibrium_trace + w.u.dot(w.force) + (1.0 - 1.0 / tau_b) * trace, 2e-16);
}

TEST_F(Collision, ABulkRateOfItsOwnChangesTheTraceAlone) {
  for (const double tau_b : {0.51, 1.0, 30.0}) {
    parameters.subgrid = Subgrid::none();
    expect_only_the_trace_differs<CollisionModel::bgk, SubgridModel::none>(f, parameters, tau_b);
    expect_only_the_trace_differs<CollisionModel::trt, SubgridModel::none>(f, parameters, tau_b);
    parameters.subgrid = Subgrid::smagorinsky(0.27);
    expect_only_the_trace_differs<CollisionModel::bgk, SubgridModel::smagorinsky>(f, parameters, tau_b);
    expect_only_the_trace_differs<CollisionModel::trt, SubgridModel::smagorinsky>(f, parameters, tau_b);
    parameters.subgrid = Subgrid::qr();
    expect_only_the_trace_differs<CollisionModel::bgk, SubgridModel::qr>(f, parameters, tau_b);
    expect_only_the_trace_differs<CollisionModel::trt, SubgridModel::qr>(f, parameters, tau_b);
  }
}

// The subgrid model sees the part of Pi without its trace: tau as in the header, with that norm.
TEST_F(Collision, ALongLivedTraceRaisesNoEddyViscosity) {
  parameters.subgrid = Subgrid::smagorinsky(0.27);
  parameters.bulk_relaxation_time = 30.0;
  const WrittenOut w(f, parameters);
  const double trace = w.pi.trace(), tau0 = parameters.relaxation_time;
  const double shear = std::sqrt(w.pi.squaredNorm() - trace * trace / 3.0);
  const double tau =
      0.5 * (tau0 + std::sqrt(tau0 * tau0 + 18.0 * std::sqrt(2.0) * 0.27 * 0.27 * shear / (1.0 + w.deviation)));
  const CellMoments<double> m = moments_of<SubgridModel::smagorinsky, true>(f, CollisionConstants<double>(parameters));
  EXPECT_NEAR(1.0 / m.omega, tau, 1e-15);
}

// A cell that is compressed alike from all sides has no shear: its norm is zero up to rounding, never the root of a
// number below zero.
TEST_F(Collision, PureCompressionRaisesNoEddyViscosity) {
  parameters.subgrid = Subgrid::smagorinsky(0.27);
  parameters.bulk_relaxation_time = 30.0;
  for (int a = 0; a < 3; ++a) parameters.force[a] = 0.0;
  const CollisionConstants<float> constants(parameters);
  for (int n = 1; n <= 100; ++n) {
    float compressed[19];
    for (int i = 0; i < 19; ++i)
      compressed[i] = static_cast<float>(1e-4 * n * 1.5 * D3Q19::weight(i) * (D3Q19::length_squared(i) - 1));
    EXPECT_NEAR(1.0F / (moments_of<SubgridModel::smagorinsky, true>(compressed, constants).omega),
                parameters.relaxation_time, 1e-6);
  }
}

}  // namespace
}  // namespace thalweg::lbm::collision_test
