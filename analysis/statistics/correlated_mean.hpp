// Mean of a correlated series, and its error.
//
// The series is kept as 512 to 1023 means of batches of 1, 2, 4, ... values, which grow as it goes on, so that what
// goes into a checkpoint does not. The standard error of the mean of n values is sqrt(sigma^2 L/n), with L the values
// in a batch and sigma^2 the long-run variance of the batches (long_run_variance.hpp). Values that fill no batch, fewer
// than one in 512, are in the mean, but not in its error.
//
// With s the standard deviation of the values, the series is worth (s/error)^2 + 1 independent values, at most n.
#pragma once

#include "core/base/archive.hpp"

#include <mpi.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace thalweg::analysis {

// Number of independent values below which an error is too small more often than by chance and drift is not judged:
// one in fifty series worth five values seems to be worth twenty.
constexpr double fewest_independent_values = 20.0;

class CorrelatedMean {
public:
  void add(double value);

  std::int64_t count() const { return static_cast<std::int64_t>(count_); }
  double mean() const { return mean_; }  // 0 as long as there is no value
  double deviation() const;              // standard deviation of the values about their mean: root of the mean square

  struct Error {
    double of_mean;      // standard error, in the unit of the values; not a number with fewer than two values
    double independent;  // values, 1
    bool holds() const { return independent >= fewest_independent_values; }  // else it is an underestimate
  };
  Error error() const;

  std::span<const double> batches() const { return batches_; }  // means of the complete ones
  double round_off() const;  // by which batches that should be alike may differ, in their unit

  // The state is one dataset of a checkpoint; load() throws DamagedFile if its batches are not those of its values.
  // Collective.
  void save(ArchiveWriter& archive, MPI_Comm communicator, const std::string& path) const;
  void load(ArchiveReader& archive, const std::string& path);
  std::vector<double> state() const;
  [[nodiscard]] bool restore(std::span<const double> state);  // false: its batches are not those of its values

  static constexpr std::size_t most_batches = 1024;

private:
  double count_ = 0.0, mean_ = 0.0, squares_ = 0.0;  // squares: sum of (value - mean)^2, as Welford adds it up
  std::vector<double> batches_;
  double length_ = 1.0;                      // values in a batch
  double begun_ = 0.0, sum_of_begun_ = 0.0;  // number and sum of the values in the batch that is not complete
};

// "1.234 +- 0.056", in the given unit; the mean alone where there are fewer than two values and so no error.
std::string with_error(const CorrelatedMean& mean, double unit);

}  // namespace thalweg::analysis
