#include "dem/reproducible_sum.hpp"

#include "core/mpi_session.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace thalweg::dem {
namespace {

TEST(ReproducibleSum, HasTheSameBitsHoweverTheTermsAreShared) {
  const int rank = rank_of(MPI_COMM_WORLD), ranks = size_of(MPI_COMM_WORLD);
  std::vector<double> all, mine;
  long double exact = 0.0L;
  for (int i = 0; i < 1000; ++i) {
    all.push_back(std::sin(1.0 + i) * std::exp(0.02 * i) * 1e-7);
    exact += all.back();
    if (i * i % ranks == rank) mine.push_back(all.back());
  }
  const double alone = reproducible_sum(MPI_COMM_SELF, all);
  EXPECT_EQ(reproducible_sum(MPI_COMM_WORLD, mine), alone);
  // The bound of the header: every term rounded to 2^-60 of 1024 times the largest term.
  EXPECT_NEAR(alone, static_cast<double>(exact), 1000.0 * 1024.0 * 50.0 * 0x1p-60);
}

TEST(ReproducibleSum, OfNothingAndOfWhatIsNoNumber) {
  EXPECT_EQ(reproducible_sum(MPI_COMM_WORLD, {}), 0.0);
  const std::vector<double> broken{1.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_TRUE(std::isnan(reproducible_sum(MPI_COMM_WORLD, broken)));
}

}  // namespace
}  // namespace thalweg::dem
