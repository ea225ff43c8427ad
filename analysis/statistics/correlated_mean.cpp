#include "analysis/statistics/correlated_mean.hpp"

#include "analysis/statistics/long_run_variance.hpp"
#include "core/state/whole_dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace thalweg::analysis {

void CorrelatedMean::add(double value) {
  count_ += 1.0;
  const double before = value - mean_;
  mean_ += before / count_;
  squares_ += before * (value - mean_);

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

double CorrelatedMean::deviation() const { return count_ > 0.0 ? std::sqrt(squares_ / count_) : 0.0; }

double CorrelatedMean::round_off() const {
  double largest = 0.0;
  for (const double batch : batches_) largest = std::max(largest, std::abs(batch));
  return 1e-12 * largest;
}

CorrelatedMean::Error CorrelatedMean::error() const {
  if (count_ < 2.0) return {std::numeric_limits<double>::quiet_NaN(), count_};
  if (deviation() <= round_off()) return {0.0, count_};  // all alike
  const double middle = std::accumulate(batches_.begin(), batches_.end(), 0.0) / static_cast<double>(batches_.size());
  std::vector<double> distances(batches_);
  for (double& distance : distances) distance -= middle;
  const double squared = long_run_variance(distances, About::mean, round_off()).of_values * length_ / count_;
  return {std::sqrt(squared), std::min(count_, squares_ / count_ / squared + 1.0)};
}

std::string with_error(const CorrelatedMean& mean, double unit) {
  const std::string text = fmt::format("{:.4g}", mean.mean() / unit);
  return mean.count() < 2 ? text : fmt::format("{} +- {:.2g}", text, mean.error().of_mean / unit);
}

std::vector<double> CorrelatedMean::state() const {
  std::vector<double> state{count_, mean_, squares_, length_, begun_, sum_of_begun_};
  state.insert(state.end(), batches_.begin(), batches_.end());
  return state;
}

void CorrelatedMean::save(ArchiveWriter& archive, MPI_Comm communicator, const std::string& path) const {
  write_whole(archive, communicator, path, state());
}

void CorrelatedMean::load(ArchiveReader& archive, const std::string& path) {
  if (!restore(read_whole<double>(archive, path)))
    throw damaged_dataset(path, "the batches of a mean are not those of its values");
}

bool CorrelatedMean::restore(std::span<const double> state) {
  if (state.size() < 6) return false;
  count_ = state[0];
  mean_ = state[1];
  squares_ = state[2];
  length_ = state[3];
  begun_ = state[4];
  sum_of_begun_ = state[5];
  batches_.assign(state.begin() + 6, state.end());
  return static_cast<double>(batches_.size()) * length_ + begun_ == count_;
}

}  // namespace thalweg::analysis
