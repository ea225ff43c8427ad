// The message of the integrator when it gets no further.
#include "continuum/stiff_integrator.hpp"
#include "core/base/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace thalweg::continuum::stiff_integrator_test {
namespace {

TEST(StiffIntegrator, TellsOfAFailureByItsErrorAlone) {
  const auto no_rates = [](std::span<const double>, std::span<double> rates) {
    std::fill(rates.begin(), rates.end(), std::numeric_limits<double>::quiet_NaN());
  };
  StiffIntegrator integrator(1, std::vector<Tolerance>(3, Tolerance{1e-4, 1e-6}), no_rates);
  std::vector<double> unknowns{1.0, 2.0, 3.0};
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  EXPECT_THROW(integrator.advance(unknowns, 1.0), RunError);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(unknowns, (std::vector<double>{1.0, 2.0, 3.0}));
}

}  // namespace
}  // namespace thalweg::continuum::stiff_integrator_test
