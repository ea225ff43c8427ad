#include "core/fixed_point.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace thalweg {
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
  // Each term is rounded by at most half a unit of 2^-50.
  EXPECT_NEAR(LatticeFixed::to_double(first), std::accumulate(terms.begin(), terms.end(), 0.0), 5000 * 0x1p-51 + 1e-11);
}

}  // namespace
}  // namespace thalweg
