#include "lbm/link_table.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace thalweg::lbm {
namespace {

// Random bodies come, change and go; the table must hold exactly what was put in last.
TEST(LinkTable, HoldsWhatWasPutInLast) {
  constexpr int tiles = 9, bodies = 6;
  LinkTable table(tiles);
  std::map<int, std::multiset<std::pair<int, std::uint32_t>>> expected;
  std::mt19937 generator(11);
  std::uint32_t serial = 0;
  for (int round = 0; round < 3000; ++round) {
    const int body = static_cast<int>(generator() % bodies);
    std::vector<Link> links;
    std::vector<int> tile_of;
    expected[body].clear();
    const bool gone = generator() % 5 == 0;
    const int first = static_cast<int>(generator() % tiles);
    for (int tile = first; tile < tiles && !gone; tile += 1 + static_cast<int>(generator() % 2))
      for (unsigned k = 0; k < generator() % 40; ++k) {
        Link link{};
        link.cell = serial++;
        links.push_back(link);
        tile_of.push_back(tile);
        expected[body].insert({tile, link.cell});
      }
    table.replace(body, links, tile_of);

    std::map<int, std::multiset<std::pair<int, std::uint32_t>>> found;
    std::size_t count = 0;
    for (int tile = 0; tile < tiles; ++tile)
      for (const LinkTable::Chunk& chunk : table.tiles()[tile].chunks)
        for (std::uint32_t k = 0; k < chunk.count; ++k, ++count)
          found[chunk.body].insert({tile, table.tiles()[tile].links.cell[chunk.first + k]});
    for (int b = 0; b < bodies; ++b) ASSERT_EQ(found[b], expected[b]) << "body " << b << " in round " << round;
    ASSERT_EQ(count, table.count());
  }
}

}  // namespace
}  // namespace thalweg::lbm
