// Homes of ids, whose number may grow.
#include "analysis/tools/distribution_by_id.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace thalweg::analysis::distribution_by_id_test {
namespace {

struct Row {
  GlobalId id;
};

// Three growths, the last of them past several rounds of ranges: what is stored stays in its place, every id has one
// home, and the array that is written is that of the ids in their order.
TEST(DistributionById, GrowsAndKeepsItsPlaces) {
  DistributionById homes(MPI_COMM_WORLD, 10);
  std::vector<double> stored;
  for (const GlobalId count : {10, 10, 23, 24, 190}) {
    homes.grow(count);
    for (std::size_t place = stored.size(); place < homes.size(); ++place)
      stored.push_back(static_cast<double>(homes.id_at(place)));
    std::vector<Row> all;
    if (rank_of(MPI_COMM_WORLD) == 0)
      for (GlobalId id = 0; id < count; ++id) all.push_back({id});
    const std::vector<Row> here = homes.bring_home(all);
    EXPECT_EQ(here.size(), homes.size());
    for (const Row& row : here) {
      ASSERT_LT(homes.location_of(row.id), stored.size());
      EXPECT_EQ(stored[homes.location_of(row.id)], static_cast<double>(row.id));
    }
    EXPECT_EQ(sum_over_ranks(MPI_COMM_WORLD, static_cast<std::int64_t>(homes.size())), count);

    std::vector<double> two_columns;
    for (const double id : stored) two_columns.insert(two_columns.end(), {id, -id});
    thalweg::test::MemoryArchive archive;
    thalweg::test::MemoryWriter writer(archive, MPI_COMM_WORLD);
    homes.write(writer, "made/up", two_columns, 2);
    const auto& written = std::get<std::vector<double>>(archive.datasets.at("made/up").values);
    ASSERT_EQ(written.size(), static_cast<std::size_t>(2 * count));
    for (GlobalId id = 0; id < count; ++id) {
      EXPECT_EQ(written[static_cast<std::size_t>(2 * id)], static_cast<double>(id));
      EXPECT_EQ(written[static_cast<std::size_t>(2 * id + 1)], static_cast<double>(-id));
    }
    const DistributionById again(MPI_COMM_WORLD, count);
    thalweg::test::MemoryReader reader(archive);
    const std::vector<double> read = again.read<double>(reader, "made/up", 2);
    for (std::size_t place = 0; place < again.size(); ++place)
      EXPECT_EQ(read[2 * place], static_cast<double>(again.id_at(place)));
    std::vector<Row> mine;
    for (std::size_t place = 0; place < homes.size(); ++place) mine.push_back({homes.id_at(place)});
    mine = homes.in_order_of_ids(std::move(mine));
    for (std::size_t n = 1; n < mine.size(); ++n) EXPECT_LT(mine[n - 1].id, mine[n].id);
  }
}

}  // namespace
}  // namespace thalweg::analysis::distribution_by_id_test
