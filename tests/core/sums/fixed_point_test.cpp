#include "core/sums/fixed_point.hpp"
#include "core/sums/wide_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace thalweg::fixed_point_test {
namespace {

TEST(FixedPoint, SumDoesNotDependOnTheOrder) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> terms(5000);
  for (double& t : terms) t = uniform(generator);
  const auto sum = [&] {
    std::int64_t s = 0;
    for (double t : terms) s += LatticeFixed::from(t);
    return s;
  };
  const std::int64_t first = sum();
  std::shuffle(terms.begin(), terms.end(), generator);
  EXPECT_EQ(sum(), first);
  // Each term is rounded by at most half a unit of 2^-44.
  EXPECT_NEAR(LatticeFixed::to_double(first), std::accumulate(terms.begin(), terms.end(), 0.0), 5000 * 0x1p-45 + 1e-11);
}

TEST(FixedPoint, RoundsToTheNearestAndTiesToEven) {
  using Quarter = FixedPoint<2>;
  EXPECT_EQ(Quarter::from(0.3), 1);
  EXPECT_EQ(Quarter::from(-0.3), -1);
  EXPECT_EQ(Quarter::from(0.125), 0);
  EXPECT_EQ(Quarter::from(0.375), 2);
  EXPECT_EQ(Quarter::from(-0.375), -2);
  EXPECT_EQ(LatticeFixed::from(-100.0), -100 * (std::int64_t{1} << 44));
  EXPECT_EQ(LatticeFixed::to_double(LatticeFixed::from(100.0 + 0x1p-44)), 100.0 + 0x1p-44);
}

// True if the work leaves the range in which sums are exact.
template <typename Work>
bool leaves_range(Work&& work) {
  SumRange::reset();
  work();
  const bool left = SumRange::was_left();
  SumRange::reset();
  return left;
}

TEST(SumRange, IsLeftByTermsThatAreTooLargeOrNoNumber) {
  const double largest = LatticeFixed::largest_term;
  EXPECT_EQ(largest, 128.0);
  EXPECT_FALSE(leaves_range([&] { EXPECT_EQ(LatticeFixed::to_double(LatticeFixed::from(127.5)), 127.5); }));
  EXPECT_FALSE(leaves_range([&] { EXPECT_EQ(LatticeFixed::to_double(LatticeFixed::from(-127.5)), -127.5); }));
  for (const double term : {largest, -largest, 1e300, std::numeric_limits<double>::infinity(), std::nan("")})
    EXPECT_TRUE(leaves_range([&] { EXPECT_EQ(LatticeFixed::from(term), 0); })) << term;
  EXPECT_TRUE(leaves_range([] { FixedTensor().add(Vec3(1.0, 20.0, 0.0), Vec3(0.0, 7.0, 0.0)); }));
}

// 1e9 cells at a tenth of a cell a step, in the resolution that sums over all cells once had: 2^36 times 1e8 is in
// range and 1.4e8 is not, where an unchecked sum changes its sign.
TEST(SumRange, IsLeftBySumsThatWouldWrap) {
  using Sum = FixedPoint<36>;
  const std::int64_t a_tenth = Sum::from(0.1);
  const auto after = [&](std::int64_t cells) { return [=] { exact_product(a_tenth, cells); }; };
  EXPECT_FALSE(leaves_range(after(1'000'000'000)));
  EXPECT_TRUE(leaves_range(after(1'400'000'000)));
  static constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  EXPECT_FALSE(leaves_range([] { EXPECT_EQ(exact_sum(most - 1, 1), most); }));
  EXPECT_TRUE(leaves_range([] { exact_sum(most, 1); }));
  EXPECT_TRUE(leaves_range([] { exact_sum(-most, -2); }));
  FixedVec3 vector{0, most, 0};
  EXPECT_FALSE(leaves_range([&] { vector += {1, 0, -1}; }));
  EXPECT_TRUE(leaves_range([&] { vector += {0, 1, 0}; }));
}

TEST(WideSum, BecomesNarrowOnlyWhereItFits) {
  static constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t value : {std::int64_t{0}, std::int64_t{-1}, most, -most - 1}) {
    WideSum sum;
    sum.add(value);
    EXPECT_FALSE(leaves_range([&] { EXPECT_EQ(sum.narrowed(), value); }));
  }
  WideSum sum;
  sum.add(most);
  sum.add(most);
  EXPECT_TRUE(leaves_range([&] { sum.narrowed(); }));
}

// The round-off of all cells of a large run, summed, is more than a term of a link may be.
TEST(WideSum, TakesNumbersOfAnySize) {
  for (const double value : {0.0, 0.25, -0.25, -5.0, 127.0, 128.0, -1e6, 1e15, -1e15, 0x1p80}) {
    const WideSum sum = WideSum::from(value, LatticeFixed::bits);
    EXPECT_EQ(sum.to_double(LatticeFixed::bits), value);
    if (std::abs(value) >= LatticeFixed::largest_term) continue;
    WideSum same;
    same.add(LatticeFixed::from(value));
    EXPECT_EQ(sum, same) << value;
  }
  EXPECT_TRUE(leaves_range([] { EXPECT_EQ(WideSum::from(0x1p82, LatticeFixed::bits), WideSum{}); }));
  EXPECT_TRUE(leaves_range([] { WideSum::from(std::numeric_limits<double>::quiet_NaN(), LatticeFixed::bits); }));
}

TEST(WideSum, GrowsBeyondSixtyFourBitsAndBack) {
  constexpr std::int64_t large = std::int64_t{1} << 62;
  WideSum sum;
  for (int n = 0; n < 1000; ++n) sum.add(large);
  EXPECT_EQ(sum.to_double(62), 1000.0);
  sum.add(-1);
  WideSum same;
  same.add(-1);
  for (int n = 0; n < 1000; ++n) same.add(large);
  EXPECT_EQ(sum, same);  // whatever the order
  for (int n = 0; n < 2000; ++n) sum.add(-large);
  EXPECT_EQ(sum.to_double(62), -1000.0);
  for (int n = 0; n < 1000; ++n) sum.add(large);
  EXPECT_EQ(sum.to_double(0), -1.0);
  sum.add(WideSum{0, 8});
  EXPECT_EQ(sum.to_double(1), 3.5);
}

}  // namespace
}  // namespace thalweg::fixed_point_test
