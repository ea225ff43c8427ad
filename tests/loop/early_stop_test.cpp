// Runs that stop before their end: wall time, signals, requests.
#include "loop/stop_request.hpp"
#include "tests/loop/time_loop_bench.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

namespace thalweg::loop::early_stop_test {
namespace {

using namespace time_loop_bench;

TEST(EarlyStop, StopsAtTheSameStepEverywhereWhenTheWallTimeIsUp) {
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
TEST(EarlyStop, WritesAFirstCheckpointInTimeToKnowHowLongTheLastOneTakes) {
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

TEST(EarlyStop, StopsEverywhereWhenOneRankReceivesASignal) {
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
TEST(EarlyStop, ARequestToStopCountsMoreThanASignal) {
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

// Open MPI's mpirun kills by SIGCONT, SIGTERM and SIGKILL; the first of them saves.
class SignalsOfMpirun : public ::testing::Test {
protected:
  SignalsOfMpirun() {
    setenv("OMPI_COMM_WORLD_RANK", std::to_string(rank_of(world)).c_str(), 1);  // also without mpirun
    unsetenv("PRTE_LAUNCHED");                                                  // and with that of Open MPI 5
  }
};

TEST_F(SignalsOfMpirun, AreASecondApartUnlessMpirunIsToldOtherwise) {
  unsetenv("OMPI_MCA_odls_base_sigkill_timeout");
  EXPECT_EQ(sigcont_to_sigterm_delay(), 1.0);
  setenv("OMPI_MCA_odls_base_sigkill_timeout", "7", 1);
  EXPECT_EQ(sigcont_to_sigterm_delay(), 7.0);
  setenv("PRTE_LAUNCHED", "1", 1);  // Open MPI 5 is not to be told
  EXPECT_EQ(sigcont_to_sigterm_delay(), 0.25);
  unsetenv("PRTE_LAUNCHED");
  unsetenv("OMPI_MCA_odls_base_sigkill_timeout");
}

TEST_F(SignalsOfMpirun, TheFirstSavesAndTheSecondStopsThere) {
  Bench bench(1e9);
  bench.plan.checkpoint = Schedule();
  bench.plan.sigcont_to_sigterm_delay = 10.0;
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

TEST_F(SignalsOfMpirun, WithoutASecondTheRunGoesOn) {
  Bench bench(0.2);
  bench.plan.checkpoint = Schedule();
  bench.plan.sigcont_to_sigterm_delay = 0.01;
  bench.system.on_advance = [](std::int64_t step) {
    if (step == 50) std::raise(SIGCONT);
  };
  const LoopRecord& record = bench.run().record();
  EXPECT_TRUE(record.finished);
  ASSERT_EQ(bench.checkpoints.size(), 2u);
  EXPECT_GE(bench.checkpoints[0], 50);
  EXPECT_EQ(bench.checkpoints[1], 200);
}

TEST_F(SignalsOfMpirun, ACheckpointThatWouldComeTooLateIsToldOf) {
  for (const double between : {0.001, 100.0}) {
    const std::string path = ::testing::TempDir() + "sigcont_" + std::to_string(getpid()) + ".log";
    Bench bench(0.010);
    bench.log = Log(true);
    bench.log.copy_to(path);
    bench.plan.sigcont_to_sigterm_delay = between;
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

}  // namespace
}  // namespace thalweg::loop::early_stop_test
