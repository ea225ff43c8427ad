#include "loop/time_loop.hpp"

#include "core/base/error.hpp"
#include "core/sums/sum_range.hpp"
#include "tests/loop/time_loop_bench.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <thread>

namespace thalweg::loop::time_loop_test {
namespace {

using namespace time_loop_bench;

TEST(TimeLoop, KeepsEveryBeatBeyondThirtyTwoBitsOfSteps) {
  constexpr std::int64_t start = 6'000'000'000;  // a multiple of 3, 4 and 5
  Bench bench(6'000'000.010, start);
  const LoopRecord& record = bench.run().record();
  EXPECT_TRUE(record.finished);
  EXPECT_EQ(record.last_step, start + 10);
  EXPECT_EQ(bench.rows, (Steps{start, start + 3, start + 6, start + 9}));
  EXPECT_EQ(bench.pictures, (Steps{start, start + 5, start + 10}));
  EXPECT_EQ(bench.checkpoints, (Steps{start + 4, start + 8, start + 10}));
}

TEST(TimeLoop, AnEndThatNoRunReachesIsNotBehindIt) {
  EXPECT_EQ(final_step(0.010, 0.001), 10);
  for (const double until : {1e30, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(final_step(until, 1e-5), no_step_reaches);
}

TEST(TimeLoop, KeepsEveryBeatAndEndsWithACheckpoint) {
  Bench bench(0.010);
  const LoopRecord& record = bench.run().record();
  EXPECT_TRUE(record.finished);
  EXPECT_EQ(record.last_step, 10);
  EXPECT_EQ(bench.rows, (Steps{0, 3, 6, 9}));
  EXPECT_EQ(bench.looks_on->steps, (Steps{0, 3, 6, 9}));
  EXPECT_EQ(bench.columns, 2u);
  EXPECT_EQ(bench.pictures, (Steps{0, 5, 10}));
  EXPECT_EQ(bench.checkpoints, (Steps{4, 8, 10}));
}

class NeedsMore : public LooksOn {
public:
  using LooksOn::LooksOn;
  bool needs_momentum() const override { return true; }
  bool needs_grain_stress() const override { return true; }
};

// The stress of a frame or measurement is the mean of two steps.
TEST(TimeLoop, AsksForMomentumAndStressesInTheStepsThatShowThem) {
  Bench bench(0.020);
  bench.plan.outputs.push_back({"grains", Schedule(0.008, 0.001), [](const Snapshot&) {}, true});
  bench.observers.push_back(std::make_unique<NeedsMore>(0.009));
  bench.run();
  EXPECT_EQ(bench.system.with_momentum, (Steps{9, 18}));
  EXPECT_EQ(bench.system.with_stress, (Steps{7, 8, 9, 15, 16, 17, 18}));
}

// 1.4 and 2.5 steps: the first steps at or after their multiples, from wherever the run goes on.
TEST(TimeLoop, KeepsIntervalsThatAreNoWholeStepsAfterARestart) {
  const auto set = [](Bench& bench) {
    bench.plan.series = Schedule(0.0014, 0.001);
    bench.plan.checkpoint = Schedule(0.0025, 0.001);
  };
  Bench straight(0.010);
  set(straight);
  straight.run();
  EXPECT_EQ(straight.rows, (Steps{0, 2, 3, 5, 6, 7, 9, 10}));
  EXPECT_EQ(straight.looks_on->steps, straight.rows);
  EXPECT_EQ(straight.checkpoints, (Steps{3, 5, 8, 10}));
  for (const std::int64_t from : {3, 4, 5}) {
    Bench again(0.010, from);
    set(again);
    again.plan.write_at_start = false;
    again.run();
    const auto later = std::upper_bound(straight.rows.begin(), straight.rows.end(), from);
    EXPECT_EQ(again.rows, Steps(later, straight.rows.end())) << from;
  }
}

TEST(TimeLoop, SavesByWallTimeAsWell) {
  for (const double wall : {1e-9, 1e9}) {
    Bench bench(0.100);
    bench.plan.checkpoint = Schedule();
    bench.plan.checkpoint_wall = wall;
    bench.run();
    EXPECT_EQ(bench.checkpoints.back(), 100);
    EXPECT_EQ(bench.checkpoints.size() > 1, wall < 1.0);
  }
}

// Step 7 is looked into unless the observer of every step looks in passing.
TEST(TimeLoop, DoesNotLookIntoTheSystemForWhoLooksInPassing) {
  for (const bool is_lightweight : {false, true}) {
    Bench bench(0.010);
    bool seen = false;
    bench.system.lattice_velocity = [&seen](std::int64_t step) {
      seen = seen || step == 7;
      return 0.05;
    };
    auto observer = std::make_unique<LooksOn>(0.001, is_lightweight);
    const LooksOn& busy = *observer;
    bench.observers.push_back(std::move(observer));
    bench.run();
    EXPECT_EQ(busy.steps.size(), 11u);
    EXPECT_EQ(seen, !is_lightweight);
  }
}

TEST(TimeLoop, EndsWhereASumHasLeftItsRangeBeforeAnythingIsWritten) {
  Bench bench(1.0);
  bench.system.on_advance = [](std::int64_t step) {
    if (step == 7 && rank_of(world) == size_of(world) - 1) SumRange::leave();
  };
  try {
    bench.run();
    ADD_FAILURE() << "no error";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("(step 8) a sum over cells, links or grains has left"), std::string::npos);
  }
  SumRange::reset();
  EXPECT_EQ(bench.rows, (Steps{0, 3, 6}));
  EXPECT_EQ(bench.checkpoints, (Steps{4}));
  EXPECT_EQ(bench.pictures, (Steps{0, 5}));
}

// A diagnostic that is bad either way keeps the value furthest from zero, with its sign.
TEST(TimeLoop, LargestOfADiagnosticThatIsBadEitherWay) {
  for (const double worst : {-0.15, 0.15}) {
    Bench bench(0.4);
    bench.plan.watch[0].side = WatchRule::Side::either;
    bench.system.lattice_velocity = [worst](std::int64_t step) {
      return step == 200 ? worst : step == 300 ? -0.1 : 0.1;
    };
    EXPECT_EQ(bench.run().record().largest.at(0).value, worst);
  }
}

// The regular looks at steps 100, 200, 300, 400 count, and the end at 450; others, here at step 7 and at the stops, do
// not, so that a run is saved with the same numbers wherever it was interrupted.
TEST(TimeLoop, LargestDiagnosticsGoOnWithARun) {
  const auto speed = [](std::int64_t step) {
    return step == 450 ? 0.18 : step == 300 ? 0.17 : step % 100 == 0 ? 0.1 : 0.19;
  };
  for (const std::int64_t stop : {150, 300, 420}) {
    std::vector<Diagnostic> saved;
    const auto keep = [&saved](const LoopRecord& record) {
      saved = record.largest;
      return std::uint64_t{0};
    };
    Bench first(0.001 * static_cast<double>(stop));
    first.system.lattice_velocity = speed;
    first.plan.write_checkpoint = keep;
    first.run();
    ASSERT_EQ(saved.size(), 1u);
    EXPECT_EQ(saved[0].value, stop < 300 ? 0.1 : 0.17);
    Bench second(0.450, stop);
    second.system.lattice_velocity = speed;
    second.plan.largest = saved;
    second.plan.write_checkpoint = keep;
    EXPECT_EQ(second.run().record().largest.at(0).value, 0.18);
    EXPECT_EQ(saved[0].value, 0.17);
  }
}

TEST(TimeLoop, GoesOnFromALaterStepWithoutRepeatingWhatIsWritten) {
  Bench bench(0.010, 6);
  bench.plan.write_at_start = false;
  const LoopRecord& record = bench.run().record();
  EXPECT_EQ(record.first_step, 6);
  EXPECT_EQ(bench.rows, (Steps{9}));
  EXPECT_EQ(bench.checkpoints, (Steps{8, 10}));
}

TEST(TimeLoop, ReachesUntilInWholeStepsDespiteRoundOff) {
  Bench exact(0.3), between(0.0305);
  EXPECT_EQ(exact.run().record().last_step, 300);  // 0.3/0.001 is 299.99999999999994 or 300 in floating point
  EXPECT_EQ(between.run().record().last_step, 31);
}

TEST(TimeLoop, StopsAnUnstableRunAndKeepsTheLastGoodCheckpoint) {
  Bench bench(1.0);
  bench.plan.series = Schedule();
  bench.plan.outputs.clear();
  bench.system.lattice_velocity = [](std::int64_t step) { return step < 398 ? 0.29 : 0.31; };
  EXPECT_THROW(bench.run(), RunError);
  EXPECT_EQ(bench.system.step(), 400);  // noticed when the next checkpoint was due
  EXPECT_EQ(bench.checkpoints.back(), 396);
  EXPECT_FALSE(bench.loop->record().finished);

  Bench rare(1.0);
  rare.plan.series = rare.plan.checkpoint = Schedule();
  rare.plan.outputs.clear();
  rare.system.lattice_velocity = [](std::int64_t step) {
    return step < 250 ? 0.29 : std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_THROW(rare.run(), RunError);
  EXPECT_EQ(rare.system.step(), 300);  // looked at every 100 steps, whatever the clock says
  EXPECT_TRUE(rare.checkpoints.empty());
}

TEST(TimeLoop, RecordsWarningsAndTheLargestOfItsOwnLooks) {
  Bench bench(1.0);
  bench.plan.series = bench.plan.checkpoint = Schedule();
  bench.plan.outputs.clear();
  // Above 0.2 at one look, at step 700; larger still where nobody looks.
  bench.system.lattice_velocity = [](std::int64_t step) { return step == 750 ? 0.29 : step == 700 ? 0.25 : 0.05; };
  bench.system.on_advance = [](std::int64_t) { std::this_thread::sleep_for(std::chrono::microseconds(1500)); };
  const LoopRecord& record = bench.run().record();
  EXPECT_EQ(record.warnings, 1);
  EXPECT_EQ(record.largest.front().value, 0.25);
}

}  // namespace
}  // namespace thalweg::loop::time_loop_test
