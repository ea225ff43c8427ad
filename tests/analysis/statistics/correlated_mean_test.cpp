#include "analysis/statistics/correlated_mean.hpp"

#include "core/base/damaged_file.hpp"
#include "tests/analysis/made_up_series.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace thalweg::analysis::correlated_mean_test {
namespace {

TEST(CorrelatedMean, HasMeanAndDeviationOfItsValues) {
  CorrelatedMean mean;
  EXPECT_EQ(mean.mean(), 0.0);
  for (const double value : {1.0, 4.0, 2.0, 5.0}) mean.add(value);
  EXPECT_EQ(mean.count(), 4);
  EXPECT_DOUBLE_EQ(mean.mean(), 3.0);
  EXPECT_DOUBLE_EQ(mean.deviation(), std::sqrt(2.5));
}

TEST(CorrelatedMean, OfEqualValuesIsExact) {
  CorrelatedMean mean;
  for (int n = 0; n < 100; ++n) mean.add(0.1);
  EXPECT_EQ(mean.error().of_mean, 0.0);
  EXPECT_EQ(mean.error().independent, 100.0);
}

CorrelatedMean mean_of_chain(double a, int values, int seed) {
  CorrelatedMean mean;
  MadeUpChain chain(a, static_cast<std::uint64_t>(seed));
  for (int n = 0; n < values; ++n) mean.add(chain.next());
  return mean;
}

// A chain x' = a x + e has the variance 1/(1 - a^2) of e's, and the mean of n of them the square error (1 + a)/(1 - a)
// of independent ones (Priestley 1981, sec. 5.3). The mean of 50 estimates scatters far less than the 10 % allowed.
TEST(CorrelatedMean, KnowsItsErrorInAChainOfKnownMemory) {
  constexpr int chains = 50;
  for (const int values : {900, 20000}) {
    for (const double a : {0.0, 0.5, 0.9}) {
      const double worth = (1.0 + a) / (1.0 - a), expected = std::sqrt(worth / (1.0 - a * a) / values);
      double error = 0.0;
      for (int seed = 1; seed <= chains; ++seed) {
        const CorrelatedMean mean = mean_of_chain(a, values, seed);
        error += mean.error().of_mean / chains;
        EXPECT_LT(std::abs(mean.mean()), 5.0 * expected) << a;
      }
      EXPECT_NEAR(error / expected, 1.0, 0.1) << a << ", " << values;
    }
  }
}

// 98 % of all series that are worth five independent values are known to be too short; of those worth a hundred none is
// taken for one. Three times the root of the number is allowed.
TEST(CorrelatedMean, KnowsWhenItIsTooShort) {
  constexpr int chains = 200, values = 600;
  int sure_of_few = 0, sure_of_many = 0;
  for (int seed = 1; seed <= chains; ++seed) {
    const auto memory = [](double independent) { return (values - independent) / (values + independent); };
    if (mean_of_chain(memory(5.0), values, seed).error().holds()) ++sure_of_few;
    if (mean_of_chain(memory(100.0), values, seed).error().holds()) ++sure_of_many;
  }
  EXPECT_LE(sure_of_few, 10);
  EXPECT_EQ(sure_of_many, chains);
}

// A record that ends as motion sets in: one event, which makes the mean.
TEST(CorrelatedMean, CountsABurstAtTheEnd) {
  CorrelatedMean mean;
  MadeUpChain chain(0.0, 5);
  for (int n = 0; n < 176; ++n) mean.add(1e-3 * chain.next());
  for (const double value : {0.02, 0.06, 0.16, 0.46, 0.92, 1.6, 2.7}) mean.add(value);
  EXPECT_GT(mean.error().of_mean, mean.deviation() / std::sqrt(183.0));
}

test::MemoryArchive saved(const CorrelatedMean& mean) {
  return test::saved(mean, MPI_COMM_WORLD, MPI_COMM_WORLD, "mean");
}

CorrelatedMean restored(const test::MemoryArchive& archive) {
  CorrelatedMean mean;
  test::load(mean, archive, "mean");
  return mean;
}

TEST(CorrelatedMean, GoesOnFromItsState) {
  CorrelatedMean whole, first, second;
  MadeUpChain chain(0.5, 1);
  for (int n = 0; n < 5000; ++n) {
    const double value = chain.next();
    whole.add(value);
    (n < 3123 ? first : second).add(value);
    if (n == 3122) second = restored(saved(first));
  }
  EXPECT_EQ(whole.state(), second.state());
  EXPECT_EQ(whole.error().of_mean, second.error().of_mean);
}

// Whatever number of values is lost.
TEST(CorrelatedMean, RefusesAStateThatHasLostValues) {
  CorrelatedMean mean;
  for (int n = 0; n < 2051; ++n) mean.add(n);
  test::MemoryArchive archive = saved(mean);
  EXPECT_EQ(restored(archive).state(), mean.state());
  auto& state = archive.datasets.at("mean");
  for (std::uint64_t left = mean.state().size(); left-- > 0;) {
    std::get<std::vector<double>>(state.values).resize(left);
    state.shape = {left};
    EXPECT_THROW(restored(archive), DamagedFile) << left;
  }
}

// Three million values, three thousand times what is kept. Their mean is n/2, and the scatter of a line is not
// forgotten.
TEST(CorrelatedMean, KeepsItsSize) {
  constexpr int values = 3'000'000;
  CorrelatedMean mean;
  for (int n = 0; n <= values; ++n) mean.add(n);
  EXPECT_LT(mean.batches().size(), CorrelatedMean::most_batches);
  EXPECT_GE(mean.batches().size(), CorrelatedMean::most_batches / 2);
  EXPECT_LT(mean.state().size(), CorrelatedMean::most_batches + 10);
  EXPECT_NEAR(mean.mean() / (0.5 * values), 1.0, 1e-12);
  EXPECT_NEAR(mean.deviation() / (values / std::sqrt(12.0)), 1.0, 1e-6);
}

}  // namespace
}  // namespace thalweg::analysis::correlated_mean_test
