// Sizes by mass, and the numbers of grains that have them.
#include "beds/sizes/grading_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace thalweg::beds::grading_curve_test {
namespace {

struct Sample {
  std::vector<double> diameters;  // m, rising
  double power;                   // of d, that the mass goes as
  double mass(double d) const { return std::pow(d, power); }
  double all() const { return finer_mass(2.0 * diameters.back()); }
  double finer_mass(double than) const {
    double sum = 0.0;
    for (const double d : diameters) sum += d <= than ? mass(d) : 0.0;
    return sum;
  }
};

Sample sample_of(const GradingCurve& curve, std::int64_t count, double power = 3.0) {
  return {diameters_by_mass(curve, count, power), power};
}

double share_finer(const GradingCurve& curve, double d) {
  std::size_t n = 0;
  while (n + 2 < curve.diameters.size() && curve.diameters[n + 1] < d) ++n;
  const double way = std::log(d / curve.diameters[n]) / std::log(curve.diameters[n + 1] / curve.diameters[n]);
  return std::clamp(curve.finer[n] + way * (curve.finer[n + 1] - curve.finer[n]), 0.0, 1.0);
}

const GradingCurve sieved{{1e-3, 1.6e-3, 2.5e-3, 4e-3, 6.3e-3}, {0.0, 0.15, 0.4, 0.4, 1.0}};

// The mass finer than any size is that of the curve to within the mass of the one grain that spans it: the next coarser
// one, or the one just below.
TEST(GradingCurve, TheMassFinerFollowsTheCurveToWithinAGrain) {
  for (const double power : {3.0, 2.0})
    for (const std::int64_t count : {1, 2, 10, 300, 20000}) {
      const Sample sample = sample_of(sieved, count, power);
      const double all = sample.all();
      ASSERT_EQ(sample.diameters.size(), static_cast<std::size_t>(count));
      EXPECT_TRUE(std::is_sorted(sample.diameters.begin(), sample.diameters.end()));
      EXPECT_GE(sample.diameters.front(), 1e-3);
      EXPECT_LE(sample.diameters.back(), 6.3e-3);
      for (double d = 1e-3; d < 6.3e-3; d *= 1.037) {
        const auto next = std::upper_bound(sample.diameters.begin(), sample.diameters.end(), d);
        const double grain = sample.mass(next == sample.diameters.end() ? sample.diameters.back() : *next);
        EXPECT_NEAR(sample.finer_mass(d) / all, share_finer(sieved, d), grain / all * (1.0 + 1e-9))
            << count << " " << d;
      }
    }
}

// On a curve straight over ln d from a to b, dN goes as d^-4: the number finer than d is (1 - (a/d)^3)/(1 - (a/b)^3).
TEST(GradingCurve, TheNumberIsTheMassOverThatOfAGrain) {
  const double a = 1e-3, b = 4e-3;
  const std::int64_t count = 10000;
  const Sample sample = sample_of({{a, b}, {0.0, 1.0}}, count);
  for (const double d : {1.1e-3, 1.5e-3, 2e-3, 3e-3}) {
    const auto finer = std::upper_bound(sample.diameters.begin(), sample.diameters.end(), d) - sample.diameters.begin();
    EXPECT_NEAR(static_cast<double>(finer),
                static_cast<double>(count) * (1.0 - std::pow(a / d, 3)) / (1.0 - std::pow(a / b, 3)), 1.0);
  }
  // The mean volume, which the depth of a bed needs: 3 ln(b/a) over (a^-3 - b^-3).
  EXPECT_NEAR(sample.all() / static_cast<double>(count) / (3.0 * std::log(b / a) / (std::pow(a, -3) - std::pow(b, -3))),
              1.0, 1e-9);
}

// Where no mass lies between two sieves, one grain at most does.
TEST(GradingCurve, AGapStaysEmpty) {
  const Sample sample = sample_of(sieved, 5000);
  EXPECT_LE(std::count_if(sample.diameters.begin(), sample.diameters.end(),
                          [](double d) { return d > 2.5e-3 * (1.0 + 1e-12) && d < 4e-3 * (1.0 - 1e-12); }),
            1);
}

// d16, d50 and d84 of the grains: where they have these shares of the mass, the curve has them to within one grain.
TEST(GradingCurve, PercentilesAreThoseOfTheMass) {
  const double d16 = 2e-3, d50 = 3e-3, d84 = 5e-3;
  const GradingCurve curve = curve_through(1e-3, d16, d50, d84, 8e-3);
  EXPECT_NEAR(curve.diameters.front(), 1e-3, 1e-15);
  EXPECT_NEAR(curve.diameters.back(), 8e-3, 1e-15);
  for (const std::int64_t count : {100, 3000, 100000}) {
    const Sample sample = sample_of(curve, count);
    const double all = sample.all(), grain = sample.mass(sample.diameters.back()) / all;
    for (const auto& [d, share] : {std::pair{d16, 0.16}, {d50, 0.5}, {d84, 0.84}})
      EXPECT_NEAR(sample.finer_mass(d) / all, share, grain) << count << " " << d;
  }
  const Sample many = sample_of(curve, 100000);  // of which the largest has 4e-4 of the mass
  EXPECT_LT(many.mass(many.diameters.back()) / many.all(), 4e-4);
}

// Between d50 and d84 ln d is normally distributed: at the middle of the two, in ln d, lies half the deviation of d84.
TEST(GradingCurve, IsLognormalBetweenThePercentiles) {
  const GradingCurve curve = curve_through(1e-3, 2e-3, 3e-3, 5e-3, 8e-3);
  const double z84 = 0.994457883209753, half = 0.5 * std::erfc(-0.5 * z84 / std::sqrt(2.0));
  EXPECT_NEAR(share_finer(curve, std::sqrt(3e-3 * 5e-3)), half, 1e-5);
  EXPECT_NEAR(share_finer(curve, std::sqrt(3e-3 * 2e-3)), 1.0 - half, 1e-5);
  // Below d16 in the shares of the distribution that is cut at 1 mm.
  const auto below = [&](double d) {
    return 0.5 * std::erfc(-std::log(d / 3e-3) / std::log(1.5) * z84 / std::sqrt(2.0));
  };
  EXPECT_NEAR(share_finer(curve, 1.5e-3), 0.16 * (below(1.5e-3) - below(1e-3)) / (0.16 - below(1e-3)), 1e-5);
}

}  // namespace
}  // namespace thalweg::beds::grading_curve_test
