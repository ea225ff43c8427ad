#include "analysis/statistics/stationarity.hpp"

#include "analysis/statistics/long_run_variance.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace thalweg::analysis {

namespace {

// Part of the mean by which a steady series may change from its begin to its end.
constexpr double bound = 0.5;

// A straight line by least squares through equally spaced values.
struct Line {
  double slope;                   // a step
  double spread;                  // S_tt, sum of (i - middle)^2
  std::vector<double> distances;  // of the values from it
};

Line line_through(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  const double middle = 0.5 * (n - 1.0), mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double product = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) product += (static_cast<double>(i) - middle) * (values[i] - mean);
  Line line{0.0, n * (n * n - 1.0) / 12.0, {}};
  line.slope = product / line.spread;
  for (std::size_t i = 0; i < values.size(); ++i)
    line.distances.push_back(values[i] - mean - line.slope * (static_cast<double>(i) - middle));
  return line;
}

}  // namespace

double student_t_of_5_percent(double degrees_of_freedom) {
  constexpr double z = 1.959963984540054, z2 = z * z;
  const double v = 1.0 / degrees_of_freedom;
  const double first = (z2 + 1.0) / 4.0, second = ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0;
  const double third = (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0;
  const double fourth = ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) / 92160.0;
  return z * (1.0 + v * (first + v * (second + v * (third + v * fourth))));
}

TrendVerdict trend_of(const CorrelatedMean& series) {
  const auto n = static_cast<double>(series.batches().size());
  if (n < 3.0) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    return {Trend::too_few_values, unknown, unknown};
  }
  const Line line = line_through(series.batches());
  const LongRunVariance about_line = long_run_variance(line.distances, About::line, series.round_off());
  const double drift = line.slope * n, error = std::sqrt(about_line.of_values / line.spread) * n;
  if (about_line.independent < fewest_independent_values) return {Trend::too_few_values, drift, error};
  const double chance = student_t_of_5_percent(about_line.independent - 2.0) * error;
  if (std::abs(drift) > chance) return {Trend::drifting, drift, error};
  if (!series.error().holds()) return {Trend::too_few_values, drift, error};
  const bool bounded = std::abs(drift) + chance <= bound * std::abs(series.mean());
  return {bounded ? Trend::steady : Trend::not_bounded, drift, error};
}

double TrendVerdict::as_number() const {
  switch (trend) {
    case Trend::steady:
      return 1.0;
    case Trend::drifting:
      return 0.0;
    case Trend::too_few_values:
      return -1.0;
    default:
      return -2.0;
  }
}

std::string TrendVerdict::sentence(double unit) const {
  if (trend == Trend::too_few_values)
    return fmt::format("too short a time to tell whether it is steady, which needs {:.0f} independent values",
                       fewest_independent_values);
  const std::string line = fmt::format(
      "a straight line through it changes by {:+.2g} +- {:.2g} over this time, which is", drift / unit, error / unit);
  switch (trend) {
    case Trend::drifting:
      return fmt::format("not steady: {} beyond chance", line);
    case Trend::steady:
      return fmt::format("steady: {} within chance and (95 %) less than half of the mean", line);
    default:
      return fmt::format("too short a time to tell whether it is steady: {} within chance, but may be half of the mean",
                         line);
  }
}

}  // namespace thalweg::analysis
