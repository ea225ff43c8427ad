#include "driver/cores.hpp"

#include <gtest/gtest.h>

namespace thalweg::driver::cores_test {
namespace {

TEST(Cores, ByTheQuotaOfAContainer) {
  EXPECT_EQ(cores_by_quota("400000 100000"), 4);
  EXPECT_EQ(cores_by_quota("150000 100000\n"), 1);
  EXPECT_EQ(cores_by_quota("50000 100000"), 1);
  EXPECT_EQ(cores_by_quota("max 100000"), std::nullopt);
  EXPECT_EQ(cores_by_quota(""), std::nullopt);
  EXPECT_EQ(cores_by_quota("100000"), std::nullopt);
}

}  // namespace
}  // namespace thalweg::driver::cores_test
