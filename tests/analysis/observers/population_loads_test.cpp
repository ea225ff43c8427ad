#include "analysis/observers/population_loads.hpp"

#include "tests/analysis/made_up_grains.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::analysis::population_loads_test {
namespace {

// Two populations dealt out to the ranks: forces and torques with small whole numbers, so that sums are exact.
TEST(PopulationLoads, AddsForcesAndTurnsThemAboutThePivot) {
  const std::vector<Vec3> places{Vec3(1.0, 5.0, 2.0), Vec3(19.0, 5.0, 2.0),  // one metre beyond the face: arm -2
                                 Vec3(4.0, 6.0, 3.0)};
  const MadeUpGrains grains(MPI_COMM_WORLD, 3, [&](GlobalId id) {
    return MadeUpGrain{.position = places[static_cast<std::size_t>(id)],
                       .fluid_force = Vec3(static_cast<double>(id), 0.0, 0.0),
                       .contact_force = Vec3(0.0, 0.0, 2.0),
                       .contact_torque = Vec3(0.0, 1.0, 0.0)};
  });
  const PeriodicBox box = made_up_box().box();
  const Snapshot snapshot = grains.snapshot(3.0);

  PopulationLoads loads(MPI_COMM_WORLD, box,
                        {{"wall", 0, 2, [](double time) { return Vec3(1.0, 5.0, time - 1.0); }},
                         {"bed", 2, 3, [](double) { return Vec3(4.0, 4.0, 0.0); }}},
                        true);
  loads.observe(snapshot);
  const std::vector<Diagnostic> diagnostics = loads.diagnostics();
  EXPECT_EQ(diagnostics.size(), 24u);
  EXPECT_EQ(value_of(diagnostics, "wall_contact_force_z"), 4.0);
  // Arms 0 and (-2, 0, 0) from the pivot at z = 2: -2 x 2 about y is +4, and one of their own each.
  EXPECT_EQ(value_of(diagnostics, "wall_contact_torque_y"), 6.0);
  EXPECT_EQ(value_of(diagnostics, "wall_contact_torque_x"), 0.0);
  EXPECT_EQ(value_of(diagnostics, "wall_fluid_force_x"), 1.0);
  EXPECT_EQ(value_of(diagnostics, "wall_fluid_torque_y"), 0.0);
  EXPECT_EQ(value_of(diagnostics, "bed_contact_torque_x"), 4.0);  // 2 m along y, 2 N up
  EXPECT_EQ(value_of(diagnostics, "bed_fluid_force_x"), 2.0);
  EXPECT_EQ(value_of(diagnostics, "bed_fluid_torque_y"), 6.0);  // 3 m up, 2 N along x
  EXPECT_EQ(value_of(diagnostics, "bed_fluid_torque_z"), -4.0);

  // A pivot that has gone around the box three times is at x = 1 as well.
  PopulationLoads travelling(MPI_COMM_WORLD, box, {{"roller", 0, 2, [](double) { return Vec3(61.0, 5.0, 2.0); }}},
                             true);
  travelling.observe(snapshot);
  EXPECT_EQ(value_of(travelling.diagnostics(), "roller_contact_torque_y"), 6.0);

  PopulationLoads dry(MPI_COMM_WORLD, box, {{"wall", 0, 2, [](double) { return Vec3::Zero(); }}}, false);
  EXPECT_EQ(dry.diagnostics().size(), 6u);
}

// Of the three ids of a round the first and the last are of the second population: with 2 at the start these are 2, 4,
// 5, 7.
TEST(PopulationLoads, AddsGrainsThatHaveComeIn) {
  const MadeUpGrains grains(MPI_COMM_WORLD, 8, [](GlobalId id) {
    return MadeUpGrain{.contact_force = Vec3(std::pow(10.0, static_cast<double>(id)), 0.0, 0.0)};
  });
  const auto origin = [](double) { return Vec3::Zero(); };
  PopulationLoads loads(MPI_COMM_WORLD, made_up_box().box(), {{"a", 0, 1, origin}, {"b", 1, 2, origin}}, false,
                        {1, 0, 1});
  loads.observe(grains.snapshot(1.0));
  EXPECT_EQ(value_of(loads.diagnostics(), "a_contact_force_x"), 1001001.0);
  EXPECT_EQ(value_of(loads.diagnostics(), "b_contact_force_x"), 10110110.0);
}

// A model fluid loads grains as water does.
TEST(PopulationLoads, HasTheLoadOfAModelFluid) {
  const Decomposition decomposition = made_up_box();
  RunContext run;
  run.box = decomposition.box();
  run.grains.emplace();
  run.grains->populations = {{"bed", 0, 3, [](double) { return Vec3::Zero(); }}};
  const auto diagnostics = [&] {
    return make_observer(PopulationLoadsKeys{}, run, {MPI_COMM_WORLD, decomposition, 1e-3})->diagnostics().size();
  };
  EXPECT_EQ(diagnostics(), 6u);  // dry: force and torque of contacts
  run.model_fluid.emplace();
  EXPECT_EQ(diagnostics(), 12u);
}

}  // namespace
}  // namespace thalweg::analysis::population_loads_test
