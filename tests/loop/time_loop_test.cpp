#include "loop/time_loop.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/sums/sum_range.hpp"
#include "loop/phase_shares.hpp"
#include "loop/stop_request.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>
#include <algorithm>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <thread>

namespace thalweg::loop::time_loop_test {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

// Counts its steps, and has one diagnostic that follows a given function of the step.
class Counter : public System {
public:
  std::function<double(std::int64_t)> lattice_velocity = [](std::int64_t) { return 0.05; };
  std::function<void(std::int64_t)> on_advance = [](std::int64_t) {};

  explicit Counter(std::int64_t start = 0) : step_(start) {}
  void advance() override {
    const auto scope = timer_.measure(timer_.phase("counting"));
    ++step_;
    on_advance(step_);
  }
  std::int64_t step() const override { return step_; }
  double time_step() const override { return 0.001; }
  Snapshot snapshot() const override {
    Snapshot snapshot;
    snapshot.time = time();
    snapshot.step = step_;
    return snapshot;
  }
  std::vector<Diagnostic> diagnostics() const override {
    return {{"largest_lattice_velocity", "1", lattice_velocity(step_)}};
  }
  void save(ArchiveWriter&) const override {}
  void load(ArchiveReader&) override {}
  PhaseTimer& timer() override { return timer_; }
  std::int64_t cells() const override { return 1000; }
  std::int64_t grain_steps_per_step() const override { return 20; }

private:
  std::int64_t step_;
  PhaseTimer timer_;
};

class LooksOn : public analysis::Observer {
public:
  explicit LooksOn(double every = 0.0, bool in_passing = false) : every_(every), in_passing_(in_passing) {}
  double every() const override { return every_; }
  bool in_passing() const override { return in_passing_; }
  std::string name() const override { return "looks_on"; }
  void observe(const Snapshot& snapshot) override { steps.push_back(snapshot.step); }
  std::vector<Diagnostic> diagnostics() const override { return {{"seen", "1", static_cast<double>(steps.size())}}; }
  void save(ArchiveWriter&) const override {}
  bool load(ArchiveReader&) override { return true; }
  std::vector<std::int64_t> steps;

private:
  double every_;
  bool in_passing_;
};

// What the loop did, and the loop itself.
struct Bench {
  explicit Bench(double until, std::int64_t start = 0) : system(start) {
    listen_for_stop_signals();  // forget the signal of an earlier test
    plan.until = until;
    plan.watch = {{"largest_lattice_velocity", WatchRule::Side::above,
                   [](const std::vector<Diagnostic>&) {
                     return WatchLimits{0.2, 0.3};
                   },
                   "the speed", "Slow down."}};
    plan.series = Schedule(0.003, 0.001);
    plan.checkpoint = Schedule(0.004, 0.001);
    plan.write_row = [this](double, std::int64_t step, const std::vector<Diagnostic>& row) {
      rows.push_back(step);
      columns = row.size();
    };
    plan.write_checkpoint = [this](const LoopRecord&) {
      checkpoints.push_back(system.step());
      return std::uint64_t{0};
    };
    plan.outputs.push_back(
        {"pictures", Schedule(0.005, 0.001), [this](const Snapshot& s) { pictures.push_back(s.step); }});
    auto observer = std::make_unique<LooksOn>();
    looks_on = observer.get();
    observers.push_back(std::move(observer));
  }
  TimeLoop& run() {
    loop = std::make_unique<TimeLoop>(world, system, observers, plan, log);
    loop->run();
    return *loop;
  }
  Counter system;
  std::vector<std::unique_ptr<analysis::Observer>> observers;
  LooksOn* looks_on;
  LoopPlan plan;
  Log log{false};
  std::unique_ptr<TimeLoop> loop;
  std::vector<std::int64_t> rows, checkpoints, pictures;
  std::size_t columns = 0;
};

using Steps = std::vector<std::int64_t>;

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
  for (const bool in_passing : {false, true}) {
    Bench bench(0.010);
    bool seen = false;
    bench.system.lattice_velocity = [&seen](std::int64_t step) {
      seen = seen || step == 7;
      return 0.05;
    };
    auto observer = std::make_unique<LooksOn>(0.001, in_passing);
    const LooksOn& busy = *observer;
    bench.observers.push_back(std::move(observer));
    bench.run();
    EXPECT_EQ(busy.steps.size(), 11u);
    EXPECT_EQ(seen, !in_passing);
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

TEST(TimeLoop, StopsAtTheSameStepEverywhereWhenTheWallTimeIsUp) {
  Bench bench(1e9);
  bench.plan.checkpoint = bench.plan.series = Schedule();
  bench.plan.outputs.clear();
  bench.plan.walltime = 0.5;
  bench.plan.started = WallClock::now();
  bench.system.on_advance = [](std::int64_t) { std::this_thread::sleep_for(std::chrono::microseconds(200)); };
  const auto start = WallClock::now();
  const LoopRecord& record = bench.run().record();
  EXPECT_LT(std::chrono::duration<double>(WallClock::now() - start).count(), 2.0);  // 0.5 s and a busy machine
  EXPECT_FALSE(record.finished);
  EXPECT_NE(record.reason.find("wall time"), std::string::npos);
  EXPECT_EQ(bench.checkpoints, (Steps{record.last_step}));
  EXPECT_EQ(sum_over_ranks(world, record.last_step), record.last_step * size_of(world));
}

// A checkpoint that takes a fifth of the wall time would be too late where none has been timed before; a guess that is
// too large costs one checkpoint more and ends nothing early.
TEST(TimeLoop, WritesAFirstCheckpointInTimeToKnowHowLongTheLastOneTakes) {
  for (const double guess : {1.0, 1000.0}) {
    Bench bench(1e9);
    bench.plan.checkpoint = bench.plan.series = Schedule();
    bench.plan.outputs.clear();
    bench.plan.walltime = 3.0;
    bench.plan.checkpoint_guess = guess;
    bench.plan.started = WallClock::now();
    bench.system.on_advance = [](std::int64_t) { std::this_thread::sleep_for(std::chrono::microseconds(200)); };
    bench.plan.write_checkpoint = [&bench](const LoopRecord&) {
      bench.checkpoints.push_back(bench.system.step());
      std::this_thread::sleep_for(std::chrono::milliseconds(400));
      return std::uint64_t{0};
    };
    const LoopRecord& record = bench.run().record();
    EXPECT_LT(std::chrono::duration<double>(WallClock::now() - bench.plan.started).count(), bench.plan.walltime);
    EXPECT_GT(record.wall_seconds, 1.2);
    EXPECT_EQ(bench.checkpoints.size(), 2u);
  }
}

TEST(TimeLoop, StopsEverywhereWhenOneRankReceivesASignal) {
  Bench bench(1e9);
  bench.plan.checkpoint = Schedule();
  bench.system.on_advance = [](std::int64_t step) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    if (step == 50 && rank_of(world) == size_of(world) - 1) std::raise(SIGUSR1);
  };
  const LoopRecord& record = bench.run().record();
  EXPECT_FALSE(record.finished);
  EXPECT_EQ(record.reason, "stopped by SIGUSR1");
  EXPECT_GE(record.last_step, 50);
  EXPECT_EQ(bench.checkpoints, (Steps{record.last_step}));
}

// Whoever asks means it, also where a job ends at the same moment.
TEST(TimeLoop, ARequestToStopCountsMoreThanASignal) {
  const std::filesystem::path request = fmt::format("stop_of_{}_ranks", size_of(world));
  for (const bool signal : {false, true}) {
    Bench bench(1e9);
    bench.plan.checkpoint = Schedule();
    bench.plan.stop_file = request;
    bench.system.on_advance = [&](std::int64_t step) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      if (step != 50) return;
      MPI_Barrier(world);  // no decision is taken meanwhile
      if (rank_of(world) == 0) std::ofstream{request};
      if (signal) std::raise(SIGUSR1);
    };
    const LoopRecord& record = bench.run().record();
    EXPECT_FALSE(record.finished);
    EXPECT_TRUE(record.asked);
    EXPECT_EQ(record.reason, stopped_on_request);
    EXPECT_EQ(bench.checkpoints, (Steps{record.last_step}));
    EXPECT_FALSE(std::filesystem::exists(request));
  }
}

// Open MPI's mpirun kills in three strokes, SIGCONT, SIGTERM, SIGKILL; the first of them saves.
class Strokes : public testing::Test {
protected:
  Strokes() {
    setenv("OMPI_COMM_WORLD_RANK", std::to_string(rank_of(world)).c_str(), 1);  // also without mpirun
    unsetenv("PRTE_LAUNCHED");                                                  // and with that of Open MPI 5
  }
};

TEST_F(Strokes, AreASecondApartUnlessMpirunIsToldOtherwise) {
  unsetenv("OMPI_MCA_odls_base_sigkill_timeout");
  EXPECT_EQ(seconds_between_strokes(), 1.0);
  setenv("OMPI_MCA_odls_base_sigkill_timeout", "7", 1);
  EXPECT_EQ(seconds_between_strokes(), 7.0);
  setenv("PRTE_LAUNCHED", "1", 1);  // Open MPI 5 is not to be told
  EXPECT_EQ(seconds_between_strokes(), 0.25);
  unsetenv("PRTE_LAUNCHED");
  unsetenv("OMPI_MCA_odls_base_sigkill_timeout");
}

TEST_F(Strokes, TheFirstSavesAndTheSecondStopsThere) {
  Bench bench(1e9);
  bench.plan.checkpoint = Schedule();
  bench.plan.between_strokes = 10.0;
  bench.system.on_advance = [](std::int64_t step) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    if (step == 50 && rank_of(world) == size_of(world) - 1) std::raise(SIGCONT);
  };
  bench.plan.write_checkpoint = [&bench](const LoopRecord&) {
    bench.checkpoints.push_back(bench.system.step());
    std::raise(SIGTERM);  // comes while the checkpoint is written: nothing is written twice
    return std::uint64_t{0};
  };
  const LoopRecord& record = bench.run().record();
  EXPECT_EQ(record.reason, "stopped by SIGTERM");
  EXPECT_GE(record.last_step, 50);
  EXPECT_EQ(bench.checkpoints, (Steps{record.last_step}));
}

TEST_F(Strokes, WithoutASecondTheRunGoesOn) {
  Bench bench(0.2);
  bench.plan.checkpoint = Schedule();
  bench.plan.between_strokes = 0.01;
  bench.system.on_advance = [](std::int64_t step) {
    if (step == 50) std::raise(SIGCONT);
  };
  const LoopRecord& record = bench.run().record();
  EXPECT_TRUE(record.finished);
  ASSERT_EQ(bench.checkpoints.size(), 2u);
  EXPECT_GE(bench.checkpoints[0], 50);
  EXPECT_EQ(bench.checkpoints[1], 200);
}

TEST_F(Strokes, ACheckpointThatWouldComeTooLateIsToldOf) {
  for (const double between : {0.001, 100.0}) {
    const std::string path = testing::TempDir() + "strokes_" + std::to_string(getpid()) + ".log";
    Bench bench(0.010);
    bench.log = Log(true);
    bench.log.copy_to(path);
    bench.plan.between_strokes = between;
    bench.plan.stop_file = "some/run/stop";
    bench.plan.write_checkpoint = [](const LoopRecord&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      return std::uint64_t{0};
    };
    bench.run();
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    EXPECT_EQ(text.str().find("thalweg stop some/run,") != std::string::npos, between < 1.0);
    std::remove(path.c_str());
  }
}

TEST(Summary, AccountsForTheWholeWallTime) {
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
}  // namespace thalweg::loop::time_loop_test
