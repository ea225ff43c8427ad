// main() of every test executable: GoogleTest under MPI. Only rank 0 reports passes; a failure on any rank fails all. A
// run without a test fails, and so does one on another number of ranks than THALWEG_TEST_RANKS, if that is set: with
// the mpiexec of another MPI every process is a world of its own, in which all that is said of ranks holds.
#include "core/parallel/mpi_session.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#ifdef THALWEG_FINDS_LEAKS
#include <sanitizer/lsan_interface.h>
#endif

namespace {

// Leaks of MPI_Init in plugins that it has unloaded again cannot be named in leaks_of_libraries.txt.
std::unique_ptr<thalweg::MpiSession> start_mpi(int& argc, char**& argv) {
#ifdef THALWEG_FINDS_LEAKS
  const __lsan::ScopedDisabler leaks_are_not_ours;
#endif
  return std::make_unique<thalweg::MpiSession>(argc, argv);
}

// Looks for leaks; call it before MPI_Finalize, which unloads the other plugins.
void look_for_leaks() {
#ifdef THALWEG_FINDS_LEAKS
  __lsan_do_leak_check();
#endif
}

// Whether tests ran, and on the ranks that CMake has asked for; says so if not.
bool ran_as_asked() {
  const int ranks = thalweg::size_of(MPI_COMM_WORLD), tests = ::testing::UnitTest::GetInstance()->test_to_run_count();
  const char* asked = std::getenv("THALWEG_TEST_RANKS");
  const bool as_asked = !asked || std::to_string(ranks) == asked;
  if (!as_asked)
    std::fprintf(stderr, "The tests are for %s ranks, and run on %d: is mpiexec of this MPI?\n", asked, ranks);
  if (tests == 0) std::fprintf(stderr, "The filter selects no test.\n");
  return as_asked && tests > 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::unique_ptr<thalweg::MpiSession> session = start_mpi(argc, argv);
  ::testing::InitGoogleTest(&argc, argv);
  if (thalweg::rank_of(MPI_COMM_WORLD) != 0) {
    auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    class FailuresOnly : public ::testing::EmptyTestEventListener {
      void OnTestPartResult(const ::testing::TestPartResult& result) override {
        if (result.failed())
          std::fprintf(stderr, "rank %d: %s:%d: %s\n", thalweg::rank_of(MPI_COMM_WORLD),
                       result.file_name() ? result.file_name() : "?", result.line_number(), result.message());
      }
    };
    listeners.Append(new FailuresOnly);
  }
  const bool failed = RUN_ALL_TESTS() != 0 || !ran_as_asked();
  const bool any_failed = thalweg::any_rank(MPI_COMM_WORLD, failed);
  look_for_leaks();
  return any_failed ? 1 : 0;
}
