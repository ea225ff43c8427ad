// Histogram: counts of values between fixed edges. Counts are integers, so they do not depend on the order of the
// values nor on the rank that counted them.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace thalweg::analysis {

class Histogram {
public:
  // bins of equal width from `lower` to `upper`
  static Histogram linear(double lower, double upper, int bins);
  // bins of equal ratio from `lower` > 0 to `upper`
  static Histogram geometric(double lower, double upper, int bins);

  // The bin of a value: 0 below the first edge, then those between edges (the lower edge belongs to it), last: above.
  std::size_t bin_of(double value) const;
  void add(double value) { ++counts_[bin_of(value)]; }

  std::span<const double> edges() const { return edges_; }
  std::span<const std::int64_t> counts() const { return counts_; }  // number of edges + 1
  std::span<std::int64_t> counts() { return counts_; }
  std::int64_t total() const;

  // The value that this share of all values lies below, linear within a bin; the first or the last edge where it lies
  // outside of them, 0 where there are no values.
  double quantile(double share) const;

private:
  explicit Histogram(std::vector<double> edges) : edges_(std::move(edges)), counts_(edges_.size() + 1, 0) {}

  std::vector<double> edges_;
  std::vector<std::int64_t> counts_;
};

}  // namespace thalweg::analysis
