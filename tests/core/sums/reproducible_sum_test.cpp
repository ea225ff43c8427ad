#include "core/sums/reproducible_sum.hpp"

#include "core/parallel/mpi_session.hpp"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <array>
#include <cmath>
#include <limits>

namespace thalweg::reproducible_sum_test {
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
  const double together = reproducible_sums(MPI_COMM_SELF, my_share(terms, 0, 1), 1)[0];
  const double dealt_out = reproducible_sums(world, my_share(terms, rank_of(world), size_of(world)), 1)[0];
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
  const std::vector<double> sums = reproducible_sums(world, terms, 4);
  EXPECT_EQ(sums[0], ranks * 4.0 * std::ldexp(1.0, -900));
  EXPECT_EQ(sums[1], ranks * 12.0);
  EXPECT_EQ(sums[2], ranks * 4.0 * std::ldexp(1.0, 800));
  EXPECT_EQ(sums[3], 0.0);
}

TEST(OrderFreeSum, OfNothingIsZeroAndOfNonsenseIsNotANumber) {
  EXPECT_EQ(reproducible_sums(world, std::vector<double>{}, 2), (std::vector<double>{0.0, 0.0}));
  const bool last = rank_of(world) == size_of(world) - 1;
  const std::vector<double> mine{last ? std::numeric_limits<double>::quiet_NaN() : 1.0, 1.0};
  const std::vector<double> sums = reproducible_sums(world, mine, 2);
  EXPECT_TRUE(std::isnan(sums[0]));
  EXPECT_EQ(sums[1], size_of(world));
}

// Rows of a bin are those of one sum: small integers times a power of two, which are summed without any rounding.
TEST(OrderFreeSum, OfBinsHoldsTheRowsOfEach) {
  constexpr int bins = 5, rows = 1000;
  std::array<std::array<std::int64_t, 2>, bins> exact{};
  for (int i = 0; i < rows; ++i) {
    exact[static_cast<std::size_t>(i * i % bins)][0] += i - 300;
    exact[static_cast<std::size_t>(i * i % bins)][1] += 7 * i;
  }
  const std::vector<double> sums = reproducible_sums_by_bin(world, bins, 2, [&](const TermTaker& take) {
    for (int i = rank_of(world); i < rows; i += size_of(world))
      take(i * i % bins, std::array{0.125 * (i - 300), 7e3 * i});
  });
  ASSERT_EQ(sums.size(), 2u * bins);
  for (std::size_t bin = 0; bin < bins; ++bin) {
    EXPECT_EQ(sums[2 * bin], 0.125 * static_cast<double>(exact[bin][0]));
    EXPECT_EQ(sums[2 * bin + 1], 1e3 * static_cast<double>(exact[bin][1]));
  }
}

TEST(OrderFreeSum, OfBinsHasTheSameBitsHoweverTheRowsAreDealtOut) {
  const auto sums_of = [](MPI_Comm communicator) {
    return reproducible_sums_by_bin(communicator, 3, 1, [&](const TermTaker& take) {
      for (int i = 999 - rank_of(communicator); i >= 0; i -= size_of(communicator))
        take(i % 3, std::array{awkward_term(i)});
    });
  };
  EXPECT_EQ(sums_of(world), sums_of(MPI_COMM_SELF));
}

// Two million rows of 46 values would take 736 MB.
TEST(OrderFreeSum, KeepsNoRows) {
  const auto peak_kilobytes = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const long before = peak_kilobytes();
  const std::array<double, 46> row{1.0};
  const std::vector<double> sums = reproducible_sums_by_bin(world, 10, 46, [&](const TermTaker& take) {
    for (int i = 0; i < 2'000'000; ++i) take(i % 10, row);
  });
  EXPECT_EQ(sums[0], 2e5 * size_of(world));
  EXPECT_LT(peak_kilobytes() - before, 10'000);
}

}  // namespace
}  // namespace thalweg::reproducible_sum_test
