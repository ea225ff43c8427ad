// Grains in thin water at a short step: nothing in it may make them shake.
#include "core/parallel/mpi_session.hpp"
#include "tests/coupling/water_box.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::coupling::calm_bed_test {
namespace {

// Let go at rest in a slot two diameters wide, at a fifth of the step that a free grain would need: sound between the
// grains is hardly damped at tau - 1/2 = 9e-5.
WaterBox slot(LoadAveraging load) {
  WaterBox box;
  box.cells = {24, 13, 40};
  box.periodic = {true, true, false};
  box.spacing = 0.8e-3;
  box.time_step = 2e-5;
  box.gravity = Vec3(0.0, 0.0, -9.8);
  box.sub_steps = 10;
  box.load = load;
  for (int k = 0; k < 3 * 2 * 5; ++k)
    box.seeds.push_back(glass_sphere(k,
                                     Vec3(6.4e-3 * (k % 3) + 3.2e-3 + 2e-4 * (k / 6 % 2), 5.2e-3 * (k / 3 % 2) + 2.6e-3,
                                          5.6e-3 * (k / 6) + 3.3e-3 + 1e-4 * (k % 5)),
                                     Vec3::Zero(), 2.475e-3));
  return box;
}

struct Energy {
  double kinetic, released;  // J
};

Energy after(const WaterBox& box, int steps) {
  const auto system =
      make_system<float>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  const auto height = [&] {
    double sum = 0.0;
    for (const Vec3& x : system->snapshot().grains.position) sum += x.z();
    return sum_over_ranks(MPI_COMM_WORLD, sum);
  };
  const double start = height();
  for (int step = 0; step < steps; ++step) system->advance();
  const double submerged = 1550.0 * 9.8 * 4.0 / 3.0 * 3.14159265358979 * std::pow(2.475e-3, 3);
  return {system->grains().kinetic_energy(), submerged * (start - height())};
}

// Grains cannot have more energy than their weight has set free.
TEST(CalmBed, HasNoMoreEnergyThanItsWeightSetsFree) {
  const Energy energy = after(slot(LoadAveraging::extrapolated), 3000);
  EXPECT_GT(energy.released, 0.0);
  EXPECT_LT(energy.kinetic, energy.released);
}

// The published mean of two exchanges does not pass: the test above looks at what it should.
TEST(CalmBed, ShakesUnderTheMeanOfTwoExchanges) {
  const Energy energy = after(slot(LoadAveraging::mean), 3000);
  EXPECT_GT(energy.kinetic, energy.released);
}

}  // namespace
}  // namespace thalweg::coupling::calm_bed_test
