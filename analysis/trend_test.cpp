#include "analysis/trend_test.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::analysis {

namespace {

// Residuals count as at least this part of the largest value, so that round-off is no drift.
constexpr double round_off = 1e-12;

// A straight line by least squares through equally spaced values.
struct Line {
  double slope = 0.0;        // a step
  double spread = 0.0;       // S_tt, sum of (i - middle)^2
  double squares = 0.0;      // sum of e_i^2
  double correlation = 0.0;  // r, of neighbours
};

Line line_through(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  const double middle = 0.5 * (n - 1.0);
  double mean = 0.0, product = 0.0, largest = 0.0;
  for (const double value : values) {
    mean += value / n;
    largest = std::max(largest, std::abs(value));
  }
  Line line;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double t = static_cast<double>(i) - middle;
    product += t * (values[i] - mean);
    line.spread += t * t;
  }
  line.slope = product / line.spread;
  double before = 0.0, neighbours = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double rest = values[i] - mean - line.slope * (static_cast<double>(i) - middle);
    line.squares += rest * rest;
    neighbours += before * rest;
    before = rest;
  }
  const double least = n * round_off * largest * round_off * largest;
  line.correlation = line.squares > least ? neighbours / line.squares : 0.0;
  line.squares = std::max(line.squares, least);
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

void TrendTest::add(double value) {
  sum_of_begun_ += value;
  begun_ += 1.0;
  if (begun_ < length_) return;
  batches_.push_back(sum_of_begun_ / length_);
  begun_ = sum_of_begun_ = 0.0;
  if (batches_.size() < most_batches) return;
  for (std::size_t b = 0; b < most_batches / 2; ++b) batches_[b] = 0.5 * (batches_[2 * b] + batches_[2 * b + 1]);
  batches_.resize(most_batches / 2);
  length_ *= 2.0;
}

TrendTest::Verdict TrendTest::verdict() const {
  if (batches_.size() < fewest_batches) return {};
  const auto n = static_cast<double>(batches_.size());
  const Line line = line_through(batches_);
  Verdict verdict;
  verdict.drift = line.slope * n;
  const double worth = std::min(n, n * (1.0 - line.correlation) / (1.0 + line.correlation));
  if (worth < 4.0) return verdict;
  const double error = std::sqrt(line.squares / ((worth - 2.0) * line.spread));
  verdict.error = error * n;
  verdict.trend = std::abs(line.slope) <= student_t_of_5_percent(worth - 2.0) * error ? Trend::steady : Trend::drifting;
  return verdict;
}

std::vector<double> TrendTest::state() const {
  std::vector<double> state{length_, begun_, sum_of_begun_};
  state.insert(state.end(), batches_.begin(), batches_.end());
  return state;
}

void TrendTest::restore(std::span<const double> state) {
  if (state.size() < 3) return;
  length_ = state[0];
  begun_ = state[1];
  sum_of_begun_ = state[2];
  batches_.assign(state.begin() + 3, state.end());
}

}  // namespace thalweg::analysis
