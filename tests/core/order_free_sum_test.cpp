#include "core/order_free_sum.hpp"

#include "core/mpi_session.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace thalweg::order_free_sum_test {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

// Terms of very different size and sign: a plain sum depends on the order in its last bits.
double awkward_term(int i) { return std::sin(1.0 + i * 12.9898) * std::pow(10.0, i % 9 - 4); }

std::vector<double> my_share(int terms, int part, int parts) {
  std::vector<double> mine;
  for (int i = 0; i < terms; ++i)
    if (i % parts == part) mine.push_back(awkward_term(i));
  return mine;
}

TEST(OrderFreeSum, HasTheSameBitsHoweverTheTermsAreDealtOut) {
  constexpr int terms = 1000;
  const double together = order_free_sums(MPI_COMM_SELF, my_share(terms, 0, 1), 1)[0];
  const double dealt_out = order_free_sums(world, my_share(terms, rank_of(world), size_of(world)), 1)[0];
  EXPECT_EQ(together, dealt_out);

  long double exact = 0.0L;
  for (int i = 0; i < terms; ++i) exact += static_cast<long double>(awkward_term(i));
  // 1000 terms below 1e4, each rounded to at most 2^-61 of 1000 * 1e4, the sum to half a unit in the last place.
  EXPECT_NEAR(together, static_cast<double>(exact), 1000 * 1e7 * std::ldexp(1.0, -61) + std::abs(together) * 2e-16);
}

TEST(OrderFreeSum, KeepsColumnsApartWhateverTheirScale) {
  // Small integers times a power of two are summed without any rounding.
  const int ranks = size_of(world);
  const std::vector<double> terms{3.0 * std::ldexp(1.0, -900), 5.0, -2.0 * std::ldexp(1.0, 800), 0.0,
                                  1.0 * std::ldexp(1.0, -900), 7.0, +6.0 * std::ldexp(1.0, 800), 0.0};
  const std::vector<double> sums = order_free_sums(world, terms, 4);
  EXPECT_EQ(sums[0], ranks * 4.0 * std::ldexp(1.0, -900));
  EXPECT_EQ(sums[1], ranks * 12.0);
  EXPECT_EQ(sums[2], ranks * 4.0 * std::ldexp(1.0, 800));
  EXPECT_EQ(sums[3], 0.0);
}

TEST(OrderFreeSum, OfNothingIsZeroAndOfNonsenseIsNotANumber) {
  EXPECT_EQ(order_free_sums(world, std::vector<double>{}, 2), (std::vector<double>{0.0, 0.0}));
  const bool last = rank_of(world) == size_of(world) - 1;
  const std::vector<double> mine{last ? std::numeric_limits<double>::quiet_NaN() : 1.0, 1.0};
  const std::vector<double> sums = order_free_sums(world, mine, 2);
  EXPECT_TRUE(std::isnan(sums[0]));
  EXPECT_EQ(sums[1], size_of(world));
}

}  // namespace
}  // namespace thalweg::order_free_sum_test
