// Clumps under the force of a model fluid.
#include "dem/motion/grain_volume.hpp"
#include "model_fluid/model_fluid_field.hpp"
#include "model_fluid/sphere_overlap.hpp"
#include "tests/dem/clump_cases.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

namespace thalweg::model_fluid::model_fluid_clump_test {
namespace {

using namespace dem;

using test::glass_clump;
using test::glass_density;
using test::glass_radius;
using test::glass_sphere;

constexpr double gravity = 9.81, thickness = 4e-3;

ModelFluidParameters fluid(double largest_radius, bool disks, double lift_ratio) {
  const double diameter = 2.0 * glass_radius;
  ModelFluidParameters parameters;
  parameters.numbers = {0.3, 10.0, lift_ratio, ModelDrag::quadratic, 0.5};
  parameters.scales = {diameter, glass_density * grain_volume(glass_radius, disks ? thickness : 0.0), gravity};
  parameters.profile = disks ? VelocityProfile::of_disks() : VelocityProfile::of_spheres();
  parameters.solid_fraction.largest_radius = largest_radius;
  parameters.solid_fraction.margin = diameter;
  parameters.solid_fraction.tolerance = 0.01 * diameter;
  parameters.solid_fraction.disks = disks;
  parameters.solid_fraction.lift = lift_ratio > 0.0;
  return parameters;
}

void allow_clumps(ModelFluidParameters& parameters, const ClumpShape& shape) {
  parameters.solid_fraction.clumps = true;
  parameters.solid_fraction.largest_member = shape.members.front().radius;
  parameters.solid_fraction.largest_offset = shape.bounding_radius;
}

GrainParameters grains_in(const ModelFluidParameters& fluid, const Decomposition& box) {
  GrainParameters p = test::parameters(test::glass(0.5), 2e-6, 50, glass_radius);
  p.contact.friction = p.contact.wall_friction = 0.0;
  p.walls = face_planes(box.box(), p.contact);
  p.walls[0].rough = true;
  p.body_force = [](double mass, double /*radius*/) { return Vec3(0.0, 0.0, -mass * gravity); };
  p.field = std::make_shared<ModelFluidField>(box.box(), fluid);
  p.attached_width = p.field->attached_columns();
  if (fluid.solid_fraction.disks) p.disk_thickness = thickness;
  return p;
}

// A layer of twelve spheres that come to rest on the floor, and six that fall on them.
std::vector<Vec3> centres() {
  std::vector<Vec3> all;
  for (int n = 0; n < 12; ++n)
    all.emplace_back(0.004 + 0.0055 * (n % 4), 0.004 + 0.0055 * (n / 4), 0.0026 + 0.0001 * n);
  for (int n = 0; n < 6; ++n) all.emplace_back(0.006 + 0.0055 * (n % 3), 0.006 + 0.0055 * (n / 3), 0.008 + 0.0002 * n);
  return all;
}

TEST(ModelFluidClump, OfOneSphereIsASphere) {
  const Decomposition box = test::cube();
  const auto shape = test::shape_of({{{0, 0, 0}, glass_radius}});
  std::vector<GrainSeed> spheres;
  std::vector<ClumpSeed> clumps;
  for (const Vec3& x : centres()) {
    spheres.push_back(glass_sphere(static_cast<GlobalId>(spheres.size()), x));
    clumps.push_back(glass_clump(static_cast<GlobalId>(clumps.size()), shape, x));
  }
  ModelFluidParameters parameters = fluid(glass_radius, false, 0.1);
  GrainDynamics as_spheres(box, MPI_COMM_SELF, grains_in(parameters, box), spheres);
  allow_clumps(parameters, *shape);
  GrainDynamics as_clumps(box, MPI_COMM_SELF, grains_in(parameters, box), {}, clumps);
  std::int64_t touched = 0;
  for (int n = 0; n < 600; ++n) {  // 0.06 s: they have fallen on the others
    test::step(as_spheres);
    test::step(as_clumps);
    touched = std::max(touched, as_spheres.contact_count());
  }
  EXPECT_GE(touched, 2);
  EXPECT_GT(as_spheres.largest_free_speed(), 0.05);
  // Rounding alone, which every collision enlarges: a spring turns a displacement into a velocity.
  for (std::size_t s = 0; s < as_spheres.store().owned; ++s) {
    EXPECT_LT((as_clumps.store().position[s] - as_spheres.store().position[s]).norm(), 1e-7 * glass_radius) << s;
    EXPECT_LT((as_clumps.store().velocity[s] - as_spheres.store().velocity[s]).norm(), 1e-6) << s;
  }
}

// Five disks on a circle, a/d = 0.6.
std::shared_ptr<const ClumpShape> ring() {
  const double d = 2.4e-3, a = 0.6 * d;
  std::vector<PlacedSphere> disks;
  for (int k = 0; k < 5; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 5.0;
    disks.push_back({Vec3(a * std::cos(angle), 0.0, a * std::sin(angle)), 0.5 * d});
  }
  return test::shape_of(disks, thickness);
}

// Two rings beside each other. phi of the first by its definition: the members of both, cut by the disk about its
// centre, times area of the ring over area of five disks. The force of model_fluid.hpp acts at the centre, without a
// couple.
TEST(ModelFluidClump, IsADiskOfItsAreaForTheFluid) {
  const Decomposition plane({20, 2, 20}, 2.5e-3, {true, true, false}, {1, 1, 1});
  const auto shape = ring();
  const double radius = shape->equivalent_radius();
  EXPECT_NEAR(std::numbers::pi * radius * radius * thickness / shape->volume, 1.0, 1e-12);
  ModelFluidParameters parameters = fluid(radius, true, 0.0);
  allow_clumps(parameters, *shape);
  const ClumpSeed first = glass_clump(0, shape, Vec3(0.0201, 0.0025, 0.02));
  ClumpSeed second = glass_clump(5, shape, Vec3(0.0263, 0.0025, 0.023));
  second.orientation = {std::cos(0.2), 0.0, std::sin(0.2), 0.0};
  GrainDynamics grains(plane, MPI_COMM_SELF, grains_in(parameters, plane), {}, {first, second});
  const GrainStore& store = grains.store();

  const double about = radius + parameters.solid_fraction.margin;
  double solid = 0.0;
  for (std::size_t s = 0; s < 10; ++s)
    solid += common_area(about, store.radius[s], (store.position[s] - first.position).norm());
  const double member = std::numbers::pi * store.radius[0] * store.radius[0];
  const double phi = solid * shape->volume / thickness / (5.0 * member) / (std::numbers::pi * about * about);
  EXPECT_GT(phi, 1.2 * shape->volume / thickness / (std::numbers::pi * about * about));  // the other one counts

  const ModelFluidCoefficients c = coefficients_of(parameters.numbers, parameters.scales);
  const double speed = c.velocity * parameters.profile(phi), size = radius / glass_radius;
  const double expected = c.viscous * size * speed + c.inertial * size * size * speed * speed;
  Vec3 force = Vec3::Zero(), couple = Vec3::Zero();
  for (std::size_t s = 0; s < 5; ++s) {
    force += store.load_force[s];
    couple += store.load_torque[s] + (store.position[s] - first.position).cross(store.load_force[s]);
  }
  EXPECT_NEAR(force.x() / expected, 1.0, 1e-9);
  EXPECT_EQ(force.z(), 0.0);
  EXPECT_LT(couple.norm(), 1e-12 * expected * radius);
}

// The rule of the paper's floor: what touches it does not move along it. It may still roll over its asperities.
TEST(ModelFluidClump, ThatTouchesTheFloorDoesNotMoveAlongIt) {
  const Decomposition plane({20, 2, 20}, 2.5e-3, {true, true, false}, {1, 1, 1});
  const auto shape = ring();
  ModelFluidParameters parameters = fluid(shape->equivalent_radius(), true, 0.0);
  allow_clumps(parameters, *shape);
  const double half = 0.05 * std::numbers::pi;  // of the turn by 18 degrees that puts two disks at the same height
  const double lowest = 0.6 * 2.4e-3 * std::cos(std::numbers::pi / 5.0) + 1.2e-3;
  ClumpSeed resting = glass_clump(0, shape, Vec3(0.02, 0.0025, lowest + 1e-8));
  resting.orientation = {std::cos(half), 0.0, -std::sin(half), 0.0};
  const ClumpSeed flying = glass_clump(5, shape, Vec3(0.035, 0.0025, 0.03));
  GrainDynamics grains(plane, MPI_COMM_SELF, grains_in(parameters, plane), {}, {resting, flying});
  for (int n = 0; n < 100; ++n) test::step(grains);
  EXPECT_LT((grains.clumps()[0].centre - resting.position).norm(), 1e-6);
  EXPECT_LT(std::abs(grains.clumps()[0].velocity.x()), 1e-12);
  EXPECT_GT(grains.clumps()[1].velocity.x(), 0.01);
}

// A floor without friction that holds grains along it carries what the fluid drags them with, of a clump and of a
// sphere that lean on each other; and a grain's contacts balance its load.
TEST(ModelFluidClump, OnTheFloorHandsItsDragToIt) {
  const Decomposition plane({20, 2, 20}, 2.5e-3, {true, true, false}, {1, 1, 1});
  const auto shape = ring();
  ModelFluidParameters parameters = fluid(shape->equivalent_radius(), true, 0.0);
  allow_clumps(parameters, *shape);
  for (const double friction : {0.0, 0.5}) {
    const double half = 0.05 * std::numbers::pi, lowest = 0.6 * 2.4e-3 * std::cos(std::numbers::pi / 5.0) + 1.2e-3;
    ClumpSeed clump = glass_clump(1, shape, Vec3(0.02, 0.0025, lowest + 1e-8));
    clump.orientation = {std::cos(half), 0.0, -std::sin(half), 0.0};
    GrainSeed sphere = glass_sphere(0, Vec3(0.02 - 5.2e-3, 0.0025, glass_radius + 1e-8));
    sphere.thickness = thickness;
    GrainParameters p = grains_in(parameters, plane);
    p.contact.friction = p.contact.wall_friction = friction;
    p.walls[0].friction = friction;
    GrainDynamics grains(plane, MPI_COMM_SELF, p, {sphere}, {clump});
    for (int n = 0; n < 100; ++n) test::step(grains);
    double drag = 0.0;
    for (const Vec3& load : grains.store().load_force) drag += load.x();
    ASSERT_GT(drag, 0.0);
    EXPECT_NEAR(grains.wall_forces()[0].x(), drag, 1e-9 * drag) << friction;
    Vec3 on_sphere = Vec3::Zero();
    grains.for_each_contact([&](std::size_t slot, const Vec3&, const Vec3& force) {
      if (grains.store().id[slot] == 0) on_sphere += force;
    });
    const std::size_t slot = grains.store().id[0] == 0 ? 0 : grains.store().owned - 1;
    EXPECT_NEAR(on_sphere.x(), -grains.store().load_force[slot].x(), 1e-9 * drag) << friction;
  }
}

// A body held regardless of forces is so by the floor as well: a plate of grains that is drawn along it moves on.
TEST(ModelFluidClump, ThatIsHeldKeepsItsVelocityOnTheFloor) {
  const Decomposition plane({20, 2, 20}, 2.5e-3, {true, true, false}, {1, 1, 1});
  const auto shape = ring();
  ModelFluidParameters parameters = fluid(shape->equivalent_radius(), true, 0.0);
  allow_clumps(parameters, *shape);
  const Vec3 velocity(0.1, 0.0, 0.0);
  ClumpSeed drawn = glass_clump(1, shape, Vec3(0.035, 0.0025, 0.6 * 2.4e-3 + 1.2e-3 - 1e-6));
  drawn.orientation = {std::cos(0.25 * std::numbers::pi), 0.0, std::sin(0.25 * std::numbers::pi), 0.0};
  drawn.velocity = velocity;
  drawn.motion = Motion::fixed;
  GrainSeed alone = glass_sphere(0, Vec3(0.015, 0.0025, glass_radius - 1e-6), velocity);
  alone.thickness = thickness;
  alone.motion = Motion::fixed;
  GrainDynamics grains(plane, MPI_COMM_SELF, grains_in(parameters, plane), {alone}, {drawn});
  for (int n = 0; n < 10; ++n) test::step(grains);
  EXPECT_EQ(grains.store().velocity[0], velocity);
  EXPECT_EQ(grains.clumps()[0].velocity, velocity);
}

}  // namespace
}  // namespace thalweg::model_fluid::model_fluid_clump_test
