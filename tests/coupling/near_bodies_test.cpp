// Which cells are near bodies is the same on any ranks and as a search of the whole box finds it, however grains come
// and go through rank borders and periodic faces.
#include "tests/coupling/crowded_box.hpp"
#include "tests/support/memory_archive.hpp"

#include "core/mpi_session.hpp"
#include "coupling/fluid_system.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <random>
#include <set>

namespace thalweg::coupling::near_bodies_test {
namespace {

// What is covered in the whole box.
class Cover {
public:
  explicit Cover(const Decomposition& decomposition)
      : whole_{{0, 0, 0}, decomposition.cells()},
        periodic_(decomposition.periodic()),
        covered_(static_cast<std::size_t>(whole_.volume())) {}

  void add(const Block& block, const lbm::CellMap& cells) {
    for_each_cell(block, [&](const Index3& at, const Index3& local) {
      const bool fluid = cells.is_fluid(cells.indexing().index(local[0], local[1], local[2]));
      covered_[static_cast<std::size_t>(whole_.place_of(at))] = fluid ? 0 : 1;
    });
  }
  void gather() {
    MPI_Allreduce(MPI_IN_PLACE, covered_.data(), static_cast<int>(covered_.size()), MPI_CHAR, MPI_MAX, MPI_COMM_WORLD);
  }

  bool is_near(const Index3& cell) const {
    for (int z = -3; z <= 3; ++z)
      for (int y = -3; y <= 3; ++y)
        for (int x = -3; x <= 3; ++x)
          if (x * x + y * y + z * z <= 9 && covers({cell[0] + x, cell[1] + y, cell[2] + z})) return true;
    return false;
  }

  // Cells of the block of which the map knows something else; counts those that are near.
  std::int64_t wrong(const Block& block, const lbm::CellMap& cells, std::int64_t& near) const {
    std::int64_t differing = 0;
    const int pack = cells.indexing().pack();
    for_each_cell(block, [&](const Index3& at, const Index3& local) {
      const bool known = cells.near_bodies(local[1], local[2])[local[0] / pack] >> local[0] % pack & 1;
      const bool is = is_near(at);
      differing += known != is;
      near += is;
    });
    return differing;
  }

private:
  template <typename Visit>
  static void for_each_cell(const Block& block, Visit visit) {
    const Index3 n = block.size();
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y)
        for (int x = 0; x < n[0]; ++x)
          visit(Index3{block.lower[0] + x, block.lower[1] + y, block.lower[2] + z}, Index3{x, y, z});
  }

  bool covers(Index3 at) const {
    for (int a = 0; a < 3; ++a) {
      const int n = whole_.upper[a];
      if (periodic_[a]) at[a] = (at[a] + n) % n;
    }
    return whole_.contains(at) && covered_[static_cast<std::size_t>(whole_.place_of(at))] != 0;
  }

  Block whole_;
  std::array<bool, 3> periodic_;
  std::vector<char> covered_;
};

// The maps of all blocks of a decomposition, without ranks.
class AllMaps {
public:
  explicit AllMaps(const Decomposition& decomposition) : decomposition_(decomposition) {
    for (int rank = 0; rank < decomposition.ranks(); ++rank)
      parts_.push_back(std::make_unique<Part>(decomposition_, decomposition.block_of(rank)));
  }

  void place(GlobalId id, double radius, const Vec3& centre) {
    for (const auto& part : parts_) {
      const int slot = part->map.slot_of(id);
      part->map.place(slot >= 0 ? slot : part->map.add(id, {radius}), centre);
    }
  }
  void remove(GlobalId id) {
    for (const auto& part : parts_) part->map.remove(part->map.slot_of(id));
  }

  // Cells near bodies. Expects them right everywhere.
  std::int64_t near() const {
    Cover cover(decomposition_);
    std::int64_t count = 0;
    for (const auto& part : parts_) cover.add(part->block, part->cells);
    for (const auto& part : parts_) EXPECT_EQ(cover.wrong(part->block, part->cells, count), 0);
    return count;
  }

private:
  struct Part {
    Block block;
    lbm::CellMap cells;
    GrainMap<> map;

    Part(const Decomposition& decomposition, const Block& its)
        : block(its), cells(lbm::CellIndexing(its.size(), 8)), map(decomposition, its, cells) {}
  };

  const Decomposition& decomposition_;
  std::vector<std::unique_ptr<Part>> parts_;
};

const Index3 layouts[] = {{1, 1, 1}, {2, 1, 1}, {4, 2, 1}, {1, 3, 2}, {2, 2, 4}};
const std::array<bool, 3> open_ends[] = {{true, true, true}, {true, false, false}, {false, false, false}};

// Grains that overlap, grow few and many, move by fractions of a cell, and jump.
TEST(NearBodies, AreFoundAsGrainsComeMoveAndGo) {
  const Index3 cells{16, 14, 17};
  for (const Index3& layout : layouts)
    for (const auto& periodic : open_ends) {
      const Decomposition decomposition(cells, 1.0, periodic, layout);
      const PeriodicBox box = decomposition.box();
      AllMaps maps(decomposition);
      std::mt19937 generator(7);
      std::uniform_real_distribution<double> uniform(0.0, 1.0);
      const auto anywhere = [&] {
        return Vec3(cells[0] * uniform(generator), cells[1] * uniform(generator), cells[2] * uniform(generator));
      };
      std::vector<std::optional<Vec3>> centre(7);
      std::int64_t least = 1 << 20, most = 0;
      for (int event = 0; event < 400; ++event) {
        const auto id = static_cast<std::size_t>(event * 5 % 7);
        const double what = uniform(generator), radius = 1.1 + 0.4 * static_cast<double>(id);
        if (centre[id] && what < 0.3) {
          maps.remove(static_cast<GlobalId>(id));
          centre[id].reset();
        } else if (centre[id] && what < 0.85) {
          const Vec3 step(uniform(generator) - 0.5, uniform(generator) - 0.5, uniform(generator) - 0.5);
          centre[id] = box.wrapped(*centre[id] + step);
          maps.place(static_cast<GlobalId>(id), radius, *centre[id]);
        } else {
          centre[id] = anywhere();
          maps.place(static_cast<GlobalId>(id), radius, *centre[id]);
        }
        if (event % 8 != 0) continue;
        const std::int64_t near = maps.near();
        least = std::min(least, near);
        most = std::max(most, near);
        ASSERT_FALSE(HasFailure()) << event << ", layout " << layout[0] << layout[1] << layout[2];
      }
      EXPECT_LT(least, 1000);
      EXPECT_GT(most, 2000);
    }
}

// Of two grains with a cell in common one goes: what is near is near to the other, whichever came first and has it.
TEST(NearBodies, OfTheGrainThatStaysRemainWhenOneOfTwoGivesUp) {
  const Decomposition decomposition({16, 16, 16}, 1.0, {true, true, true}, {2, 2, 1});
  const Vec3 centres[] = {{0.3, 6.2, 15.6}, {1.9, 7.7, 14.9}};  // across faces of blocks and of the box
  for (const int stays : {0, 1}) {
    AllMaps alone(decomposition);
    alone.place(stays, 2.6, centres[stays]);
    const std::int64_t expected = alone.near();
    EXPECT_GT(expected, 300);
    for (const int first : {0, 1}) {
      AllMaps both(decomposition);
      both.place(first, 2.6, centres[first]);
      both.place(1 - first, 2.6, centres[1 - first]);
      EXPECT_GT(both.near(), expected);
      both.remove(1 - stays);
      EXPECT_EQ(both.near(), expected);
      both.remove(stays);
      EXPECT_EQ(both.near(), 0);
    }
  }
}

template <typename Fluid>
void expect_right(const Fluid& fluid) {
  Cover cover(fluid.decomposition());
  std::int64_t near = 0;
  cover.add(fluid.block(), fluid.cells());
  cover.gather();
  EXPECT_EQ(cover.wrong(fluid.block(), fluid.cells(), near), 0);
  near = sum_over_ranks(MPI_COMM_WORLD, near);
  EXPECT_GT(near, 1000);
  const Block whole{{0, 0, 0}, fluid.decomposition().cells()};
  EXPECT_LT(near, whole.volume());
}

// A current that carries the grains along, every seventh of which is held. Returns how many came to another rank.
std::int64_t expect_right_while_grains_drift(WaterBox box, const Index3& layout) {
  static const Vec3 drift(0.4, 0.35, 0.1);  // m/s: three cells in the steps below
  box.initial = [](const Vec3& p) { return FluidInitialState{0.0, swirl(p).velocity + drift}; };
  for (std::size_t k = 0; k < box.seeds.size(); ++k) {
    const bool held = k % 7 == 0;
    if (held) box.seeds[k].motion = dem::Motion::fixed;
    box.seeds[k].velocity = held ? Vec3(Vec3::Zero()) : Vec3(box.seeds[k].velocity + drift);
  }
  for (dem::ClumpSeed& clump : box.clumps) clump.velocity += drift;
  const auto system = make_system<float>(box, MPI_COMM_WORLD, layout);
  const auto owned = [&] {
    const dem::GrainStore& store = system->grains().store();
    return std::set<GlobalId>(store.id.begin(), store.id.begin() + static_cast<std::ptrdiff_t>(store.owned));
  };
  const std::set<GlobalId> before = owned();
  for (int step = 0; step < 60; ++step) {
    if (step % 10 == 0) expect_right(system->fluid());
    system->advance();
  }
  expect_right(system->fluid());
  std::int64_t arrived = 0;
  for (const GlobalId id : owned()) arrived += !before.contains(id);
  return sum_over_ranks(MPI_COMM_WORLD, arrived);
}

void expect_right_while_grains_drift(const WaterBox& box, const std::vector<Index3>& cuts) {
  std::int64_t arrived = 0;
  for (const Index3& layout : cuts) arrived += expect_right_while_grains_drift(box, layout);
  EXPECT_EQ(arrived > 0, size_of(MPI_COMM_WORLD) > 1);
}

// Leaves one of so many.
void thin_out(WaterBox& box, GlobalId one_of) {
  std::erase_if(box.seeds, [&](const dem::GrainSeed& seed) { return seed.id % one_of != 0; });
  for (std::size_t k = 0; k < box.seeds.size(); ++k) box.seeds[k].id = static_cast<GlobalId>(k);
}

TEST(NearBodies, AreKnownInAPeriodicBoxOnAnyRanks) {
  WaterBox box = crowded({33, 34, 35}, {true, true, true}, 60, 5.4e-3);
  thin_out(box, 2);
  expect_right_while_grains_drift(box, layouts_of(size_of(MPI_COMM_WORLD)));
}

TEST(NearBodies, AreKnownBetweenWallsOnAnyRanks) {
  WaterBox box = crowded({40, 24, 36}, {true, false, false}, 36, 5.5e-3);
  expect_right_while_grains_drift(box, two_layouts_of(size_of(MPI_COMM_WORLD)));
}

// As few cells as a rank may have, and grains so small that their contacts reach less far than the cells near them.
TEST(NearBodies, AreKnownInBlocksOfFourCells) {
  WaterBox box = crowded({16, 34, 35}, {true, true, false}, 30, 5.4e-3);
  for (dem::GrainSeed& seed : box.seeds) {
    seed.radius = 1.2e-3;
    seed.velocity *= 0.3;
  }
  box.sub_steps = 40;
  const int ranks = size_of(MPI_COMM_WORLD), along = std::min(ranks, 4);
  expect_right_while_grains_drift(box, std::vector{Index3{along, ranks / along, 1}});
}

TEST(NearBodies, OfClumpsAreKnownOnAnyRanks) {
  const WaterBox box = crowded_pebbles({36, 40, 33}, {true, true, true}, 30, 7.4e-3);
  expect_right_while_grains_drift(box, two_layouts_of(size_of(MPI_COMM_WORLD)));
}

// The checkpoint does not hold them: they follow from the grains, in place of those of the grains before.
TEST(NearBodies, AreKnownAfterARestart) {
  WaterBox box = crowded({33, 34, 35}, {true, true, true}, 24, 5.4e-3);
  box.initial = swirl;
  const std::vector<Index3> cuts = two_layouts_of(size_of(MPI_COMM_WORLD));
  const auto first = make_system<float>(box, MPI_COMM_WORLD, cuts[0]),
             second = make_system<float>(box, MPI_COMM_WORLD, cuts[1]);
  for (int step = 0; step < 30; ++step) first->advance();
  test::MemoryArchive archive;
  test::MemoryWriter writer(archive, MPI_COMM_WORLD);
  first->save(writer);
  test::MemoryReader reader(archive);
  second->load(reader);
  expect_right(second->fluid());
  for (int step = 0; step < 5; ++step) second->advance();
  expect_right(second->fluid());
}

// Spheres that overlap, one through corners of a periodic box, and tetrahedra, which overlap nothing or a sphere.
TEST(NearBodies, OfSolidsAreKnownOnAnyRanks) {
  const auto tetrahedron = [](const Vec3& corner, double side) {
    TriangleMesh mesh;
    mesh.points = {corner, corner + side * Vec3::UnitX(), corner + side * Vec3::UnitY(), corner + side * Vec3::UnitZ()};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
  };
  const std::vector<SolidShape> solids = {SolidSphere{{0.4, 0.2, 15.7}, {2.7}}, SolidSphere{{2.9, 1.2, 15.1}, {2.2}},
                                          tetrahedron({8.2, 14.1, 3.3}, 5.0), tetrahedron({1.2, 2.1, 10.3}, 6.0)};
  for (const auto& periodic : open_ends)
    for (const Index3& layout : layouts_of(size_of(MPI_COMM_WORLD))) {
      if (layout[0] > 4 || layout[1] > 4 || layout[2] > 4) continue;
      FluidParameters parameters;
      parameters.units = {1.0, 1.0, 1.0};
      const FluidSystem<float> system(std::make_unique<Decomposition>(Index3{16, 19, 17}, 1.0, periodic, layout),
                                      MPI_COMM_WORLD, parameters, solids);
      expect_right(system.fluid());
    }
}

}  // namespace
}  // namespace thalweg::coupling::near_bodies_test
