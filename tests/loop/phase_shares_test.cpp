#include "loop/phase_shares.hpp"

#include "tests/loop/time_loop_bench.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace thalweg::loop::phase_shares_test {
namespace {

using namespace time_loop_bench;

TEST(PhaseShares, AccountsForTheWholeWallTime) {
  Bench bench(0.050);
  bench.system.on_advance = [](std::int64_t) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
  TimeLoop& loop = bench.run();
  const std::vector<PhaseShare> phases = collect_phases(world, bench.system, loop);
  if (rank_of(world) == 0) {
    double mean = 0.0, share = 0.0;
    for (const PhaseShare& phase : phases) {
      mean += phase.mean_seconds;
      share += phase.share;
      EXPECT_GE(phase.largest_seconds, phase.mean_seconds * (1.0 - 1e-9));
    }
    EXPECT_EQ(phases.front().name, "counting");
    EXPECT_EQ(phases.back().name, "other");
    EXPECT_GE(phases.front().mean_seconds, 0.050);  // fifty times at least a millisecond
    EXPECT_NEAR(share, mean / loop.record().wall_seconds, 1e-9);
    EXPECT_NEAR(mean, loop.record().wall_seconds, 0.2 * loop.record().wall_seconds);  // ranks start a little apart
    EXPECT_EQ(phase_table(phases).size(), phases.size() + 1);
  }
  const Speeds speeds = speeds_of(bench.system, loop.record());
  EXPECT_NEAR(speeds.steps_per_second * loop.record().wall_seconds, 50.0, 1e-9);
  EXPECT_NEAR(speeds.mlups, speeds.steps_per_second * 1e-3, 1e-12);
  EXPECT_NEAR(speeds.grain_steps_per_second, speeds.steps_per_second * 20.0, 1e-6);
}

}  // namespace
}  // namespace thalweg::loop::phase_shares_test
