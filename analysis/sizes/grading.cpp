#include "analysis/sizes/grading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace thalweg::analysis {

double SizeClasses::middle(std::size_t size_class) const {
  return std::sqrt(edges_[size_class] * edges_[size_class + 1]);
}

int SizeClasses::bin_of(double diameter) const {
  const auto above = std::upper_bound(edges_.begin() + 1, edges_.end() - 1, diameter);
  const auto size_class = static_cast<std::size_t>(above - edges_.begin()) - 1;
  const double way = std::log(diameter / edges_[size_class]) / std::log(edges_[size_class + 1] / edges_[size_class]);
  const int bin = static_cast<int>(std::clamp(std::floor(way * bins_a_class), 0.0, bins_a_class - 1.0));
  return static_cast<int>(size_class) * bins_a_class + bin;
}

std::vector<double> SizeClasses::by_class(std::span<const double> of_bins) const {
  std::vector<double> sums(count(), 0.0);
  for (std::size_t b = 0; b < of_bins.size(); ++b) sums[b / bins_a_class] += of_bins[b];
  return sums;
}

double median_diameter(std::span<const double> shares, std::span<const double> diameters) {
  const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
  if (!(all > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  double finer = 0.0;
  for (std::size_t b = 0; b < shares.size(); ++b)
    if ((finer += shares[b]) >= 0.5 * all) return diameters[b];
  return diameters.back();  // by rounding
}

}  // namespace thalweg::analysis
