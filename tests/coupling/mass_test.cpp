// Drift of the fluid's mass where grains move, and taking it back.
#include "coupling/fluid_mass.hpp"

#include "core/mpi_session.hpp"
#include "tests/coupling/water_box.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::coupling {
namespace {

WaterBox moving_grains(int correction, bool full_gravity = false) {
  WaterBox box;
  box.cells = {24, 24, 32};
  box.periodic = {true, true, false};
  box.gravity = Vec3(0.5, 0.0, -9.8);
  box.mass_correction = correction;
  box.full_gravity = full_gravity;
  box.sub_steps = 20;
  for (int k = 0; k < 18; ++k)
    box.seeds.push_back(glass_sphere(
        k, Vec3(6.3e-3 * (k % 3) + 3.2e-3, 6.3e-3 * (k / 3 % 3) + 3e-3 + 1e-4 * k, 5.5e-3 * (k / 9) + 7e-3),
        Vec3(0.3 - 0.03 * k, 0.1, 0.02 * k - 0.2)));
  return box;
}

template <typename Real>
std::unique_ptr<ResolvedSystem<Real>> make(const WaterBox& box) {
  return make_system<Real>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
}

template <typename Real>
double drift_after(const WaterBox& box, int steps) {
  const auto system = make<Real>(box);
  for (int step = 0; step < steps; ++step) system->advance();
  for (const Figure& figure : system->figures())
    if (figure.name == "mean_density_deviation") return figure.value;
  return HUGE_VAL;
}

// A cell that changes hands brings or takes its deviation from the mean density, below 1e-2 here, and 1500 times in 200
// steps would in a random walk be 0.4 of 15000 cells; systematically 1e-3.
TEST(FluidMass, DriftsLittleAndIsHeldByTheCorrection) {
  for (const bool full : {false, true}) {
    const double drift = drift_after<double>(moving_grains(0, full), 201);
    EXPECT_LT(std::abs(drift), 1e-3);
    EXPECT_GT(std::abs(drift), 1e-9);
    // Corrected before the last step: what is left came in that step.
    EXPECT_LT(std::abs(drift_after<double>(moving_grains(25, full), 201)), 0.2 * std::abs(drift));
    EXPECT_LT(std::abs(drift_after<float>(moving_grains(25, full), 201)), 0.2 * std::abs(drift) + 1e-7);
  }
}

TEST(FluidMass, CorrectionGivesNoMomentum) {
  const Decomposition decomposition({12, 10, 8}, 1.0, {true, true, true},
                                    Decomposition::best_layout({12, 10, 8}, size_of(MPI_COMM_WORLD)));
  lbm::Fluid<double> fluid(decomposition, MPI_COMM_WORLD, {}, {});
  fluid.initialise([](const Vec3& p) {
    return lbm::FluidState{0.01 * std::sin(p.x()), Vec3(0.05 * std::sin(p.y()), 0.02, 0.01 * std::cos(p.z()))};
  });
  const lbm::FluidTotals before = fluid.totals();
  const double mean = mean_density_deviation(survey_of(fluid), {});
  EXPECT_NEAR(mean, before.mass_deviation / 960.0, 1e-15);
  add_density(fluid, -mean);
  const lbm::FluidTotals after = fluid.totals();
  EXPECT_NEAR(mean_density_deviation(survey_of(fluid), {}), 0.0, 1e-11);  // cells are summed to 2^-37
  EXPECT_NEAR((after.momentum - before.momentum).norm(), 0.0, 960.0 * 0x1p-36);
}

// The correction falls due by the count of steps, so a run continued from a checkpoint has the same bits.
TEST(FluidMass, CorrectionIsTheSameAfterARestart) {
  WaterBox box = moving_grains(20, true);
  box.refill = RefillRule::grad;
  box.grain_stress = true;
  box.paper_near_contact = true;
  const auto whole = make<float>(box), first = make<float>(box), second = make<float>(box);
  test::MemoryArchive half, end, continued;
  for (int step = 0; step < 70; ++step) {
    whole->advance();
    if (step < 31) first->advance();
  }
  test::MemoryWriter to_half(half, MPI_COMM_WORLD), to_end(end, MPI_COMM_WORLD),
      to_continued(continued, MPI_COMM_WORLD);
  first->save(to_half);
  test::MemoryReader from_half(half);
  second->load(from_half);
  for (int step = 31; step < 70; ++step) second->advance();
  whole->save(to_end);
  second->save(to_continued);
  EXPECT_EQ(test::first_difference(end, continued), "");
}

}  // namespace
}  // namespace thalweg::coupling
