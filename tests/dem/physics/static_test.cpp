// Grains at rest or nearly so, against statics: incline, stack, bounce, a bed that stays, and settling in a drag.
#include "beds/packing/packing.hpp"
#include "tests/dem/grain_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace thalweg::dem::static_test {
namespace {

constexpr double g = 9.8;  // m/s^2

double glass_mass() { return test::glass_sphere(0, Vec3::Zero()).mass(); }

GrainParameters on_floor(const ContactParameters& contact, const Vec3& gravity) {
  GrainParameters p = test::parameters(contact, 5e-6, 20);
  p.walls = {face_plane(test::cube().box(), 2, false, contact.wall_friction)};
  p.body_force = [gravity](double mass, double) -> Vec3 { return mass * gravity; };
  p.initial_overlap = 1e-3;
  return p;
}

TEST(Incline, SphereRollsOrSlidesWithTheAccelerationOfTheory) {
  // Rolling at 5/7 g sin if tan <= 7 mu/2, else sliding at g (sin - mu cos), with spin 5 mu g cos t/(2 R).
  for (const double friction : {0.5, 0.1})
    for (const double angle : {0.2, 0.6}) {
      ContactParameters contact = test::glass(0.3);
      contact.wall_friction = friction;
      contact.tangential_damping = 1.0;  // without it the tangential spring goes on swinging about the mean
      const Vec3 gravity = g * Vec3(std::sin(angle), 0.0, -std::cos(angle));
      const double sag = glass_mass() * g * std::cos(angle) / contact.normal_stiffness;
      GrainDynamics grains(test::cube(), MPI_COMM_SELF, on_floor(contact, gravity),
                           {test::glass_sphere(0, Vec3(0.01, 0.025, test::glass_radius - sag))});
      for (int n = 0; n < 800; ++n) test::step(grains);  // 0.08 s
      const double time = 0.08;
      const bool rolls = std::tan(angle) <= 3.5 * friction;
      const double a = rolls ? 5.0 / 7.0 * g * std::sin(angle) : g * (std::sin(angle) - friction * std::cos(angle));
      const double turn = rolls ? a / test::glass_radius : 2.5 * friction * g * std::cos(angle) / test::glass_radius;
      // Starting up takes less than a contact time of 0.3 ms.
      EXPECT_NEAR(grains.store().velocity[0][0] / (a * time), 1.0, 2e-3) << friction << " " << angle;
      EXPECT_NEAR(grains.store().angular_velocity[0][1] / (turn * time), 1.0, 4e-3) << friction << " " << angle;
    }
}

TEST(Stack, TenSpheresCarryWhatLiesOnThem) {
  // The contact below k spheres (k = 1 at the top) carries k m g; linear springs overlap by k m g/k_n.
  const int count = 10;
  const ContactParameters contact = test::glass(0.3);
  const double mass = glass_mass(), sag = mass * g / contact.normal_stiffness;
  std::vector<GrainSeed> seeds;
  const double spacing = 2.0 * test::glass_radius;
  for (int i = 0; i < count; ++i)
    seeds.push_back(test::glass_sphere(i, Vec3(0.025, 0.025, test::glass_radius + i * spacing)));
  const Decomposition tower({20, 20, 24}, 2.5e-3, {true, true, false}, {1, 1, 1});
  GrainDynamics grains(tower, MPI_COMM_SELF, on_floor(contact, Vec3(0, 0, -g)), seeds);
  for (int n = 0; n < 5000; ++n) test::step(grains);  // 0.5 s; the stack's slowest swing decays in some 0.01 s
  const std::vector<Contact> contacts = grains.contacts();
  ASSERT_EQ(contacts.size(), 10u);
  for (const Contact& c : contacts) {
    const double carried = c.second < 0 ? count : count - 1 - static_cast<double>(c.first);
    EXPECT_NEAR(c.overlap / (carried * sag), 1.0, 1e-6) << c.first;
  }
  EXPECT_LT(grains.largest_speed(), 1e-9);
}

// Of a grain that lies on the floor m g/(k_n d), with nothing else to touch; a held one is in the floor on purpose.
TEST(Overlap, OfAGrainWithTheFloorCounts) {
  const ContactParameters contact = test::glass(0.3);
  GrainSeed held = test::glass_sphere(1, Vec3(0.04, 0.04, 0.5 * test::glass_radius));
  held.motion = Motion::fixed;
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, on_floor(contact, Vec3(0, 0, -g)),
                       {test::glass_sphere(0, Vec3(0.025, 0.025, test::glass_radius)), held});
  for (int n = 0; n < 3000; ++n) test::step(grains);
  const double sag = glass_mass() * g / contact.normal_stiffness / (2.0 * test::glass_radius);
  EXPECT_NEAR(grains.largest_overlap() / sag, 1.0, 1e-6);
  const std::optional<Location> place = grains.place_of_deepest_overlap();
  ASSERT_TRUE(place.has_value());
  EXPECT_EQ(place->grains, std::vector<GlobalId>{0});
}

// The floor carries the weight of all, and each wall of a trough tilted by 45 degrees its share of one sphere.
TEST(WallForces, AreTheWeightOfWhatLiesOnThem) {
  GrainParameters p = on_floor(test::glass(0.3), Vec3(0, 0, -g));
  std::vector<GrainSeed> seeds;
  for (int i = 0; i < 9; ++i)
    seeds.push_back(test::glass_sphere(i, Vec3(0.01 + 0.01 * (i % 3), 0.01 + 0.01 * (i / 3), test::glass_radius)));
  seeds.push_back(test::glass_sphere(9, Vec3(0.01, 0.01, 3.0 * test::glass_radius)));
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, seeds);
  for (int n = 0; n < 3000; ++n) test::step(grains);
  const double weight = 10.0 * glass_mass() * g;
  ASSERT_EQ(grains.wall_forces().size(), 1u);
  EXPECT_NEAR(grains.wall_forces()[0][2], -weight, 1e-9 * weight);
  EXPECT_NEAR(grains.wall_forces()[0][0], 0.0, 1e-9 * weight);

  p = on_floor(test::glass(0.3), Vec3(0, 0, -g));
  const double half = std::sqrt(0.5);
  p.walls.resize(2);
  for (Plane& wall : p.walls) wall.point = Vec3(0.025, 0.025, 0);
  p.walls[0].normal = Vec3(half, 0, half);
  p.walls[1].normal = Vec3(-half, 0, half);
  GrainDynamics trough(test::cube(), MPI_COMM_SELF, p,
                       {test::glass_sphere(0, Vec3(0.025, 0.025, test::glass_radius / half))});
  for (int n = 0; n < 3000; ++n) test::step(trough);
  const double share = 0.5 * glass_mass() * g;  // down on each, and as much outwards
  EXPECT_NEAR(trough.wall_forces()[0][2], -share, 1e-9 * share);
  EXPECT_NEAR(trough.wall_forces()[0][0], -share, 1e-9 * share);
  EXPECT_NEAR(trough.wall_forces()[1][0], share, 1e-9 * share);
}

TEST(Bounce, HeightsFallByTheSquareOfTheRestitution) {
  // h_n = e^(2n) h_0 of the gap below the sphere, for hard spheres; the contact's own depth is below 1e-3 of h_0.
  const double e = 0.9, h0 = 0.02;
  GrainParameters p = on_floor(test::glass(e, true), Vec3(0, 0, -g));
  p.time_step = 1e-6;
  p.sub_steps = 10;
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p,
                       {test::glass_sphere(0, Vec3(0.025, 0.025, test::glass_radius + h0))});
  std::vector<double> peaks;
  double highest = 0.0;
  bool down = false;
  for (int n = 0; n < 60000 && peaks.size() < 4; ++n) {
    test::step(grains);
    const bool touching = !grains.contacts().empty();
    if (touching && !down && highest > 0.0) peaks.push_back(highest);
    if (touching) highest = 0.0;
    down = touching;
    highest = std::max(highest, grains.store().position[0][2] - test::glass_radius);
  }
  ASSERT_EQ(peaks.size(), 4u);
  // Relative to the last one, the error of e is 1e-3 an impact (280 steps a contact), twice that in the height.
  for (int n = 0; n < 4; ++n) EXPECT_NEAR(peaks[n] / (h0 * std::pow(e, 2 * n)), 1.0, 3e-3 * (n + 1)) << n;
}

TEST(Drag, SphereSettlesAtTheTerminalVelocity) {
  // A linear load -gamma v: v = m g/gamma (1 - exp(-gamma t/m)), the load held during each step of the caller.
  GrainParameters p = on_floor(test::glass(0.9), Vec3(0, 0, -g));
  const double mass = glass_mass(), gamma = mass * g / 0.1;  // terminal velocity 0.1 m/s
  p.time_step = 1e-5;
  p.sub_steps = 1;
  GrainDynamics grains(test::cube(true), MPI_COMM_SELF, p, {test::glass_sphere(0, Vec3(0.025, 0.025, 0.045))});
  for (int n = 1; n <= 20000; ++n) {
    grains.prepare();
    grains.store().load_force[0] = -gamma * grains.store().velocity[0];
    grains.advance(1);
    grains.refresh_ghosts();
    if (n == 1000 || n == 20000) {
      const double expected = 0.1 * (1.0 - std::exp(-gamma / mass * n * 1e-5));
      // Explicit drag: first order in gamma dt/m = 1e-3.
      EXPECT_NEAR(-grains.store().velocity[0][2], expected, 1e-3 * 0.1) << n;
    }
  }
}

TEST(Bed, AtRestStaysAtRestForAMillionSteps) {
  // Twelve spheres in a close-packed corner of walls, with damping both ways: kinetic energy falls to round-off and no
  // grain creeps by 1e-9 diameters in the second half of a million steps.
  const Decomposition pit({8, 8, 16}, 1.25e-3 * 1.02, {false, false, false}, {1, 1, 1});  // two by two diameters
  ContactParameters contact = test::glass(0.3);
  contact.tangential_damping = 1.0;
  GrainParameters p = test::parameters(contact, 8e-6, 50);
  p.walls = face_planes(pit.box(), contact);
  p.body_force = [](double mass, double) { return Vec3(0.0, 0.0, -g * mass); };
  std::vector<GrainSeed> seeds;
  for (const Vec3& place : beds::uniform_packing(pit.box(), beds::whole(pit.box()), 12, test::glass_radius, 0.0, 7))
    seeds.push_back(test::glass_sphere(static_cast<GlobalId>(seeds.size()), place));
  GrainDynamics grains(pit, MPI_COMM_SELF, p, seeds);
  for (int n = 0; n < 10000; ++n) test::step(grains);
  const std::vector<Vec3> before(grains.store().position.begin(), grains.store().position.end());
  for (int n = 0; n < 10000; ++n) test::step(grains);
  double creep = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i)
    creep = std::max(creep, (grains.store().position[i] - before[i]).norm());
  EXPECT_LT(creep, 1e-9 * 2.0 * test::glass_radius);
  // Round-off of a position of 0.02 m in a step: 0.02 * 2^-53/dt = 3e-13 m/s, gathered for a while.
  EXPECT_LT(grains.largest_speed(), 1e-10);
  EXPECT_EQ(grains.store().total(), 12u);
  EXPECT_GE(grains.contact_count(), 8);
}

}  // namespace
}  // namespace thalweg::dem::static_test
