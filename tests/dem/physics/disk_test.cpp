// Disks in the x-z plane: mass, inertia, and motion that stays in the plane.
#include "beds/packing/packing.hpp"
#include "beds/packing/random_packing.hpp"
#include "core/base/error.hpp"
#include "tests/dem/grain_cases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::dem::disk_test {
namespace {

constexpr double gravity = 9.81, thickness = 4e-3;

GrainSeed disk(GlobalId id, const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  GrainSeed seed = test::glass_sphere(id, position, velocity);
  seed.thickness = thickness;
  return seed;
}

GrainParameters disk_parameters(double restitution, double friction, const Vec3& g) {
  GrainParameters p = test::parameters(test::glass(restitution), 2e-6, 50);
  p.contact.friction = p.contact.wall_friction = friction;
  p.walls = face_planes(test::cube().box(), p.contact);
  p.body_force = [g](double mass, double) { return Vec3(mass * g); };
  p.disk_thickness = thickness;
  p.initial_overlap = 0.01;
  return p;
}

// Lying on the floor with its overlap at rest.
double resting_height(const GrainSeed& seed) { return seed.radius - seed.mass() * gravity / 20000.0; }

TEST(Disks, HaveTheMassAndInertiaOfACylinder) {
  const GrainSeed seed = disk(0, Vec3(0.02, 0.025, 0.02));
  EXPECT_NEAR(seed.mass(), 2550.0 * std::numbers::pi * 6.25e-6 * 4e-3, 1e-18);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, disk_parameters(1.0, 0.0, Vec3::Zero()), {seed});
  EXPECT_EQ(grains.store().inertia[0], 0.5 * grains.store().mass[0] * 2.5e-3 * 2.5e-3);
}

// u = u0 - mu g t and R omega = 2 mu g t until both meet at t = u0/(3 mu g) with 2/3 u0.
TEST(Disks, SlideUntilTheyRollAtTwoThirdsOfTheSpeed) {
  GrainSeed seed = disk(0, Vec3(0.01, 0.025, 0.0), Vec3(0.3, 0, 0));
  seed.position[2] = resting_height(seed);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, disk_parameters(0.5, 0.3, Vec3(0, 0, -gravity)), {seed});
  const double rolls = 0.3 / (3.0 * 0.3 * gravity);
  while (grains.store().velocity[0][0] > 0.25) test::step(grains);
  const double t = (0.3 - grains.store().velocity[0][0]) / (0.3 * gravity);
  EXPECT_LT(t, rolls);
  EXPECT_NEAR(grains.store().angular_velocity[0][1] * test::glass_radius, 2.0 * 0.3 * gravity * t, 1e-4);
  for (int n = 0; n < 400; ++n) test::step(grains);  // 0.04 s; sliding ends after 0.034 s
  // The friction spring gives the point of contact a swing of mu g/omega_t, omega_t = sqrt(3 k_t/m): below 1e-3 u0.
  EXPECT_NEAR(grains.store().velocity[0][0], 0.2, 4e-4);
  EXPECT_NEAR(grains.store().angular_velocity[0][1] * test::glass_radius, 0.2, 8e-4);
}

// Without slip a = g sin/(1 + 1/2).
TEST(Disks, RollDownAnInclineWithTwoThirdsOfTheAcceleration) {
  const double angle = 0.2;
  GrainSeed seed = disk(0, Vec3(0.01, 0.025, 0.0));
  seed.position[2] = seed.radius - seed.mass() * gravity * std::cos(angle) / 20000.0;
  GrainDynamics grains(test::cube(), MPI_COMM_SELF,
                       disk_parameters(0.5, 0.5, gravity * Vec3(std::sin(angle), 0, -std::cos(angle))), {seed});
  for (int n = 0; n < 1000; ++n) test::step(grains);
  const double exact = 2.0 / 3.0 * gravity * std::sin(angle) * 0.1;
  EXPECT_NEAR(grains.store().velocity[0][0], exact, 0.005 * exact);
}

// A sliding impact: R (omega' - omega) = 2 mu (1 + e) v_n for a disk, v_t' = v_t - mu (1 + e) v_n.
TEST(Disks, LeaveAnObliqueImpactAsTheory) {
  const GrainSeed seed = disk(0, Vec3(0.01, 0.025, test::glass_radius + 1e-6), Vec3(0.08, 0, -0.01));
  GrainParameters p = disk_parameters(1.0, 0.2, Vec3::Zero());
  p.time_step = 1e-6;
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {seed});
  for (int n = 0; n < 12; ++n) test::step(grains);
  ASSERT_GT(grains.store().velocity[0][2], 0.0);
  EXPECT_NEAR(grains.store().velocity[0][0], 0.08 - 0.2 * 2.0 * 0.01, 2e-5);
  EXPECT_NEAR(grains.store().angular_velocity[0][1] * test::glass_radius, 2.0 * 0.2 * 2.0 * 0.01, 4e-5);
}

TEST(Disks, StayInTheirPlaneToTheLastBit) {
  beds::Region region = beds::whole(test::cube().box());
  region.plane = true;
  const std::vector<double> radii(40, test::glass_radius);
  std::vector<GrainSeed> seeds;
  for (const Vec3& position : beds::random_packing(test::cube().box(), region, radii, 0.0, 5))
    seeds.push_back(disk(static_cast<GlobalId>(seeds.size()), position, Vec3(position[2] > 0.025 ? -1.0 : 1.0, 0, 0)));
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, disk_parameters(0.8, 0.5, Vec3(0, 0, -gravity)), seeds);
  const double energy = grains.kinetic_energy();
  for (int n = 0; n < 300; ++n) test::step(grains);
  EXPECT_LT(grains.kinetic_energy(), 0.9 * energy);  // they have met
  for (std::size_t s = 0; s < grains.store().owned; ++s) {
    EXPECT_EQ(grains.store().position[s][1], 0.025);
    EXPECT_EQ(grains.store().velocity[s][1], 0.0);
    EXPECT_EQ(grains.store().angular_velocity[s][0], 0.0);
    EXPECT_EQ(grains.store().angular_velocity[s][2], 0.0);
  }
}

TEST(Disks, RefuseSpheresAndOtherPlanes) {
  const GrainParameters p = disk_parameters(1.0, 0.0, Vec3::Zero());
  const auto make = [&](const std::vector<GrainSeed>& seeds) {
    GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, seeds);
  };
  const Vec3 here(0.01, 0.025, 0.02), there(0.03, 0.025, 0.02);
  EXPECT_NO_THROW(make({disk(0, here), disk(1, there)}));
  EXPECT_THROW(make({disk(0, here), test::glass_sphere(1, there)}), InputError);
  EXPECT_THROW(make({test::glass_sphere(0, here)}), InputError);
  EXPECT_THROW(make({disk(0, here), disk(1, there + Vec3(0, 1e-6, 0))}), InputError);
  EXPECT_THROW(make({disk(0, here, Vec3(0, 0.1, 0))}), InputError);
}

}  // namespace
}  // namespace thalweg::dem::disk_test
