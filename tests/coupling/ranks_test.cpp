// Grains in a flow have the same bits on any number of ranks, however the box is cut: every rank runs the whole box
// alone as well, once, and compares its own block and grains. Grains cross rank borders and periodic faces all the
// time.
#include "tests/coupling/water_box.hpp"

#include "core/parallel/mpi_session.hpp"
#include "tests/support/meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace thalweg::coupling::ranks_test {
namespace {

std::vector<Index3> layouts_of(int ranks) {
  std::vector<Index3> layouts;
  for (int x = 1; x <= ranks; ++x)
    for (int y = 1; x * y <= ranks; ++y)
      if (ranks % (x * y) == 0) layouts.push_back({x, y, ranks / (x * y)});
  return layouts;
}

// Layouts with at most `most` blocks along each axis.
std::vector<Index3> layouts_up_to(const Index3& most) {
  std::vector<Index3> layouts = layouts_of(size_of(MPI_COMM_WORLD));
  std::erase_if(layouts, [&](const Index3& l) { return l[0] > most[0] || l[1] > most[1] || l[2] > most[2]; });
  return layouts;
}

// Two layouts that differ most, where all would take too long.
std::vector<Index3> two_layouts_of(int ranks) {
  const std::vector<Index3> all = layouts_of(ranks);
  if (all.size() <= 2) return all;
  return {all[all.size() / 2], all.back()};
}

FluidInitialState swirl(const Vec3& p) {
  return {0.0, Vec3(0.4 + 0.1 * std::sin(500.0 * p.z()), 0.1 * std::sin(300.0 * p.x()), 0.1 * std::cos(400.0 * p.y()))};
}

WaterBox crowded(const Index3& cells, const std::array<bool, 3>& periodic, int count, double distance) {
  WaterBox box;
  box.cells = cells;
  box.periodic = periodic;
  box.spacing = 5e-3 / 6.0;
  box.gravity = Vec3(1.0, 0.3, -9.0);
  box.sub_steps = 20;
  box.initial = swirl;
  const Index3 places{static_cast<int>(cells[0] * box.spacing / distance),
                      static_cast<int>(cells[1] * box.spacing / distance),
                      static_cast<int>(cells[2] * box.spacing / distance)};
  for (int k = 0; k < count; ++k) {
    const Index3 at{k % places[0], k / places[0] % places[1], k / (places[0] * places[1])};
    const Vec3 wobble(std::sin(1.0 + k), std::sin(2.0 + 3.0 * k), std::sin(5.0 * k));
    box.seeds.push_back(glass_sphere(k, distance * Vec3(at[0] + 0.5, at[1] + 0.5, at[2] + 0.5) + 1e-4 * wobble,
                                     0.5 * Vec3(std::cos(2.0 * k), std::sin(3.0 * k), std::cos(7.0 * k))));
  }
  return box;
}

// Stresses are measured in the last two steps, and in every other pair before.
template <typename Real>
std::unique_ptr<LatticeSystem<Real>> after(int steps, const WaterBox& box, MPI_Comm communicator,
                                           const Index3& layout) {
  auto system = make_system<Real>(box, communicator, layout);
  for (int left = steps - 1; left >= 0; --left) left % 4 < 2 ? advance_with_stress(*system) : system->advance();
  return system;
}

template <typename Real>
void expect_same(const LatticeSystem<Real>& alone, const LatticeSystem<Real>& shared, const WaterBox& box,
                 const Index3& layout) {
  const lbm::Fluid<Real>&whole = alone.fluid(), &part = shared.fluid();
  const Index3 n = part.indexing().size(), from = part.block().lower;
  std::int64_t differing = 0, solid = 0;
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const std::ptrdiff_t here = part.indexing().index(x, y, z);
        const std::ptrdiff_t there = whole.indexing().index(from[0] + x, from[1] + y, from[2] + z);
        if (part.cells().is_fluid(here) != whole.cells().is_fluid(there)) ++differing;
        solid += !part.cells().is_fluid(here);
        if (!part.cells().is_fluid(here)) continue;
        for (int i = 0; i < 19; ++i)
          differing += part.populations().post_collision(i, here) != whole.populations().post_collision(i, there);
      }
  const auto loads = alone.solid_loads(), shared_loads = shared.solid_loads();
  differing += loads.forces != shared_loads.forces || loads.torques != shared_loads.torques;
  const dem::GrainStore &all = alone.grains().store(), &mine = shared.grains().store();
  std::map<GlobalId, std::size_t> slot;
  for (std::size_t g = 0; g < all.owned; ++g) slot[all.id[g]] = g;
  for (std::size_t g = 0; g < mine.owned; ++g) {
    const std::size_t a = slot.at(mine.id[g]);
    differing += mine.position[g] != all.position[a] || mine.velocity[g] != all.velocity[a] ||
                 mine.angular_velocity[g] != all.angular_velocity[a] || mine.load_force[g] != all.load_force[a] ||
                 mine.load_torque[g] != all.load_torque[a] || mine.contact_force[g] != all.contact_force[a];
    differing += shared.snapshot().grains.fluid_stress[g] != alone.snapshot().grains.fluid_stress[a];
  }
  std::map<GlobalId, std::size_t> place;
  const dem::Clumps &clumps = alone.grains().clumps(), &here = shared.grains().clumps();
  for (std::size_t k = 0; k < clumps.size(); ++k) place[clumps[k].id] = k;
  for (std::size_t k = 0; k < here.size(); ++k) {
    const dem::Clump& other = clumps[place.at(here[k].id)];
    differing += here[k].centre != other.centre || here[k].velocity != other.velocity ||
                 here[k].orientation.w != other.orientation.w || here[k].angular_momentum != other.angular_momentum;
  }
  EXPECT_EQ(sum_over_ranks(MPI_COMM_WORLD, static_cast<std::int64_t>(here.size())),
            static_cast<std::int64_t>(box.clumps.size()));
  EXPECT_EQ(differing, 0) << "layout " << layout[0] << "," << layout[1] << "," << layout[2];
  EXPECT_EQ(sum_over_ranks(MPI_COMM_WORLD, static_cast<std::int64_t>(mine.owned)), alone.grains().global_count());
  EXPECT_GT(sum_over_ranks(MPI_COMM_WORLD, solid), 500);
}

template <typename Real>
void compare(const WaterBox& box, const std::vector<Index3>& layouts, int steps) {
  const auto alone = after<Real>(steps, box, MPI_COMM_SELF, {1, 1, 1});
  for (const Index3& layout : layouts)
    expect_same(*alone, *after<Real>(steps, box, MPI_COMM_WORLD, layout), box, layout);
}

TEST(Ranks, DoNotChangeOneBitOfABedInAFlume) {
  const WaterBox box = crowded({48, 40, 36}, {true, false, false}, 100, 5.4e-3);
  compare<float>(box, layouts_of(size_of(MPI_COMM_WORLD)), 25);
}

TEST(Ranks, DoNotChangeOneBitWhereCellsBesideGrainsCollideInTheirOwnWay) {
  WaterBox box = crowded({48, 40, 36}, {true, false, false}, 100, 5.4e-3);
  box.collision = lbm::CollisionModel::trt_at_bodies;
  compare<float>(box, two_layouts_of(size_of(MPI_COMM_WORLD)), 25);
}

TEST(Ranks, DoNotChangeOneBitOfLightGrainsWithLubrication) {
  WaterBox box = crowded({48, 40, 36}, {true, false, false}, 100, 5.4e-3);  // half a cell between the grains
  box.lubrication = true;
  box.sub_steps = 40;
  for (dem::GrainSeed& seed : box.seeds) seed.density = 400.0 + 600.0 * static_cast<double>(seed.id % 2);
  box.viscosity = 1e-5;
  compare<double>(box, {Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD))}, 25);
}

TEST(Ranks, DoNotChangeOneBitOfACloudInAPeriodicBox) {
  const WaterBox box = crowded({33, 34, 35}, {true, true, true}, 60, 5.4e-3);
  compare<double>(box, layouts_of(size_of(MPI_COMM_WORLD)), 25);
}

// A block of triangles across the ends of the box along x, and a ball, with grains that hit, roll over and lie on them.
void compare_on_solids(const std::vector<dem::PrescribedMotion>& motions, int steps) {
  WaterBox box = crowded({48, 40, 36}, {true, false, false}, 100, 5.4e-3);
  box.collision = lbm::CollisionModel::trt_at_bodies;
  const Vec3 size = box.spacing * Vec3(48, 36, 36);
  box.solids = {thalweg::test::box_mesh(Vec3(-8e-3, 6e-3, -1e-3), Vec3(9e-3, 19e-3, 14e-3)),
                bodies::SolidSphere{0.5 * size, 8e-3}};
  box.solid_motions = motions;
  const std::vector<dem::Solid> solids{grain_solid(box.solids[0]), grain_solid(box.solids[1])};
  const PeriodicBox whole{size, box.periodic};
  const std::vector<dem::PlacedSolid> placed{{solids[0], 0.0, 0.0}, {solids[1], 0.0, 0.0}};
  std::erase_if(box.seeds, [&](const dem::GrainSeed& seed) {
    return dem::depth_in_solids(seed.position, seed.radius, whole, placed, solids).depth > 0.0;
  });
  for (std::size_t n = 0; n < box.seeds.size(); ++n) box.seeds[n].id = static_cast<GlobalId>(n);
  ASSERT_GT(box.seeds.size(), 40u);
  compare<float>(box, two_layouts_of(size_of(MPI_COMM_WORLD)), steps);
  const auto system = make_system<float>(box, MPI_COMM_SELF, {1, 1, 1});
  std::array<int, 2> steps_touched{};
  for (int step = 0; step < steps; ++step) {
    system->advance();
    const std::vector<Vec3> forces = system->grains().wall_forces();
    for (std::size_t solid = 0; solid < 2; ++solid)
      if (!forces[forces.size() - 2 + solid].isZero(0.0)) ++steps_touched[solid];
  }
  EXPECT_GT(steps_touched[0], 0);
  EXPECT_GT(steps_touched[1], 0);
}

TEST(Ranks, DoNotChangeOneBitOfGrainsOnSolids) { compare_on_solids({}, 60); }

// The block runs across the ends of the box; the ball turns about an axis beside its centre, and swings.
TEST(Ranks, DoNotChangeOneBitOfGrainsBetweenSolidsThatMove) {
  dem::PrescribedMotion runs, turns;
  runs.velocity = Vec3(0.4, 0.05, 0.1);
  turns.centre = Vec3(21e-3, 14e-3, 15e-3);
  turns.axis = Vec3(1.0, 2.0, 2.0) / 3.0;
  turns.angular_velocity = 40.0;
  turns.oscillation = {Vec3(0.0, 1e-3, 1e-3), 40.0, 0.3};
  compare_on_solids({runs, turns}, 150);
}

TEST(Ranks, DoNotChangeOneBitWithABulkViscosityUnderRisingGravity) {
  WaterBox box = crowded({40, 24, 36}, {true, false, false}, 20, 5.5e-3);
  box.bulk_relaxation_time = 10.0;
  box.ramp = 30.5;
  compare<float>(box, two_layouts_of(size_of(MPI_COMM_WORLD)), 40);
}

// Every grain of the cloud is a clump half as wide again, which reaches over borders its centre does not cross.
TEST(Ranks, DoNotChangeOneBitOfClumpsInAPeriodicBox) {
  WaterBox box = crowded({36, 40, 33}, {true, true, true}, 40, 7.4e-3);
  GlobalId id = 0;
  for (const dem::GrainSeed& seed : box.seeds) {
    box.clumps.push_back(
        glass_clump(id, pebble(), seed.position, seed.velocity, 60.0 * Vec3(std::cos(id), std::sin(id), 0.5)));
    id += 3;
  }
  box.seeds.clear();
  compare<float>(box, layouts_of(size_of(MPI_COMM_WORLD)), 25);
}

TEST(Ranks, DoNotChangeOneBitWithFullGravityAndEveryOtherChoiceInAFlume) {
  WaterBox box = crowded({48, 40, 36}, {true, false, false}, 100, 5.4e-3);
  box.full_gravity = box.keep_covered_momentum = true;
  box.links.rule = bodies::LinkRule::cli;
  compare<float>(box, two_layouts_of(size_of(MPI_COMM_WORLD)), 8);
}

TEST(Ranks, DoNotChangeOneBitWithTheOtherExchangeInAPeriodicBox) {
  WaterBox box = crowded({33, 34, 35}, {true, true, true}, 60, 5.4e-3);
  box.links.momentum_exchange = bodies::MomentumExchange::classical;
  compare<double>(box, two_layouts_of(size_of(MPI_COMM_WORLD)), 14);
}

// A box only 2.1 diameters wide both ways: a grain can meet its neighbour through either periodic face, and a cut
// leaves 1.05 a rank.
TEST(Ranks, DoNotChangeOneBitInABoxOfTwoDiametersPeriodicBothWays) {
  WaterBox box = crowded({13, 13, 48}, {true, true, false}, 28, 5.21e-3);
  box.spacing = 2.1 * 5e-3 / 13.0;
  for (const bool full_gravity : {false, true}) {
    box.full_gravity = full_gravity;
    compare<float>(box, layouts_up_to({2, 2, 64}), 14);
  }
}

// A long narrow one: 2.2 diameters across.
TEST(Ranks, DoNotChangeOneBitInANarrowPeriodicBox) {
  const WaterBox box = crowded({48, 13, 40}, {true, true, false}, 40, 5.3e-3);
  compare<float>(box, layouts_up_to({64, 2, 64}), 40);
}

// A grain right where blocks meet, drifting and turning through the corner of eight: every rank has a share of its
// links, its cells and its load. Another one stands where the corners of the periodic box meet.
TEST(Ranks, DoNotChangeOneBitOfAGrainThatSpansAllOfThem) {
  WaterBox box;
  box.cells = {20, 20, 20};
  box.gravity = Vec3(1.0, 0.3, -9.0);
  box.sub_steps = 20;
  box.initial = swirl;
  box.seeds = {glass_sphere(0, 0.8e-3 * Vec3(9.7, 10.1, 9.8), Vec3(0.5, -0.4, 0.6), 3.6e-3),
               glass_sphere(1, 0.8e-3 * Vec3(0.1, 19.9, 0.2), Vec3(-0.4, 0.5, -0.3), 3.6e-3)};
  for (dem::GrainSeed& seed : box.seeds) seed.angular_velocity = Vec3(30.0, -20.0, 40.0);
  const std::vector<Index3> layouts = layouts_up_to({2, 2, 2});
  compare<double>(box, layouts, 14);
  for (const Index3& layout : layouts) {
    const auto system = make_system<double>(box, MPI_COMM_WORLD, layout);
    EXPECT_GT(system->bodies().links().count(), 100u);  // on this rank
  }
}

}  // namespace
}  // namespace thalweg::coupling::ranks_test
