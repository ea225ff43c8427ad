#include "analysis/statistics/histogram.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::analysis::histogram_test {
namespace {

TEST(Histogram, CountsWhatLiesBetweenEdgesAndOutside) {
  Histogram histogram = Histogram::linear(-1.0, 1.0, 4);
  for (const double value : {-2.0, -1.0, -0.6, 0.0, 0.49, 0.5, 1.0, 7.0}) histogram.add(value);
  const std::vector<std::int64_t> counts(histogram.counts().begin(), histogram.counts().end());
  EXPECT_EQ(counts, (std::vector<std::int64_t>{1, 2, 0, 2, 1, 2}));  // an edge belongs to the bin above it
  EXPECT_EQ(histogram.total(), 8);
}

TEST(Histogram, OfEqualRatios) {
  const Histogram histogram = Histogram::geometric(0.01, 100.0, 4);
  for (std::size_t e = 0; e < 5; ++e) EXPECT_NEAR(histogram.edges()[e] / std::pow(10.0, -2.0 + double(e)), 1.0, 1e-14);
}

TEST(Histogram, QuantilesOfEvenValuesAreExact) {
  Histogram histogram = Histogram::linear(0.0, 10.0, 10);
  EXPECT_EQ(histogram.quantile(0.5), 0.0);
  for (int n = 0; n < 1000; ++n) histogram.add((n + 0.5) / 100.0);
  for (const double share : {0.1, 0.25, 0.5, 0.9}) EXPECT_NEAR(histogram.quantile(share), 10.0 * share, 1e-12);
  for (int n = 0; n < 5000; ++n) histogram.add(1e9);
  EXPECT_EQ(histogram.quantile(0.5), 10.0);  // beyond the last edge
}

}  // namespace
}  // namespace thalweg::analysis::histogram_test
