// Counts that MPI cannot take are refused.
#include "core/parallel/mpi_count.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace thalweg::mpi_count_test {
namespace {

TEST(MpiCount, EndsBelowTwoToThe31) {
  EXPECT_EQ(mpi_count(std::uint64_t{2147483647}), 2147483647);
  EXPECT_THROW(mpi_count(std::uint64_t{2147483648}), RunError);
  EXPECT_THROW(mpi_count(std::int64_t{-2147483649}), RunError);
  try {
    mpi_count(std::uint64_t{4294967297});  // 1 as an int
  } catch (const RunError& error) {
    EXPECT_EQ(std::string(error.what()),
              "One message of 4294967297 items was to be sent, and MPI takes at most 2147483647; use more ranks.");
  }
}

}  // namespace
}  // namespace thalweg::mpi_count_test
