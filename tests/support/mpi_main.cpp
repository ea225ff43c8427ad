// main() of every test executable: GoogleTest under MPI. Only rank 0 reports passes; a failure on any rank fails all.
#include "core/mpi_session.hpp"

#include <gtest/gtest.h>

int main(int argc, char** argv) {
  thalweg::MpiSession session(argc, argv);
  ::testing::InitGoogleTest(&argc, argv);
  if (thalweg::rank_of(MPI_COMM_WORLD) != 0) {
    auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
    ::testing::TestEventListener* quiet = listeners.Release(listeners.default_result_printer());
    static_cast<void>(quiet);
    class FailuresOnly : public ::testing::EmptyTestEventListener {
      void OnTestPartResult(const ::testing::TestPartResult& result) override {
        if (result.failed())
          std::fprintf(stderr, "rank %d: %s:%d: %s\n", thalweg::rank_of(MPI_COMM_WORLD),
                       result.file_name() ? result.file_name() : "?", result.line_number(), result.message());
      }
    };
    listeners.Append(new FailuresOnly);
  }
  const bool failed = RUN_ALL_TESTS() != 0;
  return thalweg::any_rank(MPI_COMM_WORLD, failed) ? 1 : 0;
}
