// Grains of a case at their places.
#include "driver/case/grain_setup.hpp"

#include "driver/input/case_reader.hpp"
#include "tests/driver/case_texts.hpp"

#include <gtest/gtest.h>

namespace thalweg::driver::grain_setup_test {
namespace {

// A plane slopes through the box, a plate stands in the part that it leaves, and a sphere lies beside the plate.
TEST(GrainSetup, RandomGrainsKeepClearOfWallsAndSolids) {
  const std::string text = R"(system: grains
name: chute
domain:
  size: [0.06, 0.04, 0.06]
  spacing: 2.5e-3
  boundaries: {x: no_slip, y: periodic, bottom: no_slip, top: no_slip}
gravity: {magnitude: 9.8, slope: 0.0}
grains: [{count: 80, diameter: 4.0e-3, density: 2550, placement: {pattern: random, seed: 3}}]
walls:
  - {point: [0.03, 0.02, 0.02], normal: [0.5, 0, 1]}
  - {point: [0.03, 0.02, 0.04], normal: [1, 0, 0], plate: {along: [0, 0, 1], length: 0.02, width: 0.02}}
solids: [{sphere: {centre: [0.045, 0.02, 0.04], radius: 6.0e-3}}]
contact: {restitution: 0.4}
run: {until: 1.0e-3}
)";
  const Case c = testing::read_text(text);
  const PeriodicBox box = grain_box(c);
  const dem::GrainSeeds seeds = grain_seeds(c);
  ASSERT_EQ(seeds.grains.size(), 80);
  const std::vector<dem::Plane> walls = grain_parameters(c, box).walls;
  ASSERT_EQ(walls.size(), 6);  // four faces and those of the case
  for (const dem::GrainSeed& grain : seeds.grains) {
    for (const dem::Plane& wall : walls) EXPECT_GE(wall.seen_from(grain.position, box).distance, 2e-3 - 1e-12);
    EXPECT_GE((grain.position - Vec3(0.045, 0.02, 0.04)).norm(), 8e-3 - 1e-12);
  }
}

}  // namespace
}  // namespace thalweg::driver::grain_setup_test
