#include "driver/bed/obstacles.hpp"

#include "driver/bed/bed_flow.hpp"
#include "driver/case/solid_setup.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/support/meshes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace thalweg::driver::obstacles_test {
namespace {

// A bed of 12 mm over 72 mm x 48 mm, and fixed grains to be added in front of it: 220 grains of 6 mm, 11.9996 mm at a
// solid fraction of 0.6.
std::string bed_with(const std::string& fixed) {
  return fmt::format(R"(system: resolved
name: obstacles
domain: {{size: [0.072, 0.048, 0.042], spacing: 1.0e-3, boundaries: {{x: periodic, y: periodic, bottom: no_slip, top: free_slip}}}}
fluid: {{density: 1000, kinematic_viscosity: 1.0e-6, smagorinsky_constant: 0.27, time_step: 1.0e-4}}
gravity: {{magnitude: 9.81, slope: 0.02}}
grains:
{}  - {{fill: {{depth: 0.012}}, diameter: 6.0e-3, density: 2650, placement: {{pattern: random, seed: 1}}}}
contact: {{normal_stiffness: 20000, tangential_stiffness: 5714, restitution: 0.5, friction: 0.5}}
coupling: {{grain_steps_per_fluid_step: auto}}
run: {{until: 0.05}}
)",
                     fixed);
}

std::string fixed_at(const std::string& positions, double diameter) {
  return fmt::format("  - {{density: 2650, fixed: true, diameter: {}, placement: {{positions: [{}]}}}}\n", diameter,
                     positions);
}

// Twelve spheres of 16 mm, 4 mm apart across the stream, sunk into the floor by 4 mm.
std::string sill() {
  std::string positions;
  for (int n = 1; n <= 12; ++n) positions += fmt::format("{}[0.03, {}, 0.004]", n > 1 ? ", " : "", 0.004 * n);
  return fixed_at(positions, 0.016);
}

// The section of the sill between the spheres' largest and smallest, 2 mm off a centre, is that of cylinders of 8 and
// 7.75 mm; the bed fills the room beside them: 12 mm + section/72 mm.
TEST(Obstacles, ASillTakesItsRoomInTheBedOnce) {
  const Case c = testing::read_text(bed_with(sill()));
  EXPECT_EQ(obstacles_of(c).spheres.size(), 12U);
  const auto section = [](double r, double up) {  // of a cylinder, above the floor; mm^2
    return std::numbers::pi * r * r - r * r * std::acos(up / r) + up * std::sqrt(r * r - up * up);
  };
  EXPECT_LT(settled_height(c), 0.001 * (12.0 + section(8.0, 4.0) / 72.0) + 1e-5);
  EXPECT_GT(settled_height(c), 0.001 * (11.9996 + section(7.75, 4.0) / 72.0) - 1e-5);
  const double volume = solid_volume(c), grains = 220 * std::numbers::pi / 6.0 * 216e-9;
  EXPECT_LT(volume - grains, section(8.0, 4.0) * 48e-9 * 1.002);
  EXPECT_GT(volume - grains, section(7.75, 4.0) * 48e-9 * 0.998);
}

// They stand in the bed and are not of it: its solid fraction is that of its fill.
TEST(Obstacles, HaveNoShareInTheSolidFraction) {
  const std::string porosity = "grains.1.fill.porosity=0.3";
  const Case c = testing::read_text(bed_with(sill()), {porosity});
  EXPECT_NEAR(settled_fraction(c), 0.7, 1e-12);
  EXPECT_NEAR(settled_height(c), settled_height(testing::read_text(bed_with(sill()))), 1e-4);  // a fill of 12 mm each
}

// A pier through the whole depth: only what is in the bed takes room, half a sphere at the floor and above it nearly a
// cylinder, pi (r^2 - s^2/12) of spheres s apart.
TEST(Obstacles, APierIsNoBedAboveTheBed) {
  std::string positions;
  for (int n = 0; n < 10; ++n) positions += fmt::format("{}[0.03, 0.02, {}]", n > 0 ? ", " : "", 0.006 + 0.0033 * n);
  const Case c = testing::read_text(bed_with(fixed_at(positions, 0.012)));
  constexpr double pi = std::numbers::pi, area = 72.0 * 48.0, section = pi * (36.0 - 3.3 * 3.3 / 12.0);  // mm^2
  const double height = (11.9996 * area + 2.0 / 3.0 * pi * 216.0 - 6.0 * section) / (area - section);    // mm
  EXPECT_NEAR(settled_height(c), 0.001 * height, 5e-6);
}

TEST(Obstacles, AreNotTheGrainsOfAFixedLayer) {
  const std::string layer =
      fixed_at("[0.01, 0.01, 0.003], [0.0159, 0.01, 0.003], [0.02, 0.02, 0.003]", 0.006);  // 0.1 mm
  const Case glued = testing::read_text(bed_with(layer));
  EXPECT_TRUE(obstacles_of(glued).spheres.empty());
  EXPECT_EQ(solid_volume(glued), grain_volume(glued));
  EXPECT_NEAR(settled_height(glued), 223 * std::numbers::pi / 6.0 * 216e-9 / (0.6 * 0.072 * 0.048), 1e-12);
  const std::string trefoil =
      "  - {density: 2650, fixed: true, orientation: {angle: 0}, placement: {positions: [[0.01, 0.01, 0.004]]},\n"
      "     shape: {clump: [{position: [0, 0, 0], diameter: 5.0e-3}, {position: [3.0e-3, 0, 0], diameter: 5.0e-3}]}}\n";
  EXPECT_TRUE(obstacles_of(testing::read_text(bed_with(trefoil))).spheres.empty());
}

TEST(Obstacles, AreGrainsTwiceAsLongAsTheFreeOnes) {
  EXPECT_TRUE(obstacles_of(testing::read_text(bed_with(fixed_at("[0.03, 0.02, 0.006]", 0.0119)))).spheres.empty());
  EXPECT_EQ(obstacles_of(testing::read_text(bed_with(fixed_at("[0.03, 0.02, 0.006]", 0.0121)))).spheres.size(), 1U);
  const std::string post =
      "  - {density: 2650, fixed: true, orientation: {angle: 0}, placement: {positions: [[0.03, 0.02, 0.012]]},\n"
      "     shape: {clump: [{position: [0, 0, 0], diameter: 6.0e-3}, {position: [0, 0, 4.0e-3], diameter: 6.0e-3}, "
      "{position: [0, 0, 8.0e-3], diameter: 6.0e-3}]}}\n";
  const Obstacles found = obstacles_of(testing::read_text(bed_with(post)));
  ASSERT_EQ(found.spheres.size(), 3U);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(found.spheres[n].id, static_cast<GlobalId>(n));
    EXPECT_NEAR(found.spheres[n].centre[2], 0.008 + 0.004 * static_cast<double>(n), 1e-9);
  }
}

// A solid sphere, half of it above the floor, leaves less room for the bed; one that moves does not stand there.
TEST(Obstacles, SolidsTakeTheirRoomInTheBed) {
  const std::string sphere = "solids: [{sphere: {centre: [0.03, 0.02, 0.0], radius: 0.01}";
  const Case standing = testing::read_text(bed_with("") + sphere + "}]\n"),
             moving = testing::read_text(bed_with("") + sphere + ", motion: {velocity: [0.01, 0, 0]}}]\n");
  constexpr double half = 2.0 / 3.0 * std::numbers::pi * 1000.0, area = 72.0 * 48.0;  // mm^3, mm^2
  EXPECT_NEAR(settled_height(standing), 0.001 * (11.9996 + half / area), 1e-5);       // of 48 fields round the axis
  EXPECT_EQ(settled_height(moving), settled_height(testing::read_text(bed_with(""))));
  EXPECT_NEAR(solids_below(standing)(1).back(), half * 1e-9, 0.01 * half * 1e-9);
  EXPECT_FALSE(solids_below(moving));
  const Case water = testing::read_text(defaults_yaml("fluid"));  // with a sphere
  EXPECT_TRUE(solids_below(water));
  EXPECT_EQ(settled_height(water), 0.0);
}

// A sphere of 5 mm that goes along x at 0.05 m/s through a box 72 mm long, from x = 0.03 m: at 0.4 s its middle is at
// 50 mm, at 0.8 s at 70 mm, with 3 mm beyond the face, and at 1.6 s it has gone 110 mm, to 38 mm of the next box.
TEST(SolidSurfaces, AreInThePeriodicBox) {
  const Case c = testing::read_text(
      bed_with("") +
      "solids: [{sphere: {centre: [0.03, 0.02, 0.02], radius: 0.005}, motion: {velocity: [0.05, 0, 0]}}]\n");
  ASSERT_EQ(c.domain.size[0], 0.072);
  const auto ends = [&](double time) {
    double lower = 1.0, upper = -1.0;
    const std::vector<TriangleMesh> surfaces = solid_surfaces(c, time);
    for (const Vec3& point : surfaces.front().points) {
      lower = std::min(lower, point[0]);
      upper = std::max(upper, point[0]);
    }
    return std::array{lower, upper};
  };
  constexpr double slack = 2e-5;  // of the triangles, in m
  EXPECT_NEAR(ends(0.4)[0], 0.045, slack);
  EXPECT_NEAR(ends(0.4)[1], 0.055, slack);
  const std::size_t triangles = solid_surfaces(c, 0.4).front().triangles.size();
  EXPECT_EQ(solid_surfaces(c, 0.8).front().triangles.size(), 2 * triangles);  // and its image
  EXPECT_NEAR(ends(0.8)[0], -0.007, slack);
  EXPECT_NEAR(ends(0.8)[1], 0.075, slack);
  EXPECT_NEAR(ends(1.6)[0], 0.033, slack);
  EXPECT_NEAR(ends(1.6)[1], 0.043, slack);
}

// A block 20 mm long and 10 mm wide; the columns that its edges cross count or not, a hundredth at most.
TEST(Obstacles, AreThoseOfTheCaseThatIsAsked) {
  const auto block = [](double height, const char* box_height) {
    Case c = testing::read_text(bed_with(""), {"domain.size.2=" + std::string(box_height)});
    c.solids.emplace_back();
    c.solids.back().surface = thalweg::test::box_mesh(Vec3(0.02, 0.02, 0.0), Vec3(0.04, 0.03, height));
    return c;
  };
  const auto expect_below = [](const Case& c, int layers, const std::vector<double>& expected) {
    const std::vector<double> found = solids_below(c)(layers);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 0.01 * expected.back()) << k;
  };
  const Case low = block(0.007, "0.042"), high = block(0.014, "0.042"), in_high_box = block(0.014, "0.056");
  for (int again = 0; again < 2; ++again) {
    expect_below(low, 6, {0.0, 1.4e-6, 1.4e-6, 1.4e-6, 1.4e-6, 1.4e-6, 1.4e-6});
    expect_below(high, 6, {0.0, 1.4e-6, 2.8e-6, 2.8e-6, 2.8e-6, 2.8e-6, 2.8e-6});
    expect_below(in_high_box, 6, {0.0, 0.2e-6 * 28.0 / 3.0, 2.8e-6, 2.8e-6, 2.8e-6, 2.8e-6, 2.8e-6});
    expect_below(in_high_box, 4, {0.0, 2.8e-6, 2.8e-6, 2.8e-6, 2.8e-6});
  }
}

// Through a periodic face, and not through a wall; free grains are never obstacles.
TEST(Obstacles, OverlapThroughPeriodicFaces) {
  const std::string ends = fixed_at("[0.0005, 0.02, 0.003], [0.0715, 0.02, 0.003]", 0.006);
  EXPECT_EQ(obstacles_of(testing::read_text(bed_with(ends))).spheres.size(), 2U);
}

}  // namespace
}  // namespace thalweg::driver::obstacles_test
