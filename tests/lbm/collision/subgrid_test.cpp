// Verstappen's QR model in a single cell, and in a flow whose rate of strain is known.
#include "lbm/collision/subgrid.hpp"

#include "lbm/collision/collision.hpp"
#include "lbm/fluid/flow_fields.hpp"
#include "lbm/fluid/fluid.hpp"
#include "tests/lbm/collision_formulas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <experimental/simd>
#include <numbers>

namespace thalweg::lbm::subgrid_test {
namespace {

using Matrix = Eigen::Matrix3d;

CollisionParameters thin_fluid() {
  CollisionParameters p;
  p.relaxation_time = 0.502;
  p.subgrid = Subgrid::qr();
  return p;
}

// nu_t of a rate of strain, as published (Verstappen 2011, with -det S/(S:S/2) = r/q).
double eddy_viscosity(const Matrix& strain) {
  const Matrix s = strain - strain.trace() / 3.0 * Matrix::Identity();
  return Subgrid::qr().constant() * std::max(0.0, -s.determinant()) / (0.5 * s.squaredNorm());
}

template <bool with_bulk = false>
double relaxation_time(const double (&f)[19], const CollisionParameters& p) {
  return 1.0 / moments_of<SubgridModel::qr, with_bulk>(f, CollisionConstants<double>(p)).omega;
}

// A cell at rest with this Pi and no other moment.
void fill_with(double (&f)[19], const Matrix& pi) {
  for (int i = 0; i < 19; ++i) {
    const Vec3 c(D3Q19::c[i][0], D3Q19::c[i][1], D3Q19::c[i][2]);
    f[i] = D3Q19::weight(i) * 4.5 * (c.dot(pi * c) - pi.trace() / 3.0);
  }
}

double relaxation_time_of(const Matrix& pi) {
  double f[19];
  fill_with(f, pi);
  return relaxation_time(f, thin_fluid());
}

// The closed form solves the equation that it comes from: nu_t follows from the S that follows from tau.
template <bool with_bulk>
void expect_closure(const double (&f)[19], const CollisionParameters& p, int& with_eddies) {
  const WrittenOut w(f, p);
  const double tau = relaxation_time<with_bulk>(f, p);
  const Matrix strain = -1.5 / ((1.0 + w.deviation) * tau) * w.pi;
  EXPECT_NEAR((tau - p.relaxation_time) / 3.0, eddy_viscosity(strain), 1e-15);
  with_eddies += tau > p.relaxation_time + 1e-6;
}

TEST(Qr, TheClosureSolvesItsOwnEquation) {
  int with_eddies = 0;
  constexpr int cells = 50;
  for (unsigned seed = 1; seed <= cells; ++seed) {
    double f[19];
    fill_noisy(f, seed);
    CollisionParameters p = thin_fluid();
    p.force[0] = 3e-4;
    expect_closure<false>(f, p, with_eddies);
    p.bulk_relaxation_time = 30.0;
    expect_closure<true>(f, p, with_eddies);
  }
  // Strain that pulls along one axis and strain that squeezes along one are equally frequent in noise.
  EXPECT_GT(with_eddies, cells / 2);
  EXPECT_LT(with_eddies, 3 * cells / 2);
}

// S = s diag(2, -1, -1) has -det S = -2 s^3 and S:S/2 = 3 s^2: eddies where fluid is squeezed along the axis, s < 0.
TEST(Qr, ActsWhereFluidIsSqueezedAlongOneAxis) {
  const double tau0 = thin_fluid().relaxation_time, s = 1e-3;
  const Matrix axial = Vec3(2.0, -1.0, -1.0).asDiagonal();
  const double eddies = Subgrid::qr().constant() * 2.0 / 3.0 * s, tau = tau0 + 3.0 * eddies;
  EXPECT_NEAR(relaxation_time_of(-2.0 / 3.0 * tau * -s * axial), tau, 1e-15);
  EXPECT_NEAR(relaxation_time_of(-2.0 / 3.0 * tau0 * s * axial), tau0, 1e-15);
}

// Exact to a rounding of the determinant, which enters tau times 9 C/(tau_0 rho) and some 1e-16 of Pi.
TEST(Qr, IsNothingInShearInTwoDimensionsAndAtRest) {
  const double tau0 = thin_fluid().relaxation_time;
  for (const double rate : {1e-6, 1e-3, 0.05}) {
    Matrix shear = Matrix::Zero(), plane = Matrix::Zero();
    shear(0, 2) = shear(2, 0) = rate;
    plane(0, 0) = 0.7 * rate;
    plane(2, 2) = -0.7 * rate;
    plane(0, 2) = plane(2, 0) = 0.4 * rate;
    EXPECT_NEAR(relaxation_time_of(shear), tau0, 1e-15);
    EXPECT_NEAR(relaxation_time_of(plane), tau0, 1e-15);
  }
  EXPECT_EQ(relaxation_time_of(Matrix::Zero()), tau0);
  EXPECT_EQ(Subgrid::qr().viscosity_in_shear(0.1), 0.0);
}

// Compression has no part in it, with a bulk relaxation time of its own and without.
TEST(Qr, SeesThePartWithoutTrace) {
  double f[19], compressed[19];
  for (unsigned seed = 1; seed <= 10; ++seed) {
    fill_noisy(f, seed);
    CollisionParameters p = thin_fluid();
    const double tau = relaxation_time(f, p);
    for (int i = 0; i < 19; ++i)
      compressed[i] = f[i] + 0.01 * 1.5 * D3Q19::weight(i) * (D3Q19::length_squared(i) - 1.0);
    EXPECT_NEAR(relaxation_time(compressed, p), tau, 1e-15);
    p.bulk_relaxation_time = 10.0;
    EXPECT_NEAR(relaxation_time<true>(f, p), tau, 1e-15);
    EXPECT_NEAR(relaxation_time<true>(compressed, p), tau, 1e-15);
  }
}

// Populations round to 3e-9 in single precision, Pi to some 1e-8, which enters tau times 9 C.
TEST(Qr, IsTheSameInSinglePrecisionAndInPacks) {
  using Pack = std::experimental::native_simd<double>;
  const CollisionParameters p = thin_fluid();
  const CollisionConstants<float> in_single(p);
  Pack lanes[19];
  for (std::size_t lane = 0; lane < Pack::size(); ++lane) {
    double f[19];
    float rounded[19];
    fill_noisy(f, static_cast<unsigned>(lane) + 1);
    for (int i = 0; i < 19; ++i) {
      rounded[i] = static_cast<float>(f[i]);
      lanes[i][lane] = f[i];
    }
    EXPECT_NEAR(1.0F / moments_of<SubgridModel::qr>(rounded, in_single).omega, relaxation_time(f, p), 5e-7);
  }
  const CollisionConstants<Pack> in_packs(p);
  const CellMoments<Pack> m = moments_of<SubgridModel::qr>(lanes, in_packs);
  for (std::size_t lane = 0; lane < Pack::size(); ++lane) {
    double f[19];
    fill_noisy(f, static_cast<unsigned>(lane) + 1);
    EXPECT_NEAR(1.0 / m.omega[lane], relaxation_time(f, p), 1e-15);
  }
  const float at_rest[19] = {};
  EXPECT_EQ(moments_of<SubgridModel::qr>(at_rest, in_single).omega, in_single.omega0);
}

// u = U (sin kz + cos ky, sin kx + cos kz, sin ky + cos kx) is its own vorticity over k, so that it decays with nu k^2
// and keeps its shape. Its strain has no normal components and is known; the lattice's own error is of relative order
// k^2, and so is what compression and the flow's own inertia add.
TEST(Qr, GivesTheEddyViscosityOfAKnownFlow) {
  constexpr int n = 24, steps = 30;
  const double k = 2.0 * std::numbers::pi / n, start = 0.02;
  const Decomposition decomposition({n, n, n}, 1.0, {true, true, true}, {1, 1, 1});
  CollisionParameters p;
  p.relaxation_time = 0.8;
  p.subgrid = Subgrid::qr();
  const auto velocity = [&](const Vec3& at) {
    const double x = k * at.x(), y = k * at.y(), z = k * at.z();
    return Vec3(std::sin(z) + std::cos(y), std::sin(x) + std::cos(z), std::sin(y) + std::cos(x));
  };
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, p, {});
  fluid.initialise([&](const Vec3& at) {
    const Vec3 u = start * velocity(at);
    return FluidState{1.5 * (3.0 * start * start - u.squaredNorm()), u};
  });
  for (int step = 0; step < steps; ++step) fluid.advance();
  fluid.exchange_halo();
  const double speed = start * std::exp(-(p.relaxation_time - 0.5) / 3.0 * k * k * steps);
  double largest = 0.0, deviation = 0.0;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const double a = k * (x + 0.5), b = k * (y + 0.5), c = k * (z + 0.5);
        Matrix strain = Matrix::Zero();
        strain(0, 1) = strain(1, 0) = 0.5 * speed * k * (std::cos(a) - std::sin(b));
        strain(0, 2) = strain(2, 0) = 0.5 * speed * k * (std::cos(c) - std::sin(a));
        strain(1, 2) = strain(2, 1) = 0.5 * speed * k * (std::cos(b) - std::sin(c));
        const double expected = strain.squaredNorm() > 0.0 ? eddy_viscosity(strain) : 0.0;
        const SubgridState state = subgrid_state(fluid, fluid.indexing().index(x, y, z));
        largest = std::max(largest, expected);
        deviation = std::max(deviation, std::abs(state.eddy_viscosity - expected));
      }
  EXPECT_LT(deviation, k * k * largest);
  EXPECT_GT(largest, 0.1 * Subgrid::qr().constant() * speed * k);
}

}  // namespace
}  // namespace thalweg::lbm::subgrid_test
