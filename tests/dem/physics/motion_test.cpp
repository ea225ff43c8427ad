// Many grains: free flight of a colliding cloud, coming to rest, rolling, held grains, loads.
#include "beds/packing/packing.hpp"
#include "core/base/error.hpp"
#include "core/sums/reproducible_sum.hpp"
#include "tests/dem/grain_cases.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::dem::motion_test {
namespace {

// x and y periodic, 12 cells of 2.5 mm each way: six diameters.
Decomposition tray(bool periodic_z) {
  const Index3 cells{12, 12, 24};
  return Decomposition(cells, 2.5e-3, {true, true, periodic_z},
                       Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD)));
}

std::vector<GrainSeed> spread(const PeriodicBox& box, int count, double largest_velocity) {
  std::vector<GrainSeed> seeds;
  const std::vector<Vec3> places = beds::uniform_packing(box, beds::whole(box), count, test::glass_radius, 0.0, 5);
  for (int i = 0; i < count; ++i) {
    // Velocities that differ from grain to grain, without any meaning.
    const Vec3 v = largest_velocity * Vec3(std::sin(7.0 * i), std::cos(11.0 * i), std::sin(13.0 * i + 1.0));
    seeds.push_back(test::glass_sphere(i, places[i], v));
  }
  return seeds;
}

TEST(Cloud, ConservesMomentumToRoundOff) {
  const Decomposition decomposition = tray(true);
  GrainParameters p = test::parameters(test::glass(0.93), 4e-6, 25);
  GrainDynamics grains(decomposition, MPI_COMM_WORLD, p, spread(decomposition.box(), 80, 1.0));
  const Vec3 start = grains.momentum();
  const double energy = grains.kinetic_energy();
  const double scale = 80.0 * grains.largest_speed() * test::glass_sphere(0, Vec3::Zero()).mass();
  for (int n = 0; n < 300; ++n) test::step(grains);
  EXPECT_LT(grains.kinetic_energy(), 0.9 * energy);  // they did collide
  EXPECT_GT(grains.kinetic_energy(), 0.0);
  // 15000 half kicks, each rounded once per grain.
  EXPECT_LT((grains.momentum() - start).norm(), 15000.0 * 2.2e-16 * scale);
}

TEST(Settling, GrainsComeToRestAndTheFloorCarriesTheirWeight) {
  const Decomposition decomposition = tray(false);
  const double g = 9.8;
  GrainParameters p = test::parameters(test::glass(0.5), 9e-6, 20);
  p.walls = {face_plane(decomposition.box(), 2, false, 0.5)};
  p.body_force = [g](double mass, double) { return Vec3(0.0, 0.0, -g * mass); };
  GrainDynamics grains(decomposition, MPI_COMM_WORLD, p, spread(decomposition.box(), 100, 0.1));
  for (int n = 0; n < 3000; ++n) test::step(grains);  // 0.54 s; the highest falls 60 mm in 0.11 s

  const double diameter = 2.0 * test::glass_radius;
  // Nothing takes energy from rolling: a loose grain or two may still swing in their dimples by a small part of one.
  EXPECT_LT(grains.largest_speed(), 2e-2 * std::sqrt(g * diameter));
  EXPECT_LE(grains.moving_count(1e-3 * std::sqrt(g * diameter)), 3);
  const GrainStore& s = grains.store();
  const std::vector<double> mass(s.mass.begin(), s.mass.begin() + static_cast<std::ptrdiff_t>(s.owned));
  std::vector<double> carried, height;
  for (std::size_t i = 0; i < s.owned; ++i) {
    carried.push_back(s.contact_force[i][2]);
    height.push_back(s.position[i][2]);
  }
  const double weight = g * reproducible_sums(MPI_COMM_WORLD, mass, 1)[0];
  EXPECT_NEAR(reproducible_sums(MPI_COMM_WORLD, carried, 1)[0] / weight, 1.0, 1e-2);
  // 100 spheres on a plan of 36 square diameters: between the height of a dense and of a very loose bed.
  EXPECT_GT(reproducible_sums(MPI_COMM_WORLD, height, 1)[0] / 100.0, 0.9 * diameter);
  EXPECT_LT(reproducible_sums(MPI_COMM_WORLD, height, 1)[0] / 100.0, 2.0 * diameter);
  // At least the overlap of a column of three, at most a few times the mean pressure concentrated in one contact.
  const double unit = g * s.mass[0] / p.contact.normal_stiffness / diameter;
  EXPECT_GT(grains.largest_overlap(), unit);
  EXPECT_LT(grains.largest_overlap(), 30.0 * unit);
}

TEST(Rolling, SlidingTurnsIntoRollingAtFiveSevenths) {
  // A sphere set down sliding on a plane rolls after 2 u0/(7 mu g) at 5 u0/7, whatever the friction.
  const double g = 9.8, u0 = 0.1, weight = g * test::glass_sphere(0, Vec3::Zero()).mass();
  GrainParameters p = test::parameters(test::glass(0.5), 1e-5, 25);
  p.walls = {face_plane(test::cube().box(), 2, false, 0.3)};
  p.body_force = [g](double mass, double) { return Vec3(0.0, 0.0, -g * mass); };
  const double height = test::glass_radius - weight / p.contact.normal_stiffness * 0.06;  // within the allowed overlap
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p,
                       {test::glass_sphere(0, Vec3(0.01, 0.025, height), Vec3(u0, 0.0, 0.0))});
  for (int n = 0; n < 400; ++n) {
    test::step(grains);
    const double time = (n + 1) * 2.5e-4;
    if (time > 4e-3 && time < 8e-3) {  // slides until 9.7 ms; the bounce of setting it down has died out
      EXPECT_NEAR(grains.store().velocity[0][0], u0 - 0.3 * g * time, 0.01 * u0) << time;
    }
  }
  const Vec3 &v = grains.store().velocity[0], &w = grains.store().angular_velocity[0];
  // The tangential spring, undamped, keeps swinging by about mu g/omega_t, 4e-4 m/s, after rolling has begun.
  EXPECT_NEAR(v[0], 5.0 / 7.0 * u0, 6e-3 * u0);
  EXPECT_NEAR(w[1] * test::glass_radius, 5.0 / 7.0 * u0, 1.5e-2 * u0);
  EXPECT_NEAR(v[1], 0.0, 1e-12);
}

TEST(HeldGrains, KeepTheVelocityTheyWereGivenAndPushOthers) {
  GrainParameters p = test::parameters(test::glass(1.0), 2e-6, 50);
  GrainSeed still = test::glass_sphere(0, Vec3(0.030, 0.025, 0.025));
  still.motion = Motion::fixed;
  GrainSeed piston = test::glass_sphere(1, Vec3(0.010, 0.010, 0.025), Vec3(0.2, 0.0, 0.0));
  piston.motion = Motion::fixed;
  GrainSeed spinning = test::glass_sphere(2, Vec3(0.040, 0.040, 0.025));
  spinning.angular_velocity = Vec3(0.0, 0.0, 9.0);
  spinning.motion = Motion::held_rotation;
  GrainDynamics grains(test::cube(true), MPI_COMM_SELF, p,
                       {still, piston, spinning, test::glass_sphere(3, Vec3(0.0249, 0.025, 0.025), Vec3(0.1, 0.0, 0.0)),
                        test::glass_sphere(4, Vec3(0.0151, 0.010, 0.025))});
  for (GlobalId id : {0, 2}) grains.store().load_force[id] = Vec3(0.0, 1e-5, 0.0);
  grains.store().load_torque[2] = Vec3(1e-6, 0.0, 0.0);
  for (int n = 0; n < 20; ++n) test::step(grains);  // 2 ms
  const GrainStore& s = grains.store();
  EXPECT_EQ(s.position[0], still.position);
  EXPECT_EQ(s.velocity[0], Vec3::Zero());
  EXPECT_EQ(s.velocity[1], piston.velocity);
  EXPECT_NEAR(s.position[1][0], 0.010 + 0.2 * 2e-3, 1e-12);
  EXPECT_EQ(s.angular_velocity[2], spinning.angular_velocity);
  EXPECT_NEAR(s.velocity[2][1], 1e-5 / s.mass[2] * 2e-3, 1e-12);  // free to move: a = F/m
  // Elastic impacts on a body of infinite mass: reversed, and thrown at twice the piston's speed. Verlet's error is
  // at most (pi/143)^2/8 of the speed of approach with 143 steps a contact.
  EXPECT_NEAR(s.velocity[3][0], -0.1, 6.1e-5 * 0.1);
  EXPECT_NEAR(s.velocity[4][0], 0.4, 6.1e-5 * 0.2);
  EXPECT_EQ(grains.moving_count(0.01), 2);
}

TEST(MovingWall, DragsTheGrainThatLiesOnIt) {
  // A belt under a grain that weighs on it: rolling without slip, against the belt, at 2/7 of its velocity.
  const double g = 9.8, belt = 0.05;
  GrainParameters p = test::parameters(test::glass(0.5), 1e-5, 25);
  p.walls = {face_plane(test::cube().box(), 2, false, 0.5, Vec3(belt, 0.0, 0.0))};
  p.body_force = [g](double mass, double) { return Vec3(0.0, 0.0, -g * mass); };
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {test::glass_sphere(0, Vec3(0.02, 0.02, test::glass_radius))});
  for (int n = 0; n < 400; ++n) test::step(grains);
  // From rest the slip belt -> 0 gives u = 2/7 belt; the undamped spring swings by mu g/omega_t = 7e-4 m/s at most.
  EXPECT_NEAR(grains.store().velocity[0][0], 2.0 / 7.0 * belt, 1e-3);
}

}  // namespace
}  // namespace thalweg::dem::motion_test
