#include "analysis/tools/hops.hpp"

#include "tests/analysis/made_up_grains.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace thalweg::analysis::hops_test {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;
constexpr double interval = 0.125, length = 0.5;  // s, m: what the box is long
const PeriodicBox box{Vec3(length, 1.0, 1.0), {true, true, false}};
constexpr GlobalId count = 90;

// Grain id rests until measurement 2 + id % 7, is then found moving at every measurement for 1 + id % 5 of them, and
// rests again for good. It goes at 3 m/s, which is 3/4 of the box in an interval, and half an interval's way before the
// first and behind the last of these measurements.
struct Track {
  int first, last;
  explicit Track(GlobalId id) : first(static_cast<int>(2 + id % 7)), last(first + static_cast<int>(id % 5)) {}
  bool moves(int n) const { return n >= first && n <= last; }
  double x(GlobalId id, int n) const {
    const double way = 3.0 * interval * std::clamp(n - first + 0.5, 0.0, last - first + 1.0);
    const double place = 0.005 * static_cast<double>(id) + way;
    return place - length * std::floor(place / length);
  }
  double way() const { return 3.0 * interval * (last - first + 1); }
  double time() const { return interval * (last - first + 1); }
};

// way: 1, or -1 for the mirror image.
void observe(Hops& hops, MPI_Comm communicator, int n, int counts_from, double way = 1.0) {
  std::vector<Body> bodies;
  for (GlobalId id = 0; id < count; ++id) {
    if ((id * 5 + n) % size_of(communicator) != rank_of(communicator)) continue;  // another owner every time
    const Track track(id);
    const double x = way > 0.0 ? track.x(id, n) : length - track.x(id, n);
    bodies.push_back({id, 1.0, Vec3(x, 0.0, 0.0), Vec3(track.moves(n) ? way * 3.0 : 0.0, 0.0, 0.0)});
  }
  hops.observe(n * interval, box, count, bodies, n >= counts_from);
}

test::MemoryArchive saved(const Hops& hops, MPI_Comm communicator) {
  return test::saved(hops, communicator, "transport_rate");
}

TEST(Hops, AreFromRestToRestThroughPeriodicFacesAndFromRankToRank) {
  Hops hops(world, 0.1, 0.1, 0.5);
  EXPECT_EQ(value_of(hops.results(), "hops"), 0.0);
  EXPECT_TRUE(std::isnan(value_of(hops.results(), "hop_length_mean")));
  EXPECT_TRUE(std::isnan(value_of(hops.results(), "hop_time_50")));
  for (int n = 0; n < 14; ++n) observe(hops, world, n, 0);
  double ways = 0.0, times = 0.0;
  for (GlobalId id = 0; id < count; ++id) {
    ways += Track(id).way();
    times += Track(id).time();
  }
  const std::vector<Diagnostic> results = hops.results();
  EXPECT_EQ(value_of(results, "hops"), 90.0);
  EXPECT_NEAR(value_of(results, "hop_length_mean"), ways / 90.0, 1e-12);
  EXPECT_NEAR(value_of(results, "hop_time_mean"), times / 90.0, 1e-12);
  // A fifth of the hops each is 1, 2, 3, 4, 5 intervals long. A bin is 10^(1/20) wide, a ratio of 1.122.
  for (const auto& [name, intervals] : std::map<std::string, double>{{"10", 1.0}, {"50", 3.0}, {"90", 5.0}}) {
    EXPECT_NEAR(value_of(results, "hop_length_" + name) / (3.0 * interval * intervals), 1.0, 0.123) << name;
    EXPECT_NEAR(value_of(results, "hop_time_" + name) / (interval * intervals), 1.0, 0.123) << name;
  }
}

TEST(Hops, AreAsLongInAStreamToTheLeft) {
  Hops right(world, 0.1, 0.1, 0.5), left(world, 0.1, 0.1, 0.5);
  for (int n = 0; n < 14; ++n) {
    observe(right, world, n, 0);
    observe(left, world, n, 0, -1.0);
  }
  const std::vector<Diagnostic> there = right.results(), back = left.results();
  EXPECT_NEAR(value_of(back, "hop_length_mean"), -value_of(there, "hop_length_mean"), 1e-12);
  for (const char* name : {"hops", "hop_length_10", "hop_length_50", "hop_length_90", "hop_time_mean", "hop_time_50"})
    EXPECT_EQ(value_of(back, name), value_of(there, name)) << name;
}

TEST(Hops, UnderWayAtTheStartDoNotCount) {
  Hops hops(world, 0.1, 0.1, 0.5), late(world, 0.1, 0.1, 0.5);
  for (int n = 4; n < 14; ++n) observe(hops, world, n, 4);  // those that began at 2, 3 and 4 are missing
  for (int n = 0; n < 14; ++n) observe(late, world, n, 5);
  double begun = 0.0;
  for (GlobalId id = 0; id < count; ++id)
    if (Track(id).first >= 5) ++begun;
  EXPECT_EQ(value_of(hops.results(), "hops"), begun);
  EXPECT_EQ(value_of(late.results(), "hops"), begun);
}

// Two grains fall into a sink, come in again downstream and high up and come to rest there: grain 0 is away at 3 and 4,
// grain 1 is put elsewhere between two measurements. A third, which goes downstream as far at its own speed, hops.
TEST(Hops, DoNotGoOnThroughASink) {
  Hops hops(world, 0.1, 0.1, 0.5, true);
  const Vec3 still = Vec3::Zero(), falls(0.0, 0.0, -1.0);
  for (int n = 0; n < 9; ++n) {
    std::vector<Body> bodies;
    const bool back = n > 4;
    const Vec3 place(back ? 0.3 : 0.05, 0.5, back ? 0.9 : 0.6 - 0.125 * std::max(0, n - 1));
    const Vec3 velocity = n > 0 && n < 7 ? falls : still;
    if (n < 3 || n > 4) bodies.push_back({0, 1.0, place, velocity});
    bodies.push_back({1, 1.0, place, velocity});
    bodies.push_back({2, 1.0, Vec3(n < 3 ? 0.05 : 0.3, 0.5, 0.1), n == 2 || n == 3 ? Vec3(2.0, 0.0, 0.0) : still});
    if (rank_of(world) != n % size_of(world)) bodies.clear();
    hops.observe(n * interval, box, 3, bodies, true);
  }
  EXPECT_EQ(value_of(hops.results(), "hops"), 1.0);
  EXPECT_NEAR(value_of(hops.results(), "hop_length_mean"), 0.25, 1e-15);
}

TEST(Hops, HaveTheSameBitsOnAnyNumberOfRanksAndAfterARestart) {
  Hops alone(MPI_COMM_SELF, 0.1, 0.1, 0.5), shared(world, 0.1, 0.1, 0.5), restarted(world, 0.1, 0.1, 0.5);
  test::MemoryArchive half_way;
  for (int n = 0; n < 12; ++n) {
    observe(alone, MPI_COMM_SELF, n, 0);
    observe(shared, world, n, 0);
    if (n == 5) half_way = saved(alone, MPI_COMM_SELF);
  }
  test::load(restarted, half_way, "transport_rate", count);
  for (int n = 5; n < 12; ++n) observe(restarted, world, n, 0);  // 5 is seen again, as a restart does
  const test::MemoryArchive end = saved(alone, MPI_COMM_SELF);
  EXPECT_EQ(test::first_difference(end, saved(shared, world)), "");
  EXPECT_EQ(test::first_difference(end, saved(restarted, world)), "");
  EXPECT_LT(value_of(shared.results(), "hops"), 90.0);  // some are still under way
}

}  // namespace
}  // namespace thalweg::analysis::hops_test
