// trt_at_bodies in a cell near a body: trt where the cell is calm, bgk where it is noisy, and both of them in between.
#include "lbm/collision/collision.hpp"
#include "tests/lbm/collision_formulas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace thalweg::lbm::trt_at_bodies_test {
namespace {

constexpr SubgridModel qr = SubgridModel::qr;

// Cells beside bodies, in a gap and not.
struct Location {
  double in_gap, lambda;
  int power;
};
constexpr Location places[] = {{0.0, quiet, 4}, {1.0, quiet_in_gaps, 2}};

CollisionParameters water() {
  CollisionParameters p;
  p.relaxation_time = 0.502;
  p.bulk_relaxation_time = 1.0;
  p.subgrid = Subgrid::qr();
  // The odd part of a steady cell is off equilibrium by half the force, times 0.12: here 4e-4 of `quiet` or less.
  p.force[0] = 3e-3 * quiet;
  p.force[1] = -2e-3 * quiet;
  p.force[2] = 1e-3 * quiet;
  return p;
}

// A cell with this odd non-equilibrium, but for the force's, in modes that have no momentum, beside a deviation of the
// even part.
void fill_with_odd_part(double (&f)[19], double size) {
  fill_noisy(f, 5, 1e-4);
  const CollisionParameters p = water();
  const WrittenOut w(f, p);
  for (int i = 1; i < 19; i += 2) {
    const int o = D3Q19::opposite(i);
    const double odd = 0.5 * (f[i] - f[o]) - 0.5 * (w.equilibrium[i] - w.equilibrium[o]);
    f[i] -= odd;
    f[o] += odd;
  }
  // Along each axis 2 on the axis and -1/2 on the four diagonals that lean towards it: momentum 2 2 - 4 2/2 = 0.
  double mode[19];
  double squares = 0.0;
  for (int i = 0; i < 19; ++i) {
    const double towards = D3Q19::c[i][0] + 0.4 * D3Q19::c[i][1] - 0.7 * D3Q19::c[i][2];
    mode[i] = D3Q19::length_squared(i) == 1 ? 2.0 * towards : -0.5 * towards;
    squares += 0.5 * mode[i] * mode[i];
  }
  for (int i = 0; i < 19; ++i) f[i] += size / std::sqrt(squares) * mode[i];
}

using Cell = std::array<double, 19>;

template <CollisionModel model, bool with_bulk>
Cell after(const double (&f)[19], const CollisionParameters& p) {
  double g[19];
  std::copy(f, f + 19, g);
  collide<model, qr, with_bulk>(g, p);
  return std::to_array(g);
}

double largest_difference(const Cell& a, const Cell& b) {
  double largest = 0.0;
  for (int i = 0; i < 19; ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

Cell after_at_bodies(const double (&f)[19], const CollisionParameters& p, double in_gap) {
  const CollisionConstants<double> constants(p);
  const CellMoments<double> m = moments_of<qr, true>(f, constants);
  double g[19];
  std::copy(f, f + 19, g);
  relax_trt_at_bodies<true>(g, m, constants, calmness_of(f, m, constants, in_gap));
  return std::to_array(g);
}

// Collisions of a cell: trt whose trace relaxes as the shear, bgk with a bulk relaxation time of its own, and what is
// between them.
struct Both {
  Cell trt, bgk, blend;

  Both(const double (&f)[19], const Location& place)
      : trt(after<CollisionModel::trt, false>(f, water())),
        bgk(after<CollisionModel::bgk, true>(f, water())),
        blend(after_at_bodies(f, water(), place.in_gap)) {}
};

TEST(TrtAtBodies, IsTrtInCalmCellsAndLeavesTheTraceToTheShear) {
  for (const Location& place : places) {
    double f[19];
    fill_with_odd_part(f, 1e-3 * place.lambda);
    const Both both(f, place);
    EXPECT_LT(largest_difference(both.blend, both.trt), 3e-6 * largest_difference(both.trt, both.bgk) + 1e-16);
    EXPECT_GT(largest_difference(both.trt, both.bgk), 1e-6);
    EXPECT_GT(largest_difference(both.trt, after<CollisionModel::trt, true>(f, water())), 1e-6);
  }
}

TEST(TrtAtBodies, IsBgkWithItsBulkViscosityInNoisyCells) {
  for (const Location& place : places) {
    double f[19];
    fill_with_odd_part(f, 1e3 * place.lambda);
    const Both both(f, place);
    EXPECT_LT(largest_difference(both.blend, both.bgk), 2e-6 * largest_difference(both.trt, both.bgk));
  }
}

// The odd rate and the bulk term both enter a collision linearly: with a = 1/[(n/lambda)^p + 1], p = 2 in a gap and 4
// elsewhere, it is a times trt and 1 - a times bgk.
TEST(TrtAtBodies, IsBetweenThemAsItsFormulaSays) {
  for (const Location& place : places)
    for (const double times_quiet : {0.1, 0.5, 1.0, 2.0, 10.0}) {
      double f[19];
      fill_with_odd_part(f, times_quiet * place.lambda);
      const double n = WrittenOut(f, water()).odd_non_equilibrium(f) / place.lambda,
                   a = 1.0 / (std::pow(n, place.power) + 1.0);
      EXPECT_NEAR(n, times_quiet, 1e-3 + 0.01 * times_quiet);
      const Both both(f, place);
      for (int i = 0; i < 19; ++i)
        EXPECT_NEAR(both.blend[i], a * both.trt[i] + (1.0 - a) * both.bgk[i], 1e-15 * (1.0 + times_quiet));
    }
}

TEST(TrtAtBodies, ConservesMassAndAddsTheForceHoweverNoisy) {
  const CollisionParameters p = water();
  for (const Location& place : places)
    for (const double times_quiet : {0.0, 0.3, 1.0, 3.0}) {
      double f[19], g[19];
      fill_with_odd_part(f, times_quiet * place.lambda);
      const Cell after = after_at_bodies(f, p, place.in_gap);
      std::copy(after.begin(), after.end(), g);
      const Sums before = sums_of(f), now = sums_of(g);
      EXPECT_NEAR(now.density, before.density, 2e-16);
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(now.momentum[axis] - before.momentum[axis], p.force[axis], 2e-16);
    }
}

// A calmness of zero, which cells have that are far from bodies.
TEST(TrtAtBodies, IsBgkInTheOpen) {
  const CollisionParameters p = water();
  const CollisionConstants<double> constants(p);
  for (const double times_quiet : {0.0, 1.0}) {
    double f[19], g[19];
    fill_with_odd_part(f, times_quiet * quiet);
    std::copy(f, f + 19, g);
    relax_trt_at_bodies<true>(g, moments_of<qr, true>(f, constants), constants, 0.0);
    EXPECT_LT(largest_difference(std::to_array(g), after<CollisionModel::bgk, true>(f, p)), 1e-16);
  }
}

}  // namespace
}  // namespace thalweg::lbm::trt_at_bodies_test
