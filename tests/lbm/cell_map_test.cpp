#include "lbm/cell_map.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace thalweg::lbm::cell_map_test {
namespace {

const Index3 size{21, 8, 5};

// How many bodies claim a cell, by its local coordinates.
using Claims = std::map<Index3, int>;

bool is_near(const Claims& claims, int radius_squared, const Index3& cell) {
  for (const auto& [covered, count] : claims) {
    int squared = 0;
    for (int a = 0; a < 3; ++a) squared += (covered[a] - cell[a]) * (covered[a] - cell[a]);
    if (count > 0 && squared <= radius_squared) return true;
  }
  return false;
}

struct Found {
  int near = 0, elsewhere = 0, empty_rows = 0;
};

// bits(y, z): of the packs of a row. any(y, z): whether one of them is 1.
template <typename Bits, typename Any>
void expect_right(const Claims& claims, int radius_squared, int pack, Bits bits, Any any, Found& found) {
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y) {
      bool in_row = false;
      for (int x = 0; x < size[0]; ++x) {
        const bool known = bits(y, z)[x / pack] >> x % pack & 1, is = is_near(claims, radius_squared, {x, y, z});
        ASSERT_EQ(known, is) << x << " " << y << " " << z;
        (is ? found.near : found.elsewhere) += 1;
        in_row = in_row || is;
      }
      ASSERT_EQ(any(y, z), in_row) << y << " " << z;
      found.empty_rows += !in_row;
      // Of the cells that fill up the last pack nobody knows anything.
      ASSERT_EQ(bits(y, z)[(size[0] - 1) / pack] >> ((size[0] - 1) % pack + 1), 0);
    }
}

class Chance {
public:
  int within(int from, int to) { return std::uniform_int_distribution<int>(from, to)(generator_); }
  Index3 cell(int layers) {
    Index3 at;
    for (int a = 0; a < 3; ++a) at[a] = within(-layers, size[a] - 1 + layers);
    return at;
  }

private:
  std::mt19937 generator_{3};
};

// Bodies that come, go and take cells from each other, in the block, in its ghost cells and beyond, where several of
// them claim a cell and none is known to have it.
TEST(CellMap, KnowsWhichCellsHaveABodyNearThem) {
  for (const int pack : {4, 8, 16}) {
    CellMap map(CellIndexing(size, pack));
    const CellIndexing& indexing = map.indexing();
    Claims claims;
    Chance chance;
    Found found;
    for (int change = 0; change < 900; ++change) {
      // One that is covered every other time, so that few are covered at a time.
      const bool again = change % 2 && !claims.empty();
      const Index3 cell = again
                              ? std::next(claims.begin(), chance.within(0, static_cast<int>(claims.size()) - 1))->first
                              : chance.cell(near_body_layers);
      int& count = claims[cell];
      if (indexing.in_memory(cell[0], cell[1], cell[2])) {
        count = again ? chance.within(0, 4) / 4 : 1;
        map.assign(cell[0], cell[1], cell[2], count ? chance.within(0, 4) : CellMap::fluid);
      } else if (again) {
        --count;
        map.give_up_beyond(cell);
      } else {
        count += 2;
        map.claim_beyond(cell);
        map.claim_beyond(cell);
      }
      if (count == 0) claims.erase(cell);
      expect_right(
          claims, near_body_radius_squared, pack, [&](int y, int z) { return map.near_bodies(y, z); },
          [&](int y, int z) { return map.any_near_bodies(y, z); }, found);
      ASSERT_FALSE(HasFatalFailure());
      if (claims.size() > 12) {  // begin with few again
        for (const auto& [at, times] : claims)
          for (int k = 0; k < times; ++k)
            indexing.in_memory(at[0], at[1], at[2]) ? map.assign(at[0], at[1], at[2], CellMap::fluid)
                                                    : map.give_up_beyond(at);
        claims.clear();
      }
    }
    EXPECT_GT(found.near, 10000);
    EXPECT_GT(found.elsewhere, 10000);
    EXPECT_GT(found.empty_rows, 1000);
  }
}

// A radius squared of 2 is that of the directions of the lattice, 0 the cell itself.
TEST(NearBodies, KnowCellsWithinAnyRadius) {
  for (const int radius_squared : {0, 1, 2, 3, 6, 15}) {
    NearBodies near(CellIndexing(size, 8), radius_squared);
    Claims claims;
    Chance chance;
    Found found;
    for (int change = 0; change < 100; ++change) {
      const Index3 cell = chance.cell(layers_within(radius_squared));
      int& count = claims[cell];
      count = 1 - count;
      near.cell_changes(cell[0], cell[1], cell[2], count ? 1 : -1);
      expect_right(
          claims, radius_squared, 8, [&](int y, int z) { return near.in_packs(y, z); },
          [&](int y, int z) { return near.any_in_row(y, z); }, found);
      ASSERT_FALSE(HasFatalFailure());
    }
    EXPECT_GT(found.near, 100);
  }
}

// A ball of radius 3 has 123 cells: as many counts as a cell can have go up, and down again.
TEST(NearBodies, CountEveryCellOfABall) {
  NearBodies near(CellIndexing(size, 8));
  const auto change_all = [&](int change) {
    for (int z = -3; z < size[2] + 3; ++z)
      for (int y = -3; y < size[1] + 3; ++y)
        for (int x = -3; x < size[0] + 3; ++x) near.cell_changes(x, y, z, change);
  };
  for (int times = 0; times < 3; ++times) {
    change_all(1);
    for (int x = 0; x < size[0]; ++x) EXPECT_EQ(near.in_packs(2, 2)[x / 8] >> x % 8 & 1, 1);
    change_all(-1);
    for (int z = 0; z < size[2]; ++z)
      for (int y = 0; y < size[1]; ++y) EXPECT_FALSE(near.any_in_row(y, z));
  }
}

}  // namespace
}  // namespace thalweg::lbm::cell_map_test
