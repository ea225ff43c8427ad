// Gravity that rises from zero: what fluid and grains gain is its integral, on any number of ranks, and a run that is
// taken up again in the middle of the rise goes on with the same bits.
#include "coupling/system/lattice_system.hpp"
#include "tests/coupling/water_box.hpp"
#include "tests/support/memory_archive.hpp"

#include "core/parallel/mpi_session.hpp"

#include <gtest/gtest.h>

namespace thalweg::coupling::ramp_test {
namespace {

Index3 best_layout(const Index3& cells) { return Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD)); }

LatticeParameters falling_fluid(double ramp) {
  LatticeParameters p;
  p.units = {1.0, 1.0, 1.0};
  p.collision.relaxation_time = 0.6;
  p.collision.force[0] = 1e-5;
  p.collision.force[1] = -4e-6;
  p.ramp = ramp;
  return p;
}

std::unique_ptr<LatticeSystem<double>> fluid_in(const LatticeParameters& parameters) {
  const Index3 cells{8, 6, 10};
  auto decomposition =
      std::make_unique<Decomposition>(cells, 1.0, std::array<bool, 3>{true, true, true}, best_layout(cells));
  return std::make_unique<LatticeSystem<double>>(std::move(decomposition), MPI_COMM_WORLD, parameters);
}

double diagnostic(const System& system, const std::string& name) {
  return find_diagnostic(system.diagnostics(), name).value();
}

// 80 steps of the ramp of 80.5 steps give F times its integral; 200 steps F (200 - 80.5/2), since the integral of the
// rise is half its duration. Momenta of 1e-3 are rounded to 2^-37 a cell.
TEST(Ramp, GivesThePeriodicFluidItsIntegral) {
  const double ramp = 80.5;
  const auto system = fluid_in(falling_fluid(ramp));
  EXPECT_EQ(diagnostic(*system, "mean_velocity_x"), 0.0);
  EXPECT_EQ(diagnostic(*system, "body_force_x"), 0.0);
  for (int step = 1; step <= 200; ++step) {
    system->advance();
    const double x = 80.0 / ramp, integral = ramp * (x * x * x - 0.5 * x * x * x * x);
    if (step != 80 && step != 200) continue;
    const double full_steps = step == 80 ? integral : 200.0 - 0.5 * ramp;
    const Vec3 mean = system->fluid().totals().momentum / 480.0;
    EXPECT_NEAR(mean.x(), 1e-5 * full_steps, 1e-11) << step;
    EXPECT_NEAR(mean.y(), -4e-6 * full_steps, 1e-11) << step;
    EXPECT_EQ(mean.z(), 0.0);
  }
  EXPECT_EQ(diagnostic(*system, "body_force_x"), 1e-5);
}

// The axis that the controller steers is its own from the first step; the other axes rise.
TEST(Ramp, LeavesTheSteeredAxisAlone) {
  LatticeParameters p = falling_fluid(50.0);
  p.flow_target = lbm::FlowTarget{.axis = 0, .velocity = 0.01, .response_time = 100.0, .interval = 10};
  const auto ramped = fluid_in(p);
  p.ramp = 0.0;
  const auto at_once = fluid_in(p);
  for (int step = 0; step < 30; ++step) {
    ramped->advance();
    at_once->advance();
    EXPECT_NEAR(diagnostic(*ramped, "body_force_x"), diagnostic(*at_once, "body_force_x"), 1e-14) << step;
  }
  EXPECT_LT(std::abs(ramped->fluid().parameters().force[1]), std::abs(at_once->fluid().parameters().force[1]));
}

template <typename Real>
test::MemoryArchive under_an_outlet_after(int steps, MPI_Comm communicator, const Index3& layout,
                                          const test::MemoryArchive* from = nullptr) {
  LatticeParameters p = falling_fluid(50.0);
  p.flow_target = lbm::FlowTarget{.axis = 0, .velocity = 0.01, .response_time = 100.0, .interval = 10};
  p.faces[4].type = lbm::FaceType::no_slip;
  p.faces[5].type = lbm::FaceType::pressure_outlet;
  p.faces[5].density_deviation = 0.004;
  const std::array periodic{true, true, false};
  LatticeSystem<Real> system(std::make_unique<Decomposition>(Index3{16, 17, 10}, 1.0, periodic, layout), communicator,
                             p);
  if (from) {
    test::load(system, *from);
  }
  for (int step = 0; step < steps; ++step) system.advance();
  return test::saved(system, communicator);
}

// The velocity at an outlet is that under the force of the last step, and the next one has another along both axes.
template <typename Real>
void expect_the_same_bits_under_an_outlet() {
  const int ranks = size_of(MPI_COMM_WORLD);
  const test::MemoryArchive straight = under_an_outlet_after<Real>(34, MPI_COMM_SELF, {1, 1, 1});
  for (const Index3& layout : {Index3{1, ranks, 1}, Index3{ranks, 1, 1}}) {
    const test::MemoryArchive middle = under_an_outlet_after<Real>(17, MPI_COMM_WORLD, layout);
    const test::MemoryArchive resumed = under_an_outlet_after<Real>(17, MPI_COMM_WORLD, layout, &middle);
    EXPECT_EQ(test::first_difference(straight, resumed), "") << layout[0] << " " << layout[1] << " " << sizeof(Real);
  }
}

TEST(Ramp, HasTheSameBitsUnderAnOutletOnAnyRanksAndAfterARestart) {
  expect_the_same_bits_under_an_outlet<double>();
  expect_the_same_bits_under_an_outlet<float>();
}

// A grain under its weight alone: the loads of the fluid, which the grain hardly moves in two steps, are taken off. The
// velocity a free grain gains is the weight times the integral of the ramp over the mass, to round-off.
TEST(Ramp, GivesAFreeGrainItsIntegral) {
  WaterBox box;
  box.gravity = Vec3(0.8, 0.0, -9.8);
  box.ramp = 40.25;
  box.seeds = {glass_sphere(0, Vec3(0.0128, 0.0096, 0.0096))};
  const auto system = make_system<double>(box, MPI_COMM_WORLD, best_layout(box.cells));
  double mass = 0.0;
  Vec3 gained = Vec3::Zero(), impulse_of_loads = Vec3::Zero();
  for (int step = 0; step < 60; ++step) {
    system->advance();
    const dem::GrainStore& store = system->grains().store();
    Vec3 load = Vec3::Zero(), momentum = Vec3::Zero();
    if (store.owned == 1) {
      load = store.load_force[0];
      momentum = store.mass[0] * store.velocity[0];
      mass = store.mass[0];
    }
    for (int a = 0; a < 3; ++a) {
      impulse_of_loads[a] += sum_over_ranks(MPI_COMM_WORLD, load[a]) * box.time_step;
      gained[a] = sum_over_ranks(MPI_COMM_WORLD, momentum[a]);
    }
  }
  mass = max_over_ranks(MPI_COMM_WORLD, mass);
  const Vec3 weight = mass * Vec3(0.8, 0.0, -9.8 * (1.0 - 1.0 / 2.55));
  const Vec3 expected = weight * box.time_step * (60.0 - 0.5 * 40.25);
  EXPECT_NEAR((gained - impulse_of_loads - expected).norm(), 0.0, 1e-12 * expected.norm());
}

// Grains, a clump and the fluid, saved in the middle of the rise and at its end.
TEST(Ramp, GoesOnInItsMiddleWithTheSameBits) {
  WaterBox box;
  box.gravity = Vec3(0.8, 0.1, -9.8);
  box.ramp = 45.0;
  box.bulk_relaxation_time = 10.0;
  box.seeds = {glass_sphere(0, Vec3(0.0061, 0.0096, 0.0096)), glass_sphere(1, Vec3(0.0181, 0.0046, 0.0126))};
  box.clumps = {glass_clump(2, pebble(), Vec3(0.0121, 0.0146, 0.0046))};
  const auto whole = make_system<double>(box, MPI_COMM_WORLD, best_layout(box.cells));
  const auto again = make_system<double>(box, MPI_COMM_WORLD, best_layout(box.cells));
  for (int step = 0; step < 23; ++step) whole->advance();
  test::load(*again, test::saved(*whole, MPI_COMM_WORLD));
  EXPECT_EQ(diagnostic(*again, "largest_lattice_velocity"), diagnostic(*whole, "largest_lattice_velocity"));
  for (int step = 23; step < 60; ++step) {
    whole->advance();
    again->advance();
  }
  EXPECT_EQ(test::first_difference(test::saved(*whole, MPI_COMM_WORLD), test::saved(*again, MPI_COMM_WORLD)), "");
}

}  // namespace
}  // namespace thalweg::coupling::ramp_test
