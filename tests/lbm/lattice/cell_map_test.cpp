#include "lbm/lattice/cell_map.hpp"

#include <gtest/gtest.h>

#include <random>

namespace thalweg::lbm::cell_map_test {
namespace {

constexpr Index3 size{21, 6, 5};

bool has_covered_neighbour(const CellMap& map, std::ptrdiff_t cell) {
  for (int i = 1; i < D3Q19::directions; ++i)
    if (!map.is_fluid(cell + map.indexing().offset(i))) return true;
  return false;
}

// True if a line through the cell has a body at one end, and a body or a wall at the other.
bool is_in_gap(const CellMap& map, const WallPositions& walls, const Index3& cell) {
  const std::ptrdiff_t at = map.indexing().index(cell[0], cell[1], cell[2]);
  for (int i = 1; i < D3Q19::directions; ++i) {
    if (map.is_fluid(at + map.indexing().offset(i))) continue;
    if (!map.is_fluid(at - map.indexing().offset(i))) return true;
    for (int a = 0; a < 3; ++a)
      for (int steps = 1; steps <= 3; ++steps)
        if (const int to = cell[a] - steps * D3Q19::c[i][a]; to < walls.lower[a] || to >= walls.upper[a]) return true;
  }
  return false;
}

// Bodies that come, go and take cells from each other, in the block and in its ghost cells; a floor at the block's
// lower end, and a wall two cells beyond its upper end along y.
TEST(CellMap, KnowsWhichCellsHaveABodyBesideThemAndWhichAreInGaps) {
  WallPositions walls;
  walls.lower[2] = 0;
  walls.upper[1] = size[1] + 2;
  for (const int pack : {4, 8, 16}) {
    CellMap map(CellIndexing(size, pack), walls);
    std::mt19937 generator(3);
    const auto any = [&](int from, int to) { return std::uniform_int_distribution<int>(from, to)(generator); };
    int with = 0, without = 0, gaps = 0;
    for (int change = 0; change < 400; ++change) {
      map.assign(any(-1, size[0]), any(-1, size[1]), any(-1, size[2]), change % 3 ? CellMap::fluid : any(0, 4));
      for (int z = 0; z < size[2]; ++z)
        for (int y = 0; y < size[1]; ++y)
          for (int x = 0; x < size[0]; ++x) {
            const bool known = map.beside_bodies(y, z)[x / pack] >> x % pack & 1;
            const bool is = has_covered_neighbour(map, map.indexing().index(x, y, z));
            ASSERT_EQ(known, is) << x << " " << y << " " << z;
            (is ? with : without) += 1;
            const bool gap = map.in_gaps(y, z)[x / pack] >> x % pack & 1;
            ASSERT_EQ(gap, is_in_gap(map, walls, {x, y, z})) << x << " " << y << " " << z;
            gaps += gap ? 1 : 0;
          }
    }
    EXPECT_GT(with, 1000);
    EXPECT_GT(without, 1000);
    EXPECT_GT(gaps, 1000);
    EXPECT_LT(gaps, with - 1000);
  }
}

}  // namespace
}  // namespace thalweg::lbm::cell_map_test
