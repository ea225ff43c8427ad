#include "analysis/statistics/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace thalweg::analysis {

Histogram Histogram::linear(double lower, double upper, int bins) {
  std::vector<double> edges;
  for (int b = 0; b <= bins; ++b) edges.push_back(lower + (upper - lower) * b / bins);
  return Histogram(std::move(edges));
}

Histogram Histogram::geometric(double lower, double upper, int bins) {
  std::vector<double> edges;
  for (int b = 0; b <= bins; ++b) edges.push_back(lower * std::pow(upper / lower, static_cast<double>(b) / bins));
  return Histogram(std::move(edges));
}

std::size_t Histogram::bin_of(double value) const {
  return static_cast<std::size_t>(std::upper_bound(edges_.begin(), edges_.end(), value) - edges_.begin());
}

std::int64_t Histogram::total() const { return std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0}); }

double Histogram::quantile(double share) const {
  const auto all = static_cast<double>(total());
  if (all == 0.0) return 0.0;
  double below = static_cast<double>(counts_.front());
  if (share * all <= below) return edges_.front();
  for (std::size_t b = 1; b < edges_.size(); ++b) {
    const auto here = static_cast<double>(counts_[b]);
    if (here > 0.0 && share * all <= below + here)
      return edges_[b - 1] + (share * all - below) / here * (edges_[b] - edges_[b - 1]);
    below += here;
  }
  return edges_.back();
}

}  // namespace thalweg::analysis
