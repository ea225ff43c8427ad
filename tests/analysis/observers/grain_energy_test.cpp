#include "analysis/observers/grain_energy.hpp"

#include "tests/analysis/made_up_grains.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

namespace thalweg::analysis::grain_energy_test {
namespace {

TEST(GrainEnergy, SumsMotionAndSpinOfSpheres) {
  // 2 kg, R = 1/2 m: I = 0.2 kg m^2. Speed 3 m/s: 9 J; spin 10 rad/s: 10 J. Every second grain goes the other way.
  const MadeUpGrains grains(MPI_COMM_WORLD, 101, [](GlobalId id) {
    const double sign = id % 2 == 0 ? 1.0 : -1.0;
    return MadeUpGrain{0.5, 2.0, sign * Vec3(1.0, 2.0, -2.0), Vec3(0.0, 6.0, 8.0)};
  });
  GrainEnergy energy(MPI_COMM_WORLD);
  energy.observe(grains.snapshot(0.0));
  EXPECT_NEAR(value_of(energy.diagnostics(), "grain_kinetic_energy"), 101 * 19.0, 101 * 19.0 * 1e-15);
  EXPECT_EQ(value_of(energy.diagnostics(), "grain_momentum_x"), 2.0);  // one grain more goes forward: m v, exact
  EXPECT_EQ(value_of(energy.diagnostics(), "grain_momentum_y"), 4.0);
  EXPECT_EQ(value_of(energy.diagnostics(), "grain_momentum_z"), -4.0);
  // A run that goes on from its last step does not measure again.
  GrainEnergy restarted(MPI_COMM_WORLD);
  test::load(restarted, test::saved(energy, MPI_COMM_WORLD));
  EXPECT_EQ(value_of(restarted.diagnostics(), "grain_kinetic_energy"),
            value_of(energy.diagnostics(), "grain_kinetic_energy"));
  EXPECT_EQ(value_of(restarted.diagnostics(), "grain_momentum_z"), -4.0);
}

TEST(GrainEnergy, TakesAClumpForOneGrain) {
  // Three spheres as above and five members, whose mass is that of their clump: 7 kg at 2 m/s, 30 J.
  MadeUpGrains grains(MPI_COMM_WORLD, 8, [](GlobalId id) {
    return MadeUpGrain{0.5, id < 3 ? 2.0 : 7.0, Vec3(1.0, 2.0, -2.0), Vec3(0.0, 6.0, 8.0)};
  });
  grains.bind(5, {3, 7.0, 1.0, Vec3::Zero(), Vec3(0.0, 0.0, 2.0), 30.0});
  GrainEnergy energy(MPI_COMM_WORLD);
  energy.observe(grains.snapshot(0.0));
  EXPECT_NEAR(value_of(energy.diagnostics(), "grain_kinetic_energy"), 3 * 19.0 + 30.0, 87.0 * 1e-15);
  EXPECT_EQ(value_of(energy.diagnostics(), "grain_momentum_x"), 6.0);
  EXPECT_EQ(value_of(energy.diagnostics(), "grain_momentum_z"), -12.0 + 14.0);
  EXPECT_EQ(grains.snapshot(0.0).grains.body_count(), 4);
}

}  // namespace
}  // namespace thalweg::analysis::grain_energy_test
