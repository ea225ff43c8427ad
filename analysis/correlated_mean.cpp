#include "analysis/correlated_mean.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::analysis {

namespace {

// The scatter of fewer says too little: it is off by a quarter with eight, and by half with three, which then may seem
// to be enough by chance.
constexpr double fewest_blocks = 8.0;

}  // namespace

void CorrelatedMean::add(double value) {
  for (std::size_t k = 0;; ++k) {
    if (k == levels_.size()) levels_.emplace_back();
    Level& level = levels_[k];
    level.blocks += 1.0;  // Welford's sums, which do not cancel
    const double before = value - level.mean;
    level.mean += before / level.blocks;
    level.squares += before * (value - level.mean);
    if (level.waits == 0.0) {
      level.waits = 1.0;
      level.waiting = value;
      return;
    }
    level.waits = 0.0;
    value = 0.5 * (level.waiting + value);
  }
}

std::int64_t CorrelatedMean::count() const {
  return levels_.empty() ? 0 : static_cast<std::int64_t>(levels_.front().blocks);
}

double CorrelatedMean::mean() const { return levels_.empty() ? 0.0 : levels_.front().mean; }

double CorrelatedMean::deviation() const {
  return levels_.empty() ? 0.0 : std::sqrt(levels_.front().squares / levels_.front().blocks);
}

CorrelatedMean::Error CorrelatedMean::error() const {
  Error error;
  if (count() < 2) return error;
  const double values = levels_.front().blocks, plain = squared_error(levels_.front(), {});
  if (plain == 0.0) return {0.0, 0.5, true};  // all alike
  double largest = 0.0;
  Rest rest;
  for (std::size_t k = 0; k < levels_.size() && (k == 0 || levels_[k].blocks >= fewest_blocks); ++k) {
    const double squared = squared_error(levels_[k], rest), ratio = squared / plain;
    largest = std::max(largest, squared);
    if (std::exp2(3.0 * static_cast<double>(k)) > 2.0 * values * ratio * ratio)
      return {std::sqrt(squared), 0.5 * ratio, true};
    rest = {0.5 * (rest.length + levels_[k].waits), 0.5 * (rest.sum + levels_[k].waits * levels_[k].waiting)};
  }
  return {std::sqrt(largest), 0.5 * largest / plain, false};
}

double CorrelatedMean::squared_error(const Level& level, const Rest& rest) {
  if (rest.length == 0.0) return level.squares / (level.blocks * (level.blocks - 1.0));
  const double length = level.blocks + rest.length, from_mean = rest.sum / rest.length - level.mean;
  const double squares = level.squares + level.blocks * rest.length / length * from_mean * from_mean;
  return squares / (length * level.blocks);
}

std::vector<double> CorrelatedMean::state() const {
  std::vector<double> state;
  for (const Level& level : levels_)
    state.insert(state.end(), {level.blocks, level.mean, level.squares, level.waits, level.waiting});
  return state;
}

void CorrelatedMean::restore(std::span<const double> state) {
  levels_.clear();
  for (std::size_t n = 0; n + numbers_a_level <= state.size(); n += numbers_a_level)
    levels_.push_back({state[n], state[n + 1], state[n + 2], state[n + 3], state[n + 4]});
}

}  // namespace thalweg::analysis
