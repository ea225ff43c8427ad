// Taylor-Green vortices in a periodic box: the viscosity the lattice delivers, and the order of its error.
#include "lbm/fluid/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::lbm::decay_test {
namespace {

// Runs u = U (-cos kx sin ky, sin kx cos ky) e^{-2 nu k^2 t} for a time of 1/(2 nu k^2); returns the relative L2 error
// of the velocity. Diffusive scaling: U falls as 1/n so that the Mach number error is second order, too.
double error_at(int n, double bulk_relaxation_time = 0.0) {
  const Decomposition decomposition({n, n, 4}, 1.0, {true, true, true}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = 0.8;
  parameters.bulk_relaxation_time = bulk_relaxation_time;
  const double nu = (parameters.relaxation_time - 0.5) / 3.0, k = 2.0 * std::numbers::pi / n, speed = 0.64 / n;
  const int steps = static_cast<int>(std::lround(1.0 / (2.0 * nu * k * k)));
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, {});
  const auto exact = [&](const Vec3& p, double t) {
    const double decay = std::exp(-2.0 * nu * k * k * t);
    return Vec3(-speed * std::cos(k * p.x()) * std::sin(k * p.y()) * decay,
                speed * std::sin(k * p.x()) * std::cos(k * p.y()) * decay, 0.0);
  };
  fluid.initialise([&](const Vec3& p) {
    const double pressure = -0.25 * speed * speed * (std::cos(2.0 * k * p.x()) + std::cos(2.0 * k * p.y()));
    return FluidState{3.0 * pressure, exact(p, 0.0)};
  });
  for (int step = 0; step < steps; ++step) fluid.advance();
  double error = 0.0, norm = 0.0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const Vec3 u = fluid.state_at(fluid.indexing().index(x, y, 1)).velocity;
      const Vec3 e = exact(Vec3(x + 0.5, y + 0.5, 1.5), steps);
      error += (u - e).squaredNorm();
      norm += e.squaredNorm();
    }
  return std::sqrt(error / norm);
}

TEST(TaylorGreen, ErrorFallsWithTheSquareOfTheSpacing) {
  const double coarse = error_at(16), middle = error_at(32), fine = error_at(64);
  EXPECT_NEAR(std::log2(coarse / middle), 2.0, 0.2);
  EXPECT_NEAR(std::log2(middle / fine), 2.0, 0.1);
  // Terms of k^2 = (2 pi/64)^2 in the viscosity, with factors well below one, and of the Mach number squared, 3e-4.
  EXPECT_LT(fine, 2e-3);
}

// The same with a large bulk viscosity, which a flow without divergence does not feel.
TEST(TaylorGreen, IsOfSecondOrderWithABulkViscosityOfItsOwn) {
  const double middle = error_at(32, 10.0), fine = error_at(64, 10.0);
  EXPECT_NEAR(std::log2(middle / fine), 2.0, 0.2);
  EXPECT_LT(fine, 2e-3);
}

// A uniform force in a periodic box: u = F t exactly, with the half force counted.
TEST(BodyForce, AcceleratesUniformly) {
  const Decomposition decomposition({8, 6, 5}, 1.0, {true, true, true}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = 0.51;
  parameters.subgrid = Subgrid::smagorinsky(0.2);
  parameters.force[0] = 1e-6;
  parameters.force[2] = -2e-6;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, {});
  for (int step = 0; step < 1000; ++step) fluid.advance();
  const FluidState s = fluid.state_at(fluid.indexing().index(3, 2, 4));
  // The n-th collision sees the force of n - 1 whole steps and its own half.
  EXPECT_NEAR(s.velocity.x(), 1e-6 * (1000 - 0.5), 1e-15);
  EXPECT_NEAR(s.velocity.z(), -2e-6 * (1000 - 0.5), 1e-15);
  EXPECT_NEAR(s.velocity.y(), 0.0, 1e-16);
}

}  // namespace
}  // namespace thalweg::lbm::decay_test
