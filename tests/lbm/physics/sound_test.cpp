// Standing sound waves: their speed and their damping by shear and bulk viscosity, for every collision; and that flows
// without sound know nothing of the bulk viscosity.
#include "core/base/error.hpp"
#include "tests/lbm/channel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace thalweg::lbm::sound_test {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr CollisionModel models[] = {CollisionModel::bgk, CollisionModel::trt, CollisionModel::trt_at_bodies};

// Growth and frequency of sound of wave number k. A viscous stress that relaxes in a time t answers a strain rate that
// varies as e^{st} with its viscosity over 1 + s t (Maxwell); on the lattice t = tau - 1/2. Momentum and mass give
//   s^2 + s k^2 [4/3 nu/(1 + s (tau - 1/2)) + zeta/(1 + s (tau_b - 1/2))] + k^2/3 = 0,
// for slow waves s = -(k^2/2)(4/3 nu + zeta) + i k/sqrt(3) (Landau and Lifshitz, Fluid Mechanics, section 79).
Complex growth_of_sound(double k, double tau, double tau_b) {
  const double shear = (tau - 0.5) / 3.0, bulk = 2.0 / 9.0 * (tau_b - 0.5);
  Complex s(0.0, k / std::sqrt(3.0));
  for (int n = 0; n < 200; ++n) {
    const Complex half = 0.5 * k * k * (4.0 / 3.0 * shear / (1.0 + s * (tau - 0.5)) + bulk / (1.0 + s * (tau_b - 0.5)));
    s = -half + Complex(0.0, 1.0) * std::sqrt(k * k / 3.0 - half * half);
  }
  return s;
}

// The same of the lattice. A damped oscillation obeys a(t + m) = p a(t) - q a(t - m) with p = 2 e^{-gm} cos(wm) and q =
// e^{-2gm}; the two are fitted to the density wave over two periods by least squares.
Complex measured_growth(CollisionModel model, double tau, double tau_b, int n) {
  const Decomposition decomposition({4, 4, n}, 1.0, {true, true, true}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.model = model;
  parameters.relaxation_time = tau;
  parameters.bulk_relaxation_time = tau_b;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, {});
  const double k = 2.0 * pi / n;
  fluid.initialise([&](const Vec3& p) { return FluidState{1e-6 * std::cos(k * p.z()), Vec3::Zero()}; });
  const int quarter = static_cast<int>(n * std::sqrt(3.0) / 4.0);
  for (int step = 0; step < 12 * quarter; ++step) fluid.advance();  // until the relaxing mode has died
  std::vector<double> wave;
  for (int step = 0; step < 8 * quarter; ++step) {
    fluid.advance();
    double sum = 0.0;
    for (int z = 0; z < n; ++z)
      sum += std::cos(k * (z + 0.5)) * fluid.state_at(fluid.indexing().index(1, 2, z)).density_deviation;
    wave.push_back(sum);
  }
  double xx = 0.0, xy = 0.0, yy = 0.0, xz = 0.0, yz = 0.0;
  for (std::size_t t = quarter; t + quarter < wave.size(); ++t) {
    const double x = wave[t], y = -wave[t - quarter], z = wave[t + quarter];
    xx += x * x, xy += x * y, yy += y * y, xz += x * z, yz += y * z;
  }
  const double determinant = xx * yy - xy * xy, p = (xz * yy - yz * xy) / determinant,
               q = (yz * xx - xz * xy) / determinant;
  return {0.5 * std::log(q) / quarter, std::acos(0.5 * p / std::sqrt(q)) / quarter};
}

// On 96 cells the lattice's own error is of relative order k^2 = 0.4 % in the speed and in the damping; the latter also
// feels that third-order moments carry the trace along, which is of the same order at tau = 0.8, where they relax in
// less than a step. With tau_b = 30 the stress hardly follows the wave any more, which runs a fifth faster.
TEST(Sound, IsDampedByShearAndBulkViscosity) {
  constexpr int n = 96;
  const double k = 2.0 * pi / n, tau = 0.8;
  for (const CollisionModel model : models)
    for (const double tau_b : {0.0, 0.6, 1.0, 3.0, 10.0, 30.0}) {
      const Complex expected = growth_of_sound(k, tau, tau_b > 0.0 ? tau_b : tau);
      const Complex found = measured_growth(model, tau, tau_b, n);
      EXPECT_NEAR(found.imag() / expected.imag(), 1.0, k * k) << int(model) << ", tau_b " << tau_b;
      EXPECT_NEAR(found.real() / expected.real(), 1.0, 2.0 * k * k) << int(model) << ", tau_b " << tau_b;
    }
}

// A slow wave: the damping is that of the textbook, (k^2/2)(4/3 nu + zeta), up to the relaxation's own (w tau_b)^2 =
// 0.2 %.
TEST(Sound, IsDampedAsTextbooksSay) {
  constexpr int n = 192;
  const double k = 2.0 * pi / n, tau = 0.6, tau_b = 3.0;
  const double rate = 0.5 * k * k * (4.0 / 3.0 * (tau - 0.5) / 3.0 + 2.0 / 9.0 * (tau_b - 0.5));
  for (const CollisionModel model : models)
    EXPECT_NEAR(-measured_growth(model, tau, tau_b, n).real() / rate, 1.0, 0.01) << int(model);
}

// Flow between plates under a force is the parabola of Poiseuille, with the walls' own error of the collision, whatever
// the bulk viscosity: it has no divergence. The stress of compression it sees is of the order of the square of the
// velocity, 1e-6 here, and goes with the pressure.
TEST(BulkViscosity, LeavesPoiseuilleFlowAsItIs) {
  for (const CollisionModel model : models) {
    Channel channel;
    channel.height = 12;
    channel.collision.model = model;
    channel.collision.relaxation_time = 0.8;
    channel.collision.force[0] = 1e-3 * 8.0 * 0.1 / (12.0 * 12.0);  // 1e-3 cells a step in the middle
    channel.low.type = channel.high.type = FaceType::no_slip;
    const std::vector<double> before = velocity_across(channel, 6000);
    for (const double tau_b : {1.0, 10.0, 100.0}) {
      channel.collision.bulk_relaxation_time = tau_b;
      const std::vector<double> now = velocity_across(channel, 6000);
      for (std::size_t z = 0; z < now.size(); ++z)
        EXPECT_NEAR(now[z], before[z], 1e-6 * 1e-3) << int(model) << ", tau_b " << tau_b;
    }
  }
}

TEST(BulkViscosity, NeedsARelaxationTimeAboveOneHalf) {
  const Decomposition decomposition({4, 4, 4}, 1.0, {true, true, true}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.bulk_relaxation_time = 0.5;
  EXPECT_THROW(Fluid<double>(decomposition, MPI_COMM_SELF, parameters, {}), InputError);
}

}  // namespace
}  // namespace thalweg::lbm::sound_test
