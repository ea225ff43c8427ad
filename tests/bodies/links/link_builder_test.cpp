// Links kept up to date against links found anew.
#include "bodies/links/link_builder.hpp"

#include "bodies/map/body_map.hpp"
#include "lbm/fluid/fluid.hpp"
#include "tests/bodies/enclosed_by_definition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <utility>

namespace thalweg::bodies::link_builder_test {
namespace {

const lbm::FaceConditions between_plates{{{}, {}, {}, {}, {lbm::FaceType::no_slip}, {lbm::FaceType::no_slip}}};

// Every link there must be by the map of the cells, and no other, in the words of the table.
std::set<std::array<std::uint32_t, 4>> links_by_definition(const lbm::Fluid<double>& fluid) {
  std::set<std::array<std::uint32_t, 4>> links;  // body, tile, place, tag
  const Index3& n = fluid.indexing().size();
  const lbm::CellMap& cells = fluid.cells();
  const auto is_fluid = [&](const Index3& at) {  // periodic along x and y; the faces along z are open
    const Index3 inside{(at[0] + n[0]) % n[0], (at[1] + n[1]) % n[1], std::clamp(at[2], -1, n[2])};
    return cells.is_fluid(fluid.indexing().index(inside[0], inside[1], inside[2]));
  };
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const std::ptrdiff_t cell = fluid.indexing().index(x, y, z);
        for (int i = 1; i < 19; ++i) {
          const std::int32_t body = cells.body(cell + fluid.indexing().offset(i));
          if (!cells.is_fluid(cell) || body == lbm::CellMap::fluid) continue;
          const std::int32_t upstream = cells.body(cell - fluid.indexing().offset(i));
          links.insert({static_cast<std::uint32_t>(body), static_cast<std::uint32_t>(fluid.tiles().tile_of(y, z)),
                        LinkXY::of(x, y),
                        LinkTag::of(i, upstream, thalweg::test::is_enclosed_by_definition({x, y, z}, is_fluid))});
        }
      }
  return links;
}

// The same of a table.
std::set<std::array<std::uint32_t, 4>> links_kept(const LinkTable& table) {
  std::set<std::array<std::uint32_t, 4>> kept;
  for (std::size_t tile = 0; tile < table.tiles().size(); ++tile) {
    const LinkTable::Tile& t = table.tiles()[tile];
    for (const LinkTable::Chunk& chunk : t.chunks)
      for (std::uint32_t k = chunk.first; k < chunk.first + chunk.count; ++k)
        kept.insert(
            {static_cast<std::uint32_t>(chunk.body), static_cast<std::uint32_t>(tile), t.links.xy[k], t.links.tag[k]});
  }
  return kept;
}

// Sum of w_i c_i over all lattice lines from a cell of q, or from beyond a wall, into an owned cell of p.
std::map<std::pair<std::int32_t, std::int32_t>, Vec3> patches_by_definition(const lbm::Fluid<double>& fluid,
                                                                            const Decomposition& decomposition) {
  std::map<std::pair<std::int32_t, std::int32_t>, Vec3> patches;
  const Index3& n = fluid.indexing().size();
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        const std::ptrdiff_t cell = fluid.indexing().index(x, y, z);
        const std::int32_t p = fluid.cells().body(cell);
        for (int i = 1; i < 19 && p != lbm::CellMap::fluid; ++i) {
          const int from[3] = {x - lbm::D3Q19::c[i][0], y - lbm::D3Q19::c[i][1], z - lbm::D3Q19::c[i][2]};
          std::int32_t q = fluid.cells().body(cell - fluid.indexing().offset(i));
          for (int a = 0; a < 3; ++a)
            if (!decomposition.periodic()[a] && (from[a] < 0 || from[a] >= n[a]))
              q = OccludedPatches::wall_of_face(2 * a + (from[a] < 0 ? 0 : 1));
          if (q == p || q == lbm::CellMap::fluid) continue;
          Vec3& sum = patches.try_emplace({p, q}, Vec3::Zero()).first->second;
          for (int a = 0; a < 3; ++a) sum[a] += lbm::D3Q19::weight(i) * lbm::D3Q19::c[i][a];
        }
      }
  return patches;
}

// Spheres wander, jump, vanish and appear, through each other and the periodic faces, many cells changing hands at
// once: what the builder keeps up to date must be what it would find anew.
TEST(LinkBuilder, FollowsTheMapThroughAnyMoves) {
  const Index3 cells{21, 18, 17};
  const Decomposition decomposition(cells, 1.0, {true, true, false}, {1, 1, 1});
  lbm::Fluid<double> fluid(decomposition, MPI_COMM_SELF, {}, between_plates);
  BodyMap map(decomposition, fluid.block(), fluid.cells());
  LinkTable table(fluid.tiles().count());
  LinkBuilder builder(decomposition, fluid.block(), fluid.cells(), fluid.tiles());
  std::mt19937 generator(8);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto anywhere = [&] {
    return Vec3(cells[0] * uniform(generator), cells[1] * uniform(generator), cells[2] * uniform(generator));
  };
  constexpr GlobalId grains = 12;
  for (int round = 0; round < 100; ++round) {
    map.begin_update();
    for (GlobalId id = 0; id < grains; ++id) {
      const BodySlot slot = map.slot_of(id);
      if (slot == BodySlot::none) {
        if (uniform(generator) < 0.5) map.remap(map.add(id, 2.0 + 1.5 * uniform(generator)), anywhere());
      } else if (uniform(generator) < 0.05) {
        map.remove(slot);
      } else if (uniform(generator) < 0.7) {
        const Vec3 step =
            0.3 * (Vec3(uniform(generator), uniform(generator), uniform(generator)) - Vec3::Constant(0.5));
        const PeriodicBox box{Vec3(cells[0], cells[1], cells[2]), {true, true, false}};
        map.remap(slot,
                  uniform(generator) < 0.9 ? box.wrapped(map.bodies()[index_of(slot)].centre + step) : anywhere());
      }
    }
    map.settle();
    builder.update(map, table);
    const std::set<std::array<std::uint32_t, 4>> kept = links_kept(table);
    ASSERT_EQ(kept.size(), table.count()) << "a link twice, round " << round;
    ASSERT_EQ(kept, links_by_definition(fluid)) << "round " << round;
    std::array<Vec3, grains>
        whole;  // over the closed surface of a grain sum w_i c_i vanishes, seen and hidden together
    for (std::size_t slot = 0; slot < whole.size(); ++slot)
      whole[slot] = table.sums_of(static_cast<int>(slot)).normal();
    for (const auto& [pair, sum] : patches_by_definition(fluid, decomposition)) {
      ASSERT_LT((map.occluded_patches().patch(pair.first, pair.second) - sum).norm(), 1e-12) << "round " << round;
      whole[static_cast<std::size_t>(pair.first)] += sum;
    }
    for (const Vec3& sum : whole) ASSERT_LT(sum.norm(), 1e-12) << "round " << round;
  }
}

// A grain on each of the 18 cells around one, of which one after the other leaves and comes back: all links of that
// cell change, also those to grains that stay.
TEST(LinkBuilder, KnowsWhichCellsAreEnclosed) {
  const Index3 middle{9, 0, 4};
  const Decomposition decomposition({18, 9, 9}, 1.0, {true, true, false}, {1, 1, 1});
  lbm::Fluid<double> fluid(decomposition, MPI_COMM_SELF, {}, between_plates);
  BodyMap map(decomposition, fluid.block(), fluid.cells());
  LinkTable table(fluid.tiles().count());
  LinkBuilder builder(decomposition, fluid.block(), fluid.cells(), fluid.tiles());
  const PeriodicBox box{Vec3(18, 9, 9), {true, true, false}};
  const auto beside = [&](int i) {
    Vec3 centre;
    for (int a = 0; a < 3; ++a) centre[a] = middle[a] + lbm::D3Q19::c[i][a] + 0.5;
    return box.wrapped(centre);
  };
  const auto enclosed_links = [&] {
    map.settle();
    builder.update(map, table);
    EXPECT_EQ(links_kept(table), links_by_definition(fluid));
    int count = 0;
    for (const auto& link : links_kept(table)) count += (link[3] & LinkTag::enclosed) != 0 ? 1 : 0;
    return count;
  };
  map.begin_update();
  for (int i = 1; i < 19; ++i) map.remap(map.add(i, 0.6), beside(i));
  EXPECT_EQ(enclosed_links(), 18);
  for (int i = 1; i < 19; ++i) {
    map.begin_update();
    map.remap(map.slot_of(i), Vec3(2.5, 4.5, 4.5));
    EXPECT_EQ(enclosed_links(), 0) << "grain " << i << " away";
    map.begin_update();
    map.remap(map.slot_of(i), beside(i));
    EXPECT_EQ(enclosed_links(), 18) << "grain " << i << " back";
  }
}

}  // namespace
}  // namespace thalweg::bodies::link_builder_test
