#include "analysis/observers/bed_surface.hpp"

#include "core/base/counter_random.hpp"
#include "tests/analysis/made_up_grains.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

namespace thalweg::analysis::bed_surface_test {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;
constexpr double d = 1.0 / 128.0;  // m; with its multiples exact in binary

// Spheres at given places, each owned by another rank at every step. Box of 16 d x 8 d x 32 d, periodic along x and y.
class Spheres {
public:
  explicit Spheres(MPI_Comm communicator)
      : communicator_(communicator), decomposition_({32, 16, 64}, d / 2.0, {true, true, false}, {1, 1, 1}) {}

  PeriodicBox box() const { return decomposition_.box(); }

  // Until the next call. first_light: id from which on grains have half the mass.
  Snapshot at(std::int64_t step, const std::vector<Vec3>& positions, std::size_t first_light = SIZE_MAX) {
    const auto grain = [&](GlobalId id) {
      const auto n = static_cast<std::size_t>(id);
      return MadeUpGrain{.radius = 0.5 * d, .mass = n < first_light ? 1.0 : 0.5, .position = positions[n]};
    };
    grains_.emplace(communicator_, static_cast<GlobalId>(positions.size()), grain, step, decomposition_);
    return grains_->snapshot(0.125 * static_cast<double>(step), 0.125);
  }

private:
  MPI_Comm communicator_;
  Decomposition decomposition_;
  std::optional<MadeUpGrains> grains_;
};

std::vector<Vec3> cubic_lattice(int layers) {
  std::vector<Vec3> positions;
  for (int z = 0; z < layers; ++z)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 16; ++x) positions.emplace_back((x + 0.5) * d, (y + 0.5) * d, (z + 0.5) * d);
  return positions;
}

BedSurfaceKeys keys() { return {0.0, 0.125, d, d / 25.0, 0.5}; }

// Slope and walls of a flume: rho_f g S = 500 Pa/m, (rho_s - rho_f) g d = 80 Pa.
const BedFlow flume{2, 500.0, 80.0};

using thalweg::test::saved;

// Ten layers of a simple cubic lattice: a window of one diameter holds pi/6 anywhere inside, and half of it around the
// top.
TEST(BedSurface, OfACubicLatticeIsTheTopOfItsHighestLayer) {
  Spheres spheres(world);
  BedSurface surface(world, spheres.box(), keys(), d, flume, 0.0);
  std::vector<Vec3> grains = cubic_lattice(10);
  grains.emplace_back(0.1 * d, 0.2 * d, 20.0 * d);  // one in the flow is no bed
  for (int step = 0; step < 5; ++step) surface.observe(spheres.at(step, grains));
  // The one above moves the quantiles by up to half a grain's volume, which near the plane between two layers of 128
  // grains is as much as lies within h of it, 128 pi R h^2 = V/2, h = 0.036 d: 2 % of the bulk's fraction over its 4 d,
  // and 1 % of d in the height, where phi falls by 0.8 a diameter.
  EXPECT_NEAR(value_of(surface.diagnostics(), "bed_height"), 10.0 * d, 0.01 * d);
  EXPECT_NEAR(value_of(surface.results(), "bulk_solid_fraction_mean"), std::numbers::pi / 6.0, 0.02 * 0.53);
  const double depth = 32.0 * d - value_of(surface.diagnostics(), "bed_height"), width = 8.0 * d;
  const double radius = depth * width / (2.0 * depth + width);
  EXPECT_NEAR(value_of(surface.diagnostics(), "flow_depth"), depth, 1e-15);
  EXPECT_NEAR(value_of(surface.diagnostics(), "hydraulic_radius"), radius, 1e-15);
  EXPECT_NEAR(value_of(surface.diagnostics(), "bed_stress"), 500.0 * radius, 1e-10);
  EXPECT_NEAR(value_of(surface.diagnostics(), "shields_number"), 500.0 * radius / 80.0, 1e-12);
  EXPECT_EQ(value_of(surface.results(), "measurements"), 5.0);
  EXPECT_NEAR(value_of(surface.results(), "shields_number_mean"), 500.0 * radius / 80.0, 1e-12);

  BedSurface wide(world, spheres.box(), keys(), d, BedFlow{0, 500.0, 80.0}, 0.0),
      dry(world, spheres.box(), keys(), d, {}, 0.0);
  wide.observe(spheres.at(0, cubic_lattice(10)));
  dry.observe(spheres.at(0, cubic_lattice(10)));
  EXPECT_NEAR(value_of(wide.diagnostics(), "bed_height"), 10.0 * d, 1e-12);
  EXPECT_NEAR(value_of(wide.diagnostics(), "hydraulic_radius"), 22.0 * d, 1e-12);
  EXPECT_EQ(dry.diagnostics().size(), 2u);
}

// Half of gravity drives the flow in the middle of its ramp, and 3/16 - 2/64 of it after a quarter.
// Of grains that a floor is made of half of the volume may lie below it.
TEST(BedSurface, CountsNothingBelowTheFloor) {
  Spheres spheres(world);
  std::vector<Vec3> positions = cubic_lattice(10);
  for (Vec3& position : positions) position.z() -= 0.5 * d;
  BedSurface surface(world, spheres.box(), keys(), d, flume, 0.0);
  surface.observe(spheres.at(0, positions));
  EXPECT_NEAR(value_of(surface.diagnostics(), "bed_height"), 9.5 * d, 0.01 * d);
  EXPECT_NEAR(value_of(surface.results(), "bulk_solid_fraction_mean"), std::numbers::pi / 6.0, 0.02 * 0.53);
}

TEST(BedSurface, DuringTheRampHasTheStressOfTheMoment) {
  Spheres spheres(world);
  BedFlow flow{0, 500.0, 80.0};
  const auto stress_at = [&](int step) {
    BedSurface surface(world, spheres.box(), keys(), d, flow, 0.0);
    surface.observe(spheres.at(step, cubic_lattice(10)));
    return value_of(surface.diagnostics(), "bed_stress");
  };
  const double full = stress_at(2);
  EXPECT_NEAR(full, 500.0 * 22.0 * d, 1e-10);
  flow.ramp = 2.0 * spheres.at(2, cubic_lattice(10)).time;
  EXPECT_NEAR(stress_at(2), 0.5 * full, 1e-10);
  EXPECT_NEAR(stress_at(1), 5.0 / 32.0 * full, 1e-10);
  EXPECT_NEAR(stress_at(9), full, 1e-10);
}

// A sill of overlapping spheres across a lattice of nine layers, four diameters wide and six high, in place of its
// grains there. Its spheres are a quarter of a diameter apart: the surface is within 1 - sqrt(1 - 1/8) of a radius of
// the block, 0.03 d, and its two upper edges are round, 0.2 d^2/4 of a section of 24 d^2: at most 3 % of the block,
// which is a quarter of the room in the bulk. Of the 960 grains left a tenth is the lowest layer, and half are the
// lowest five.
TEST(BedSurface, LeavesOutASillOfOverlappingSpheres) {
  Spheres spheres(world);
  std::vector<Vec3> grains;
  std::vector<GlobalId> sill;
  for (int z = 0; z <= 20; ++z)
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x <= 12; ++x) {
        sill.push_back(static_cast<GlobalId>(grains.size()));
        grains.emplace_back((4.5 + 0.25 * x) * d, 0.25 * y * d, (0.5 + 0.25 * z) * d);
      }
  for (const Vec3& grain : cubic_lattice(9))
    if (grain.x() < 4.0 * d || grain.x() > 8.0 * d || grain.z() > 6.0 * d) grains.push_back(grain);
  BedSurface surface(world, spheres.box(), keys(), d, flume, 0.0, {sill});
  surface.observe(spheres.at(0, grains));
  EXPECT_NEAR(value_of(surface.diagnostics(), "bed_height"), 9.0 * d, 0.02 * d);
  EXPECT_NEAR(value_of(surface.results(), "bulk_solid_fraction_mean"), std::numbers::pi / 6.0, 0.02 * 0.53);
  // Where there is nothing else, it is the bed.
  grains.resize(sill.size());
  BedSurface alone(world, spheres.box(), keys(), d, flume, 0.0, {sill});
  alone.observe(spheres.at(0, grains));
  EXPECT_NEAR(value_of(alone.results(), "bulk_solid_fraction_mean"), 0.25, 0.03 * 0.25);
  EXPECT_NEAR(value_of(alone.diagnostics(), "bed_height"), 6.0 * d, 0.08 * d);
}

// Grains that float lie below the lid as densely as others lie on the floor, and are no bed but where nothing else is.
TEST(BedSurface, LeavesOutGrainsThatFloat) {
  Spheres spheres(world);
  const std::vector<Vec3> bed = cubic_lattice(10);
  std::vector<Vec3> grains = bed, raft;
  for (const Vec3& grain : cubic_lattice(1)) raft.emplace_back(grain.x(), grain.y(), 31.5 * d);
  grains.insert(grains.end(), raft.begin(), raft.end());
  BedObstacles light;
  light.floating_density = 0.75 / (std::numbers::pi / 6.0 * d * d * d);  // of 0.75 kg
  BedSurface surface(world, spheres.box(), keys(), d, flume, 0.0, light),
      of_bed(world, spheres.box(), keys(), d, flume, 0.0), of_raft(world, spheres.box(), keys(), d, flume, 0.0, light);
  for (int step = 0; step < 5; ++step) {
    surface.observe(spheres.at(step, grains, bed.size()));
    of_bed.observe(spheres.at(step, bed));
    of_raft.observe(spheres.at(step, raft, 0));
  }
  EXPECT_NEAR(value_of(surface.diagnostics(), "bed_height"), 10.0 * d, 1e-12);
  for (const char* name : {"static_bed_height", "flow_depth", "bed_stress", "shields_number"})
    EXPECT_EQ(value_of(surface.diagnostics(), name), value_of(of_bed.diagnostics(), name)) << name;
  EXPECT_NEAR(value_of(of_raft.diagnostics(), "bed_height"), 32.0 * d, 1e-12);
}

// A boulder among the grains, here a post of spheres, does not raise the surface of what stands still beside it.
TEST(BedSurface, LeavesObstaclesOutOfTheStaticPixels) {
  Spheres spheres(world);
  const std::vector<Vec3> bed = cubic_lattice(10);
  std::vector<Vec3> grains = bed;
  std::vector<GlobalId> post;
  for (int z = 0; z < 12; ++z) {
    post.push_back(static_cast<GlobalId>(grains.size()));
    grains.emplace_back(4.5 * d, 4.5 * d, (9.5 + 0.5 * z) * d);
  }
  BedSurface beside(world, spheres.box(), keys(), d, flume, 0.0, {post}),
      of_bed(world, spheres.box(), keys(), d, flume, 0.0);
  for (int step = 0; step < 5; ++step) {
    beside.observe(spheres.at(step, grains));
    of_bed.observe(spheres.at(step, bed));
  }
  EXPECT_EQ(value_of(beside.diagnostics(), "static_bed_height"), value_of(of_bed.diagnostics(), "static_bed_height"));
}

// As once all have gone by a sink.
TEST(BedSurface, OfNoGrainsIsTheFloor) {
  Spheres spheres(world);
  BedSurface surface(world, spheres.box(), keys(), d, flume, 0.0);
  surface.observe(spheres.at(0, {}));
  EXPECT_EQ(value_of(surface.diagnostics(), "bed_height"), 0.0);
  EXPECT_EQ(value_of(surface.diagnostics(), "flow_depth"), 32.0 * d);
}

// A fluid that a force drives and whose top takes or gives stress.
class DrivenFluid final : public FluidSource {
public:
  explicit DrivenFluid(const Drive& drive) : drive_(drive) {}
  FluidFields sample(const std::vector<FluidField>&, const Block&) const override { return {}; }
  void for_each_velocity(const VelocityVisitor&) const override {}
  std::optional<State> state_in(const Index3&) const override { return std::nullopt; }
  Drive drive() const override { return drive_; }

private:
  Drive drive_;
};

// Momentum of the water above the bed, per length: tau_b (W + n H) = f H W + tau_top W.
TEST(BedSurface, TakesTheStressFromTheForcesOnTheWater) {
  Spheres spheres(world);
  const double depth = 22.0 * d, width = 8.0 * d, plan = 16.0 * d * width;
  struct Example {
    double force, top;  // N/m^3; Pa on the water
    int walls;
  };
  for (const Example& e : {Example{300.0, 0.0, 0}, {0.0, 2.5, 0}, {300.0, -7.0, 2}, {100.0, 2.5, 1}}) {
    const DrivenFluid fluid({Vec3(e.force, 1.0, 2.0), Vec3(-e.top * plan, 3.0, 4.0)});
    BedSurface surface(world, spheres.box(), keys(), d, BedFlow{e.walls, 1e9, 80.0, true}, 0.0);
    Snapshot snapshot = spheres.at(0, cubic_lattice(10));
    snapshot.fluid = &fluid;
    surface.observe(snapshot);
    const double stress = (e.force * depth + e.top) * width / (width + e.walls * depth);
    EXPECT_NEAR(value_of(surface.diagnostics(), "bed_stress"), stress, 1e-9);
    EXPECT_NEAR(value_of(surface.results(), "shields_number_mean"), stress / 80.0, 1e-11);
  }
}

// A pier of solid triangles through the whole depth, an eighth of the plan: the bed fills the room beside it, and what
// the pier takes of the flow does not reach the bed, nor is the force there where it stands.
TEST(BedSurface, LeavesOutWhatSolidsFillAndTake) {
  Spheres spheres(world);
  const double plan = 16.0 * 8.0 * d * d, depth = 22.0 * d, taken = 0.3 * 300.0 * depth * plan;
  const FluidSource::Drive drive{Vec3(300.0, 1.0, 2.0), Vec3::Zero(), Vec3(taken, 3.0, 4.0)};
  const DrivenFluid fluid(drive);
  std::vector<Vec3> bed = cubic_lattice(10);
  std::erase_if(bed, [](const Vec3& centre) { return centre.x() < 2.0 * d; });
  BedObstacles pier;
  pier.solids_below = [&](int layers) {
    std::vector<double> below;
    for (int k = 0; k <= layers; ++k) below.push_back(0.125 * plan * 32.0 * d * k / layers);
    return below;
  };
  BedSurface surface(world, spheres.box(), keys(), d, BedFlow{1, 1e9, 80.0, true}, 0.0, pier);
  Snapshot snapshot = spheres.at(0, bed);
  snapshot.fluid = &fluid;
  surface.observe(snapshot);
  EXPECT_NEAR(value_of(surface.diagnostics(), "bed_height"), 10.0 * d, 1e-9);
  EXPECT_NEAR(value_of(surface.results(), "bulk_solid_fraction_mean"), std::numbers::pi / 6.0, 0.02 * 0.53);
  const auto expect_stress = [&](const BedSurface& of, double force) {
    const double left = 300.0 * 0.875 * depth - force / plan;
    EXPECT_NEAR(value_of(of.diagnostics(), "bed_stress"), left * 8.0 * d / (8.0 * d + depth), 1e-9);
  };
  expect_stress(surface, taken);
  // Of what it takes by height, all above the bed: not what a floor of the same solid takes beneath it.
  MomentumBudget budget;
  budget.on_solids.assign(2 * 64 + 1, Vec3::Zero());
  for (const int half_cells : {7, 40, 41, 120})  // the bed ends at 20 cells
    budget.on_solids[static_cast<std::size_t>(half_cells)] = Vec3(0.1 * taken * half_cells, 5.0, 6.0);
  BedSurface by_height(world, spheres.box(), keys(), d, BedFlow{1, 1e9, 80.0, true, true}, 0.0, pier);
  EXPECT_TRUE(by_height.needs_momentum());
  snapshot.momentum = &budget;
  by_height.observe(snapshot);
  expect_stress(by_height, 0.1 * taken * (41 + 120));
}

// The same of a sphere that is an obstacle, by height: what it takes of the flow above the bed, and of its volume what
// is there, wherever its middle is. Without other grains it is the bed, from which nothing is subtracted.
TEST(BedSurface, LeavesOutWhatOtherObstaclesTake) {
  Spheres spheres(world);
  std::vector<Vec3> bed = cubic_lattice(10);
  const auto post = static_cast<GlobalId>(bed.size());
  bed.emplace_back(8.0 * d, 4.0 * d, 20.0 * d);
  const DrivenFluid fluid({Vec3(300.0, 0.0, 0.0), Vec3::Zero()});
  const BedFlow flow{0, 1e9, 80.0, true, true};
  BedSurface surface(world, spheres.box(), keys(), d, flow, 0.0, {{post}});
  EXPECT_TRUE(surface.needs_momentum());
  MomentumBudget budget;
  budget.on_solids.assign(2 * 64 + 1, Vec3::Zero());
  budget.on_obstacles = budget.on_solids;
  for (const int half_cells : {7, 40, 41, 80})  // the bed ends at 20 cells
    budget.on_obstacles[static_cast<std::size_t>(half_cells)] = Vec3(0.01 * half_cells, 5.0, 6.0);
  const auto observed = [&](BedSurface& of, const std::vector<Vec3>& grains) {
    Snapshot snapshot = spheres.at(1, grains);
    snapshot.fluid = &fluid;
    snapshot.momentum = &budget;
    of.observe(snapshot);
    return value_of(of.diagnostics(), "bed_stress");
  };
  const double plan = 16.0 * 8.0 * d * d, sphere = std::numbers::pi / 6.0 * d * d * d;
  const double taken = 0.01 * (41 + 80);
  EXPECT_NEAR(observed(surface, bed), 300.0 * (22.0 * d - sphere / plan) - taken / plan, 300.0 * 2e-3 * sphere / plan);
  BedSurface alone(world, spheres.box(), keys(), d, flow, 0.0, {{0}});
  const double stress = observed(alone, {Vec3(8.0 * d, 4.0 * d, 0.5 * d)});
  EXPECT_NEAR(stress, 300.0 * value_of(alone.diagnostics(), "flow_depth"), 1e-9);
}

// What a run has not recorded, as in a state it was restarted from without the analysis, is no measurement of a stress.
TEST(BedSurface, HasNoStressOfAStateWithoutTheMomentumItNeeds) {
  Spheres spheres(world);
  const DrivenFluid fluid({Vec3(300.0, 0.0, 0.0), Vec3::Zero()});
  BedSurface surface(world, spheres.box(), keys(), d, BedFlow{0, 1e9, 80.0, true, true}, 0.0);
  MomentumBudget budget;
  budget.on_solids.assign(2 * 64 + 1, Vec3::Zero());
  for (const int step : {7, 8}) {
    Snapshot snapshot = spheres.at(step, cubic_lattice(10));
    snapshot.fluid = &fluid;
    if (step == 8) snapshot.momentum = &budget;
    surface.observe(snapshot);
    EXPECT_EQ(std::isnan(value_of(surface.diagnostics(), "bed_stress")), step == 7);
  }
  EXPECT_EQ(value_of(surface.results(), "measurements"), 2.0);
  EXPECT_NEAR(value_of(surface.results(), "bed_height_mean"), 10.0 * d, 1e-9);
  EXPECT_NEAR(value_of(surface.results(), "bed_stress_mean"), 300.0 * 22.0 * d, 1e-9);
}

// Grains that are still falling may fill the box; the means must outlive that.
TEST(BedSurface, HasAStressUnderTheLid) {
  Spheres spheres(world);
  const DrivenFluid fluid({Vec3(300.0, 0.0, 0.0), Vec3(-2.5 * 16.0 * d * 8.0 * d, 0.0, 0.0)});
  BedSurface surface(world, spheres.box(), keys(), d, BedFlow{0, 1e9, 80.0, true}, 0.0);
  Snapshot snapshot = spheres.at(0, cubic_lattice(32));
  snapshot.fluid = &fluid;
  surface.observe(snapshot);
  EXPECT_EQ(value_of(surface.diagnostics(), "flow_depth"), 0.0);
  EXPECT_NEAR(value_of(surface.results(), "bed_stress_mean"), 2.5, 1e-12);
}

// Sums of heights over layers of another thickness, or of Shields numbers of another grain, are not gone on with.
TEST(BedSurface, BeginsAnewWithOtherSettings) {
  Spheres spheres(world);
  BedSurface surface(world, spheres.box(), keys(), d, flume, 0.0);
  surface.observe(spheres.at(0, cubic_lattice(10)));
  const test::MemoryArchive archive = saved(surface, world);
  BedSurfaceKeys thick = keys(), patient = keys();
  thick.layer = 2.0 * d, patient.static_time = 0.75;
  const auto takes = [&](const BedSurfaceKeys& with, const BedFlow& flow) {
    test::MemoryReader reader(archive);
    return BedSurface(world, spheres.box(), with, d, flow, 0.0).load(reader);
  };
  EXPECT_TRUE(takes(keys(), flume));
  EXPECT_FALSE(takes(thick, flume));
  EXPECT_FALSE(takes(patient, flume));
  EXPECT_FALSE(takes(keys(), {2, 500.0, 81.0}));
}

// Runs that have a stress at all, and its origin. The grains: 1 mm, 2000 kg/m^3 heavier than the water.
TEST(BedSurface, KnowsWhatDrivesTheWater) {
  bool side_walls_move = false;
  const auto diagnostic_count = [&](const Vec3& gravity, bool steered, bool top_drags, bool top_moves) {
    Spheres spheres(world);
    RunContext run;
    run.box = spheres.box();
    run.gravity = gravity;
    run.fluid = FluidContext{1000.0, 1e-6, 1.0, steered, 0, top_drags, top_moves};
    run.fluid->side_walls_move = side_walls_move;
    run.grains.emplace();
    run.grains->reference_diameter = 1e-3;
    run.grains->reference_density = 3000.0;
    const Decomposition decomposition({32, 16, 64}, d / 2.0, {true, true, false}, {1, 1, 1});
    const auto observer = make_observer(BedSurfaceKeys{}, run, {world, decomposition, 1e-3});
    return observer->diagnostics().size();
  };
  const Vec3 down(0.0, 0.0, -9.8), tilted(1.0, 0.0, -9.7), to_the_left(-1.0, 0.0, -9.7);
  EXPECT_EQ(diagnostic_count(down, false, false, false), 4u);  // heights, depth, radius
  EXPECT_EQ(diagnostic_count(down, false, true, false), 4u);   // a lid at rest
  EXPECT_EQ(diagnostic_count(tilted, false, false, false), 6u);
  EXPECT_EQ(diagnostic_count(to_the_left, false, false, false), 6u);
  EXPECT_EQ(diagnostic_count(down, true, false, false), 6u);
  EXPECT_EQ(diagnostic_count(down, false, true, true), 6u);
  side_walls_move = true;  // which take an unknown share
  EXPECT_EQ(diagnostic_count(tilted, false, false, false), 4u);
  EXPECT_EQ(diagnostic_count(down, true, false, false), 4u);
}

// Places that jiggle by up to half a diameter about a drift of half a box in a picture, for some of them.
std::vector<Vec3> jiggling(std::int64_t step) {
  std::vector<Vec3> positions;
  for (std::uint64_t id = 0; id < 40; ++id) {
    const auto random = [id](std::uint64_t draw) { return uniform_random(11, id, draw); };
    const auto now = static_cast<std::uint64_t>(step);
    const double drift = id % 5 == 0 ? 2.0 * d * static_cast<double>(step) : 0.0;
    const double size = id % 3 == 0 ? 0.0 : 0.5 * random(3);
    const double x = 16.0 * d * random(0) + drift + size * d * (random(10 + now) - 0.5);
    positions.emplace_back(x - 16.0 * d * std::floor(x / (16.0 * d)), 4.0 * d,
                           d * (0.5 + 6.0 * random(1)) + size * d * (random(1000 + now) - 0.5));
  }
  return positions;
}

// Pixel by pixel: the upper edge of the highest that one grain covers at all steps from first to last.
std::vector<double> surface_by_pixels(std::int64_t first, std::int64_t last, double width, double height) {
  std::vector<std::vector<Vec3>> places;
  for (std::int64_t step = first; step <= last; ++step) places.push_back(jiggling(step));
  std::vector<double> surface(400, 0.0);
  for (std::size_t id = 0; id < 40; ++id)
    for (std::size_t column = 0; column < 400; ++column)
      for (int row = 0; row < 200; ++row) {
        bool covered = true;
        for (std::size_t look = 0; look < places.size() && covered; ++look) {
          const Vec3 place = places[look][id];
          double off = (static_cast<double>(column) + 0.5) * width - place.x();
          off -= 16.0 * d * std::round(off / (16.0 * d));
          const double up = (row + 0.5) * height - place.z();
          covered = off * off + up * up <= 0.25 * d * d;
        }
        if (covered) surface[column] = std::max(surface[column], (row + 1) * height);
      }
  return surface;
}

TEST(StaticPixels, AreThoseThatOneGrainCoversAllTheTime) {
  Spheres spheres(world);
  StaticPixels pixels(world, spheres.box(), d / 25.0,
                      0.5);  // pictures of five looks, the last of one the first of the next
  ASSERT_EQ(pixels.columns(), 400);
  std::int64_t pictures = 0;
  for (std::int64_t step = 0; step <= 8; ++step) {
    const bool complete = pixels.look(spheres.at(step, jiggling(step)));
    EXPECT_EQ(complete, step == 4 || step == 8);
    if (!complete) continue;
    ++pictures;
    EXPECT_NEAR(pixels.begun(), 0.5 * static_cast<double>(pictures - 1), 1e-15);
    const std::vector<double> expected = surface_by_pixels(step - 4, step, pixels.column_width(), d / 25.0);
    for (std::size_t c = 0; c < 400; ++c) EXPECT_NEAR(pixels.surface()[c], expected[c], 1e-12) << step << ' ' << c;
    EXPECT_GT(std::set<double>(expected.begin(), expected.end()).size(), 20u);  // there is something to see
  }
  EXPECT_EQ(pictures, 2);
}

// A supply may begin with a box without grains: those that come in later are seen as wide as they are.
TEST(StaticPixels, OfGrainsThatComeInLaterAreAllTheirColumns) {
  Spheres spheres(world), others(world);
  StaticPixels late(world, spheres.box(), d / 25.0, 0.5), early(world, spheres.box(), d / 25.0, 0.5);
  const std::vector<Vec3> lying{{3.02 * d, d, 0.5 * d}, {8.02 * d, d, 0.5 * d}};
  for (std::int64_t step = 0; step <= 8; ++step) {
    late.look(spheres.at(step, step < 3 ? std::vector<Vec3>{} : lying));
    early.look(others.at(step, lying));
  }
  EXPECT_EQ(late.surface(), early.surface());
  EXPECT_EQ(std::count_if(early.surface().begin(), early.surface().end(), StaticPixels::is_static), 50);
}

TEST(BedSurface, HasTheSameBitsOnAnyNumberOfRanksAndAfterARestart) {
  Spheres own(MPI_COMM_SELF), dealt(world);
  BedSurface alone(MPI_COMM_SELF, own.box(), keys(), d, flume, 0.0), shared(world, own.box(), keys(), d, flume, 0.0);
  BedSurface restarted(world, own.box(), keys(), d, flume, 0.0);
  test::MemoryArchive half_way;
  for (std::int64_t step = 0; step <= 11; ++step) {
    alone.observe(own.at(step, jiggling(step)));
    shared.observe(dealt.at(step, jiggling(step)));
    if (step == 6) half_way = saved(alone, MPI_COMM_SELF);
  }
  test::load(restarted, half_way);
  for (std::int64_t step = 6; step <= 11; ++step) restarted.observe(dealt.at(step, jiggling(step)));  // 6 is seen again
  const test::MemoryArchive end = saved(alone, MPI_COMM_SELF);
  EXPECT_EQ(test::first_difference(end, saved(shared, world)), "");
  EXPECT_EQ(test::first_difference(end, saved(restarted, world)), "");
  EXPECT_EQ(value_of(alone.results(), "static_pictures"), 2.0);
  EXPECT_EQ(value_of(alone.results(), "measurements"), 12.0);
  EXPECT_EQ(value_of(restarted.results(), "static_bed_height_mean"),
            value_of(alone.results(), "static_bed_height_mean"));
}

// Columns through which all grains move have no height: the mean is that of the others, whose share is given.
TEST(BedSurface, LeavesColumnsWithoutStaticPixelsOut) {
  Spheres spheres(world);
  BedSurface surface(world, spheres.box(), keys(), d, flume, 0.0);
  // One at rest, 3 d high at its top, and one that goes up by two diameters from look to look.
  for (std::int64_t step = 0; step <= 5; ++step)
    surface.observe(spheres.at(
        step, {Vec3(4.0 * d, 4.0 * d, 2.5 * d), Vec3(8.0 * d, 4.0 * d, d * (1.0 + 2.0 * static_cast<double>(step)))}));
  const double seen = value_of(surface.results(), "static_share_mean"), width = 16.0 * 25.0;  // pixels
  EXPECT_NEAR(seen * width, 25.0, 1.0);                                                       // a diameter, to a pixel
  // The upper half of a circle is pi d/8 high on average; to a pixel of d/25.
  EXPECT_NEAR(value_of(surface.results(), "static_bed_height_mean"), (2.5 + std::numbers::pi / 8.0) * d, d / 25.0);
  EXPECT_NEAR(value_of(surface.diagnostics(), "static_bed_height"), (2.5 + std::numbers::pi / 8.0) * d, d / 25.0);
}

}  // namespace
}  // namespace thalweg::analysis::bed_surface_test
