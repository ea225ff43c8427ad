#include "driver/bed/supplied_grains.hpp"

#include "driver/bed/reference_grain.hpp"
#include "driver/estimate/contact_estimate.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::driver::supplied_grains_test {
namespace {

// q* is a rate of volume, scaled with the reference grain: of heavier grains it is as many, whose mass is larger.
TEST(SuppliedGrains, HaveTheVolumeOfTheTransportRate) {
  Case c = water_over_glass(5e-3, 0.05, 0.04, 0.01, lbm::FaceType::law_of_the_wall);
  const ReferenceGrain grain = reference_grain(c);
  const double unit = std::sqrt((grain.density / 1000.0 - 1.0) * 9.8 * grain.diameter) * grain.diameter;
  EXPECT_NEAR(unit_rate(c), unit * c.domain.size.y(), 1e-12 * unit_rate(c));

  beds::SupplyKeys supply;
  supply.transport_rate = 0.2;
  supply.population = static_cast<std::int64_t>(c.grains.size());
  c.grains.push_back(c.grains.back());
  beds::Population& fed = c.grains.back();
  fed.fixed = true;  // so that the reference grain stays as it is
  for (const double density : {1500.0, 7800.0}) {
    fed.density = density;
    const double volume = std::numbers::pi / 6.0 * std::pow(fed.diameter, 3);
    EXPECT_NEAR(grains_per_second(c, supply) * volume, 0.2 * unit_rate(c), 1e-9 * unit_rate(c)) << density;
  }
  supply.transport_rate.reset();
  supply.mass_rate = 1.0;
  EXPECT_NEAR(grains_per_second(c, supply) * fed.density * std::numbers::pi / 6.0 * std::pow(fed.diameter, 3), 1.0,
              1e-9);
}

// The fluid next to grains that come in fast is as fast as they are, and so are their impacts.
TEST(SuppliedGrains, ComeInWithTheirOwnVelocity) {
  Case c = water_over_glass(5e-3, 0.0, 0.04, 0.04, lbm::FaceType::periodic);
  EXPECT_EQ(fastest_supply(c), 0.0);
  c.supplies.emplace_back().velocity = Vec3(0.0, 3.0, -4.0);
  EXPECT_EQ(fastest_supply(c), 5.0);
  EXPECT_EQ(flow_estimate(c).speed, 5.0);
  EXPECT_EQ(flow_estimate(c).cause, FlowCause::moving_grains);
  EXPECT_EQ(expected_overlaps(c).speed, 5.0);
  c.sinks.emplace_back().recirculation.emplace().velocity = Vec3(6.0, 0.0, 0.0);
  EXPECT_EQ(flow_estimate(c).speed, 6.0);
}

}  // namespace
}  // namespace thalweg::driver::supplied_grains_test
