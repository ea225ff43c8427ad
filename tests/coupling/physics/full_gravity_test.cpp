// Gravity on everything: the fluid at rest, buoyancy through the links, and the same motion as in reduced gravity.
#include "tests/coupling/water_box.hpp"
#include "tests/support/meshes.hpp"

#include "core/parallel/mpi_session.hpp"
#include "lbm/fluid/fluid_survey.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace thalweg::coupling::full_gravity_test {
namespace {

constexpr double radius = 2.5e-3, gravity = 9.8;
const double displaced_weight = 1000.0 * gravity * 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);

WaterBox deep_box(const Index3& cells) {
  WaterBox box;
  box.cells = cells;
  box.periodic = {true, true, false};
  box.spacing = 0.5e-3;  // ten cells a diameter
  box.time_step = 5e-5;
  box.viscosity = 1.0 / 6.0 * 0.5e-3 * 0.5e-3 / 5e-5;  // tau = 1
  box.smagorinsky_constant = 0.0;
  box.gravity = Vec3(0.0, 0.0, -gravity);
  box.full_gravity = true;
  return box;
}

std::unique_ptr<LatticeSystem<double>> make(const WaterBox& box) {
  return make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
}

TEST(FullGravity, LeavesAFluidAtRestAtRest) {
  WaterBox box = deep_box({8, 8, 24});
  const auto system = make(box);
  for (int step = 0; step < 400; ++step) system->advance();
  // The linear density is the exact rest state: what is left is the round-off of populations of up to 6e-4, 1e-19, in
  // each of 400 steps.
  EXPECT_LT(survey_of(system->fluid()).fastest.value, 1e-16);
}

// Grains that reach into the floor, where they hide a sixth of it, and one into the top: the fluid at rest presses on
// floor, top and grains together with its weight.
TEST(FullGravity, WallsUnderGrainsFeelThePressureOnThePatchesThatGrainsHide) {
  WaterBox box = deep_box({24, 24, 22});
  box.links.rule = bodies::LinkRule::cli;
  box.wall_forces = true;
  for (const Vec3& cells : {Vec3(6.1, 5.8, 4.7), Vec3(17.6, 6.3, 4.4), Vec3(6.4, 17.9, 4.9), Vec3(17.8, 18.2, 17.5)}) {
    box.seeds.push_back(glass_sphere(static_cast<GlobalId>(box.seeds.size()), box.spacing * cells));
    box.seeds.back().motion = dem::Motion::fixed;
  }
  const auto system = make(box);
  for (int step = 0; step < 100; ++step) system->advance();
  double force = 0.0;
  const dem::GrainStore& store = system->grains().store();
  for (std::size_t g = 0; g < store.owned; ++g) force += store.load_force[g].z();
  force = sum_over_ranks(MPI_COMM_WORLD, force);
  for (const Diagnostic& diagnostic : system->diagnostics())
    if (diagnostic.name.starts_with("fluid_wall_force") && diagnostic.name.ends_with("_z")) force += diagnostic.value;
  const double weight =
      1000.0 * gravity * std::pow(box.spacing, 3) * static_cast<double>(survey_of(system->fluid()).totals.cells);
  EXPECT_NEAR(force / -weight, 1.0, 1e-9);
}

struct Buoyancy {
  double smallest = 1e9, largest = -1e9, mean = 0.0;  // of the force along z over the weight of the displaced fluid
  double torque = 0.0, sideways = 0.0;                // largest, over weight (times radius)
};

// Fixed grains, means of their loads over the second half of the run.
Buoyancy buoyancy_of(WaterBox& box, int steps) {
  for (dem::GrainSeed& seed : box.seeds) seed.motion = dem::Motion::fixed;
  const auto system = make(box);
  const std::size_t count = box.seeds.size();
  std::vector<double> force(3 * count, 0.0), torque(3 * count, 0.0);
  for (int step = 0; step < steps; ++step) {
    system->advance();
    const dem::GrainStore& store = system->grains().store();
    for (std::size_t g = 0; step >= steps / 2 && g < store.owned; ++g)
      for (int a = 0; a < 3; ++a) {
        force[3 * static_cast<std::size_t>(store.id[g]) + a] += store.load_force[g][a] / (steps - steps / 2);
        torque[3 * static_cast<std::size_t>(store.id[g]) + a] += store.load_torque[g][a] / (steps - steps / 2);
      }
  }
  Buoyancy b;
  for (std::size_t g = 0; g < count; ++g) {
    Vec3 f, t;
    for (int a = 0; a < 3; ++a) {
      f[a] = sum_over_ranks(MPI_COMM_WORLD, force[3 * g + a]) / displaced_weight;
      t[a] = sum_over_ranks(MPI_COMM_WORLD, torque[3 * g + a]) / (displaced_weight * radius);
    }
    b.smallest = std::min(b.smallest, f.z());
    b.largest = std::max(b.largest, f.z());
    b.mean += f.z() / static_cast<double>(count);
    b.sideways = std::max(b.sideways, std::hypot(f.x(), f.y()));
    b.torque = std::max(b.torque, t.norm());
  }
  return b;
}

// Nine spheres of ten cells, each elsewhere between cells.
WaterBox scattered_grains() {
  WaterBox box = deep_box({54, 54, 22});
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> cell(-0.5, 0.5);
  for (int k = 0; k < 9; ++k)
    box.seeds.push_back(glass_sphere(k, 0.5e-3 * Vec3(18.0 * (k % 3) + 9.0 + cell(generator),
                                                      18.0 * (k / 3) + 9.0 + cell(generator), 11.0 + cell(generator))));
  return box;
}

// Volume of the cells whose centres are inside, over that of the sphere.
double covered_share(const dem::GrainSeed& seed, double spacing) {
  const Vec3 centre = seed.position / spacing;
  const double r = seed.radius / spacing;
  int inside = 0;
  for (int z = -7; z <= 7; ++z)
    for (int y = -7; y <= 7; ++y)
      for (int x = -7; x <= 7; ++x) {
        const Vec3 cell(std::floor(centre.x()) + x + 0.5, std::floor(centre.y()) + y + 0.5,
                        std::floor(centre.z()) + z + 0.5);
        inside += (cell - centre).norm() < r;
      }
  return inside / (4.0 / 3.0 * std::numbers::pi * r * r * r);
}

// The rule CLI leaves the resting fluid exactly at rest, so that the force is that of the linear pressure on the cells
// the sphere covers: their weight in fluid, to round-off. Torque: these cells' centre is off the sphere's by a few
// hundredths of a radius at most.
TEST(FullGravity, LiftsAGrainWithCliLinksByTheWeightOfTheCellsItCovers) {
  WaterBox box = scattered_grains();
  box.links.rule = bodies::LinkRule::cli;
  double mean = 0.0, smallest = 2.0, largest = 0.0;
  for (const dem::GrainSeed& seed : box.seeds) {
    const double share = covered_share(seed, box.spacing);
    mean += share / 9.0;
    smallest = std::min(smallest, share);
    largest = std::max(largest, share);
  }
  const Buoyancy b = buoyancy_of(box, 200);
  EXPECT_NEAR(b.mean, mean, 1e-9);
  EXPECT_NEAR(b.smallest, smallest, 1e-9);
  EXPECT_NEAR(b.largest, largest, 1e-9);
  EXPECT_LT(b.sideways, 1e-9);
  EXPECT_LT(b.torque, 0.03);
}

// Bouzidi's rule does not know of the pressure gradient along a link: it drives a weak flow, and the lift comes out too
// large, the more the higher the viscosity. At tau = 1 a prototype had 1.014 +- 0.008 at ten cells; bound three of its
// standard deviations for each sphere.
TEST(FullGravity, LiftsAGrainAnywhereBetweenCellsByTheFluidItDisplaces) {
  WaterBox box = scattered_grains();
  const Buoyancy b = buoyancy_of(box, 400);
  EXPECT_NEAR(b.smallest, 1.014, 3.0 * 0.008);
  EXPECT_NEAR(b.largest, 1.014, 3.0 * 0.008);
  EXPECT_LT(b.sideways, 0.005);
  EXPECT_LT(b.torque, 0.03);
}

// Three on the floor and one on top, all touching: what they hide from each other and the floor hides would be missing
// otherwise. A patch of 1 cell on the floor, 20 cells under the middle of the water, would take away (3 F 20)/(3 F) =
// 20 cells of volume, 4 % of a sphere, and those between the spheres push sideways as much: a quarter of this is
// allowed. Torque: the centre of the covered cells is off the sphere's by a few hundredths of a radius at most.
TEST(FullGravity, LiftsGrainsThatTouchEachOtherAndTheFloor) {
  WaterBox box = deep_box({36, 36, 60});
  box.links.rule = bodies::LinkRule::cli;
  const Vec3 first(5.0e-3, 5.1e-3, 2.5e-3);
  box.seeds = {glass_sphere(0, first), glass_sphere(1, first + Vec3(5.0e-3, 0.0, 0.0)),
               glass_sphere(2, first + Vec3(2.5e-3, 5e-3 * std::sqrt(0.75), 0.0)),
               glass_sphere(3, first + 5e-3 * Vec3(0.5, std::sqrt(0.75) / 3.0, std::sqrt(2.0 / 3.0)))};
  const Buoyancy b = buoyancy_of(box, 400);
  EXPECT_NEAR(b.smallest, 1.0, 0.02);  // the covered cells' share differs by up to 2 % from the spheres'
  EXPECT_NEAR(b.largest, 1.0, 0.02);
  EXPECT_LT(b.sideways, 0.01);
  EXPECT_LT(b.torque, 0.02);
}

// One on a block, one that leans on its side and one on a ball: what solids hide from grains presses as well.
TEST(FullGravity, LiftsGrainsThatTouchSolids) {
  WaterBox box = deep_box({46, 36, 60});
  box.links.rule = bodies::LinkRule::cli;
  const double top = 12.15e-3, side = 10.1e-3;
  const Vec3 ball(18.0e-3, 9.0e-3, 8.0e-3);
  box.solids = {thalweg::test::box_mesh(Vec3(2.1e-3, 2.2e-3, 4.0e-3), Vec3(side, 15.0e-3, top)),
                bodies::SolidSphere{ball, 3.1e-3}};
  box.seeds = {glass_sphere(0, Vec3(6.1e-3, 8.3e-3, top + radius)),
               glass_sphere(1, Vec3(side + radius, 5.2e-3, 8.0e-3)),
               glass_sphere(2, ball + Vec3(0.0, 0.6, 0.8) * (3.1e-3 + radius))};
  const Buoyancy b = buoyancy_of(box, 400);
  EXPECT_NEAR(b.smallest, 1.0, 0.02);  // as above
  EXPECT_NEAR(b.largest, 1.0, 0.02);
  EXPECT_LT(b.sideways, 0.01);
  EXPECT_LT(b.torque, 0.02);
}

TEST(FullGravity, MovesAGrainAsReducedGravityDoes) {
  double fall[2];
  for (const bool full : {false, true}) {
    WaterBox box = deep_box({24, 24, 60});
    box.spacing = 0.625e-3;
    box.time_step = 1e-4;
    box.viscosity = 5e-5;
    box.sub_steps = 20;
    box.full_gravity = full;
    box.seeds = {glass_sphere(0, Vec3(0.0073, 0.0076, 0.033))};
    const auto system = make(box);
    for (int step = 0; step < 1000; ++step) system->advance();
    const dem::GrainStore& store = system->grains().store();
    fall[full] = sum_over_ranks(MPI_COMM_WORLD, store.owned == 1 ? store.position[0].z() - 0.033 : 0.0);
  }
  EXPECT_LT(fall[0], -0.009);
  // The lift is up to 2.4 % too large (above), which is 1.5 % of the submerged weight, and less in the velocity.
  EXPECT_NEAR(fall[1], fall[0], 0.015 * std::abs(fall[0]));
}

}  // namespace
}  // namespace thalweg::coupling::full_gravity_test
