// Grains whose motion is given load the fluid, and are loaded by it, as free ones are.
#include "tests/coupling/water_box.hpp"

#include "core/parallel/mpi_session.hpp"
#include "core/sums/reproducible_sum.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace thalweg::coupling::held_grains_test {
namespace {

// Three spheres in a stream: one in a corner of the periodic box, none touching.
WaterBox three_spheres() {
  WaterBox box;
  box.fluid_velocity = Vec3(0.2, 0.0, 0.05);
  const Vec3 v(0.1, -0.05, 0.02);
  box.seeds = {glass_sphere(0, Vec3(0.001, 0.0005, 0.018), v), glass_sphere(1, Vec3(0.0128, 0.0101, 0.0096), v),
               glass_sphere(2, Vec3(0.0201, 0.004, 0.005), v)};
  return box;
}

std::unique_ptr<LatticeSystem<double>> system_of(const WaterBox& box) {
  return make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
}

TEST(HeldGrains, FeelWhatFreeOnesFeelAtTheSamePlaceAndSpeed) {
  const WaterBox free = three_spheres();
  WaterBox held = free, rigid = free;
  for (dem::GrainSeed& seed : held.seeds) seed.motion = dem::Motion::fixed;
  rigid.assemblies.resize(1);
  rigid.assemblies[0].velocity = free.seeds[0].velocity;
  for (dem::GrainSeed& seed : rigid.seeds) {
    seed.motion = dem::Motion::fixed;
    seed.assembly = 0;
    seed.velocity = Vec3::Zero();  // the assembly's counts
  }
  const auto reference = system_of(free);
  reference->advance();
  for (const WaterBox& box : {held, rigid}) {
    const auto system = system_of(box);
    system->advance();
    const dem::GrainStore &a = reference->grains().store(), &b = system->grains().store();
    ASSERT_EQ(a.owned, b.owned);
    for (std::size_t g = 0; g < a.owned; ++g) {
      EXPECT_EQ(a.load_force[g], b.load_force[g]);
      EXPECT_EQ(a.load_torque[g], b.load_torque[g]);
      EXPECT_GT(a.load_force[g].norm(), 0.0);
    }
  }
}

// A rigid body of three spheres that goes, swings and turns takes from the fluid exactly what its loads say.
TEST(HeldGrains, ARigidAssemblyTakesFromTheFluidWhatItsLoadSays) {
  WaterBox box = three_spheres();
  box.links.momentum_exchange = bodies::MomentumExchange::classical;
  box.assemblies.resize(1);
  dem::PrescribedMotion& motion = box.assemblies[0];
  motion.velocity = Vec3(0.3, 0.0, 0.0);
  motion.oscillation = {Vec3(0.0, 1e-3, 0.5e-3), 40.0, 0.0};
  motion.centre = Vec3(0.0128, 0.0101, 0.0096);
  motion.axis = Vec3::UnitY();
  motion.angular_velocity = 20.0;
  for (dem::GrainSeed& seed : box.seeds) {
    seed.motion = dem::Motion::fixed;
    seed.assembly = 0;
  }
  const auto system = system_of(box);
  lbm::FluidTotals before = system->fluid().totals();
  Vec3 taken = Vec3::Zero(), earlier = Vec3::Zero();
  for (int step = 0; step < 200; ++step) {
    system->advance();
    const lbm::FluidTotals after = system->fluid().totals();
    const bodies::ExchangeTotals& t = system->bodies().step_totals();
    const Vec3 mine = t.refilled - t.covered - t.link_momentum;
    Vec3 exchanged;
    for (int a = 0; a < 3; ++a) exchanged[a] = sum_over_ranks(MPI_COMM_WORLD, mine[a]);
    // The totals round every cell to within 2^-37, as in balance_test.cpp.
    ASSERT_LT((after.momentum - before.momentum - exchanged).norm(), 2.0 * 0x1p-37 * static_cast<double>(after.cells));
    before = after;
    // The load applied in the next step is extrapolated from the last three exchanges
    // (coupling/loads/load_averaging.hpp).
    const dem::GrainStore& s = system->grains().store();
    std::vector<double> load;
    for (std::size_t g = 0; g < s.owned; ++g)
      load.insert(load.end(), s.load_force[g].data(), s.load_force[g].data() + 3);
    const std::vector<double> sum = reproducible_sums(MPI_COMM_WORLD, load, 3);
    const double unit = 1000.0 * std::pow(box.spacing, 4) / (box.time_step * box.time_step);
    Vec3 links;
    for (int a = 0; a < 3; ++a) links[a] = unit * sum_over_ranks(MPI_COMM_WORLD, t.link_momentum[a]);
    if (step > 1) {
      // Rounding of 2^-45 of a link, a few thousand of them, in units of force.
      const Vec3 expected = links + 0.5 * (taken - earlier);
      EXPECT_LT((Vec3(sum[0], sum[1], sum[2]) - expected).norm(), 3e4 * 0x1p-45 * unit) << step;
    }
    earlier = taken;
    taken = links;
  }
  EXPECT_GT(taken.norm(), 1e-4);
  const dem::GrainStore& s = system->grains().store();
  for (std::size_t g = 0; g < s.owned; ++g) {
    Vec3 place = motion.place(box.seeds[static_cast<std::size_t>(s.id[g])].position, 0.02);
    const Vec3 off = system->grains().decomposition().box().difference(
        system->grains().decomposition().box().wrapped(place), s.position[g]);
    EXPECT_LT(off.norm(), 1e-15);
  }
}

}  // namespace
}  // namespace thalweg::coupling::held_grains_test
