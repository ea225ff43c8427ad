// A uniform stream near tau = 1/2: disturbances the size of a cell grow or die as the eigenvalues of the linearised
// step say, which depends on the bulk relaxation time.
#include "lbm/fluid/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace thalweg::lbm::stream_test {
namespace {

constexpr int side = 16;          // cells of the periodic box
constexpr int averaged = 500;     // steps
constexpr double excess = 0.003;  // tau - 1/2 of water on a coarse lattice with its subgrid viscosity

// Growth a step of the disturbances of a stream along x between two numbers of steps.
double growth(double speed, double bulk_relaxation_time, int from, int to) {
  const Decomposition decomposition({side, side, side}, 1.0, {true, true, true}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = 0.5 + excess;
  parameters.bulk_relaxation_time = bulk_relaxation_time;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, {});
  std::mt19937 bits(1);
  const auto noise = [&] { return 1e-12 * (static_cast<double>(bits()) / 0x1p31 - 1.0); };
  fluid.initialise([&](const Vec3&) { return FluidState{0.0, Vec3(speed + noise(), noise(), noise())}; });
  const auto size = [&] {
    double sum = 0.0;
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
          sum += (fluid.state_at(fluid.indexing().index(x, y, z)).velocity - Vec3(speed, 0, 0)).squaredNorm();
    return sum;
  };
  const auto advance = [&](int steps) {
    for (int step = 0; step < steps; ++step) fluid.advance();
  };
  // A standing wave swings, so squares are averaged over many steps.
  const auto average = [&] {
    double sum = 0.0;
    for (int n = 0; n < averaged; ++n, advance(1)) sum += size();
    return sum;
  };
  advance(from);
  const double before = average();
  advance(to - from - averaged);
  return 0.5 * std::log(average() / before) / (to - from);
}

// The largest eigenvalue over all waves of this box (benchmarks/lattice/linear_stability.py, which shares no code with
// the library) is 1.0043072, that of the wave (8, 8, 3); after 3000 steps it has outgrown the noise of the others.
TEST(Stream, GrowsUnstableWithALargeBulkViscosityAsTheEigenvaluesSay) {
  EXPECT_NEAR(growth(0.14, 3.0, 3000, 5000), std::log(1.0043072), 0.01 * 0.0043072);
}

// No eigenvalue is beyond 1 in the same stream with the default, nor in a slower one with three steps.
TEST(Stream, StaysCalmWithTheBulkViscosityOfCasesWithGrains) {
  EXPECT_LT(growth(0.14, 1.0, 500, 2500), 0.0);
  EXPECT_LT(growth(0.10, 3.0, 500, 2500), 0.0);
}

}  // namespace
}  // namespace thalweg::lbm::stream_test
