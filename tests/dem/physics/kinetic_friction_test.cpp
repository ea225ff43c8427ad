// Static and kinetic friction: what a contact holds at rest, and what it holds while it slides.
#include "core/base/error.hpp"
#include "dem/laws/contact_laws.hpp"
#include "tests/dem/grain_cases.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace thalweg::dem::kinetic_friction_test {
namespace {

constexpr double g = 9.8, static_friction = 0.8, kinetic_friction = 0.2;
constexpr double no_rolling = 1.0;  // a rolling friction above the slopes

ContactParameters two_frictions(bool elastic) {
  ContactParameters contact = test::damped_glass(elastic);
  contact.friction = contact.wall_friction = static_friction;
  contact.kinetic_friction_ratio = kinetic_friction / static_friction;
  return contact;
}

GrainSeed sphere_with(double speed) {
  return test::glass_sphere(0, Vec3(0.01, 0.025, test::glass_radius), Vec3(speed, 0.0, 0.0));
}

double along_x(const GrainDynamics& grains) { return grains.store().velocity[0][0]; }

// F_t/F_n of a contact of the linear law that is pulled along x at these speeds (m/s), one a step.
std::vector<double> friction_of(const ContactParameters& contact, const std::vector<double>& speeds, double step) {
  std::vector<double> ratio;
  with_law({contact}, step, [&](const auto& law) {
    using ContactLaw = std::decay_t<decltype(law)>;
    typename ContactLaw::History history{};
    typename ContactLaw::Coefficients k{};
    if constexpr (requires { k.tangential_stiffness; }) {
      k.stiffness = contact.normal_stiffness, k.tangential_stiffness = contact.tangential_stiffness;
      k.friction = contact.friction;
    }
    for (const double speed : speeds) {
      const ContactMotion motion{.overlap = 1e-5,
                                 .nx = 0,
                                 .ny = 0,
                                 .nz = 1,
                                 .vx = speed,
                                 .vy = 0,
                                 .vz = 0,
                                 .effective_radius = test::glass_radius};
      const ContactLoad load = law(motion, k, typename ContactLaw::Constants{}, history);
      ratio.push_back(-load.tx / load.normal);
    }
  });
  return ratio;
}

// Slow: the spring grows by a hundredth of the difference of the two limits in a step. Without a memory of sliding it
// would swing between them.
TEST(KineticFriction, LastsAsLongAsTheContactSlides) {
  ContactParameters contact = test::glass(1.0);
  contact.friction = static_friction;
  contact.kinetic_friction_ratio = kinetic_friction / static_friction;
  const double step = 1e-6, normal = contact.normal_stiffness * 1e-5;
  const double growth = 0.01 * (static_friction - kinetic_friction);  // of F_t/F_n in a step
  const double speed = growth * normal / (contact.tangential_stiffness * step);
  std::vector<double> speeds(400, speed);
  speeds.insert(speeds.end(), 400, -speed);
  const std::vector<double> ratio = friction_of(contact, speeds, step);

  const auto steps_to = [growth](double from, double to) { return static_cast<int>((to - from) / growth); };
  const int sticks = steps_to(0.0, static_friction);
  for (int n = 0; n < sticks; ++n) EXPECT_NEAR(ratio[n], (n + 1) * growth, 1e-12);
  EXPECT_LE(*std::max_element(ratio.begin(), ratio.end()), static_friction * (1.0 + 1e-12));
  for (int n = sticks + 2; n < 400; ++n) EXPECT_NEAR(ratio[n], kinetic_friction, 1e-12) << n;
  // Turned back it sticks at once, up to the static limit on the other side, and slides there.
  const int back = steps_to(-static_friction, kinetic_friction);
  for (int n = 0; n < back; ++n) EXPECT_NEAR(ratio[400 + n], kinetic_friction - (n + 1) * growth, 1e-12) << n;
  for (int n = 400 + back + 2; n < 800; ++n) EXPECT_NEAR(ratio[n], -kinetic_friction, 1e-12) << n;
}

TEST(KineticFriction, OfOneIsFrictionAlone) {
  ContactParameters contact = test::glass(1.0);
  contact.kinetic_friction_ratio = 1.0;
  EXPECT_EQ(history_parts_of(LawChoice{contact}).size(), 1U);
  contact.kinetic_friction_ratio = 0.9;
  EXPECT_STREQ(history_parts_of(LawChoice{contact}).back().name, "sliding");
}

// tan between the two coefficients: a sphere that is set down stays, one that is pushed downwards gets faster by
// g (sin - mu_k cos), one that is pushed upwards slows down by g (sin + mu_k cos), stops and stays.
TEST(KineticFriction, HoldsABodyThatRestsAndNotOneThatSlides) {
  const double slope = 0.35, angle = std::atan(slope);
  const double down = g * (std::sin(angle) - kinetic_friction * std::cos(angle));
  const double up = g * (std::sin(angle) + kinetic_friction * std::cos(angle));
  for (const bool elastic : {false, true}) {
    const GrainParameters p = test::on_floor(two_frictions(elastic), no_rolling, slope);
    const auto after = [&p](double speed, double time) {
      GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {sphere_with(speed)});
      for (int n = 0; n < std::lround(time / 2.5e-4); ++n) test::step(grains);
      return grains.store().velocity[0][0];
    };
    EXPECT_NEAR(after(0.0, 0.5), 0.0, 1e-9);
    // The setting down takes 1e-2 s at most, in which the mean of |F_n| is the weight's.
    EXPECT_NEAR(after(0.1, 0.1), 0.1 + down * 0.1, 5e-3 * down * 0.1);
    EXPECT_NEAR(after(-0.2, 0.03), -0.2 + up * 0.03, 5e-3 * up * 0.03);
    EXPECT_NEAR(after(-0.2, 0.5), 0.0, 1e-9);
  }
}

// A sphere that hits the floor in gross sliding: the impulse across is mu_k times that along the normal. The spring is
// at the static limit after one sub-step; bound: ten such steps of a thousand at four times the kinetic friction.
TEST(KineticFriction, TakesItsShareInAnImpactThatSlides) {
  for (const bool elastic : {false, true}) {
    ContactParameters contact = two_frictions(elastic);
    contact.tangential_damping = 0.0;
    GrainParameters p = test::parameters(contact, elastic ? 3e-6 : 3e-7, 50, 5e-4);
    p.walls = {face_plane(test::cube().box(), 2, false, contact.wall_friction)};
    const Vec3 velocity(0.5, 0.0, -5e-4);
    const Vec3 above_floor(0.025, 0.025, test::glass_radius + 1e-9);
    GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {test::glass_sphere(0, above_floor, velocity)});
    for (int n = 0; n < 60; ++n) test::step(grains);
    const Vec3 change = grains.store().velocity[0] - velocity;
    EXPECT_GT(change[2], 5e-4);  // it has left the floor
    EXPECT_NEAR(-change[0], kinetic_friction * change[2], 3e-2 * kinetic_friction * change[2]);
  }
}

// A run that is stopped while the contact slides slides on with the same bits.
TEST(KineticFriction, IsAPartOfACheckpoint) {
  const GrainParameters p = test::on_floor(two_frictions(false), no_rolling, 0.35);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {sphere_with(0.05)});
  for (int n = 0; n < 80; ++n) test::step(grains);
  const thalweg::test::MemoryArchive archive = thalweg::test::saved(grains, MPI_COMM_SELF);
  EXPECT_EQ(std::get<std::vector<double>>(archive.datasets.at("grains/contact_sliding").values),
            std::vector<double>{1.0});
  GrainDynamics restarted(test::cube(), MPI_COMM_SELF, p, GrainSeeds{});
  thalweg::test::load(restarted, archive);
  for (int n = 0; n < 200; ++n) test::step(grains), test::step(restarted);
  EXPECT_GT(along_x(grains), 0.05);
  EXPECT_EQ(along_x(grains), along_x(restarted));
}

TEST(KineticFriction, ImpossibleRatiosAreRefused) {
  for (const double ratio : {0.0, -0.5, 1.1, std::nan("")}) {
    ContactParameters contact = test::glass(0.5);
    contact.kinetic_friction_ratio = ratio;
    EXPECT_THROW(check(contact), InputError) << ratio;
  }
  ContactParameters other = test::glass(0.5);
  other.kinetic_friction_ratio = 0.5;
  EXPECT_THROW(mixed(test::glass(0.5), other), InputError);
}

}  // namespace
}  // namespace thalweg::dem::kinetic_friction_test
