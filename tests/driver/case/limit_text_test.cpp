// Values that messages advise are not refused.
#include "driver/case/limit_text.hpp"

#include <gtest/gtest.h>

namespace thalweg::driver::limit_text_test {
namespace {

TEST(LimitText, KeepsTheLimit) {
  EXPECT_EQ(at_most_text(1.2357e-4, 3), "0.000123");
  EXPECT_EQ(at_most_text(1.2341e-4, 3), "0.000123");
  EXPECT_EQ(at_most_text(9.996, 3), "9.99");
  EXPECT_EQ(at_most_text(0.25, 2), "0.25");
  EXPECT_EQ(at_most_text(0.0, 2), "0");
  EXPECT_EQ(at_least_text(1.2341e-4, 3), "0.000124");
  EXPECT_EQ(at_least_text(9.991, 3), "10");
  EXPECT_EQ(at_least_text(25.0, 2), "25");
  for (double limit = 1.0e-7; limit < 1.0e7; limit *= 1.37) {
    EXPECT_LE(std::stod(at_most_text(limit, 3)), limit);
    EXPECT_GT(std::stod(at_most_text(limit, 3)), 0.99 * limit);
    EXPECT_GE(std::stod(at_least_text(limit, 3)), limit);
    EXPECT_LT(std::stod(at_least_text(limit, 3)), 1.0101 * limit);
  }
}

}  // namespace
}  // namespace thalweg::driver::limit_text_test
