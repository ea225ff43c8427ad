// Solids that move in water as they are told, against grains that do the same and against what is conserved.
#include "core/parallel/mpi_session.hpp"
#include "core/sums/wide_sums_over_ranks.hpp"
#include "coupling/system/fluid_mass.hpp"
#include "tests/coupling/water_box.hpp"
#include "tests/support/meshes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

namespace thalweg::coupling::moving_solids_test {
namespace {

std::unique_ptr<LatticeSystem<double>> make(const WaterBox& box) {
  return make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
}

dem::PrescribedMotion motion_of(const Vec3& velocity, const Vec3& centre = Vec3::Zero(),
                                const Vec3& spin = Vec3::Zero()) {
  dem::PrescribedMotion motion;
  motion.velocity = velocity;
  motion.centre = centre;
  if (spin.isZero(0.0)) return motion;
  motion.axis = spin.normalized();
  motion.angular_velocity = spin.norm();
  return motion;
}

// A grain that keeps its velocity and spin, in the place of a solid.
dem::GrainSeed held_sphere(const Vec3& centre, double radius, const Vec3& velocity, const Vec3& spin) {
  dem::GrainSeed seed = glass_sphere(0, centre, velocity, radius);
  seed.angular_velocity = spin;
  seed.motion = dem::Motion::fixed;
  return seed;
}

struct Load {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // N and N m
};

// The mean over the second half of some steps of what the water exerts on the one body.
Load mean_load(const WaterBox& box, int steps) {
  const auto system = make(box);
  const Units units{box.spacing, box.time_step, 1000.0};
  Load mean;
  for (int step = 0; step < steps; ++step) {
    system->advance();
    if (2 * step < steps) continue;
    if (!box.solids.empty()) {
      const auto loads = system->solid_loads();
      mean.force += loads.forces[0] * units.force() / (0.5 * steps);
      mean.torque += loads.torques[0] * units.torque() / (0.5 * steps);
      continue;
    }
    // Its load is extrapolated; what the links gave in this step is the same quantity as that of a solid.
    const bodies::BodySlot slot = system->bodies().slot_of(0);
    const bodies::LinkBody here = slot == bodies::BodySlot::none ? bodies::LinkBody{} : system->bodies().body(slot);
    const std::vector<Vec3> sums = vectors_over_ranks(MPI_COMM_WORLD, std::array{here.force, here.torque});
    mean.force += sums[0] * units.force() / (0.5 * steps);
    mean.torque += sums[1] * units.torque() / (0.5 * steps);
  }
  return mean;
}

// The solid and the water in uniform motion: no force and no torque, although cells are covered and uncovered all the
// time. Links keep in single precision where they meet a mesh: 1e-7 of the pressures at play, which are those of
// 1/2 rho U^2. The Galilean-invariant exchange leaves a torque of the order of the staircase (balance_test.cpp).
class SolidInUniformMotion
    : public ::testing::TestWithParam<std::tuple<bool, bodies::MomentumExchange, bodies::LinkRule>> {};

TEST_P(SolidInUniformMotion, FeelsNoForce) {
  const auto [is_mesh, exchange, rule] = GetParam();
  WaterBox box;
  box.viscosity = 2e-5;
  box.smagorinsky_constant = 0.0;
  box.links.momentum_exchange = exchange;
  box.links.rule = rule;
  const Vec3 velocity(0.35, -0.21, 0.13), centre(0.0251, 0.0007, 0.0096);
  box.fluid_velocity = velocity;
  if (is_mesh)
    box.solids = {thalweg::test::sphere_mesh(centre, 2.5e-3, 3)};
  else
    box.solids = {bodies::SolidSphere{centre, 2.5e-3}};
  box.solid_motions = {motion_of(velocity)};
  const auto system = make(box);
  const Units units{box.spacing, box.time_step, 1000.0};
  const double scale = 0.5 * 1000.0 * velocity.squaredNorm() * std::numbers::pi * std::pow(2.5e-3, 2);  // 1/2 rho U^2 A
  for (int step = 0; step < 120; ++step) {
    system->advance();
    const auto loads = system->solid_loads();
    ASSERT_LT(loads.forces[0].norm() * units.force() / scale, 1e-6) << "step " << step;
    if (exchange == bodies::MomentumExchange::classical) {
      ASSERT_LT(loads.torques[0].norm() * units.torque() / (scale * 2.5e-3), 1e-6) << "step " << step;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllRules, SolidInUniformMotion,
                         ::testing::Combine(::testing::Bool(),
                                            ::testing::Values(bodies::MomentumExchange::galilean_invariant,
                                                              bodies::MomentumExchange::classical),
                                            ::testing::Values(bodies::LinkRule::bouzidi, bodies::LinkRule::cli)));

// Ten cells a diameter; 5120 triangles with their corners on the sphere, whose volume is 0.1 % less.
class DrivenSphere : public ::testing::TestWithParam<bool> {};

TEST_P(DrivenSphere, OfTrianglesFeelsWhatAGrainFeels) {
  const bool turns = GetParam();
  WaterBox box;
  box.cells = {36, 30, 30};
  box.spacing = 5e-4;
  box.time_step = 5e-5;
  box.viscosity = 1e-5;
  box.collision = lbm::CollisionModel::trt_at_bodies;
  const Vec3 centre(9.03e-3, 7.4e-3, 7.61e-3), velocity(turns ? 0.0 : 0.3, 0.0, turns ? 0.0 : -0.1),
      spin(0.0, turns ? 120.0 : 0.0, turns ? 30.0 : 0.0);
  WaterBox with_grain = box, with_sphere = box, with_mesh = box;
  with_grain.seeds = {held_sphere(centre, 2.5e-3, velocity, spin)};
  with_sphere.solids = {bodies::SolidSphere{centre, 2.5e-3}};
  with_mesh.solids = {thalweg::test::sphere_mesh(centre, 2.5e-3, 4)};
  with_sphere.solid_motions = with_mesh.solid_motions = {motion_of(velocity, turns ? centre : Vec3::Zero(), spin)};
  const Load grain = mean_load(with_grain, 400), sphere = mean_load(with_sphere, 400), mesh = mean_load(with_mesh, 400);
  const auto compare = [](const Vec3& one, const Vec3& other, double bound) {
    EXPECT_LT((one - other).norm() / other.norm(), bound) << one.transpose() << " and " << other.transpose();
  };
  // The solid's cells follow its exact place, those of the grain to within a thousandth of a cell.
  compare(turns ? sphere.torque : sphere.force, turns ? grain.torque : grain.force, 1e-3);
  // The drag of a free sphere grows as its speed to the power 1.4 or so: half a per cent in speed.
  compare(turns ? mesh.torque : mesh.force, turns ? grain.torque : grain.force, 5e-3);
}

INSTANTIATE_TEST_SUITE_P(MovesOrTurns, DrivenSphere, ::testing::Bool());

// How often a solid that turns has passed through a periodic box does not change its velocity anywhere: with a start
// many boxes away, its loads are those of the same solid in the box.
TEST(MovingSolids, TurnAsTheyDidHoweverFarTheyTravel) {
  const Vec3 centre(9.03e-3, 7.4e-3, 7.61e-3), velocity(0.2, 0.0, -0.1), spin(0.0, 120.0, 30.0);
  const auto load = [&](bool is_mesh, const Vec3& away) {
    WaterBox box;
    box.cells = {20, 20, 20};
    box.viscosity = 1e-5;
    box.collision = lbm::CollisionModel::trt_at_bodies;
    const Vec3 start = centre + away;
    if (is_mesh)
      box.solids = {thalweg::test::sphere_mesh(start, 2.5e-3, 3)};
    else
      box.solids = {bodies::SolidSphere{start, 2.5e-3}};
    box.solid_motions = {motion_of(velocity, start, spin)};
    return mean_load(box, 60);
  };
  const double box = 20 * 0.8e-3;  // m
  for (const bool is_mesh : {false, true}) {
    const Load here = load(is_mesh, Vec3::Zero());
    for (const Vec3& boxes : {Vec3(2.0, 0.0, -1.0), Vec3(-5.0, 3.0, 7.0)}) {
      const Load there = load(is_mesh, box * boxes);
      // Links keep in single precision where they meet it.
      EXPECT_LT((there.force - here.force).norm(), 1e-6 * here.force.norm()) << boxes.transpose();
      EXPECT_LT((there.torque - here.torque).norm(), 1e-6 * here.torque.norm()) << boxes.transpose();
    }
  }
}

// An axis oblique to the periodic ones may be given by any of its points: forces and motion are the same, and torques
// are about that point, T + r x F.
TEST(MovingSolids, TurnAboutAnObliqueAxisWhateverItsPoint) {
  const Vec3 centre(9.03e-3, 7.4e-3, 7.61e-3), velocity(0.2, 0.0, -0.1), axis = Vec3(0.6, 0.0, 0.8);
  const auto load = [&](double along) {
    WaterBox box;
    box.cells = {20, 20, 20};
    box.viscosity = 1e-5;
    box.collision = lbm::CollisionModel::trt_at_bodies;
    box.solids = {thalweg::test::sphere_mesh(centre, 2.5e-3, 3)};
    box.solid_motions = {motion_of(velocity, centre + along * axis, 120.0 * axis)};
    return mean_load(box, 60);
  };
  const Load near = load(0.0);
  for (const double along : {9e-3, -0.025}) {  // m, in a box of 16 mm
    const Load far = load(along);
    const Vec3 expected = near.torque - along * axis.cross(near.force);
    EXPECT_LT((far.force - near.force).norm(), 1e-6 * near.force.norm()) << along;
    EXPECT_LT((far.torque - expected).norm(), 1e-6 * expected.norm()) << along;
  }
}

// Two slabs of triangles: of the lower one, which slides in its own plane across the ends of the box, the profile is
// that of a plate (linear interpolation is exact for it), and the drag that of the shear stress.
TEST(MovingSolids, CouetteFlowOverASlidingSlabIsExact) {
  for (const bodies::LinkRule rule : {bodies::LinkRule::bouzidi, bodies::LinkRule::cli}) {
    WaterBox box;
    box.cells = {12, 12, 14};
    box.periodic = {true, true, false};
    box.spacing = 1e-3;
    box.time_step = 1e-2;
    box.viscosity = 2e-5;  // tau 1.1
    box.smagorinsky_constant = 0.0;
    box.closed = true;
    box.links.rule = rule;
    const double top = 3.35e-3, speed = 2e-3;
    box.solids = {thalweg::test::box_mesh(Vec3(-1e-3, -1e-3, -1e-3), Vec3(13e-3, 13e-3, top))};
    box.solid_motions = {motion_of(Vec3(speed, 0.5 * speed, 0.0))};
    const auto system = make(box);
    for (int step = 0; step < 3000; ++step) system->advance();
    const double depth = 14e-3 - top, shear = 1000.0 * box.viscosity * speed / depth * 144e-6;
    const Vec3 force = system->solid_loads().forces[0] * Units{box.spacing, box.time_step, 1000.0}.force();
    EXPECT_NEAR(force.x(), -shear, 1e-5 * shear);
    EXPECT_NEAR(force.y(), -0.5 * shear, 1e-5 * shear);
    const auto& fluid = system->fluid();
    const Index3 n = fluid.indexing().size();
    for (int z = 0; z < n[2]; ++z) {
      const double height = (fluid.block().lower[2] + z + 0.5) * 1e-3;
      if (height < top) continue;
      const Vec3 u = fluid.state_at(fluid.indexing().index(0, 0, z)).velocity * (box.spacing / box.time_step);
      EXPECT_NEAR(u.x(), speed * (14e-3 - height) / depth, 1e-6 * speed) << height;
    }
  }
}

// Under its full weight the water lifts a solid by what it displaces, at rest and while it creeps along: to 1 %, which
// is what the pressure, linear between cells, leaves at a surface of six cells, and the drag is a thousandth of that.
TEST(MovingSolids, AreLiftedByTheWaterTheyDisplace) {
  for (const double speed : {0.0, 1e-4}) {
    WaterBox box;
    box.cells = {24, 20, 26};
    box.periodic = {true, true, false};
    box.closed = true;
    box.full_gravity = true;
    box.gravity = Vec3(0.0, 0.0, -9.8);
    box.viscosity = 1e-5;
    const Vec3 centre(9.3e-3, 8.2e-3, 10.1e-3);
    box.solids = {thalweg::test::sphere_mesh(centre, 2.5e-3, 4),
                  bodies::SolidSphere{centre + Vec3(7e-3, 0, 3e-3), 2.5e-3}};
    box.solid_motions = {motion_of(Vec3(speed, 0.0, 0.0)), motion_of(Vec3(speed, 0.0, 0.0))};
    const auto system = make(box);
    for (int step = 0; step < 600; ++step) system->advance();
    const Units units{box.spacing, box.time_step, 1000.0};
    const double displaced = 4.0 / 3.0 * std::numbers::pi * std::pow(2.5e-3, 3) * 1000.0 * 9.8;
    for (const Vec3& force : system->solid_loads().forces)
      EXPECT_NEAR(force.z() * units.force(), displaced, 0.01 * displaced) << speed;
  }
}

// The mass that links and cells that change hands take is owed, and comes back: excess mass and owed mass together
// stay what they were, to round-off.
TEST(MovingSolids, OweTheWaterWhatTheyTake) {
  WaterBox box;
  box.cells = {30, 24, 26};
  box.periodic = {false, false, false};
  box.closed = true;
  box.viscosity = 1e-5;
  const Vec3 middle = 0.5 * box.spacing * Vec3(30, 24, 26);
  box.solids = {thalweg::test::box_mesh(middle - Vec3(7e-3, 5e-3, 1.7e-3), middle + Vec3(7e-3, 5e-3, 1.7e-3)),
                bodies::SolidSphere{Vec3(20e-3, 10e-3, 3e-3), 2.2e-3}};
  dem::PrescribedMotion swings;
  swings.oscillation = {Vec3(1e-3, 2e-3, 0.0), 30.0, 0.0};
  box.solid_motions = {motion_of(Vec3::Zero(), middle, Vec3(0.0, 25.0, 0.0)), swings};
  const auto system = make(box);
  const auto excess = [&] { return excess_mass(lbm::survey_of(system->fluid()), bodies::Hydrostatic{}).sum; };
  const double before = excess();
  std::int64_t turned_over = 0;
  for (int step = 0; step < 190; ++step) {  // no correction yet
    system->advance();
    // The survey rounds every cell to within 2^-37.
    ASSERT_NEAR(excess() + system->mass_owed(), before, 0x1p-36 * 30 * 24 * 26) << step;
    turned_over += std::abs(system->bodies().step_totals().link_mass);
  }
  EXPECT_GT(LatticeFixed::to_double(turned_over), 0.1);  // there was something to owe
}

}  // namespace
}  // namespace thalweg::coupling::moving_solids_test
