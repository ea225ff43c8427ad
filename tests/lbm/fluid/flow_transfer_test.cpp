// The flow of one lattice on another, finer or coarser, on any number of ranks.
#include "lbm/fluid/flow_transfer.hpp"
#include "core/parallel/mpi_session.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::lbm::flow_transfer_test {
namespace {

// Periodic along x and y, walls across z: where a fraction s of the box is reached.
using Flow = FluidState (*)(const Vec3& s);

const FaceConditions between_plates{{{}, {}, {}, {}, {FaceType::no_slip}, {FaceType::no_slip}}};

class Lattice {
public:
  explicit Lattice(const Index3& cells)
      : decomposition_(cells, 1.0, {true, true, false}, Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD))),
        fluid_(decomposition_, MPI_COMM_WORLD, {}, between_plates) {}

  Fluid<double>& fluid() { return fluid_; }

  void set(Flow flow) {
    fluid_.initialise([&](const Vec3& centre) { return flow(fraction(centre)); });
  }
  test::MemoryArchive saved() const { return test::saved(fluid_, MPI_COMM_WORLD); }
  // The largest differences of velocity and density from a flow.
  std::array<double, 2> differences(Flow flow) const {
    double velocity = 0.0, density = 0.0;
    const Index3& n = fluid_.indexing().size();
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y)
        for (int x = 0; x < n[0]; ++x) {
          const Index3& lower = fluid_.block().lower;
          const FluidState there = fluid_.state_at(fluid_.indexing().index(x, y, z)),
                           right = flow(fraction(Vec3(lower[0] + x + 0.5, lower[1] + y + 0.5, lower[2] + z + 0.5)));
          velocity = std::max(velocity, (there.velocity - right.velocity).norm());
          density = std::max(density, std::abs(there.density_deviation - right.density_deviation));
        }
    return {max_over_ranks(MPI_COMM_WORLD, velocity), max_over_ranks(MPI_COMM_WORLD, density)};
  }

private:
  Vec3 fraction(const Vec3& centre) const {
    const Index3& n = decomposition_.cells();
    return {centre.x() / n[0], centre.y() / n[1], centre.z() / n[2]};
  }

  Decomposition decomposition_;
  Fluid<double> fluid_;
};

constexpr double two_pi = 2.0 * std::numbers::pi;

FluidState waves(const Vec3& s) {
  const double a = two_pi * s.x(), b = two_pi * s.y(), c = std::numbers::pi * s.z();
  return {0.01 * std::cos(a) * std::cos(c),
          0.05 * Vec3(std::sin(a) * std::cos(b), std::cos(b), std::sin(b) * std::cos(c))};
}

FluidState waves_twice_as_fast(const Vec3& s) {
  const FluidState slow = waves(s);
  return {4.0 * slow.density_deviation, 2.0 * slow.velocity};
}

// A profile linear across the walls is met exactly between the outermost centres of the saved cells.
FluidState shear(const Vec3& s) { return {0.001, Vec3(0.05 * s.z(), 0.0, 0.0)}; }

TEST(FlowTransfer, IsOfSecondOrder) {
  // Linear interpolation between points h apart misses at most h^2/8 times the second derivative, along each axis.
  // Populations of another lattice are divided by a density that is interpolated, too: of higher order here, hence 1.1.
  double last = 0.0;
  for (const int coarser : {2, 1}) {
    Lattice source({24 / coarser, 16 / coarser, 20 / coarser}), target({30, 26, 35});
    source.set(waves);
    const test::MemoryArchive archive = source.saved();
    test::MemoryReader reader(archive);
    transfer_flow(target.fluid(), reader, 2.0);
    const auto [velocity, density] = target.differences(waves_twice_as_fast);
    const double kx = two_pi * coarser / 24, ky = two_pi * coarser / 16, kz = std::numbers::pi * coarser / 20;
    // Beyond the last centres of z, half a cell, a cosine that is level at the walls is taken as constant: h^2/8 again.
    const double curvature = (kx * kx + ky * ky + kz * kz) / 8.0;
    EXPECT_LT(velocity, 1.1 * curvature * 0.1 * std::sqrt(3.0));
    EXPECT_LT(density, 1.1 * curvature * 0.04);
    if (last > 0.0) {
      EXPECT_GT(last / velocity, 3.0);
    }
    last = velocity;
  }
}

TEST(FlowTransfer, MeetsShearExactlyAndStaysLevelNextToWalls) {
  for (const Index3& cells : {Index3{7, 8, 13}, Index3{12, 9, 40}}) {
    Lattice source({8, 6, 20}), target(cells);
    source.set(shear);
    const test::MemoryArchive archive = source.saved();
    test::MemoryReader reader(archive);
    transfer_flow(target.fluid(), reader, 1.0);
    const auto [velocity, density] = target.differences(
        [](const Vec3& s) { return shear(Vec3(s.x(), s.y(), std::clamp(s.z(), 0.5 / 20.0, 19.5 / 20.0))); });
    EXPECT_LT(velocity, 1e-14);
    EXPECT_LT(density, 1e-14);
  }
}

// The force of the saved flow is not known, so that all of it counts, not half.
TEST(FlowTransfer, BeginsHalfAForceTooFast) {
  const FluidState uniform{0.25, Vec3(0.03, 0.0, 0.01)};
  const Vec3 force(2e-3, 0.0, 0.0);
  Lattice source({8, 6, 20}), target({12, 9, 40});
  source.fluid().set_force(force);
  source.fluid().carry_force();
  source.fluid().initialise([&](const Vec3&) { return uniform; });
  const test::MemoryArchive archive = source.saved();
  test::MemoryReader reader(archive);
  transfer_flow(target.fluid(), reader, 1.0);
  const auto [velocity, density] = target.differences([](const Vec3&) { return FluidState{0.25, {0.03, 0.0, 0.01}}; });
  EXPECT_NEAR(velocity, 2e-3 / (2.0 * 1.25), 1e-14);
  EXPECT_LT(density, 1e-14);
}

TEST(FlowTransfer, IsTheSameOnEveryNumberOfRanks) {
  Lattice source({24, 16, 20}), target({30, 26, 35});
  source.set(waves);
  const test::MemoryArchive archive = source.saved();
  test::MemoryReader reader(archive);
  transfer_flow(target.fluid(), reader, 0.7);
  const Decomposition whole({30, 26, 35}, 1.0, {true, true, false}, {1, 1, 1});
  Fluid<double> alone(whole, MPI_COMM_SELF, {}, between_plates);
  test::MemoryReader again(archive);
  transfer_flow(alone, again, 0.7);
  const test::MemoryArchive of_one = test::saved(alone, MPI_COMM_SELF);
  EXPECT_EQ(test::first_difference(target.saved(), of_one), "");
}

}  // namespace
}  // namespace thalweg::lbm::flow_transfer_test
