#include "driver/warnings/solid_warnings.hpp"

#include "tests/driver/case_texts.hpp"
#include "tests/driver/text_search.hpp"

#include <gtest/gtest.h>

namespace thalweg::driver::solid_warnings_test {
namespace {

using testing::channel;

// Fifty grains in the lower half of the same box.
const std::string bed = R"(system: resolved
domain:
  size: [0.04, 0.02, 0.02]
  spacing: 1.0e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6}
gravity: {magnitude: 9.81, slope: 0.001}
grains: [{count: 20, diameter: 4.0e-3, density: 2650, placement: {pattern: random, seed: 1}}]
contact: {restitution: 0.9}
coupling: {fewest_cells_per_diameter: 2}
run: {until: 1}
)";

// The surface of a box, outwards.
SolidCase box(const Vec3& lower, const Vec3& upper) {
  SolidCase solid;
  solid.stl = "box.stl";
  for (int n = 0; n < 8; ++n)
    solid.surface.points.emplace_back(n & 1 ? upper.x() : lower.x(), n & 2 ? upper.y() : lower.y(),
                                      n & 4 ? upper.z() : lower.z());
  solid.surface.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                             {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return solid;
}

std::string said(const std::string& text, const std::vector<SolidCase>& solids,
                 const std::vector<std::string>& overrides = {}) {
  Case c = testing::read_text(text, overrides);
  c.solids = solids;
  std::string all;
  for (const std::string& sentence : solids_in_the_lattice(c)) all += sentence + "\n";
  return all;
}

// From wall to wall at x = 10 mm.
SolidCase gate(double low, double high) { return box({0.010, -0.001, low}, {0.012, 0.021, high}); }

TEST(SolidWarnings, OfAGateFromFloorToLid) {
  const std::string closed = said(channel, {gate(-0.001, 0.021)});
  EXPECT_TRUE(contains(closed,
                       "The solid solids.0 blocks the channel, so no water passes along x: consider another "
                       "solids.0.translate in m or solids.0.scale."))
      << closed;
  EXPECT_EQ(said(channel, {gate(-0.001, 0.019)}), "");  // one cell is open
  EXPECT_TRUE(contains(said(channel, {gate(-0.001, 0.01), gate(0.01, 0.021)}), "The solids together block"));
  EXPECT_EQ(said(channel, {gate(-0.001, 0.021)}, {"domain.boundaries.x=no_slip"}), "");  // nothing flows anyway
}

// No plane across x is closed, and yet there is no way: two half gates, and a ceiling from one to the other.
TEST(SolidWarnings, OfAStepThatCloses) {
  const SolidCase low = gate(-0.001, 0.0105), high = box({0.028, -0.001, 0.009}, {0.030, 0.021, 0.021}),
                  between = box({0.010, -0.001, 0.009}, {0.030, 0.021, 0.0115});
  EXPECT_EQ(said(channel, {low, high}), "");
  EXPECT_TRUE(contains(said(channel, {low, between, high}), "block the channel"));
}

TEST(SolidWarnings, CountASolidThroughAPeriodicFace) {
  EXPECT_TRUE(
      contains(said(channel, {box({0.01, 0.015, -0.001}, {0.012, 0.036, 0.021})}, {"domain.boundaries.y=periodic"}),
               "blocks the channel"));
  EXPECT_EQ(said(channel, {box({0.01, 0.005, -0.001}, {0.012, 0.0242, 0.021})}, {"domain.boundaries.y=periodic"}), "");
  // Along x, too: a gate in two halves beside the face.
  EXPECT_TRUE(contains(said(channel, {box({-0.002, -0.001, -0.001}, {0.002, 0.021, 0.021})}), "blocks the channel"));
}

// The corners of the channel are sqrt(2) * 10 mm from its middle.
TEST(SolidWarnings, OfASphereThatFillsTheChannel) {
  SolidCase sphere;
  sphere.sphere = SphereCase{{0.02, 0.01, 0.01}, 0.0145};
  EXPECT_TRUE(contains(said(channel, {sphere}), "blocks the channel"));
  sphere.sphere->radius = 0.0125;
  EXPECT_EQ(said(channel, {sphere}), "");
}

TEST(SolidWarnings, OfASolidBetweenTheCentresOfCells) {
  const std::string thin = said(channel, {box({0.01, 0.005, -0.01}, {0.02, 0.015, 0.0004})});
  EXPECT_TRUE(contains(thin, "The solid solids.0 covers the centre of no cell of 0.001 m")) << thin;
  EXPECT_EQ(said(channel, {box({0.01, 0.005, -0.01}, {0.02, 0.015, 0.0006})}), "");
}

TEST(SolidWarnings, OfASolidWithinAnother) {
  const SolidCase block = box({0.01, 0.005, -0.001}, {0.03, 0.015, 0.010}),
                  core = box({0.015, 0.008, -0.001}, {0.025, 0.012, 0.005}),
                  spike = box({0.015, 0.008, -0.001}, {0.025, 0.012, 0.012});
  EXPECT_EQ(said(channel, {core, block}),
            "The solid solids.0 lies within solids.1, where neither fluid nor grains meet it: remove it, or consider "
            "another solids.0.translate in m or solids.0.scale.\n");
  EXPECT_EQ(said(channel, {block, spike}), "");  // its head is outside
  SolidCase moving = core;
  moving.motion.emplace();
  EXPECT_EQ(said(channel, {block, moving}), "");
}

TEST(SolidWarnings, OfOneSolidTwice) {
  const SolidCase block = box({0.01, 0.005, -0.001}, {0.03, 0.015, 0.010});
  const std::string twice = said(channel, {block, block});
  EXPECT_TRUE(contains(twice, "solids.1 lies within solids.0")) << twice;
  EXPECT_FALSE(contains(twice, "solids.0 lies within")) << twice;
}

// A sphere in the notch of a block: its box lies within that of the block.
TEST(SolidWarnings, OfNoSolidInTheNotchOfAnother) {
  SolidCase left = box({0.01, 0.005, -0.001}, {0.015, 0.015, 0.012}), sphere;
  const SolidCase right = box({0.025, 0.005, -0.001}, {0.030, 0.015, 0.012});
  const int points = static_cast<int>(left.surface.points.size());
  for (auto triangle : right.surface.triangles) {
    for (auto& corner : triangle) corner += points;
    left.surface.triangles.push_back(triangle);
  }
  left.surface.points.insert(left.surface.points.end(), right.surface.points.begin(), right.surface.points.end());
  sphere.sphere = SphereCase{{0.02, 0.01, 0.006}, 0.003};
  EXPECT_EQ(said(channel, {left, sphere}), "");
}

TEST(SolidWarnings, OfAPlateOverAllOfTheBed) {
  const std::string over = said(bed, {box({-0.001, -0.001, 0.012}, {0.041, 0.021, 0.014})});
  EXPECT_TRUE(contains(over, "covers all of the bed")) << over;
  EXPECT_EQ(said(bed, {box({-0.001, -0.001, 0.012}, {0.038, 0.0188, 0.014})}), "");  // it leaves a gap
  EXPECT_EQ(said(bed, {box({-0.001, -0.001, 0.012}, {0.041, 0.021, 0.021})}), "");   // a lid on the flow
  EXPECT_EQ(said(bed, {box({-0.001, -0.001, -0.001}, {0.041, 0.021, 0.003})}), "");  // a floor beneath
  EXPECT_EQ(said(bed, {box({-0.001, -0.001, 0.002}, {0.041, 0.021, 0.003})},         // a false floor
                 {"grains.0.placement.region={lower: [0, 0, 0.003], upper: [0.04, 0.02, 0.02]}"}),
            "");
}

}  // namespace
}  // namespace thalweg::driver::solid_warnings_test
