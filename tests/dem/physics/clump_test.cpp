// Clumps: free rotation, impact, contact with a floor, many in a cloud, and what a clump of one sphere must be.
#include "beds/packing/packing.hpp"
#include "beds/population/population_clumps.hpp"
#include "core/base/error.hpp"
#include "tests/dem/clump_cases.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace thalweg::dem::clump_test {
namespace {

using test::angular_momentum;
using test::dumbbell;
using test::glass;
using test::glass_clump;
using test::glass_density;
using test::pebble;
using test::step;

constexpr double epsilon = 2.2e-16;

// 50 mm wide, no face periodic, no walls: a free space.
Decomposition room() { return Decomposition({20, 20, 20}, 2.5e-3, {false, false, false}, {1, 1, 1}); }

GrainParameters free_flight(double time_step, int sub_steps = 10) {
  GrainParameters p = test::parameters(glass(0.9), time_step, sub_steps);
  return p;
}

// The principal axis k of a clump in space.
Vec3 axis(const Clump& clump, int k) { return rotation_matrix(clump.orientation).col(k); }

TEST(Clump, TumblesWithConstantAngularMomentumAndSwingingEnergy) {
  // About the middle axis nearly: the motion that turns over again and again. The energy of the symmetric splitting is
  // off by (w dt)^2/12 of itself at most, times ratios of the moments of the order of one; it swings and does not
  // drift.
  const Vec3 spin(20.0, 900.0, 20.0);
  double swing[2];
  for (const int finer : {0, 1}) {
    ClumpSeed seed = glass_clump(0, pebble(), Vec3::Constant(0.025));
    const Eigen::Matrix3d turn = rotation_matrix(seed.principal_orientation());
    seed.angular_velocity = turn * spin;
    const double dt = finer == 0 ? 4e-6 : 2e-6;
    GrainDynamics grains(room(), MPI_COMM_SELF, free_flight(dt), {}, {seed});
    const double energy = grains.kinetic_energy();
    const Vec3 momentum = angular_momentum(grains);
    double most = 0.0, turned_over = 1.0, drift = 0.0;
    const int steps = finer == 0 ? 5000 : 10000;  // of ten sub-steps: 0.2 s, about 30 turns
    for (int n = 0; n < steps; ++n) {
      step(grains);
      const double deviation = grains.kinetic_energy() / energy - 1.0;
      most = std::max(most, std::abs(deviation));
      if (n >= steps / 2)
        drift += deviation;
      else
        drift -= deviation;
      turned_over =
          std::min(turned_over, grains.clumps()[0].angular_velocity.normalized().dot(axis(grains.clumps()[0], 1)));
    }
    const double angle = spin.norm() * dt;
    EXPECT_LT(most, angle * angle / 4.0);
    EXPECT_GT(most, 1e-3 * angle * angle);  // it is the splitting's error that is seen
    EXPECT_LT(turned_over, -0.9);           // the axis has gone over to the other side
    // The second half differs from the first by less than the swing: nothing accumulates.
    EXPECT_LT(std::abs(drift) / (steps / 2), 0.2 * most);
    // Never changed but by the rounding of w = I^-1 L and back.
    EXPECT_LT((angular_momentum(grains) - momentum).norm(), 100 * epsilon * momentum.norm());
    swing[finer] = most;
  }
  EXPECT_NEAR(swing[0] / swing[1], 4.0, 0.2);  // second order
}

TEST(Clump, SymmetricTopPrecessesAsEulersEquationsSay) {
  // I1 = I2: the axis goes round L at L/I1, the spin round the axis at (I3/I1 - 1) w3 seen from the body. The order of
  // the splitting makes the rate wrong by (w dt)^2/12 of it; with w dt = 4e-3 that is 1.3e-6, times ratios of the
  // moments. The bound is ten times that, on angles of 16 and 9 turns.
  ClumpSeed seed = glass_clump(0, dumbbell(), Vec3::Constant(0.025));
  const Vec3 moments = glass_density * seed.shape->moments;
  // Eigenvalues rise: the axis of the dumbbell, with the least moment, is the first of the principal axes.
  EXPECT_LT(moments[0], 0.9 * moments[1]);
  EXPECT_NEAR(moments[2] / moments[1], 1.0, 1e-11);
  const Eigen::Matrix3d turn = rotation_matrix(seed.principal_orientation());
  const Vec3 in_body(900.0, 400.0, 0.0);
  seed.angular_velocity = turn * in_body;
  const double dt = 4e-6;
  GrainDynamics grains(room(), MPI_COMM_SELF, free_flight(dt, 25), {}, {seed});
  const Vec3 l = angular_momentum(grains), start = axis(grains.clumps()[0], 0);
  const int steps = 1000;
  const double time = steps * 25 * dt;
  for (int n = 0; n < steps; ++n) step(grains);

  const double precession = l.norm() / moments[1] * time;
  EXPECT_GT(precession, 10.0);
  const double bound = 10.0 * std::pow(in_body.norm() * dt, 2) / 12.0;
  const Vec3 expected = Eigen::AngleAxisd(precession, l.normalized()) * start;
  EXPECT_LT((axis(grains.clumps()[0], 0) - expected).norm(), bound * precession);

  const double round_axis = (moments[0] / moments[1] - 1.0) * in_body[0] * time;
  EXPECT_GT(std::abs(round_axis), 10.0);
  const Vec3 spin = rotation_matrix(grains.clumps()[0].orientation).transpose() * grains.clumps()[0].angular_velocity;
  // dw/dt = w3 (I3/I1 - 1) (axis x w)
  const Vec3 turned = Eigen::AngleAxisd(round_axis, Vec3::UnitX()) * in_body;
  EXPECT_LT((spin - turned).norm() / in_body.norm(), bound * (std::abs(round_axis) + precession));
}

TEST(Clump, OfOneSphereMovesLikeTheSphere) {
  // Bounces on a floor with friction and spin. Both are the same equations, in other words: they part by rounding,
  // which contacts amplify by far less than a thousand in two bounces.
  const Decomposition tray({20, 20, 20}, 2.5e-3, {true, true, false}, {1, 1, 1});
  GrainParameters p = free_flight(4e-6, 25);
  p.walls = face_planes(tray.box(), p.contact);
  p.body_force = [](double mass, double radius) { return Vec3(0.0, 0.0, -9.8 * mass + 1e-3 * radius); };
  const Vec3 place(0.01, 0.02, 0.004), velocity(0.2, -0.1, -0.3), spin(30.0, 20.0, -50.0);
  GrainSeed sphere = test::glass_sphere(0, place, velocity);
  sphere.angular_velocity = spin;
  GrainDynamics one(tray, MPI_COMM_SELF, p, {sphere});
  const auto ball = test::shape_of({{Vec3(1.0, 2.0, 3.0), test::glass_radius}});
  GrainDynamics other(tray, MPI_COMM_SELF, p, {}, {glass_clump(0, ball, place, velocity, spin)});
  double lowest = 1.0;
  for (int n = 0; n < 1500; ++n) {
    step(one);
    step(other);
    lowest = std::min(lowest, one.store().position[0].z());
  }
  EXPECT_LT(lowest, test::glass_radius);  // it was in contact
  EXPECT_LT((one.store().position[0] - other.store().position[0]).norm(), 1e-12 * 0.05);
  EXPECT_LT((one.store().velocity[0] - other.store().velocity[0]).norm(), 1e-10 * velocity.norm());
  EXPECT_LT((one.store().angular_velocity[0] - other.store().angular_velocity[0]).norm(), 1e-10 * spin.norm());
  EXPECT_NEAR(one.kinetic_energy() / other.kinetic_energy(), 1.0, 1e-10);
}

TEST(Clump, DumbbellThatHitsAPlaneOffItsCentre) {
  // Without friction, without loss, the impulse P n at the lower sphere's foot, at r from the centre: with
  // m = 1/(1/M + (r x n)^2/I), P = -2 m v_n, V = V_0 + P/M n, w = I^-1 (r x P n). The dumbbell turns while in contact,
  // by about w t_c = 0.006, and the impulse is off by that; the contact costs dt^2 of energy.
  const double angle = 0.7, speed = 0.05;
  const Decomposition tray({20, 20, 20}, 2.5e-3, {true, true, false}, {1, 1, 1});
  GrainParameters p = free_flight(2e-6);
  p.contact = glass(1.0);
  p.contact.normal_stiffness = 2e6;
  p.contact.tangential_stiffness = 0.0;
  p.contact.friction = p.contact.wall_friction = 0.0;
  p.time_step = 2e-7;
  p.walls = face_planes(tray.box(), p.contact);
  ClumpSeed seed = glass_clump(0, dumbbell(), Vec3(0.02, 0.02, 0.0));
  seed.orientation = {std::cos(0.5 * angle), 0.0, std::sin(0.5 * angle), 0.0};
  seed.position.z() = 1.5e-3 * std::cos(angle) + 2e-3 + 1e-6;
  seed.velocity = Vec3(0.0, 0.0, -speed);
  GrainDynamics grains(tray, MPI_COMM_SELF, p, {}, {seed});
  const double energy = grains.kinetic_energy();
  for (int n = 0; n < 100; ++n) step(grains);  // 0.2 ms: a contact of 0.01 ms is over, the other end still above
  ASSERT_EQ(grains.contacts().size(), 0u);

  const double mass = seed.mass(), inertia = glass_density * seed.shape->moments[2];
  const double lever = 1.5e-3 * std::sin(angle);  // r x n = lever along y: r = (-sin, 0, -cos) 1.5 mm
  const double impulse = 2.0 * speed / (1.0 / mass + lever * lever / inertia);
  const Clump& clump = grains.clumps()[0];
  const double spin = impulse * lever / inertia, bound = 0.01;
  EXPECT_LT((clump.velocity - Vec3(0.0, 0.0, impulse / mass - speed)).norm(), bound * speed);
  EXPECT_LT((clump.angular_velocity - Vec3(0.0, spin, 0.0)).norm(), bound * spin);
  EXPECT_NEAR(grains.kinetic_energy() / energy, 1.0, 1e-3);
  // Nothing has pushed it sideways, and nothing out of its plane.
  EXPECT_LT(std::abs(clump.velocity.x()), epsilon * speed);
  EXPECT_EQ(clump.velocity.y(), 0.0);
}

TEST(Clump, MeetsAnotherHeadOnWithTheRestitutionOfTheirMasses) {
  // Two dumbbells along x on one axis: nothing turns, and the contact of their ends moves whole clumps. 450 steps a
  // contact, whose integration is off by less than 2e-3 in e (as that of spheres in normal_impact_test.cpp).
  const double speed = 0.1, restitution = 0.6;
  GrainParameters p = free_flight(4e-7, 50);
  p.contact = glass(restitution);
  std::vector<ClumpSeed> clumps;
  for (const double side : {-1.0, 1.0}) {
    clumps.push_back(glass_clump(side < 0.0 ? 0 : 2, dumbbell(), Vec3(0.025 + side * 3.51e-3, 0.02, 0.02),
                                 Vec3(-side * speed, 0.0, 0.0)));
    clumps.back().orientation = {std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0};
  }
  GrainDynamics grains(room(), MPI_COMM_SELF, p, {}, clumps);
  for (int n = 0; n < 40; ++n) step(grains);
  ASSERT_EQ(grains.contact_count(), 0);
  const Vec3 apart = grains.clumps()[1].velocity - grains.clumps()[0].velocity;
  EXPECT_NEAR(apart.x() / (2.0 * speed), restitution, 2e-3);
  EXPECT_LT(grains.clumps()[0].angular_velocity.norm() * 2e-3, 1e-12 * speed);
}

TEST(Clump, AtRestOnAFloorStays) {
  // A dumbbell lying on two feet, each under half the weight: overlap mg/(2 k). It begins there and stays there.
  const Decomposition tray({20, 20, 20}, 2.5e-3, {true, true, false}, {1, 1, 1});
  GrainParameters p = free_flight(8e-6, 50);
  p.contact = glass(0.5);
  p.initial_overlap = 1e-3;
  p.walls = face_planes(tray.box(), p.contact);
  p.body_force = [](double mass, double) { return Vec3(0.0, 0.0, -9.8 * mass); };
  ClumpSeed seed = glass_clump(0, dumbbell(), Vec3(0.02, 0.02, 0.0));
  seed.orientation = {std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0};
  const double overlap = seed.mass() * 9.8 / (2.0 * 20000.0);
  seed.position.z() = 2e-3 - overlap;
  GrainDynamics grains(tray, MPI_COMM_SELF, p, {}, {seed});
  const Vec3 start = grains.clumps()[0].centre;
  for (int n = 0; n < 1000; ++n) step(grains);
  EXPECT_LT((grains.clumps()[0].centre - start).norm(), 1e-9 * 4e-3);
  EXPECT_LT(grains.largest_speed(), 1e-12);
  EXPECT_LT(grains.clumps()[0].angular_velocity.norm() * 2e-3, 1e-12);
  // The floor, the lowest of the walls, carries the weight.
  EXPECT_NEAR(grains.wall_forces()[0].z() / (-9.8 * seed.mass()), 1.0, 1e-9);
  EXPECT_LT(grains.largest_acceleration(), 1e-8);
}

TEST(Clump, CloudOfClumpsAndSpheresConservesMomentumAndAngularMomentum) {
  const Decomposition space = room();
  GrainParameters p = free_flight(2e-6, 25);
  std::vector<Vec3> places =
      beds::uniform_packing(space.box(), {Vec3::Constant(0.015), Vec3::Constant(0.035)}, 27, 3.3e-3, 0.0, 5);
  std::vector<GrainSeed> spheres;
  std::vector<ClumpSeed> clumps;
  GlobalId id = 0;
  double scale = 0.0;
  for (int i = 0; i < 27; ++i) {
    const Vec3 inwards =
        0.5 * (Vec3::Constant(0.025) - places[i]).normalized() + 0.2 * Vec3(std::sin(7.0 * i), 0.0, 0.0);
    if (i % 3 == 0) {
      spheres.push_back(test::glass_sphere(id++, places[i], inwards));
      spheres.back().angular_velocity = Vec3(100.0, -50.0, 0.0);
    } else {
      clumps.push_back(
          glass_clump(id, i % 3 == 1 ? dumbbell() : pebble(), places[i], inwards, Vec3(0.0, 200.0, 100.0)));
      clumps.back().orientation = test::some_orientation(i);
      id += static_cast<GlobalId>(clumps.back().shape->members.size());
    }
    scale += test::glass_sphere(0, Vec3::Zero()).mass();
  }
  GrainDynamics grains(space, MPI_COMM_SELF, p, spheres, clumps);
  const Vec3 momentum = grains.momentum(), angular = angular_momentum(grains);
  const double energy = grains.kinetic_energy();
  const int steps = 300;
  for (int n = 0; n < steps; ++n) step(grains);
  EXPECT_LT(grains.kinetic_energy(), 0.8 * energy);  // they collided
  EXPECT_GT(grains.kinetic_energy(), 0.05 * energy);
  // Every half kick of every grain rounds once: 15000 of them, all to the same side at worst.
  const double roundings = 2.0 * 25.0 * steps * epsilon;
  EXPECT_LT((grains.momentum() - momentum).norm(), roundings * scale * 1.0);
  EXPECT_LT((angular_momentum(grains) - angular).norm(), roundings * scale * 1.0 * 0.05);
}

TEST(Clump, HeldMotionIsKept) {
  // A prescribed rotation turns the members round the centre, which a prescribed velocity moves.
  GrainParameters p = free_flight(4e-6, 25);
  ClumpSeed seed = glass_clump(0, pebble(), Vec3::Constant(0.02), Vec3(0.05, 0.0, 0.0), Vec3(0.0, 0.0, 40.0));
  seed.motion = Motion::fixed;
  const GrainSeed projectile = test::glass_sphere(3, Vec3(0.02, 0.03, 0.02), Vec3(0.0, -0.5, 0.0));
  GrainDynamics grains(room(), MPI_COMM_SELF, p, {projectile}, {seed});
  const Vec3 arm = grains.store().position[1] - seed.position;
  for (int n = 0; n < 300; ++n) step(grains);
  const double time = 300 * 25 * 4e-6;
  EXPECT_GT(grains.store().velocity[3].y(), 0.0);  // it was hit
  const Clump& clump = grains.clumps()[0];
  EXPECT_EQ(clump.velocity, seed.velocity);
  EXPECT_EQ(clump.angular_velocity, seed.angular_velocity);
  // 7500 roundings of a sum, and of a product of quaternions.
  EXPECT_LT((clump.centre - seed.position - time * seed.velocity).norm(), 7500 * epsilon * 0.05);
  const Vec3 turned = Eigen::AngleAxisd(40.0 * time, Vec3::UnitZ()) * arm;
  EXPECT_LT((grains.store().position[1] - clump.centre - turned).norm(), 7500 * 4 * epsilon * arm.norm());
  EXPECT_LT((grains.store().velocity[1] - seed.velocity - seed.angular_velocity.cross(turned)).norm(), 1e-10);
  EXPECT_EQ(grains.moving_count(0.0), 1);  // the sphere alone is free
}

TEST(Clump, OfDisksTurnsInItsPlane) {
  // Two disks of thickness t that touch: I about y is that of both about their own axes and m R^2 each. A sphere-like
  // disk hits one of them squarely from the side, without friction and loss: V and w from the impulse as above.
  const double radius = 2e-3, thickness = 1e-3, speed = 0.1;
  const auto pair = test::shape_of({{{-radius, 0, 0}, radius}, {{radius, 0, 0}, radius}}, thickness);
  const double one = std::numbers::pi * radius * radius * thickness;
  EXPECT_NEAR(pair->volume / (2.0 * one), 1.0, 1e-12);
  EXPECT_NEAR(pair->moments[1] / (2.0 * one * 1.5 * radius * radius), 1.0, 1e-12);

  const Decomposition plane({20, 4, 20}, 2.5e-3, {true, true, false}, {1, 1, 1});
  GrainParameters p = free_flight(4e-7, 25);
  p.disk_thickness = thickness;
  p.contact = glass(1.0);
  p.contact.normal_stiffness = 2e5;
  p.contact.tangential_stiffness = 0.0;
  p.contact.friction = 0.0;
  GrainSeed disk = test::glass_sphere(2, Vec3(0.02 + radius, 0.005, 0.01), Vec3(0.0, 0.0, speed), radius);
  disk.thickness = thickness;
  const ClumpSeed seed = glass_clump(0, pair, Vec3(0.02, 0.005, 0.01 + 2.001 * radius));
  GrainDynamics grains(plane, MPI_COMM_SELF, p, {disk}, {seed});
  const double energy = grains.kinetic_energy();
  for (int n = 0; n < 100; ++n) step(grains);
  const double mass = glass_density * one, inertia = glass_density * pair->moments[1];
  const double impulse = 2.0 * speed / (1.0 / mass + 0.5 / mass + radius * radius / inertia);
  const Clump& clump = grains.clumps()[0];
  EXPECT_LT((clump.velocity - Vec3(0.0, 0.0, 0.5 * impulse / mass)).norm(), 0.01 * speed);
  EXPECT_LT((clump.angular_velocity - Vec3(0.0, -impulse * radius / inertia, 0.0)).norm(),
            0.01 * impulse * radius / inertia);
  EXPECT_NEAR(grains.kinetic_energy() / energy, 1.0, 1e-3);
  // They are in the plane to the last bit.
  for (std::size_t s = 0; s < 3; ++s) {
    EXPECT_EQ(grains.store().position[s].y(), 0.005);
    EXPECT_EQ(grains.store().velocity[s].y(), 0.0);
    EXPECT_EQ(grains.store().angular_velocity[s].x(), 0.0);
    EXPECT_EQ(grains.store().angular_velocity[s].z(), 0.0);
  }
}

// A rod of five spheres, 12 mm long across a periodic box of 12.5 mm: its last members are nearer to the first one's
// image.
TEST(Clump, LongerThanHalfAPeriodicBoxIsReadAsItWas) {
  std::vector<BedGrain> open, wrapped;
  const PeriodicBox box{Vec3(0.03, 0.0125, 0.03), {true, true, false}}, room{box.size, {false, false, false}};
  for (int member = 0; member < 5; ++member) {
    BedGrain row;
    row.radius = 2e-3;
    row.density = glass_density;
    row.clump = 0;
    row.position = Vec3(0.01, 0.004 + 2e-3 * member, 0.02);
    open.push_back(row);
    row.position = box.wrapped(row.position);
    wrapped.push_back(row);
  }
  const ClumpSeed exact = beds::clump_from(open, room, 0.0), read = beds::clump_from(wrapped, box, 0.0);
  EXPECT_NEAR(read.mass() / exact.mass(), 1.0, 1e-12);
  EXPECT_NEAR(read.shape->bounding_radius, 6e-3, 1e-12);
  EXPECT_LT((read.position - exact.position).norm(), 1e-12);
}

TEST(Clump, ThatCannotBeIsRefused) {
  const Decomposition tray({20, 20, 20}, 2.5e-3, {true, true, false}, {1, 1, 1});
  GrainParameters p = free_flight(4e-6);
  p.walls = face_planes(tray.box(), p.contact);
  const auto refused = [&](const GrainParameters& parameters, const std::vector<GrainSeed>& grains,
                           const ClumpSeed& clump, const std::string& reason) {
    try {
      GrainDynamics dynamics(tray, MPI_COMM_SELF, parameters, grains, {clump});
      ADD_FAILURE() << "accepted, though: " << reason;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  };
  const ClumpSeed good = glass_clump(0, dumbbell(), Vec3::Constant(0.02));
  refused(p, {test::glass_sphere(1, Vec3::Constant(0.04))}, good, "given twice");
  refused(p, {test::glass_sphere(2, Vec3(0.02, 0.02, 0.024))}, good, "overlap");
  refused(p, {}, glass_clump(0, dumbbell(), Vec3(0.02, 0.02, 0.003)), "into the wall");
  refused(p, {}, glass_clump(0, dumbbell(), Vec3(0.02, 0.06, 0.02)), "outside the box");
  refused(p, {}, glass_clump(0, test::shape_of({{{0, 0, 0}, 1e-3}, {{0.05, 0, 0}, 1e-3}}), Vec3::Constant(0.02)),
          "touches itself");
  GrainParameters slow = p;
  // A contact at the end of a dumbbell lasts shorter than one of its whole mass: between the two the step is refused.
  slow.time_step = contact_time(p.contact, good.shape->least_contact_mass(glass_density), 1e-3) / 19.0;
  EXPECT_LT(slow.time_step, contact_time(p.contact, good.mass(), 1e-3) / 20.0);
  refused(slow, {}, good, "time step");
  EXPECT_THROW(clump_shape({}), InputError);
  EXPECT_THROW(clump_shape(std::vector<PlacedSphere>{{Vec3::Zero(), 0.0}}), InputError);
  EXPECT_THROW(clump_shape(std::vector<PlacedSphere>{{Vec3::Zero(), 1.0}, {Vec3(0, 0.1, 0), 1.0}}, 0.1), InputError);
}

}  // namespace
}  // namespace thalweg::dem::clump_test
