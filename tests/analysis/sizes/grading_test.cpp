#include "analysis/sizes/grading.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::analysis::grading_test {
namespace {

TEST(SizeClasses, HoldWhatPassesTheUpperSieveButNotTheLower) {
  const SizeClasses classes({1e-3, 2e-3, 4e-3});
  ASSERT_EQ(classes.count(), 2U);
  const auto class_of = [&](double diameter) { return classes.bin_of(diameter) / SizeClasses::bins_a_class; };
  EXPECT_EQ(classes.bin_of(1e-3), 0);
  EXPECT_EQ(class_of(1.9999e-3), 0);
  EXPECT_EQ(class_of(2e-3), 1);
  EXPECT_EQ(classes.bin_of(4e-3), classes.bins() - 1);
  // Beyond the edges nothing is lost.
  EXPECT_EQ(classes.bin_of(0.5e-3), 0);
  EXPECT_EQ(classes.bin_of(9e-3), classes.bins() - 1);
  EXPECT_NEAR(classes.middle(1), std::sqrt(8.0) * 1e-3, 1e-18);
}

// Sizes even in ln d from 1 to 4 mm, all of the same share: half of them is finer than 2 mm. A bin is a fiftieth of a
// phi wide.
TEST(MedianDiameter, IsThatOfTheGrainsAndNotOfTheClasses) {
  const SizeClasses classes({1e-3, 2e-3, 4e-3});
  std::vector<double> shares(100, 0.0), sizes(100, 0.0), counts(100, 0.0);
  constexpr int grains = 10000;
  for (int n = 0; n < grains; ++n) {
    const double diameter = 1e-3 * std::exp2(2.0 * (n + 0.5) / grains);
    const auto bin = static_cast<std::size_t>(classes.bin_of(diameter));
    shares[bin] += 1.0;
    sizes[bin] += diameter;
  }
  for (std::size_t b = 0; b < sizes.size(); ++b) sizes[b] /= shares[b];
  EXPECT_NEAR(median_diameter(shares, sizes) / 2e-3, 1.0, 0.5 * (std::exp2(1.0 / 50.0) - 1.0) + 1e-9);
  // With two sizes in one class it is one of them, and no size between.
  const std::vector<double> two{0.4, 0.0, 0.6}, diameters{1.1e-3, 0.0, 1.9e-3};
  EXPECT_EQ(median_diameter(two, diameters), 1.9e-3);
  EXPECT_TRUE(std::isnan(median_diameter(std::vector<double>{0.0, -1.0, 0.5}, diameters)));
}

}  // namespace
}  // namespace thalweg::analysis::grading_test
