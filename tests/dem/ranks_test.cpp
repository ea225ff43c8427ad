// The same bits on any number of ranks, in any layout, and after saving and loading: the saved state (everything the
// next step depends on) of a run on all ranks is compared with that of a run each rank does alone.
#include "beds/packing/packing.hpp"
#include "beds/packing/random_packing.hpp"
#include "core/base/counter_random.hpp"
#include "tests/dem/clump_cases.hpp"
#include "tests/support/memory_archive.hpp"
#include "tests/support/meshes.hpp"

#include <gtest/gtest.h>

namespace thalweg::dem::ranks_test {
namespace {

struct Case {
  Index3 cells;
  double spacing;  // m
  std::array<bool, 3> periodic;
  int grains;
  Vec3 gravity;          // m/s^2
  Vec3 drift;            // m/s, of all grains at the start: a heap in contact crosses the borders between ranks
  bool elastic = false;  // Hertz and Mindlin, two materials, tangential damping
  bool clumps = false;   // every other grain is one
  double rolling = 0.0;  // rolling friction
  bool moving = false;   // the floor swings, and the held grains turn about an axis that moves
  bool plate = false;    // comes up from below the floor, across the end of the box along x
  bool lubricated = false;
  bool movable_cuts = false;
  bool moist = false;   // with liquid bridges
  bool solids = false;  // a floor of triangles, and a block that turns and comes up from below
};

struct Cloud {
  std::vector<GrainSeed> grains;
  std::vector<ClumpSeed> clumps;
};

// A rod of four spheres, 9 mm long, a stout pair, or a pebble without symmetry.
std::shared_ptr<const ClumpShape> shape_for(int i) {
  static const auto rod = test::shape_of(
      {{{-3e-3, 0, 0}, 1.5e-3}, {{-1e-3, 0, 0}, 1.5e-3}, {{1e-3, 0, 0}, 1.5e-3}, {{3e-3, 0, 0}, 1.5e-3}});
  static const auto pair = test::dumbbell(), pebble = test::pebble();
  return i % 3 == 0 ? rod : i % 3 == 1 ? pair : pebble;
}

// Grains of 3.2 to 5 mm, thrown about at up to 0.4 m/s an axis.
Cloud cloud(const Case& c) {
  const PeriodicBox box = Decomposition(c.cells, c.spacing, c.periodic, {1, 1, 1}).box();
  const auto is_clump = [&c](int i) { return c.clumps && i % 2 == 1; };
  std::vector<double> radii;
  for (int i = 0; i < c.grains; ++i)
    radii.push_back(is_clump(i) ? shape_for(i)->bounding_radius : 1.6e-3 + 0.9e-3 * uniform_random(1, i, 0));
  const std::vector<Vec3> places = beds::random_packing(box, beds::whole(box), radii, 1e-5, 4);
  Cloud all;
  GlobalId id = 0;
  for (int i = 0; i < c.grains; ++i) {
    const auto draw = [i](int n) { return 2.0 * uniform_random(2, i, n) - 1.0; };
    GrainSeed seed = test::glass_sphere(id, places[i], c.drift + 0.4 * Vec3(draw(0), draw(1), draw(2)), radii[i]);
    seed.angular_velocity = 30.0 * Vec3(draw(3), draw(4), draw(5));
    if (c.elastic) seed.material = i % 2;
    if (i % 17 == 3 && (c.periodic[0] || c.drift.isZero())) {  // drifting, they would leave a closed box
      seed.motion = Motion::fixed;
      seed.velocity = i % 2 == 0 ? Vec3::Zero() : c.drift;
      if (c.moving) seed.assembly = 0;
    }
    if (is_clump(i)) {
      ClumpSeed clump = test::glass_clump(id, shape_for(i), places[i], seed.velocity, seed.angular_velocity);
      clump.orientation = test::some_orientation(i);
      clump.motion = seed.motion;
      all.clumps.push_back(clump);
      id += static_cast<GlobalId>(clump.shape->members.size());
    } else {
      all.grains.push_back(seed);
      ++id;
    }
  }
  return all;
}

GrainParameters parameters_of(const Case& c) {
  const PeriodicBox box = Decomposition(c.cells, c.spacing, c.periodic, {1, 1, 1}).box();
  GrainParameters p;
  p.contact = test::glass(0.6);
  // Soft grains: long contacts, so that many are open at any time, and long steps.
  p.contact.normal_stiffness = 500.0;
  p.contact.tangential_stiffness = 2.0 / 7.0 * 500.0;
  p.contact.rolling_friction = p.contact.wall_rolling_friction = c.rolling;
  if (c.moist) p.contact.liquid_bridge = LiquidBridgeParameters{0.05, 0.3, 5e-11};  // breaks at 0.42 mm
  if (c.elastic) {
    p.contact.law = Law::hertz_mindlin;
    p.contact.youngs_modulus = 1e5;  // about as soft
    p.contact.poisson_ratio = 0.3;
    p.contact.tangential_damping = 0.5;
    p.other_materials = {p.contact};
    p.other_materials[0].youngs_modulus = 3e5;
    p.other_materials[0].friction = 0.1;
  }
  p.walls = face_planes(box, p.contact);
  if (c.plate) {
    Plane plate = face_plane(box, 2, false, 0.5, Vec3(0.05, 0.0, 0.15));
    plate.point = Vec3(0.0, 0.5 * box.size[1], -3e-3);
    plate.plate = {Vec3::UnitX(), 6e-3, 5e-3};
    p.walls.push_back(plate);
  }
  if (c.solids) {
    const Vec3 size = box.size, third = size / 3.0;
    const auto hilly = [&](double x, double y) {
      return 1e-3 * std::cos(6.0 * x / size.x()) * std::sin(6.0 * y / size.y()) - 5e-4;
    };
    const TriangleMesh floor = thalweg::test::slab_mesh(Vec3(0.0, 0.0, -3e-3), Vec3(size.x(), size.y(), 0.0), 9, 8,
                                                        hilly, [](int, int) { return Vec3::Zero(); });
    p.solids.push_back({std::make_shared<SolidSurface>(floor), 0.4, c.rolling, {}});
    const auto solid = [&](SolidSurface surface) {
      return Solid{std::make_shared<SolidSurface>(std::move(surface)), 0.6, c.rolling, {}};
    };
    Solid block = solid(SolidSurface(
        thalweg::test::box_mesh(Vec3(-0.5 * third - Vec3(0, 0, 5e-3)), Vec3(0.5 * third - Vec3(0, 0, 5e-3)))));
    block.motion.axis = Vec3(0.0, 0.6, 0.8);
    block.motion.angular_velocity = 4.0;
    block.motion.velocity = Vec3(0.1, 0.0, 0.02);
    block.motion.oscillation = {Vec3(0.0, 1e-3, 0.0), 20.0, 0.0};
    Solid ball = solid(SolidSurface::sphere(Vec3(0.0, third.y(), -3.2e-3), 3e-3));
    ball.motion.velocity = Vec3(0.3, 0.2, 0.04);
    p.solids.insert(p.solids.end(), {block, ball});
  }
  if (c.moving) {
    for (Plane& wall : p.walls)
      if (wall.normal[2] > 0.0) wall.oscillation = {Vec3(1e-3, 0.0, 1e-3), 30.0, 0.0};
    PrescribedMotion turning;
    turning.centre = 0.5 * box.size;
    turning.axis = Vec3(0.6, 0.0, 0.8);
    turning.angular_velocity = 20.0;
    turning.velocity = Vec3(0.3, -0.2, 0.0);
    p.assemblies = {turning};
  }
  p.body_force = [g = c.gravity](double mass, double) { return Vec3(mass * g); };
  p.time_step = 2.5e-5;
  p.sub_steps = 10;
  p.skin = 1e-3;
  p.ghost_width = 3e-3;
  p.movable_cuts = c.movable_cuts;
  if (c.lubricated)
    p.lubrication = LubricationParameters{0.02, 6e-4, 4e-4, 1e-2, std::vector<bool>(p.walls.size(), true)};
  p.attached_width = 2;
  return p;
}

// Steps with loads that depend on the grain's state; the attached columns remember something of every step, and ghosts
// are told the second.
void run(GrainDynamics& grains, int steps) {
  for (int n = 0; n < steps; ++n) {
    grains.prepare();
    GrainStore& s = grains.store();
    for (std::size_t i = 0; i < s.owned; ++i) {
      const auto attached = s.attached_of(i);
      s.load_force[i] = -2e-4 * s.velocity[i] + Vec3(1e-5 * attached[0], 0.0, 0.0);
      s.load_torque[i] = -1e-9 * s.angular_velocity[i];
      attached[0] = s.velocity[i][0];
      attached[1] += s.position[i][2];
    }
    grains.advance(grains.parameters().sub_steps);
    grains.refresh_ghosts();
    grains.refresh_ghost_attached(1, 1);
  }
}

using thalweg::test::saved;

std::vector<Index3> layouts(const Index3& cells, int ranks) {
  std::vector<Index3> all;
  for (int px = 1; px <= ranks; ++px)
    for (int py = 1; px * py <= ranks; ++py) {
      if (ranks % (px * py) != 0) continue;
      const Index3 layout{px, py, ranks / (px * py)};
      bool fits = true;
      for (int a = 0; a < 3; ++a)
        fits = fits && (layout[a] == 1 || cells[a] / layout[a] >= Decomposition::min_cells_per_rank);
      if (fits) all.push_back(layout);
    }
  return all;
}

// Every ghost is its owner's grain, bit for bit; of attached columns in what ghosts are told.
void expect_true_ghosts(const GrainDynamics& grains, MPI_Comm communicator) {
  const thalweg::test::MemoryArchive archive = saved(grains, communicator);
  const auto values = [&](const char* name) { return std::get<std::vector<double>>(archive.datasets.at(name).values); };
  const auto position = values("grains/position"), velocity = values("grains/velocity"),
             spin = values("grains/angular_velocity"), attached = values("grains/attached");
  const GrainStore& s = grains.store();
  for (std::size_t i = s.owned; i < s.total(); ++i) {
    ASSERT_EQ(s.attached_of(i)[1], attached[static_cast<std::size_t>(s.attached_width * s.id[i] + 1)]);
    for (int a = 0; a < 3; ++a) {
      const std::size_t at = static_cast<std::size_t>(3 * s.id[i] + a);
      ASSERT_EQ(s.position[i][a], position[at]);
      ASSERT_EQ(s.velocity[i][a], velocity[at]);
      ASSERT_EQ(s.angular_velocity[i][a], spin[at]);
    }
  }
}

// The forces of single contacts and of lubrication are the terms of the sum under which each grain moved, to rounding.
void expect_terms_of_the_contact_force(const GrainDynamics& grains) {
  const GrainStore& store = grains.store();
  std::vector<Vec3> sum(store.owned, Vec3::Zero());
  std::vector<double> size(store.owned, 0.0);
  const auto add = [&](std::size_t slot, const Vec3& /*arm*/, const Vec3& force) {
    sum[slot] += force;
    size[slot] += force.norm();
  };
  grains.for_each_contact(add);
  grains.for_each_lubrication(add);
  for (std::size_t s = 0; s < store.owned; ++s)
    ASSERT_LE((sum[s] - store.contact_force[s]).norm(), 1e-12 * size[s]) << "grain " << store.id[s];
}

int moved_to_another_octant(const Case& c, const Cloud& seeds, const GrainDynamics& grains) {
  const Decomposition octants(c.cells, c.spacing, c.periodic, {2, 2, 2});
  int count = 0;
  for (const GrainSeed& seed : with_members(seeds.grains, seeds.clumps, octants.box()))
    if (octants.owner_of(seed.position) != octants.owner_of(grains.store().position[static_cast<std::size_t>(seed.id)]))
      ++count;
  return count;
}

// Members that are in another octant than the centre of their clump, which says whose they are.
int members_abroad(const Case& c, const GrainDynamics& grains) {
  const Decomposition octants(c.cells, c.spacing, c.periodic, {2, 2, 2});
  int count = 0;
  for (std::size_t n = 0; n < grains.clumps().size(); ++n)
    for (std::int64_t m = 0; m < grains.clumps()[n].members; ++m)
      if (octants.owner_of(grains.store().position[grains.clumps().first_slot(n) + static_cast<std::size_t>(m)]) !=
          octants.owner_of(grains.clumps()[n].centre))
        ++count;
  return count;
}

// Saved bridges across a gap, between grains that belong to different octants.
int bridges_across_borders(const Case& c, const thalweg::test::MemoryArchive& archive) {
  const Decomposition octants(c.cells, c.spacing, c.periodic, {2, 2, 2});
  const auto reals = [&](const char* name) { return std::get<std::vector<double>>(archive.datasets.at(name).values); };
  const auto ids = std::get<std::vector<std::int64_t>>(archive.datasets.at("grains/contact_ids").values);
  const auto bridge = reals("grains/contact_bridge"), position = reals("grains/position"),
             radius = reals("grains/radius");
  int count = 0;
  for (std::size_t n = 0; n < bridge.size(); ++n) {
    const auto first = static_cast<std::size_t>(ids[2 * n]), second = static_cast<std::size_t>(ids[2 * n + 1]);
    if (ids[2 * n + 1] < 0 || bridge[n] == 0.0) continue;
    const Vec3 a(&position[3 * first]), b(&position[3 * second]);
    const bool stretched = octants.box().difference(a, b).norm() > radius[first] + radius[second];
    count += stretched && octants.owner_of(a) != octants.owner_of(b);
  }
  return count;
}

// Layouts matter to what crosses borders, not to the law of a contact: cases that add only a law take two. Four ranks
// try all; eight, which wait for one another most of the time, both kinds of slabs and the blocks, or only the blocks.
enum class Layouts { all, two };

std::vector<Index3> layouts(const Case& c, int ranks, Layouts wanted) {
  const std::vector<Index3> possible = layouts(c.cells, ranks);
  if (possible.size() <= 2 || (wanted == Layouts::all && ranks <= 4)) return possible;
  const Index3 blocks = Decomposition::best_layout(c.cells, ranks);
  if (wanted == Layouts::two && ranks > 4) return {blocks};
  if (wanted == Layouts::two) return {possible.front(), blocks};
  return {possible.front(), blocks, possible.back()};
}

void compare(const Case& c, int steps, Layouts wanted = Layouts::all) {
  const Cloud seeds = cloud(c);
  const GrainParameters p = parameters_of(c);
  const int ranks = size_of(MPI_COMM_WORLD);
  GrainDynamics alone(Decomposition(c.cells, c.spacing, c.periodic, {1, 1, 1}), MPI_COMM_SELF, p, seeds.grains,
                      seeds.clumps);
  const double energy = alone.kinetic_energy();
  run(alone, steps / 2);
  const thalweg::test::MemoryArchive half = saved(alone, MPI_COMM_SELF);
  run(alone, steps - steps / 2);
  const thalweg::test::MemoryArchive reference = saved(alone, MPI_COMM_SELF);
  // The run is worth comparing: grains collided, touch with friction, and have crossed borders.
  EXPECT_LT(alone.kinetic_energy(), 0.9 * energy);
  EXPECT_GT(half.datasets.at("grains/contact_ids").shape[0], c.clumps ? 4u : 10u);
  EXPECT_GT(alone.rebuilds(), 3);
  EXPECT_GT(moved_to_another_octant(c, seeds, alone), c.grains / 10);
  if (c.clumps) {
    EXPECT_GT(members_abroad(c, alone), c.grains / 10);
  }
  if (c.moist) {
    EXPECT_GT(bridges_across_borders(c, half), 0);
  }
  if (c.plate) {
    EXPECT_LT(alone.wall_forces().back()[2], 0.0);
  }
  if (c.solids) {
    const std::vector<Vec3> forces = alone.wall_forces();
    for (const std::size_t s : {p.walls.size(), p.walls.size() + 1}) EXPECT_NE(forces[s][2], 0.0) << s;
  }

  for (const Index3& layout : layouts(c, ranks, wanted)) {
    const std::string name = fmt::format("layout {},{},{}", layout[0], layout[1], layout[2]);
    const Decomposition decomposition(c.cells, c.spacing, c.periodic, layout);
    GrainDynamics grains(decomposition, MPI_COMM_WORLD, p, seeds.grains, seeds.clumps);
    run(grains, steps / 2);
    EXPECT_EQ(thalweg::test::first_difference(saved(grains, MPI_COMM_WORLD), half), "") << name;
    expect_true_ghosts(grains, MPI_COMM_WORLD);
    run(grains, steps - steps / 2);
    EXPECT_EQ(thalweg::test::first_difference(saved(grains, MPI_COMM_WORLD), reference), "") << name;
    EXPECT_EQ(grains.kinetic_energy(), alone.kinetic_energy()) << name;
    EXPECT_EQ(grains.momentum(), alone.momentum()) << name;
    EXPECT_EQ(grains.contact_count(), alone.contact_count()) << name;
    EXPECT_EQ(grains.largest_overlap(), alone.largest_overlap()) << name;
    EXPECT_EQ(grains.rebuilds(), alone.rebuilds()) << name;
    expect_terms_of_the_contact_force(grains);

    // The state that one rank saved half way, loaded on all of them, ends alike.
    GrainDynamics restarted(decomposition, MPI_COMM_WORLD, p, GrainSeeds{});
    thalweg::test::load(restarted, half);
    EXPECT_EQ(thalweg::test::first_difference(saved(restarted, MPI_COMM_WORLD), half), "") << name;
    run(restarted, steps - steps / 2);
    EXPECT_EQ(thalweg::test::first_difference(saved(restarted, MPI_COMM_WORLD), reference), "") << name;
  }
}

TEST(Ranks, CloudInAPeriodicBox) {
  compare({{16, 16, 16}, 2.0e-3, {true, true, true}, 220, Vec3::Zero(), Vec3(0.2, -0.3, 0.4)}, 120);
}

TEST(Ranks, HeapBetweenWalls) {
  compare({{16, 8, 32}, 1.5e-3, {false, false, false}, 60, Vec3(4.0, 0.0, -15.0), Vec3::Zero()}, 240);
}

TEST(Ranks, HeapThatSlidesAcrossBorders) {
  compare({{16, 16, 16}, 1.5e-3, {true, true, false}, 60, Vec3(4.0, 2.0, -15.0), Vec3(0.4, 0.3, 0.0)}, 240);
}

TEST(Ranks, ElasticHeapOfTwoMaterials) {
  compare({{16, 16, 16}, 1.5e-3, {true, true, false}, 60, Vec3(4.0, 2.0, -15.0), Vec3(0.4, 0.3, 0.0), true}, 240,
          Layouts::two);
}

TEST(Ranks, CloudOfClumpsInAPeriodicBox) {
  Case c{{16, 16, 16}, 2.0e-3, {true, true, true}, 110, Vec3::Zero(), Vec3(0.2, -0.3, 0.4)};
  c.clumps = true;
  compare(c, 80);
}

TEST(Ranks, HeapOfClumpsThatSlidesAcrossBorders) {
  Case c{{16, 16, 16}, 1.5e-3, {true, true, false}, 30, Vec3(4.0, 2.0, -30.0), Vec3(0.4, 0.3, 0.0)};
  c.clumps = c.movable_cuts = c.lubricated = true;
  compare(c, 320);
}

TEST(Ranks, HeapWithRollingFriction) {
  Case c{{16, 16, 16}, 1.5e-3, {true, true, false}, 60, Vec3(4.0, 2.0, -15.0), Vec3(0.4, 0.3, 0.0)};
  c.rolling = 0.1;
  compare(c, 240, Layouts::two);
  c.elastic = true;
  compare(c, 240, Layouts::two);
}

TEST(Ranks, HeapOnSolids) {
  Case c{{16, 16, 16}, 1.5e-3, {true, true, false}, 60, Vec3(4.0, 2.0, -15.0), Vec3(0.4, 0.3, 0.0)};
  c.solids = true;
  compare(c, 240);
  c.elastic = c.lubricated = true;
  c.rolling = 0.1;
  compare(c, 240, Layouts::two);
}

TEST(Ranks, HeapOnAMovingFloorWithARigidAssembly) {
  Case c{{16, 16, 16}, 1.5e-3, {true, true, false}, 80, Vec3(4.0, 2.0, -25.0), Vec3(0.4, 0.3, 0.0)};
  c.moving = true;
  compare(c, 240, Layouts::two);
}

TEST(Ranks, HeapLiftedByAPlate) {
  Case c{{16, 16, 16}, 1.5e-3, {true, true, false}, 80, Vec3(4.0, 2.0, -25.0), Vec3(0.4, 0.3, 0.0)};
  c.plate = true;
  compare(c, 240, Layouts::two);
  c.clumps = true;
  c.gravity = Vec3(4.0, 2.0, -30.0);
  c.grains = 30;
  compare(c, 320, Layouts::two);
}

// Everything falls into one corner of a closed box, so that even cuts leave some ranks nearly without grains.
TEST(Ranks, CutsFollowTheGrainsAndChangeNothing) {
  Case c{{48, 48, 48}, 1.0e-3, {false, false, false}, 120, Vec3(-12.0, -9.0, -12.0), Vec3(-0.2, -0.2, -0.2)};
  c.movable_cuts = true;
  compare(c, 300);

  const auto fullest = [&](bool movable) {
    c.movable_cuts = movable;
    GrainDynamics grains(Decomposition(c.cells, c.spacing, c.periodic, {size_of(MPI_COMM_WORLD), 1, 1}), MPI_COMM_WORLD,
                         parameters_of(c), cloud(c).grains);
    run(grains, 300);
    return max_over_ranks(MPI_COMM_WORLD, static_cast<double>(grains.store().owned));
  };
  const double even = fullest(false), followed = fullest(true);
  if (size_of(MPI_COMM_WORLD) > 1) {
    EXPECT_LT(followed, 0.9 * even);
  }
}

TEST(Ranks, HeapWithLubrication) {
  Case c{{16, 16, 16}, 1.5e-3, {true, true, false}, 60, Vec3(4.0, 2.0, -15.0), Vec3(0.4, 0.3, 0.0)};
  c.lubricated = true;
  compare(c, 240, Layouts::two);
}

TEST(Ranks, HeapWithLiquidBridges) {
  Case c{{16, 16, 16}, 1.5e-3, {true, true, false}, 60, Vec3(4.0, 2.0, -15.0), Vec3(0.4, 0.3, 0.0)};
  c.moist = true;
  compare(c, 240, Layouts::two);
  c.elastic = true;
  c.rolling = 0.1;
  compare(c, 240, Layouts::two);
}

TEST(Ranks, MoistHeapOfClumpsWithMovingCuts) {
  Case c{{16, 16, 16}, 1.5e-3, {true, true, false}, 30, Vec3(4.0, 2.0, -30.0), Vec3(0.4, 0.3, 0.0)};
  c.moist = c.clumps = c.movable_cuts = c.lubricated = true;
  compare(c, 320, Layouts::two);
}

TEST(Ranks, ChannelTwoDiametersWide) {
  // 10.5 mm, 2.1 of the largest diameters, periodic and cut; and short along x as well, where everything is near.
  compare({{32, 8, 16}, 1.3125e-3, {true, true, false}, 40, Vec3(4.0, 0.0, -15.0), Vec3(0.2, 0.4, 0.0)}, 420);
  compare({{8, 8, 32}, 1.3125e-3, {true, true, false}, 30, Vec3(0.0, 4.0, -15.0), Vec3(0.3, 0.4, 0.0)}, 420);
}

TEST(Ranks, StateSavedByAllIsLoadedByOne) {
  const Case c{{16, 8, 16}, 2.0e-3, {true, true, false}, 80, Vec3(0.0, 0.0, -15.0), Vec3(0.3, 0.2, 0.0)};
  const GrainParameters p = parameters_of(c);
  const Decomposition one(c.cells, c.spacing, c.periodic, {1, 1, 1});
  GrainDynamics together(
      Decomposition(c.cells, c.spacing, c.periodic, Decomposition::best_layout(c.cells, size_of(MPI_COMM_WORLD))),
      MPI_COMM_WORLD, p, cloud(c).grains);
  run(together, 120);
  const thalweg::test::MemoryArchive half = saved(together, MPI_COMM_WORLD);
  run(together, 120);
  GrainDynamics alone(one, MPI_COMM_SELF, p, GrainSeeds{});
  thalweg::test::load(alone, half);
  run(alone, 120);
  EXPECT_EQ(thalweg::test::first_difference(saved(together, MPI_COMM_WORLD), saved(alone, MPI_COMM_SELF)), "");
}

}  // namespace
}  // namespace thalweg::dem::ranks_test
