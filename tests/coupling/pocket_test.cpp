// A pocket between two grains, as one was in the surface of a bed in a flume: a cell of fluid whose only fluid
// neighbours are beside it across the gap's own direction, so that nothing can flow through it along the gap.
#include "tests/coupling/water_box.hpp"

#include <gtest/gtest.h>

namespace thalweg::coupling::pocket_test {
namespace {

constexpr Index3 pocket{12, 12, 12};
constexpr double radius = 4.95, spacing = 5e-4;  // cells, m

// Steps after which v would still be exp(-100 8 nu) = 0.91 of what it was, by viscosity alone.
constexpr int steps = 100;

dem::GrainSeed fixed_grain(int id, const Vec3& from_pocket) {
  dem::GrainSeed seed;
  seed.id = id;
  seed.radius = radius * spacing;
  seed.density = 2550.0;
  seed.position = (Vec3(pocket[0], pocket[1], pocket[2]) + Vec3::Constant(0.5) + from_pocket) * spacing;
  seed.motion = dem::Motion::fixed;
  return seed;
}

class Pocket : public ::testing::TestWithParam<lbm::GapRule> {
protected:
  WaterBox box() const {
    WaterBox box;
    box.cells = {26, 26, 26};
    box.periodic = {true, true, true};
    box.spacing = spacing;
    box.time_step = 2.8e-5;
    box.links.gaps = GetParam();
    box.fluid_velocity = along_gap * box.spacing / box.time_step;
    box.seeds = {fixed_grain(0, Vec3(-2.1841, -0.5565, -4.4271)), fixed_grain(1, Vec3(2.2590, 0.0194, 4.5304))};
    return box;
  }

  const Vec3 along_gap = Vec3(0.0179, 0.0, -0.0089);  // cells a step, 0.02 in all
};

TEST_P(Pocket, DoesNotKeepAVelocityAlongTheGap) {
  const auto system = make_system<double>(box(), MPI_COMM_SELF, {1, 1, 1});
  const lbm::Fluid<double>& fluid = system->fluid();
  const std::ptrdiff_t cell = fluid.indexing().index(pocket[0], pocket[1], pocket[2]);
  ASSERT_EQ(fluid.cells().confinement(cell), lbm::Confinement::pocket);
  for (int step = 0; step < steps; ++step) system->advance();
  EXPECT_LT(std::abs(fluid.state_at(cell).velocity.dot(along_gap)) / along_gap.squaredNorm(), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Gaps, Pocket, ::testing::Values(lbm::GapRule::no_slip, lbm::GapRule::slip),
                         [](const auto& gap) { return gap.param == lbm::GapRule::slip ? "slip" : "no_slip"; });

}  // namespace
}  // namespace thalweg::coupling::pocket_test
