// Flows that oscillate, decay or travel, against their exact solutions.
#include "lbm/fluid/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace thalweg::lbm::wave_test {
namespace {

using std::numbers::pi;

// A shear wave u = b + a e sin(k.x), e normal to k, decays as exp(-nu k^2 t) and travels with the background velocity
// b: its complex amplitude at time t over the one at the start is exp(-nu k^2 t - i k.b t), whatever the direction of
// k.
struct ShearWave {
  Index3 waves;  // wave numbers in a box of 32 cells
  Vec3 shear;    // e, a unit vector
  Vec3 background;
};

std::complex<double> amplitude(const Fluid<double>& fluid, const ShearWave& wave, const Vec3& k, int n) {
  std::complex<double> sum = 0.0;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const Vec3 p(x + 0.5, y + 0.5, z + 0.5);
        const Vec3 u = fluid.state_at(fluid.indexing().index(x, y, z)).velocity;
        sum += u.dot(wave.shear) * std::exp(std::complex<double>(0.0, -k.dot(p)));
      }
  return sum;
}

// Effective viscosity over the true one, and speed of travel over k.b (1 if there is no background).
std::pair<double, double> viscosity_and_speed(const ShearWave& wave, CollisionModel model, double tau) {
  constexpr int n = 32, steps = 100;
  const Decomposition decomposition({n, n, n}, 1.0, {true, true, true}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.model = model;
  parameters.relaxation_time = tau;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, {});
  const Vec3 k = 2.0 * pi / n * Vec3(wave.waves[0], wave.waves[1], wave.waves[2]);
  fluid.initialise([&](const Vec3& p) {
    return FluidState{0.0, wave.background + 1e-3 * std::sin(k.dot(p)) * wave.shear};
  });
  for (int step = 0; step < 20; ++step) fluid.advance();  // until the stress belongs to the velocity
  const std::complex<double> first = amplitude(fluid, wave, k, n);
  for (int step = 0; step < steps; ++step) fluid.advance();
  const std::complex<double> ratio = amplitude(fluid, wave, k, n) / first;
  const double nu = (tau - 0.5) / 3.0, travelled = k.dot(wave.background) * steps;
  return {-std::log(std::abs(ratio)) / (nu * k.squaredNorm() * steps),
          travelled == 0.0 ? 1.0 : -std::arg(ratio) / travelled};
}

// Isotropy: the same viscosity in any direction, up to the fourth-order error of the lattice, relative size k^2/12,
// which is 1.6 % for the shortest of these waves.
TEST(ShearWave, DecaysWithTheViscosityInAnyDirection) {
  const ShearWave waves[] = {{{1, 0, 0}, Vec3(0, 1, 0), Vec3::Zero()},
                             {{0, 1, 0}, Vec3(0, 0, 1), Vec3::Zero()},
                             {{1, 1, 0}, Vec3(1, -1, 0).normalized(), Vec3::Zero()},
                             {{1, 1, 0}, Vec3(0, 0, 1), Vec3::Zero()},
                             {{1, 1, 1}, Vec3(1, -1, 0).normalized(), Vec3::Zero()},
                             {{2, 1, 0}, Vec3(1, -2, 0).normalized(), Vec3::Zero()}};
  for (const CollisionModel model : {CollisionModel::bgk, CollisionModel::trt, CollisionModel::trt_at_bodies})
    for (const ShearWave& wave : waves)
      EXPECT_NEAR(viscosity_and_speed(wave, model, 0.8).first, 1.0, 0.02)
          << int(model) << " " << wave.waves[0] << wave.waves[1] << wave.waves[2];
}

// Galilean invariance: a background velocity b changes the viscosity of the quadratic equilibrium by a relative amount
// of -3 b^2 along the wave vector (Qian and Zhou 1998) on top of the above: 3 % at b = 0.1; and the wave travels with
// b.
TEST(ShearWave, TravelsWithTheBackgroundAndKeepsItsViscosity) {
  for (const CollisionModel model : {CollisionModel::bgk, CollisionModel::trt}) {
    const ShearWave along{{1, 0, 0}, Vec3(0, 1, 0), Vec3(0.1, 0, 0)}, across{{1, 0, 0}, Vec3(0, 1, 0), Vec3(0, 0, 0.1)};
    const auto [viscosity, speed] = viscosity_and_speed(along, model, 0.8);
    EXPECT_NEAR(viscosity, 1.0 - 3.0 * 0.01, 0.01) << int(model);
    EXPECT_NEAR(speed, 1.0, 0.01) << int(model);
    EXPECT_NEAR(viscosity_and_speed(across, model, 0.8).first, 1.0, 0.01) << int(model);
  }
}

// A standing sound wave of length L oscillates with the period L sqrt(3) (c_s = 1/sqrt 3), here with so little damping
// (relative frequency shift (nu k/c_s)^2 below 1e-4) that the zero crossings tell the speed; the lattice disperses
// sound by k^2 of order 0.2 % at 48 cells.
TEST(Sound, TravelsAtOneOverTheRootOfThree) {
  constexpr int n = 48;
  for (const int axis : {0, 1, 2}) {
    Index3 cells{4, 4, 4};
    cells[axis] = n;
    const Decomposition decomposition(cells, 1.0, {true, true, true}, {1, 1, 1});
    CollisionParameters parameters;
    parameters.relaxation_time = 0.53;
    Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, {});
    const double k = 2.0 * pi / n;
    fluid.initialise([&](const Vec3& p) { return FluidState{1e-4 * std::cos(k * p[axis]), Vec3::Zero()}; });
    const auto density = [&] {
      Index3 at{1, 1, 1};
      double sum = 0.0;
      for (at[axis] = 0; at[axis] < n; ++at[axis])
        sum += std::cos(k * (at[axis] + 0.5)) *
               fluid.state_at(fluid.indexing().index(at[0], at[1], at[2])).density_deviation;
      return sum;
    };
    std::vector<double> crossings;
    double last = density();
    for (int step = 1; crossings.size() < 9; ++step) {
      fluid.advance();
      const double now = density();
      if (last * now < 0.0) crossings.push_back(step - now / (now - last));
      last = now;
      ASSERT_LT(step, 2000);
    }
    const double period = (crossings.back() - crossings.front()) / 4.0;  // two crossings a period
    EXPECT_NEAR(n / period, 1.0 / std::sqrt(3.0), 0.005 / std::sqrt(3.0));
  }
}

// Womersley flow between plates: with the force G cos(w t) the velocity is Re{ i G/w [cosh(q y)/cosh(q h/2) - 1]
// e^{iwt} }, q = sqrt(i w/nu), y from the middle; here at the Womersley number h/2 sqrt(w/nu) = 4.
TEST(Womersley, AgreesWithinOnePerCent) {
  constexpr int h = 40;
  const double half = h / 2.0, tau = 0.9, nu = (tau - 0.5) / 3.0, omega = nu * 16.0 / (half * half), force = 1e-6;
  const Decomposition decomposition({4, h, 4}, 1.0, {true, false, true}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = tau;
  FaceConditions faces;
  faces[2].type = faces[3].type = FaceType::no_slip;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
  using Complex = std::complex<double>;
  const Complex i(0.0, 1.0), q = std::sqrt(i * omega / nu);
  const auto exact = [&](double y, double t) {
    return (i * force / omega * (std::cosh(q * y) / std::cosh(q * half) - 1.0) * std::exp(i * omega * t)).real();
  };
  const double period = 2.0 * pi / omega;
  const int steps = static_cast<int>(std::lround(6.0 * period));
  double error = 0.0, norm = 0.0;
  for (int step = 0; step < steps; ++step) {
    fluid.set_force(Vec3(force * std::cos(omega * step), 0.0, 0.0));
    fluid.advance();
    if (step < steps - static_cast<int>(period) || step % 50 != 0) continue;
    for (int k = 0; k < h; ++k) {
      const double u = fluid.state_at(fluid.indexing().index(1, k, 1)).velocity.x(), e = exact(k + 0.5 - half, step);
      error += (u - e) * (u - e);
      norm += e * e;
    }
  }
  EXPECT_LT(std::sqrt(error / norm), 0.01);
  EXPECT_GT(norm, 0.0);
}

}  // namespace
}  // namespace thalweg::lbm::wave_test
