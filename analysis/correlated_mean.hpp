// The mean of a series whose values depend on those before, and how far it may be off.
//
// The values are averaged in pairs, the averages in pairs again, and so on (Flyvbjerg & Petersen, J. Chem. Phys. 91
// (1989) 461). Values at the end that fill no block make one that is shorter. With blocks of 2^k values, their means b,
// their lengths w in units of a whole one, n_k blocks in all and the mean m of the series,
//
//   sigma_k^2 = sum w (b - m)^2 / ((n_k - 1) sum w)
//
// grows with k until blocks are longer than the memory of the series, and is then the square of the error of the mean.
// The shortest blocks with B^3 > 2 n (sigma_k / sigma_0)^4, B = 2^k, n the number of values, are taken (Wolff, Comput.
// Phys. Commun. 156 (2004) 143; Lee et al., Phys. Rev. E 83 (2011) 066706), if there are at least eight. The integrated
// autocorrelation time is then sigma_k^2 / (2 sigma_0^2) times the interval between values: half an interval where
// values do not depend on each other.
//
// What is kept grows with the logarithm of the number of values, so that it goes into a checkpoint.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::analysis {

class CorrelatedMean {
public:
  void add(double value);

  std::int64_t count() const;
  double mean() const;       // 0 as long as there is no value
  double deviation() const;  // standard deviation of the values about their mean: root of the mean square

  struct Error {
    double of_mean = 0.0;           // standard error; where no length of blocks is enough, the largest found
    double correlation_time = 0.5;  // intervals between values
    bool blocks_long_enough = false;
  };
  Error error() const;

  // For a checkpoint: numbers_a_level numbers for each length of blocks.
  static constexpr std::size_t numbers_a_level = 5;
  std::vector<double> state() const;
  void restore(std::span<const double> state);

private:
  // Blocks of one length.
  struct Level {
    double blocks = 0.0, mean = 0.0, squares = 0.0;  // squares: sum of (block - mean)^2
    double waits = 0.0, waiting = 0.0;               // waits 1: a block, `waiting`, waits for its partner
  };
  // The values at the end that fill no block of a level: their length in blocks, and their mean times that length.
  struct Rest {
    double length = 0.0, sum = 0.0;
  };
  static double squared_error(const Level& level, const Rest& rest);  // sigma_k^2

  std::vector<Level> levels_;
};

}  // namespace thalweg::analysis
