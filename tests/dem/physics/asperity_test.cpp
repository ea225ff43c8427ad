// Grains of Clark et al. (2017) whose friction is geometry: n frictionless disks of diameter d on a circle of radius a.
// Their effective coefficient of friction from a sliding test, against its closed form and table II of the paper.
#include "tests/dem/clump_cases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::dem::asperity_test {
namespace {

struct Model {
  int disks;
  double ratio;      // a/d
  double published;  // effective friction, table II
};

constexpr Model models[] = {{2, 0.1, 0.2},  {2, 0.2, 0.42}, {2, 0.4, 1.06}, {3, 0.2, 0.33}, {3, 0.4, 0.7},
                            {3, 0.5, 0.93}, {3, 0.75, 2.0}, {4, 0.5, 0.65}, {4, 0.75, 1.1}, {4, 1.0, 2.0},
                            {5, 0.1, 0.11}, {5, 0.4, 0.4},  {5, 0.6, 0.6}};

// Two grains that face each other with the gap between two disks, one shifted by half the distance s of these, in
// diameters: a disk of each lies in the other's gap. The line of centres leans by `lean` to the one side, and the
// contact that holds them at the limit by `contact` to the other.
struct Interlocked {
  explicit Interlocked(const Model& m)
      : s(m.ratio * std::sin(std::numbers::pi / m.disks)), c(m.ratio * std::cos(std::numbers::pi / m.disks)) {}
  double s, c;
  double q() const { return std::sqrt(1.0 - s * s); }
  double lean() const { return std::atan(s / (2.0 * c + q())); }
  double contact() const { return std::asin(s); }
  double friction() const { return std::tan(lean() + contact()); }
};

TEST(Asperities, ClosedFormIsThatOfThePaper) {
  // mu = s (c + q)/[q c + (q^2 - s^2)/2]. The paper prints two digits, of values above 1 sometimes one.
  for (const Model& m : models) {
    const Interlocked pair(m);
    const double s = pair.s, c = pair.c, q = pair.q();
    EXPECT_NEAR(pair.friction(), s * (c + q) / (q * c + 0.5 * (q * q - s * s)), 1e-12 * pair.friction());
    EXPECT_NEAR(pair.friction(), m.published, std::max(0.02 * m.published, 0.006)) << m.disks << " " << m.ratio;
  }
}

constexpr double diameter = 1e-3, thickness = 1e-3;  // m

std::shared_ptr<const ClumpShape> ring(const Model& m) {
  std::vector<PlacedSphere> disks;
  for (int n = 0; n < m.disks; ++n) {
    const double angle = (2 * n + 1) * std::numbers::pi / m.disks;
    const double a = m.ratio * diameter;
    disks.push_back({{a * std::sin(angle), 0.0, a * std::cos(angle)}, 0.5 * diameter});
  }
  return test::shape_of(disks, thickness);
}

// True if the upper of two interlocked grains, which cannot turn, leaves its place under a load that pulls it along
// with `friction` times what presses it on the lower one.
bool slides(const Model& m, double friction) {
  // So light that springing back at the start, an overlap of 5e-7 diameters, lifts nothing out of the shallowest gap:
  // 2 % below the limit the way out of it still rises by 2e-6 diameters.
  constexpr double weight_per_mass = 0.2;  // m/s^2
  const Interlocked pair(m);
  const double angle = pair.lean() - std::atan(friction);  // of what the load is opposite to, from the upright
  const Vec3 load = -weight_per_mass * Vec3(std::sin(angle), 0.0, std::cos(angle));

  GrainParameters p = test::parameters(test::glass(0.3), 2e-6, 50, 0.1 * diameter);
  p.contact.normal_stiffness = 1000.0;
  p.contact.tangential_stiffness = 1000.0;
  p.contact.friction = 0.0;
  p.disk_thickness = thickness;
  p.body_force = [load](double mass, double /*radius*/) { return Vec3(mass * load); };

  const Decomposition plane({10, 2, 10}, 2e-3, {false, true, false}, {1, 1, 1});
  const Vec3 middle(0.01, 0.002, 0.01);
  ClumpSeed lower = test::glass_clump(0, ring(m), middle);
  lower.motion = Motion::fixed;
  ClumpSeed upper = test::glass_clump(m.disks, ring(m), middle + diameter * Vec3(pair.s, 0.0, 2.0 * pair.c + pair.q()));
  upper.orientation = {0.0, 0.0, 1.0, 0.0};  // half a turn about y
  upper.motion = Motion::held_rotation;
  GrainDynamics grains(plane, MPI_COMM_SELF, p, {}, {lower, upper});
  const Vec3 start = grains.clumps()[1].centre;
  // A load 2 % above the limit accelerates it by 4e-4 m/s^2 or more, which takes at most 0.3 s for 2 % of a diameter.
  for (int n = 0; n < 3200; ++n) {
    test::step(grains);
    if ((grains.clumps()[1].centre - start).norm() > 0.02 * diameter) return true;
  }
  return false;
}

TEST(Asperities, SlideAtTheirEffectiveFriction) {
  for (const Model& m : models) {
    const double friction = Interlocked(m).friction();
    EXPECT_FALSE(slides(m, 0.98 * friction)) << m.disks << " disks, a/d " << m.ratio;
    EXPECT_TRUE(slides(m, 1.02 * friction)) << m.disks << " disks, a/d " << m.ratio;
  }
}

}  // namespace
}  // namespace thalweg::dem::asperity_test
