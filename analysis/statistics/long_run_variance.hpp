// Variance of the mean of correlated values.
//
// Of n values with the autocovariances gamma_k a mean has the variance sigma^2/n, and the slope of a straight line by
// least squares sigma^2/S_tt (S_tt the sum of squared distances from the middle), with
//
//   sigma^2 = sum over k of gamma_k,   k = 0, +-1, +-2, ...
//
// where n is much larger than the memory of the values. The sum is that of Geyer's initial monotone sequence (Stat.
// Sci. 7 (1992) 473, sec. 3.3): Gamma_m = gamma_2m + gamma_2m+1 is positive and falls with m, so the sum ends at the
// first estimate that is not positive, at n/2 at the latest, and an estimate above the one before it is replaced by
// that.
//
// Autocovariances about the mean of the same values are too small: that of lag k, sum e_i e_(i+k)/n, on average by
// sigma^2 h_k/n, with h_k = sum of H_(i,i+k) over i, H the projection onto what was taken away, here 1/n, and for a
// line t_i t_j/S_tt as well (Priestley, Spectral Analysis and Time Series (1981), sec. 5.3.3; Wolff, Comput. Phys.
// Commun. 156 (2004) 143, sec. 3.3). The sum up to a lag w thus lacks the share sum over |k| <= w of h_k/n, and is
// divided by what remains. docs/theory.md section 5 has a table of how often the truth is within one and two errors.
//
// python/thalweg/means.py does the same.
#pragma once

#include <span>

namespace thalweg::analysis {

enum class About { mean, line };

struct LongRunVariance {
  double of_values;    // sigma^2, in the squared unit of the values; never less than their own variance
  double independent;  // how many independent values have the same variance of the mean, 1; at most n
};

// Long-run variance of the distances of n >= 2 (line: n >= 3) values at equal intervals from their mean or their line.
// If these do not exceed `round_off` (unit of the values), that is sigma, and all values are independent.
LongRunVariance long_run_variance(std::span<const double> distances, About about, double round_off);

}  // namespace thalweg::analysis
