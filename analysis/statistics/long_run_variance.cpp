#include "analysis/statistics/long_run_variance.hpp"

#include <algorithm>

namespace thalweg::analysis {

namespace {

// A sum is never taken to lack more than this, where the lags are no longer short beside the series.
constexpr double largest_lack = 0.8;

// A pair of autocovariances below this share of the variance counts as none: round-off does not decide where a sum
// ends.
constexpr double negligible = 1e-10;

double autocovariance(std::span<const double> distances, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = lag; i < distances.size(); ++i) sum += distances[i] * distances[i - lag];
  return sum / static_cast<double>(distances.size());
}

// h_k of the header.
double lack(double n, double k, About about) {
  const double of_mean = (n - k) / n;
  if (about == About::mean) return of_mean;
  const double m = n - k;  // terms t_i t_(i+k), of which the midpoints are m equally spaced places about the middle
  return of_mean + m * (m * m - 1.0 - 3.0 * k * k) / (n * (n * n - 1.0));
}

}  // namespace

LongRunVariance long_run_variance(std::span<const double> distances, About about, double round_off) {
  const auto n = static_cast<double>(distances.size());
  const double fitted = about == About::mean ? 1.0 : 2.0;
  const double variance = autocovariance(distances, 0);
  if (variance <= round_off * round_off) return {round_off * round_off, n};
  double sum = -variance, lacking = -lack(n, 0.0, about), before = 2.0 * variance;
  for (std::size_t k = 0; k + 1 < std::max<std::size_t>(2, distances.size() / 2); k += 2) {
    const double pair = autocovariance(distances, k) + autocovariance(distances, k + 1);
    if (pair <= negligible * variance) break;
    before = std::min(before, pair);
    sum += 2.0 * before;
    const auto lag = static_cast<double>(k);
    lacking += 2.0 * (lack(n, lag, about) + lack(n, lag + 1.0, about));
  }
  const double least = variance * n / (n - fitted);
  const double of_values = std::max(sum / (1.0 - std::min(lacking / n, largest_lack)), least);
  return {of_values, std::min(n, n * variance / of_values + fitted)};
}

}  // namespace thalweg::analysis
