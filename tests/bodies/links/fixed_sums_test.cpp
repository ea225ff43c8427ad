#include "bodies/links/fixed_sums.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace thalweg::bodies::fixed_sums_test {
namespace {

using Sums = FixedSums<2>;
using Wide = Sums::Wide;

// A pack of `value`s, one lane of which is `other`.
Wide pack(double value, int lane, double other) {
  Wide result = value;
  result[lane] = other;
  return result;
}

bool leaves_range(int lane, double term) {
  SumRange::reset();
  Sums sums;
  sums.add({pack(1.0, lane, 0.5), pack(-1.0, lane, term)});
  sums.add({Wide(1.0), Wide(-1.0)});
  static_cast<void>(sums[0]);
  EXPECT_FALSE(SumRange::was_left());
  static_cast<void>(sums[1]);
  const bool left = SumRange::was_left();
  SumRange::reset();
  return left;
}

TEST(FixedSums, AreThoseOfSingleTerms) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(-127.0, 127.0);
  Sums sums;
  std::int64_t expected[2] = {0, 0};
  SumRange::reset();
  for (int n = 0; n < Sums::most_terms / Sums::width; ++n) {
    std::array<Wide, 2> terms;
    for (int s = 0; s < 2; ++s)
      for (int lane = 0; lane < Sums::width; ++lane) {
        const double term = uniform(generator);
        terms[static_cast<std::size_t>(s)][lane] = term;
        expected[s] += LatticeFixed::from(term);
      }
    sums.add(terms);
  }
  EXPECT_EQ(sums[0], expected[0]);
  EXPECT_EQ(sums[1], expected[1]);
  EXPECT_FALSE(SumRange::was_left());
}

// The limit is LatticeFixed::largest_term, 128, in every lane and with either sign.
TEST(FixedSums, NoteATermThatIsOutOfRange) {
  for (int lane = 0; lane < Sums::width; ++lane) {
    for (const double term : {127.9, -127.9, 0.0, -0.0, 1e-300}) EXPECT_FALSE(leaves_range(lane, term)) << term;
    for (const double term : {128.1, -128.1, 1e3, -1e3, 1e18, -1e18, 1e300, std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity(), std::nan("")})
      EXPECT_TRUE(leaves_range(lane, term)) << term;
  }
}

}  // namespace
}  // namespace thalweg::bodies::fixed_sums_test
