// Grains that are placed by ranks, each knowing its own and what may touch them.
#include "beds/files/population_bed.hpp"
#include "beds/packing/random_packing.hpp"
#include "beds/population_seeds.hpp"
#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "tests/dem/grain_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace thalweg::beds::seeds_of_rank_test {
namespace {

using namespace dem;

constexpr Index3 cells{24, 16, 24};

Decomposition box_cut_into(const Index3& layout) { return Decomposition(cells, 2.5e-3, {true, true, false}, layout); }
Decomposition shared_box() { return box_cut_into(Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD))); }

constexpr double reach = 5e-3 * (1.0 + allowed_initial_overlap);  // of two centres that touch

Population glass(std::int64_t count, PlacementPattern pattern, double lower, double upper) {
  Population grains;
  grains.count = count;
  grains.diameter = 5e-3;
  grains.density = 2550.0;
  grains.placement.pattern = pattern;
  grains.placement.region = RegionKeys{Vec3(0.0, 0.0, lower), Vec3(0.06, 0.04, upper)};
  return grains;
}

// A lattice, grains at random that keep clear of it, two at given places, and a body of four that moves as one.
std::vector<Population> four_kinds() {
  Population given = glass(2, PlacementPattern::uniform, 0.0, 0.06),
             body = glass(4, PlacementPattern::uniform, 0.05, 0.06);
  given.placement.region.reset();
  given.placement.positions = {Vec3(0.001, 0.02, 0.045), Vec3(0.0585, 0.0245, 0.045)};
  given.velocity = Vec3(0.1, 0.0, 0.0);
  body.motion = MotionKeys{};
  return {glass(90, PlacementPattern::uniform, 0.0, 0.02), glass(60, PlacementPattern::random, 0.0, 0.045), given,
          body};
}

GrainSeeds of_this_rank(const std::vector<Population>& populations, const Decomposition& decomposition = shared_box()) {
  return grain_seeds(populations, PackingDomain(decomposition.box(), MPI_COMM_WORLD, decomposition, reach));
}

GrainSeeds of_one_process(const std::vector<Population>& populations) {
  return grain_seeds(populations, PackingDomain(shared_box().box()));
}

bool same(const GrainSeed& a, const GrainSeed& b) {
  return a.id == b.id && a.position == b.position && a.velocity == b.velocity && a.radius == b.radius &&
         a.density == b.density && a.motion == b.motion && a.assembly == b.assembly && a.material == b.material;
}

// Every grain that this rank is to know, as among all, and no other.
void expect_share_of_all(const std::vector<Population>& populations, std::size_t count,
                         const Decomposition& decomposition = shared_box()) {
  const PeriodicBox box = decomposition.box();
  const GrainSeeds all = of_one_process(populations);
  ASSERT_TRUE(all.whole);
  ASSERT_EQ(all.grains.size(), count);
  const GrainSeeds mine = of_this_rank(populations, decomposition);
  EXPECT_EQ(mine.whole, decomposition.ranks() == 1);
  std::map<GlobalId, GrainSeed> known;
  for (const GrainSeed& grain : mine.grains) known[grain.id] = grain;
  EXPECT_EQ(known.size(), mine.grains.size());
  for (const GrainSeed& grain : all.grains) {
    const bool wanted = decomposition.reaches(rank_of(MPI_COMM_WORLD), box.wrapped(grain.position), reach) ||
                        grain.assembly >= 0 || decomposition.ranks() == 1;
    ASSERT_EQ(known.count(grain.id), wanted ? 1u : 0u);
    EXPECT_TRUE(!wanted || same(known[grain.id], grain)) << grain.id;
  }
}

TEST(SeedsOfRank, AreItsShareOfAllSeeds) { expect_share_of_all(four_kinds(), 156); }

// Three sizes at random among grains on a lattice, nearly a third of the volume, and a body placed at random.
TEST(SeedsOfRank, AtRandomAreItsShareOfAllSeeds) {
  Population mixed = glass(240, PlacementPattern::random, 0.0, 0.06),
             body = glass(5, PlacementPattern::random, 0.03, 0.06);
  for (int grain = 0; grain < 240; ++grain)
    mixed.diameters.push_back(grain % 3 == 0 ? 5e-3 : grain % 3 == 1 ? 4e-3 : 2e-3);
  body.motion = MotionKeys{};
  expect_share_of_all({mixed, glass(60, PlacementPattern::uniform, 0.0, 0.02), body}, 305);
}

// Half of the volume below, and grains at random that keep clear of it.
TEST(SeedsOfRank, DenselyPackedAreItsShareOfAllSeeds) {
  Population dense = glass(550, PlacementPattern::dense, 0.0, 0.04);
  for (int grain = 0; grain < 550; ++grain) dense.diameters.push_back(grain % 2 == 0 ? 5e-3 : 4.5e-3);
  expect_share_of_all({glass(40, PlacementPattern::random, 0.03, 0.06), dense}, 590);
}

// One grain that starts just before the middle of the box, where two and more ranks meet, and is pushed across it, by
// 0.3 mm and a third more before it stops, by a grain behind it. That is too far for another one in front, which a rank
// would not know by the distance from its block alone.
TEST(SeedsOfRank, DenselyPackedAmongOthersAreTheirShareOfAllSeeds) {
  Population given = glass(2, PlacementPattern::uniform, 0.0, 0.06),
             dense = glass(1, PlacementPattern::dense, 0.0, 0.06);
  given.placement.region.reset();
  given.placement.positions = {Vec3(0.02525, 0.02, 0.03), Vec3(0.0353, 0.02, 0.03)};
  dense.placement.region = RegionKeys{Vec3(0.02745, 0.0174, 0.0274), Vec3(0.033, 0.0226, 0.0326)};
  const int ranks = size_of(MPI_COMM_WORLD);
  const Decomposition decomposition = box_cut_into(ranks > 1 ? Index3{2, ranks / 2, 1} : Index3{1, 1, 1});
  for (dense.placement.seed = 1; dense.placement.seed < 40; ++dense.placement.seed)
    expect_share_of_all({given, dense}, 3, decomposition);
}

// Two sizes at random among obstacles, a quarter of the volume.
TEST(SeedsOfRank, PlacedTogetherAreThoseOfOneRank) {
  const Decomposition decomposition = shared_box();
  const PeriodicBox box = decomposition.box();
  const auto radius = [](std::int64_t number) { return number % 3 == 0 ? 2.5e-3 : 1.8e-3; };
  const GrainsToPlace grains{whole(box), 720, radius, 2.5e-3, 0.0, 7};
  const std::vector<Obstacle> obstacles{{{Vec3(0.03, 0.02, 0.03), 2.4e-3}, 1}, {{Vec3(0.0, 0.0, 0.05), 1e-3}, 2}};
  const PackingDomain together(box, MPI_COMM_WORLD, decomposition, reach);
  std::vector<Obstacle> known;
  for (const Obstacle& obstacle : obstacles)
    if (together.knows(obstacle.sphere.position)) known.push_back(obstacle);
  const std::vector<PlacedGrain> all = random_packing(PackingDomain(box), grains, obstacles),
                                 mine = random_packing(together, grains, known);
  ASSERT_EQ(all.size(), 720u);
  auto here = mine.begin();
  for (const PlacedGrain& grain : all) {
    for (const Obstacle& obstacle : obstacles)
      EXPECT_GE(box.difference(grain.centre, obstacle.sphere.position).norm(),
                radius(grain.number) + obstacle.sphere.radius);
    for (std::int64_t other = 0; other < grain.number; ++other)
      EXPECT_GE(box.difference(grain.centre, all[static_cast<std::size_t>(other)].centre).norm(),
                radius(grain.number) + radius(other));
    EXPECT_TRUE(grain.centre.z() >= radius(grain.number) && grain.centre.z() <= 0.06 - radius(grain.number));
    if (!together.knows(grain.centre)) continue;
    ASSERT_TRUE(here != mine.end());
    EXPECT_TRUE(here->number == grain.number && here->centre == grain.centre) << grain.number;
    ++here;
  }
  EXPECT_TRUE(here == mine.end());
}

TEST(SeedsOfRank, TooManyPlacedTogetherAreRefusedOnAllRanks) {
  const Decomposition decomposition = shared_box();
  const GrainsToPlace grains{whole(decomposition.box()), 1100, [](std::int64_t) { return 2.5e-3; }, 2.5e-3, 0.0, 7};
  const PackingDomain ranks(decomposition.box(), MPI_COMM_WORLD, decomposition, reach);
  EXPECT_THROW(random_packing(ranks, grains, {}), InputError);
}

// All ranks say how many did.
TEST(SeedsOfRank, ThatDoNotFitAreRefusedOnAllRanks) {
  const auto message_of = [](const std::vector<Population>& populations) -> std::string {
    try {
      of_this_rank(populations);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  const std::string alone = message_of({glass(1100, PlacementPattern::random, 0.0, 0.06)});
  EXPECT_NE(alone.find("grains.0: 1100 grains do not fit at random"), std::string::npos) << alone;
  EXPECT_EQ(alone.find("other populations"), std::string::npos) << alone;
  // 600 would fit without the dense ones, which are placed before wherever they stand in the list.
  const std::string beside =
      message_of({glass(600, PlacementPattern::random, 0.0, 0.06), glass(550, PlacementPattern::dense, 0.0, 0.04)});
  EXPECT_NE(beside.find("beside those of other populations"), std::string::npos) << beside;
}

GrainParameters usual() {
  GrainParameters p = test::parameters(test::glass(0.9), 5e-6, 20);
  p.assemblies = assemblies_of(four_kinds());
  return p;
}

// The lists of a rank make the same grains as the whole lists, and know what there is of the whole.
TEST(SeedsOfRank, BeginTheSameRun) {
  const std::vector<Population> populations = four_kinds();
  const Decomposition decomposition = shared_box();
  GrainDynamics whole(decomposition, MPI_COMM_WORLD, usual(), of_one_process(populations));
  GrainDynamics parts(decomposition, MPI_COMM_WORLD, usual(), of_this_rank(populations));
  EXPECT_EQ(parts.global_count(), 156);
  EXPECT_EQ(parts.body_count(), whole.body_count());
  for (int step = 0; step < 20; ++step)
    for (GrainDynamics* grains : {&whole, &parts}) {
      grains->prepare();
      grains->advance(20);
      grains->refresh_ghosts();
    }
  ASSERT_EQ(parts.store().id, whole.store().id);
  EXPECT_EQ(parts.store().position, whole.store().position);
  EXPECT_EQ(parts.store().velocity, whole.store().velocity);
}

// Two grains overlap where one rank or two see it; all ranks say so.
TEST(SeedsOfRank, AreRefusedOnAllRanks) {
  std::vector<Population> populations{glass(2, PlacementPattern::uniform, 0.0, 0.06)};
  populations[0].placement.region.reset();
  populations[0].placement.positions = {Vec3(0.0599, 0.02, 0.03), Vec3(0.003, 0.02, 0.03)};
  std::string message;
  try {
    const GrainDynamics grains(shared_box(), MPI_COMM_WORLD, usual(), of_this_rank(populations));
  } catch (const InputError& error) {
    message = error.what();
  }
  EXPECT_NE(message.find("grain 1 at"), std::string::npos) << message;
  EXPECT_NE(message.find("overlap by 0.0019 m"), std::string::npos) << message;
}

}  // namespace
}  // namespace thalweg::beds::seeds_of_rank_test
