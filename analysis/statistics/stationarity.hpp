// Test of whether a series is stationary, by the drift of a straight line through it.
//
// A line is fitted by least squares to the batches of the series (correlated_mean.hpp). Its slope has the variance
// sigma^2/S_tt, with sigma^2 the long-run variance of the batches about the line (long_run_variance.hpp), which are
// worth n_r independent values. With t Student's at n_r - 2 degrees of freedom and 5 % (both sides), the series
//
//   - is too short to tell if n_r is below 20,
//   - drifts if the line changes over the series by more than t times its error,
//   - otherwise is too short if it is worth fewer than 20 independent values, or if the change plus t times its error
//     exceeds half of the mean, so that such a change cannot be excluded,
//   - and is steady otherwise.
//
// Steady thus means: with 95 % confidence a straight line through the series changes by less than half of its mean, and
// no drift is seen. A series without a drift is called drifting about once in twenty times. The test is that of Santer
// et al. (J. Geophys. Res. 105 (2000) 7337) with the number of independent values from all lags instead of the first.
#pragma once

#include "analysis/statistics/correlated_mean.hpp"

#include <string>

namespace thalweg::analysis {

enum class Trend { too_few_values, not_bounded, drifting, steady };

struct TrendVerdict {
  Trend trend;
  double drift;  // by which the line rises over the series, in the unit of the values; with < 3 batches not a number
  double error;  // standard error of the drift

  double as_number() const;  // 1: steady, 0: drifting, -1: too few values, -2: not bounded
  // The verdict with its reason, without a full stop; unit: by which the drift is divided before it is printed.
  std::string sentence(double unit) const;
};

TrendVerdict trend_of(const CorrelatedMean& series);

// Student's t that is exceeded on either side with 5 %: Cornish and Fisher's expansion about the normal distribution
// (Abramowitz & Stegun 26.7.5), within 1 % of the exact value from two degrees of freedom on.
double student_t_of_5_percent(double degrees_of_freedom);

}  // namespace thalweg::analysis
