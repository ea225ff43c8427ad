// Refusals at the start and errors that stop a run, on every rank alike.
#include "core/base/error.hpp"
#include "tests/dem/grain_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace thalweg::dem::refusal_test {
namespace {

Decomposition shared_box() {
  const Index3 cells{16, 16, 16};
  return Decomposition(cells, 2.5e-3, {true, true, false}, Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD)));
}

GrainParameters usual() {
  GrainParameters p = test::parameters(test::glass(0.9), 5e-6, 20);
  p.walls = {face_plane(shared_box().box(), 2, false, 0.5)};
  return p;
}

template <typename Error>
std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

std::string start(const std::vector<GrainSeed>& seeds, const GrainParameters& p = usual()) {
  return message_of<InputError>([&] { GrainDynamics grains(shared_box(), MPI_COMM_WORLD, p, seeds); });
}

void expect_names(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
}

TEST(Start, RefusesATurningAssemblyAcrossAPeriodicFace) {
  GrainParameters p = usual();
  PrescribedMotion turning;
  turning.angular_velocity = 5.0;
  p.assemblies = {turning};
  const auto start_with = [&](const Vec3& axis, double x) {
    p.assemblies[0].axis = axis;
    std::vector<GrainSeed> seeds = {test::glass_sphere(0, Vec3(0.038, 0.02, 0.02)),
                                    test::glass_sphere(1, Vec3(x, 0.02, 0.02))};
    for (GrainSeed& seed : seeds) seed.motion = Motion::fixed, seed.assembly = 0;
    return start(seeds, p);
  };
  expect_names(start_with(Vec3::UnitY(), 0.002), {"Grains 0 and 1", "axis x", "tear"});
  EXPECT_EQ(start_with(Vec3::UnitX(), 0.002), "nothing was thrown");  // turns along with its image
  EXPECT_EQ(start_with(Vec3::UnitY(), 0.034), "nothing was thrown");
  EXPECT_EQ(start_with(Vec3::UnitY(), 0.006), "nothing was thrown");  // far from each other
}

TEST(Start, RefusesImpossibleGrains) {
  const GrainSeed good = test::glass_sphere(0, Vec3(0.02, 0.02, 0.02));
  EXPECT_EQ(start({good}), "nothing was thrown");
  GrainSeed bad = good;
  bad.radius = -1e-3;
  expect_names(start({bad}), {"Grain 0", "radius", "-0.001 m"});
  bad = good;
  bad.density = 0.0;
  expect_names(start({bad}), {"Grain 0", "density"});
  expect_names(start({test::glass_sphere(0, Vec3(0.041, 0.02, 0.02))}), {"Grain 0", "outside", "0.041"});
  expect_names(start({test::glass_sphere(0, Vec3(0.02, 0.02, 0.002))}), {"Grain 0", "wall"});
  expect_names(start({good, test::glass_sphere(2, Vec3(0.03, 0.03, 0.03))}), {"id 2"});
  // Across the periodic face; touching within a millionth of a diameter is taken for rounding.
  const GrainSeed edge = test::glass_sphere(0, Vec3(0.0395, 0.02, 0.02));
  expect_names(start({edge, test::glass_sphere(1, Vec3(0.0040, 0.02, 0.02))}),
               {"Grain 0", "grain 1", "0.0395", "0.004"});
  EXPECT_EQ(start({edge, test::glass_sphere(1, Vec3(0.0045 - 4e-9, 0.02, 0.02))}), "nothing was thrown");
}

TEST(Start, RefusesImpossibleParameters) {
  const std::vector<GrainSeed> seeds{test::glass_sphere(0, Vec3(0.02, 0.02, 0.02)),
                                     test::glass_sphere(1, Vec3(0.03, 0.03, 0.03))};
  GrainParameters p = usual();
  p.time_step = 2e-5;  // t_c/20 of a pair is 1.015e-5 s
  expect_names(start(seeds, p), {"2e-05 s", "too long", "1.015"});
  p = usual();
  p.skin = 0.0;
  expect_names(start(seeds, p), {"skin"});
  p = usual();
  p.contact.damping = 0.1;
  expect_names(start(seeds, p), {"restitution and damping"});
  const GrainSeed boulder = test::glass_sphere(0, Vec3(0.02, 0.02, 0.02), Vec3::Zero(), 0.0105);
  expect_names(start({boulder}), {"periodic axis x", "0.042"});
}

// The time of a Hertzian contact goes with (m^2/R)^(1/5), which need not be least of the lightest or the smallest
// grain.
TEST(Start, TheShortestHertzianContactIsThatOfOneGrain) {
  ContactParameters contact;
  contact.law = Law::hertz_mindlin;
  contact.youngs_modulus = 5e7;
  contact.poisson_ratio = 0.25;
  contact.restitution = 1.0;
  LightestGrain lightest;
  double shortest = std::numeric_limits<double>::infinity();
  const double kinds[][2] = {{1.0e-4, 2e-3}, {0.8e-4, 4e-3}, {0.85e-4, 5e-3}};  // kg, m
  for (const auto& [mass, radius] : kinds) {
    lightest.include(mass, radius);
    shortest = std::min(shortest, contact_time(contact, mass, radius));
    EXPECT_NEAR(contact_time(contact, lightest.mass, lightest.hertzian_radius()) / shortest, 1.0, 1e-12);
  }
}

TEST(Run, StopsWhereAGrainLeavesTheBox) {
  GrainDynamics grains(shared_box(), MPI_COMM_WORLD, usual(),
                       {test::glass_sphere(0, Vec3(0.02, 0.02, 0.037), Vec3(0.0, 0.0, 2.0)),
                        test::glass_sphere(1, Vec3(0.005, 0.02, 0.02))});
  // Steps of 1e-4 s: 0.2 mm each; the centre is a radius beyond the top after 5.5 mm, in the 28th step.
  const std::string message = message_of<RunError>([&] {
    for (int n = 0; n < 40; ++n) test::step(grains);
  });
  expect_names(message, {"Grain 0", "0.042", "2 m/s", "beyond a face"});
}

TEST(Run, StopsWhereAGrainIsTooFastForTheStep) {
  GrainDynamics fast(shared_box(), MPI_COMM_WORLD, usual(),
                     {test::glass_sphere(0, Vec3(0.02, 0.02, 0.02), Vec3(30.0, 0.0, 0.0))});
  expect_names(message_of<RunError>([&] { fast.prepare(); }), {"Grain 0", "30 m/s", "more than its radius"});
  GrainDynamics quick(shared_box(), MPI_COMM_WORLD, usual(),
                      {test::glass_sphere(0, Vec3(0.02, 0.02, 0.02), Vec3(10.0, 0.0, 0.0))});
  test::step(quick);
  expect_names(message_of<RunError>([&] { quick.prepare(); }), {"Grain 0", "10 m/s", "half the skin"});
}

TEST(Run, StopsWhereALoadIsNoNumber) {
  GrainDynamics grains(shared_box(), MPI_COMM_WORLD, usual(), {test::glass_sphere(0, Vec3(0.02, 0.02, 0.02))});
  grains.prepare();
  for (std::size_t s = 0; s < grains.store().owned; ++s)
    grains.store().load_force[s][1] = std::numeric_limits<double>::quiet_NaN();
  grains.advance(20);
  grains.refresh_ghosts();
  expect_names(message_of<RunError>([&] { grains.prepare(); }), {"Grain 0", "not a number"});
}

}  // namespace
}  // namespace thalweg::dem::refusal_test
