#include "driver/warnings/boundary_warnings.hpp"

#include "driver/warnings/case_warnings.hpp"
#include "tests/driver/case_texts.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace thalweg::driver::boundary_warnings_test {
namespace {

using testing::channel;

Case with_ends(const std::string& low, const std::string& high) {
  return testing::read_text(channel, {"domain.boundaries={x_low: " + low + ", x_high: " + high +
                                      ", y: periodic, bottom: no_slip, top: free_slip}"});
}

bool any_says(const Case& c, const std::string& part) {
  const std::vector<std::string> found = warnings(c);
  return std::any_of(found.begin(), found.end(),
                     [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

const std::string into = "{type: velocity_inlet, velocity: [0.1, 0, 0]}",
                  back = "{type: velocity_inlet, velocity: [-0.1, 0, 0]}";

TEST(BoundaryWarnings, OfNothingWhereFluidPassesFromOneEndToTheOther) {
  const Case c = with_ends(into, "pressure_outlet"), against = with_ends("pressure_outlet", back);
  for (const Case* one : {&c, &against}) {
    EXPECT_TRUE(inlets(*one).empty());
    EXPECT_TRUE(outlets(*one).empty());
  }
  EXPECT_TRUE(outlets(with_ends("{type: pressure_outlet, pressure: 1}", "pressure_outlet")).empty());
}

TEST(BoundaryWarnings, OfAnInletThatSucks) {
  EXPECT_TRUE(any_says(with_ends(back, "pressure_outlet"),
                       "The velocity of the velocity_inlet domain.boundaries.x_low points out of the box, so it "
                       "removes fluid: consider domain.boundaries.x_low.velocity: [0.1, 0, 0]."));
  // As much leaves at the end as comes in, so that no pressure rises; an outlet does that without a fixed velocity.
  const Case through = testing::read_text(
      channel, {"domain.boundaries={x_low: {type: velocity_inlet, velocity: [0.2, 0, 0]}, x_high: {type: "
                "velocity_inlet, velocity: [0.2, 0, 0.001]}, y: periodic, bottom: no_slip, top: free_slip}"});
  EXPECT_TRUE(any_says(through, "consider domain.boundaries.x_high: pressure_outlet"));
  EXPECT_FALSE(any_says(through, "without limit"));
  EXPECT_TRUE(any_says(with_ends("{type: velocity_inlet, velocity: [0, 0, 0.1]}", "pressure_outlet"),
                       "has no component into the box"));
}

TEST(BoundaryWarnings, OfWaterThatCannotLeaveOrComeIn) {
  EXPECT_TRUE(any_says(with_ends(into, "no_slip"),
                       "fills the box and no face lets the fluid out, so its pressure rises without limit"));
  EXPECT_TRUE(any_says(with_ends(back, "no_slip"), "empties the box"));
  EXPECT_TRUE(any_says(with_ends("no_slip", "pressure_outlet"), "no face brings any in"));
}

TEST(BoundaryWarnings, OfAFloorAndALidThatAreSwapped) {
  const std::vector<std::string> swap{"domain.boundaries.bottom=free_slip", "domain.boundaries.top=no_slip"};
  const Case c = testing::read_text(channel, swap);
  EXPECT_TRUE(any_says(c, "which look swapped"));
  const Warnings found = swapped_floor(c);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(changed(c, found.front().advice.front().remedy) == testing::read_text(channel));
  EXPECT_TRUE(swapped_floor(testing::read_text(channel)).empty());
  EXPECT_TRUE(swapped_floor(testing::read_text(channel, {"domain.boundaries.top=no_slip"})).empty());
  EXPECT_TRUE(swapped_floor(testing::read_text(channel, {"domain.boundaries.bottom=free_slip"})).empty());
}

}  // namespace
}  // namespace thalweg::driver::boundary_warnings_test
