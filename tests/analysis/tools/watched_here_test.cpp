// The questions to homes of ids, and the grains of this rank that are watched, as grains change their ranks.
#include "analysis/tools/watched_here.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace thalweg::analysis::watched_here_test {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;
constexpr GlobalId count = 101;

bool is_here(GlobalId id, int step) { return (id * 7 + id / 5 * step) % size_of(world) == rank_of(world); }

// Ids of the grains of this rank, in an order that changes.
std::vector<GlobalId> ids_here(int step) {
  std::vector<GlobalId> ids;
  for (GlobalId n = 0; n < count; ++n) {
    const GlobalId id = (n * 37 + step) % count;
    if (is_here(id, step)) ids.push_back(id);
  }
  return ids;
}

TEST(DistributionById, AnswersInTheOrderOfTheQuestions) {
  const DistributionById homes(world, count);
  const std::vector<GlobalId> ids = ids_here(3);
  const std::vector<double> answers = homes.ask(ids, [&](GlobalId id) {
    EXPECT_EQ(homes.home_of(id), rank_of(MPI_COMM_WORLD));
    EXPECT_LT(homes.location_of(id), homes.size());
    return 0.5 * static_cast<double>(id);
  });
  ASSERT_EQ(answers.size(), ids.size());
  for (std::size_t n = 0; n < ids.size(); ++n) EXPECT_EQ(answers[n], 0.5 * static_cast<double>(ids[n]));
}

// Every third grain is watched. Homes are asked for grains that have come, and for no others.
TEST(WatchedHere, FollowsGrainsFromRankToRank) {
  const DistributionById homes(world, count);
  WatchedHere watched;
  std::vector<char> chosen;
  for (const GlobalId id : ids_here(0)) chosen.push_back(id % 3 == 0);
  watched.set(ids_here(0), chosen);
  for (int step = 0; step < 8; ++step) {
    std::int64_t asked = 0, came = 0;
    const std::vector<GlobalId> ids = ids_here(step);
    const std::vector<char>& flags = watched.flags(world, ids, homes, [&](GlobalId id) {
      ++asked;
      return id % 3 == 0;
    });
    ASSERT_EQ(flags.size(), ids.size());
    for (std::size_t n = 0; n < ids.size(); ++n) {
      EXPECT_EQ(flags[n] != 0, ids[n] % 3 == 0) << ids[n];
      if (step > 0 && !is_here(ids[n], step - 1)) ++came;
    }
    EXPECT_EQ(sum_over_ranks(world, asked), sum_over_ranks(world, came));
  }
  // One that knows nothing yet asks for all.
  WatchedHere anew;
  std::int64_t asked = 0;
  anew.flags(world, ids_here(0), homes, [&](GlobalId) { return ++asked > 0; });
  EXPECT_EQ(sum_over_ranks(world, asked), count);
}

}  // namespace
}  // namespace thalweg::analysis::watched_here_test
