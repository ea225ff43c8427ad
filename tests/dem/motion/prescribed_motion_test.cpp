// Walls and rigid assemblies of grains that move as a given function of time.
#include "dem/motion/prescribed_motion.hpp"
#include "core/base/error.hpp"
#include "tests/dem/grain_cases.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace thalweg::dem::prescribed_motion_test {
namespace {

using std::numbers::pi;

// The relative error of velocity Verlet over an elastic contact of N steps is at most (pi/N)^2/8.
double verlet_error(const GrainParameters& p, double effective_mass) {
  const double steps = contact_time(p.contact, effective_mass, 0.0) / p.time_step;
  return pi * pi / (8.0 * steps * steps);
}

GrainParameters elastic() {
  GrainParameters p = test::parameters(test::glass(1.0), 2e-6, 25);
  return p;
}

TEST(PrescribedMotion, IsTheFunctionItSays) {
  PrescribedMotion m;
  m.velocity = Vec3(0.1, 0.0, -0.2);
  m.oscillation = {Vec3(0.0, 3e-3, 1e-3), 20.0, 0.3};
  m.centre = Vec3(0.01, 0.02, 0.0);
  m.axis = Vec3(0.0, 0.6, 0.8);
  m.angular_velocity = 5.0;
  const Vec3 start(0.03, -0.01, 0.02);
  EXPECT_LT((m.place(start, 0.0) - start).norm(), 1e-17);
  // After a whole turn and eight whole swings only the velocity has moved it; and a turn keeps the distance.
  m.oscillation.frequency = 8.0 * 5.0 / (2.0 * pi);
  const double turn = 2.0 * pi / 5.0;
  EXPECT_LT((m.place(start, turn) - start - turn * m.velocity).norm(), 1e-15);
  const Vec3 moved = m.place(start, 0.4) - m.displacement(0.4) - m.centre;
  EXPECT_NEAR(moved.norm(), (start - m.centre).norm(), 1e-16);
  EXPECT_NEAR(moved.dot(m.axis), (start - m.centre).dot(m.axis), 1e-16);
  // The velocity is the derivative: a central difference over 2 h is off by h^2/6 of the third one, 20 m (250/s)^3.
  const double h = 1e-6;
  EXPECT_LT((m.velocity_of(start, 0.4) - (m.place(start, 0.4 + h) - m.place(start, 0.4 - h)) / (2.0 * h)).norm(), 1e-9);
  EXPECT_LE(m.velocity_of(start, 0.4).norm(), m.largest_speed((start - m.centre).norm()));
  m.axis = Vec3(0.0, 1.0, 1.0);
  EXPECT_THROW(check(m), InputError);
}

TEST(MovingPlane, ThrowsAGrainBackWithTwiceItsVelocity) {
  const double u = 0.3, v = -0.1;
  GrainParameters p = elastic();
  p.walls = {face_plane(test::cube().box(), 2, false, 0.5, Vec3(0.0, 0.0, u))};
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p,
                       {test::glass_sphere(0, Vec3(0.025, 0.025, 2.0 * test::glass_radius), Vec3(0.0, 0.0, v))});
  for (int n = 0; n < 200; ++n) test::step(grains);  // 10 ms; they meet after 6 ms
  EXPECT_EQ(grains.contact_count(), 0);
  EXPECT_NEAR(grains.store().velocity[0][2], 2.0 * u - v, verlet_error(p, grains.store().mass[0]) * (u - v));
  EXPECT_EQ(grains.walls()[0].point[2], u * grains.time());  // no sum of steps
  EXPECT_NEAR(grains.time(), 0.01, 1e-17);
}

TEST(MovingPlane, DoesTheWorkThatItsGrainGains) {
  // Every bounce off a swinging floor: the kinetic energy changes by the work of the force on the floor's way, up to
  // the error of Verlet's rule in each contact, in which the energy at hand is that of the fastest approach.
  GrainParameters p = elastic();
  p.sub_steps = 1;
  p.walls = {face_plane(test::cube().box(), 2, false, 0.0), face_plane(test::cube().box(), 2, true, 0.0)};
  p.walls[0].oscillation = {Vec3(0.0, 0.0, 1.5e-3), 40.0, 0.0};
  p.walls[1].point[2] = 4.0 * test::glass_radius;
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p,
                       {test::glass_sphere(0, Vec3(0.025, 0.025, 1.9 * test::glass_radius), Vec3(0.0, 0.0, -0.4))});
  const double mass = grains.store().mass[0];
  double work = 0.0, fastest = 0.0, changed = 0.0;
  int bounces = 0;
  bool touching = false;
  const double before = grains.kinetic_energy();
  for (int n = 0; n < 50000; ++n) {
    test::step(grains);
    const std::vector<Vec3> forces = grains.wall_forces();
    work -= forces[0][2] * grains.walls()[0].velocity[2] * p.time_step;
    const bool touches = forces[0][2] != 0.0;
    bounces += touches && !touching;
    touching = touches;
    fastest = std::max(fastest, grains.largest_speed() + 2.0 * pi * 40.0 * 1.5e-3);
    if (!touching && forces[1][2] == 0.0) changed = std::max(changed, std::abs(grains.kinetic_energy() - before));
  }
  while (touching || grains.wall_forces()[1][2] != 0.0) {
    test::step(grains);
    work -= grains.wall_forces()[0][2] * grains.walls()[0].velocity[2] * p.time_step;
    touching = grains.wall_forces()[0][2] != 0.0;
  }
  const double bound = 4.0 * bounces * verlet_error(p, mass) * mass * fastest * fastest;
  EXPECT_GE(bounces, 3);
  EXPECT_GT(changed, 10.0 * bound);  // there is something to balance
  EXPECT_NEAR(grains.kinetic_energy() - before, work, bound);
}

TEST(MovingPlane, GrainsMayFollowItOutOfTheBoxButNotBeyondIt) {
  GrainParameters p = elastic();
  p.contact = test::glass(0.5);
  p.body_force = [](double mass, double) { return Vec3(0.0, 0.0, -9.8 * mass); };
  p.walls = {face_plane(test::cube().box(), 2, false, 0.5, Vec3(0.0, 0.0, -0.1))};
  GrainDynamics lowered(test::cube(), MPI_COMM_SELF, p,
                        {test::glass_sphere(0, Vec3(0.025, 0.025, test::glass_radius), Vec3(0.0, 0.0, -0.1))});
  for (int n = 0; n < 2000; ++n) test::step(lowered);  // 0.1 s
  const double weight = 9.8 * lowered.store().mass[0];
  EXPECT_NEAR(lowered.store().position[0][2], test::glass_radius - 0.01 - weight / 20000.0, 1e-9);
  GrainDynamics loaded(test::cube(), MPI_COMM_SELF, p, GrainSeeds{});
  thalweg::test::load(loaded, thalweg::test::saved(lowered, MPI_COMM_SELF));
  EXPECT_EQ(loaded.walls()[0].point, lowered.walls()[0].point);

  // Two plates pass through each other with a grain in between.
  p.walls = {face_plane(test::cube().box(), 2, false, 0.5), face_plane(test::cube().box(), 2, true, 0.5)};
  p.walls[0].velocity[2] = 1.0;
  p.walls[1].velocity[2] = -1.0;
  GrainDynamics squeezed(test::cube(), MPI_COMM_SELF, p, {test::glass_sphere(0, Vec3(0.025, 0.025, 0.025))});
  std::string message;
  for (int n = 0; n < 1000 && message.empty(); ++n) try {
      test::step(squeezed);
    } catch (const RunError& error) {
      message = error.what();
    }
  EXPECT_NE(message.find("Grain 0 at"), std::string::npos);
  EXPECT_NE(message.find("beyond a wall"), std::string::npos) << message;
  EXPECT_NEAR(squeezed.walls()[0].point[2], 0.025 + test::glass_radius, 2e-4);  // within three steps
}

TEST(Assembly, FollowsItsFunctionAndPushesOthers) {
  GrainParameters p = elastic();
  PrescribedMotion turning, swinging;
  turning.centre = Vec3(0.030, 0.025, 0.025);
  turning.axis = Vec3::UnitY();
  turning.angular_velocity = 30.0;
  turning.velocity = Vec3(-0.5, 0.0, 0.0);  // 0.2 m: four times around the box
  swinging.oscillation = {Vec3(2e-3, 0.0, 0.0), 25.0, -pi / 2.0};
  p.assemblies = {turning, swinging};
  std::vector<GrainSeed> seeds{test::glass_sphere(0, Vec3(0.040, 0.025, 0.025)),
                               test::glass_sphere(1, Vec3(0.0376, 0.025, 0.0274)),  // they overlap, as in a drum
                               test::glass_sphere(2, Vec3(0.010, 0.005, 0.005))};
  for (std::size_t n = 0; n < seeds.size(); ++n) {
    seeds[n].motion = Motion::fixed;
    seeds[n].assembly = n < 2 ? 0 : 1;
  }
  // Where the swinging one comes at its fastest, half way at 2 mm from its start, lies a free one.
  seeds.push_back(test::glass_sphere(3, Vec3(0.012 + 2.0 * test::glass_radius, 0.005, 0.005)));
  GrainDynamics grains(test::cube(true), MPI_COMM_SELF, p, seeds);
  EXPECT_EQ(grains.store().velocity[0], turning.velocity_of(seeds[0].position, 0.0));
  for (int n = 0; n < 300; ++n) test::step(grains);  // 15 ms
  const double thrown = grains.store().velocity[3][0];
  for (int n = 300; n < 8000; ++n) test::step(grains);  // 0.4 s
  const PeriodicBox box = test::cube(true).box();
  for (int n = 0; n < 3; ++n) {
    const PrescribedMotion& motion = n < 2 ? turning : swinging;
    Vec3 place = motion.place(seeds[n].position, 0.4);
    for (int a = 0; a < 3; ++a) place[a] -= box.size[a] * std::floor(place[a] / box.size[a]);
    EXPECT_LT((grains.store().position[n] - place).norm(), 1e-15) << n;
    EXPECT_LT((grains.store().velocity[n] - motion.velocity_of(seeds[n].position, 0.4)).norm(), 1e-13) << n;
    EXPECT_EQ(grains.store().angular_velocity[n], motion.spin());
  }
  // It was struck after a quarter of the first swing and thrown at twice the velocity of its piston, which slows down
  // by (w t)^2/2 of it while they touch.
  const double fastest = 2.0 * pi * 25.0 * 2e-3, touch = contact_time(p.contact, grains.store().mass[3], 0.0);
  EXPECT_NEAR(thrown, 2.0 * fastest,
              2.0 * fastest * (verlet_error(p, grains.store().mass[3]) + std::pow(2.0 * pi * 25.0 * touch, 2)));
}

TEST(Assembly, ImpossibleOnesAreRefused) {
  GrainParameters p = elastic();
  p.assemblies = {PrescribedMotion{}};
  GrainSeed seed = test::glass_sphere(0, Vec3(0.025, 0.025, 0.025));
  seed.assembly = 0;
  EXPECT_THROW(GrainDynamics(test::cube(), MPI_COMM_SELF, p, {seed}), InputError);  // not fixed
  seed.motion = Motion::fixed;
  EXPECT_NO_THROW(GrainDynamics(test::cube(), MPI_COMM_SELF, p, {seed}));
  seed.assembly = 1;
  EXPECT_THROW(GrainDynamics(test::cube(), MPI_COMM_SELF, p, {seed}), InputError);
  seed.assembly = 0;
  p.assemblies[0].velocity = Vec3(12.0, 0.0, 0.0);  // 0.6 mm in a step of 50 us: more than half the skin of 1 mm
  EXPECT_THROW(GrainDynamics(test::cube(), MPI_COMM_SELF, p, {seed}), InputError);
  p.assemblies = {PrescribedMotion{}};
  p.walls = {face_plane(test::cube().box(), 2, false, 0.5, Vec3(0.0, 0.0, 12.0))};
  EXPECT_THROW(GrainDynamics(test::cube(), MPI_COMM_SELF, p, {seed}), InputError);
}

}  // namespace
}  // namespace thalweg::dem::prescribed_motion_test
