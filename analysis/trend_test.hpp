// Whether a series has settled: a straight line through it that rises or falls by more than chance is a drift.
//
// The series is kept as 32 to 63 means of batches of equal length, which grow as it goes on. A line is fitted to them
// by least squares. The residuals e have the lag-one autocorrelation r = sum e_i e_(i+1) / sum e_i^2, so that the n
// batches are worth n_e = n (1 - r)/(1 + r) independent ones, at most n, and the slope b = S_tx / S_tt has the error
//
//   s_b^2 = sum e_i^2 / ((n_e - 2) S_tt).
//
// The series drifts if |b| > t s_b with t Student's at n_e - 2 degrees of freedom and 5 % (both sides): Santer et al.,
// J. Geophys. Res. 105 (2000) 7337, their "adjusted" test. A series without a drift is thus called drifting about once
// in twenty times. With fewer than 8 batches or n_e < 4 nothing can be said.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace thalweg::analysis {

enum class Trend { too_short, steady, drifting };

class TrendTest {
public:
  void add(double value);

  struct Verdict {
    Trend trend = Trend::too_short;
    double drift = 0.0;  // by which the line rises over the whole series, in the unit of the values
    double error = 0.0;  // standard error of the drift
  };
  Verdict verdict() const;

  // For a checkpoint.
  std::vector<double> state() const;
  void restore(std::span<const double> state);

  static constexpr std::size_t fewest_batches = 8, most_batches = 64;

private:
  std::vector<double> batches_;              // means of the complete ones
  double length_ = 1.0;                      // values in a batch
  double begun_ = 0.0, sum_of_begun_ = 0.0;  // number and sum of the values in the batch that is not complete
};

// Student's t that is exceeded on either side with 5 %: Cornish and Fisher's expansion about the normal distribution
// (Abramowitz & Stegun 26.7.5), within 1 % of the exact value from two degrees of freedom on.
double student_t_of_5_percent(double degrees_of_freedom);

}  // namespace thalweg::analysis
