#include "bodies/map/link_table.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace thalweg::bodies::link_table_test {
namespace {

// Every other body has its crossings stored.
bool stores_crossings(std::int32_t body) { return body % 2 == 0; }

// The promise of LinkTable about the links of a range: narrow ones come first, copies of the last fill it up.
void expect_whole_vectors(const LinkStream& links, const LinkTable::LinkRange& range) {
  for (std::uint32_t k = 0; k < range.count; ++k)
    ASSERT_EQ(LinkTag::is_narrow(links.tag[range.first + k]), k < range.narrow);
  const std::uint32_t last = range.first + range.count - 1;
  for (std::uint32_t k = last + 1; k < range.first + padded(range.count); ++k) {
    ASSERT_EQ(links.xy[k], links.xy[last]);
    ASSERT_EQ(links.tag[k], links.tag[last]);
    if (stores_crossings(range.body)) {
      ASSERT_EQ(links.crossing[k].distance, links.crossing[last].distance);
    }
  }
}

// Random bodies come, change and go; the table must hold exactly what was put in last.
TEST(LinkTable, HoldsWhatWasPutInLast) {
  constexpr int tiles = 9, bodies = 6;
  LinkTable table(tiles);
  using Held = std::multiset<std::pair<std::uint32_t, std::uint32_t>>;
  std::map<std::pair<int, int>, Held> expected;  // by body and tile
  std::mt19937 generator(11);
  std::uint32_t serial = 0;
  for (int round = 0; round < 2000; ++round) {
    const int body = static_cast<int>(generator() % bodies), tile = static_cast<int>(generator() % tiles);
    if (generator() % 20 == 0) {
      table.remove(body);
      for (int t = 0; t < tiles; ++t) expected.erase({body, t});
    }
    std::vector<Link> links;
    std::vector<LinkCrossing> crossings;
    expected.erase({body, tile});
    const bool none = generator() % 3 == 0;
    for (auto left = none ? 0 : generator() % 60; left > 0; --left) {
      const std::uint32_t tag =
          LinkTag::of(1 + static_cast<int>(serial % 18), static_cast<std::int32_t>(serial % 1000) - 400);
      links.push_back({serial, tag});
      if (stores_crossings(body)) crossings.push_back({static_cast<float>(serial % 1000), {}});
      expected[{body, tile}].insert({serial, tag});
      ++serial;
    }
    table.replace(body, tile, links, crossings);

    std::map<std::pair<int, int>, Held> found;
    std::size_t count = 0;
    for (int t = 0; t < tiles; ++t) {
      const LinkTable::Tile& there = table.tiles()[t];
      std::size_t in_order = 0;
      for (const LinkTable::LinkRange& range : table.ranges_in_order(t)) {
        in_order += range.count;
        expect_whole_vectors(there.links, range);
      }
      ASSERT_EQ(in_order, there.live);
      for (const LinkTable::Chunk& chunk : there.chunks)
        for (std::uint32_t k = chunk.first; k < chunk.first + chunk.count; ++k, ++count) {
          found[{chunk.body, t}].insert({there.links.xy[k], there.links.tag[k]});
          if (stores_crossings(chunk.body)) {
            ASSERT_EQ(there.links.crossing[k].distance, static_cast<float>(there.links.xy[k] % 1000));
          }
        }
    }
    ASSERT_EQ(found, expected) << "in round " << round;
    ASSERT_EQ(count, table.count());
  }
}

}  // namespace
}  // namespace thalweg::bodies::link_table_test
