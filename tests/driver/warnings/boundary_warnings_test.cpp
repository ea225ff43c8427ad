#include "driver/warnings/boundary_warnings.hpp"

#include "driver/warnings/case_warnings.hpp"
#include "tests/driver/case_texts.hpp"

#include <fmt/format.h>
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

// Pressures count from the one at which the fluid starts, and only their differences drive it.
TEST(BoundaryWarnings, OfOutletsUnderThePressureOfTheAir) {
  const Case c = with_ends(into, "{type: pressure_outlet, pressure: 101325}");
  EXPECT_TRUE(any_says(c, "All outlets are 101325 Pa above the pressure at which the fluid starts"));
  const Warnings found = outlet_pressures(c);
  ASSERT_EQ(found.size(), 1U);
  const Case mended = changed(c, found.front().advice.front().remedy);
  EXPECT_EQ(mended.domain.faces[x_high].pressure, 0.0);
  EXPECT_TRUE(outlet_pressures(mended).empty());
  const Case between =
      with_ends("{type: pressure_outlet, pressure: 101335}", "{type: pressure_outlet, pressure: 101325}");
  const Case less = changed(between, outlet_pressures(between).front().advice.front().remedy);
  EXPECT_EQ(less.domain.faces[x_low].pressure, 10.0);
  EXPECT_EQ(less.domain.faces[x_high].pressure, 0.0);
}

// 3 p/(rho (dx/dt)^2): 10 Pa are 0.05 with cells of 1 mm and steps of 1.29e-3 s.
TEST(BoundaryWarnings, OfOutletsThatCompressTheFluid) {
  const std::string low = "{type: pressure_outlet, pressure: 10}", high = "{type: pressure_outlet, pressure: 0}";
  Case c = with_ends(low, high);
  c.fluid.time_step = 1.28e-3;
  EXPECT_TRUE(outlet_pressures(c).empty());
  c.fluid.time_step = 2.0e-3;
  const Warnings found = outlet_pressures(c);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found.front().sentence.find("by 12 %"), std::string::npos);
  const Case mended = changed(c, found.front().advice.front().remedy);
  EXPECT_TRUE(outlet_pressures(mended).empty());
  EXPECT_GT(*mended.fluid.time_step, 1.19e-3);
}

// A layer of held spheres from the inlet on, a diameter from it, behind a recycling plane, and one sphere.
TEST(BoundaryWarnings, OfHeldBedsAtAnInlet) {
  const auto with_layer = [](const std::string& low, double begins, int count) {
    return testing::read_text(
        testing::channel,
        {"system=resolved", "gravity={magnitude: 9.81, slope: 0}", "contact={restitution: 0.5, friction: 0.5}",
         "domain.boundaries={x_low: " + low +
             ", x_high: pressure_outlet, y: periodic, bottom: no_slip, top: free_slip}",
         fmt::format(
             "grains=[{{count: {}, diameter: 5.0e-3, density: 2650, fixed: true, placement: {{pattern: uniform, "
             "region: {{lower: [{}, 0, 0], upper: [0.04, 0.02, 0.005]}}}}}}]",
             count, begins)});
  };
  EXPECT_EQ(beds_at_inlets(with_layer(into, 0.0, 32)).size(), 1U);
  EXPECT_EQ(beds_at_inlets(with_layer(into, 0.004, 28)).size(), 1U);
  EXPECT_TRUE(beds_at_inlets(with_layer(into, 0.005, 28)).empty());
  EXPECT_TRUE(beds_at_inlets(with_layer(into, 0.0, 2)).empty());
  EXPECT_TRUE(
      beds_at_inlets(with_layer("{type: velocity_inlet, velocity: [0.1, 0, 0], recycling_plane: 0.03}", 0.0, 32))
          .empty());
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
