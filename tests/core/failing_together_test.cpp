#include "core/base/error.hpp"
#include "core/parallel/failure_barrier.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_all_ranks.hpp"
#include "core/parallel/on_first_rank.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>

namespace thalweg::failing_together_test {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

TEST(OnFirstRank, WorksOnceAndTellsEveryRankOfItsErrors) {
  int calls = 0;
  on_first_rank(world, [&] { ++calls; });
  EXPECT_EQ(calls, rank_of(world) == 0 ? 1 : 0);
  for (const bool input : {true, false}) {
    std::string message;
    try {
      on_first_rank(world, [&] {
        if (input) throw InputError("no such folder");
        throw RunError("disk full");
      });
    } catch (const InputError& error) {
      message = std::string("input: ") + error.what();
    } catch (const RunError& error) {
      message = std::string("run: ") + error.what();
    }
    EXPECT_EQ(message, input ? "input: no such folder" : "run: disk full");
  }
}

TEST(OnFirstRank, TellsOfAnyErrorInASentence) {
  const auto told = [](const std::function<void()>& work) -> std::string {
    try {
      on_first_rank(world, work);
    } catch (const RunError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(told([] { throw std::bad_alloc(); }), "The memory of this machine is not enough for the case.");
  EXPECT_EQ(told([] { throw std::out_of_range("at"); }), "Unexpected error: at.");
}

TEST(OnFirstRank, TellsTheOthersWhatItHasFound) {
  int calls = 0;
  const std::string found = told_by_first_rank(world, [&] {
    ++calls;
    return std::string("a\0b\n", 4) + std::to_string(rank_of(world));
  });
  EXPECT_EQ(found, std::string("a\0b\n0", 5));
  EXPECT_EQ(calls, rank_of(world) == 0 ? 1 : 0);
  EXPECT_EQ(told_by_first_rank(world, [] { return std::string(); }), "");
  EXPECT_EQ(told_by_first_rank(MPI_COMM_NULL, [] { return std::string("alone"); }), "alone");
  EXPECT_THROW(told_by_first_rank(world, []() -> std::string { throw InputError("gone"); }), InputError);
}

TEST(OnAllRanks, TellsEveryRankOfTheFirstError) {
  int calls = 0;
  on_all_ranks(world, [&] { ++calls; });
  EXPECT_EQ(calls, 1);
  const int last = size_of(world) - 1;
  for (const int first : {0, last}) {
    std::string message;
    try {
      on_all_ranks(world, [&] {
        if (rank_of(world) >= first) throw InputError("grain of rank " + std::to_string(rank_of(world)));
      });
    } catch (const InputError& error) {
      message = error.what();
    }
    EXPECT_EQ(message, "grain of rank " + std::to_string(first));
  }
}

TEST(FailureBarrier, AgreesWhenEveryRankHasFailed) {
  FailureBarrier failures(world);
  std::this_thread::sleep_for(std::chrono::milliseconds(20 * rank_of(world)));
  EXPECT_TRUE(failures.all_ranks_failed(30.0));
  EXPECT_TRUE(failures.all_ranks_failed(0.0));  // remembered
}

TEST(FailureBarrier, NoticesThatTheOthersDoNotCome) {
  const int last = size_of(world) - 1;
  if (last == 0) GTEST_SKIP() << "one rank is everybody";
  FailureBarrier failures(world);
  if (rank_of(world) == last) {
    EXPECT_FALSE(failures.all_ranks_failed(0.05));
    EXPECT_FALSE(failures.all_ranks_failed(30.0));  // remembered, without waiting again
  }
  MPI_Barrier(world);                                           // where the others wait for the failed rank
  if (rank_of(world) != last) failures.all_ranks_failed(30.0);  // completes the barrier the failed rank has left
}

}  // namespace
}  // namespace thalweg::failing_together_test
