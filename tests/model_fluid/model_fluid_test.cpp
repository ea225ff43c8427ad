#include "model_fluid/model_fluid_field.hpp"
#include "model_fluid/model_fluid_keys.hpp"
#include "model_fluid/sphere_overlap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace thalweg::model_fluid::model_fluid_test {
namespace {

using namespace dem;

constexpr double pi = std::numbers::pi;

// Two unit spheres a radius apart share 5 pi/12, two unit disks 2 pi/3 - sqrt(3)/2; half a sphere is above its centre.
TEST(Lens, KnownVolumesAndAreas) {
  EXPECT_NEAR(common_volume(1.0, 1.0, 1.0), 5.0 * pi / 12.0, 1e-14);
  EXPECT_NEAR(common_area(1.0, 1.0, 1.0), 2.0 * pi / 3.0 - 0.5 * std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(common_volume(2.0, 0.5, 0.1), 4.0 / 3.0 * pi * 0.125, 1e-15);  // one inside the other
  EXPECT_NEAR(common_area(2.0, 0.5, 0.1), pi * 0.25, 1e-15);
  EXPECT_EQ(common_volume(1.0, 1.0, 2.0), 0.0);
  EXPECT_EQ(common_area(1.0, 1.0, 2.5), 0.0);
  EXPECT_NEAR(common_volume(1.5, 0.5, 1.0 + 1e-9), 4.0 / 3.0 * pi * 0.125, 1e-8);  // touching from inside
  EXPECT_NEAR(volume_above(2.0, 0.0), 2.0 / 3.0 * pi * 8.0, 1e-13);
  EXPECT_NEAR(volume_above(1.0, 5.0), 4.0 / 3.0 * pi, 1e-15);
  EXPECT_NEAR(volume_above(1.0, 0.3) + volume_above(1.0, -0.3), 4.0 / 3.0 * pi, 1e-15);
  EXPECT_NEAR(area_above(1.0, 0.3) + area_above(1.0, -0.3), pi, 1e-15);
  EXPECT_NEAR(area_above(1.0, 0.0), 0.5 * pi, 1e-15);
}

// Definitions: Theta = 2/3 (B_1 v_0 + B_2 v_0^2)/(m g'), Re_* = sqrt(3) m/B_1 sqrt(Theta g'/D). Table I of the
// paper has Re_p = 30 Re_* at large Re_*, which is B_2 = m/(2 D).
TEST(ModelFluid, CoefficientsGiveBackTheirNumbers) {
  const GrainScales s{2e-3, 3e-5, 6.0};
  for (const ModelDrag drag : {ModelDrag::linear, ModelDrag::quadratic})
    for (const double reynolds : {1e-2, 1.0, 100.0})
      for (const double shields : {0.05, 0.3}) {
        const ModelFluidCoefficients c = coefficients_of({shields, reynolds, 2.0, drag, 0.5}, s);
        const double force = c.viscous * c.velocity + c.inertial * c.velocity * c.velocity;
        EXPECT_NEAR(2.0 / 3.0 * force / (s.mass * s.gravity), shields, 1e-12 * shields);
        EXPECT_NEAR(std::sqrt(3.0) * s.mass / c.viscous * std::sqrt(shields * s.gravity / s.diameter), reynolds,
                    1e-12 * reynolds);
        EXPECT_NEAR(c.lift / force, 2.0, 1e-12);
      }
  const ModelFluidCoefficients fast = coefficients_of({0.1, 1e6, 0.0, ModelDrag::quadratic, 0.5}, {1.0, 1.0, 1.0});
  EXPECT_NEAR(particle_reynolds(fast) / 1e6, 30.0, 1e-3);
}

// f(phi_t) = 1, f(phi_m) = 0; [exp(-3) - exp(-3.5)]/[exp(-2.1) - exp(-3.5)] = 0.2123 and 8.679 at 1/27; of disks
// exp(5 (1/2 - 1/9)) = 6.989.
TEST(ModelFluid, VelocityFallsOffWithTheSolidFraction) {
  const VelocityProfile spheres = VelocityProfile::of_spheres(), disks = VelocityProfile::of_disks();
  EXPECT_NEAR(spheres(0.42), 1.0, 1e-15);
  EXPECT_NEAR(spheres(0.7), 0.0, 1e-15);
  EXPECT_EQ(spheres(0.8), 0.0);
  EXPECT_NEAR(spheres(0.6), 0.2123, 1e-4);
  EXPECT_NEAR(spheres(1.0 / 27.0), 8.679, 1e-3);
  EXPECT_NEAR(disks(0.5), 1.0, 1e-15);
  EXPECT_NEAR(disks(1.0 / 9.0), 6.989, 1e-3);
}

// Drag along the velocity of the fluid relative to the grain, with |w| of all components; sizes as D and D^2.
TEST(ModelFluid, ForceOnAGrainByHand) {
  const ModelFluidCoefficients c{2.0, 3.0, 5.0, 1.0};
  const ModelForce f = model_force(c, 1.5, 4.0, 1.0, 0.0, -4.0, 0.5);  // w = (3, 0, 4), |w| = 5
  const double drag = 2.0 * 1.5 + 3.0 * 2.25 * 5.0;
  EXPECT_NEAR(f.x, drag * 3.0, 1e-13);
  EXPECT_NEAR(f.y, 0.0, 1e-13);
  EXPECT_NEAR(f.z, drag * 4.0 + 5.0 * 2.25 * 0.5, 1e-13);
}

// A packing in a box so narrow that a grain's neighbourhood meets two images of another, or disks in a box as thick as
// they are; some of it is cut by the floor.
struct Packing {
  PeriodicBox box{Vec3(3.0, 4.0, 6.0), {true, true, false}};
  GrainStore store{4};
  PackedGrainState moving;
  SolidFractionParameters parameters;

  explicit Packing(bool disks) {
    if (disks) box.size[1] = 1.0;
    const double radii[2] = {6.0 / 11.0, 5.0 / 11.0};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int n = 0; n < 40; ++n)
      store.append(
          n, radii[n % 2], 1.0, Motion::free,
          Vec3(box.size[0] * uniform(random), disks ? 0.5 : box.size[1] * uniform(random), 4.0 * uniform(random)));
    store.owned = store.total();
    moving.gather_from(store, std::vector<Vec3>(store.total(), Vec3::Zero()));
    parameters = {radii[0], 2.0 * radii[0], 0.01, disks, true};
  }

  // In plain numbers, relative to a point: the count below takes millions of them, and vectors ten times as long under
  // sanitizers.
  struct Sphere {
    double x, y, z, radius;
  };

  // All images of grains that reach into a sphere, relative to its centre.
  std::vector<Sphere> images_near(const Vec3& centre, double radius) const {
    std::vector<Sphere> near;
    const int across = parameters.disks ? 0 : 2;
    for (std::size_t grain = 0; grain < store.total(); ++grain)
      for (int i = -2; i <= 2; ++i)
        for (int j = -across; j <= across; ++j) {
          const Vec3 away = store.position[grain] + Vec3(i * box.size[0], j * box.size[1], 0.0) - centre;
          if (away.norm() < radius + store.radius[grain])
            near.push_back({away.x(), away.y(), away.z(), store.radius[grain]});
        }
    return near;
  }

  // Counted at points of the R3 sequence (M. Roberts, 2018): their number k times the powers of 1/1.2207..., the root
  // of x^4 = x + 1, modulo 1. Overlaps count twice, as in the sum of common volumes.
  double counted(std::size_t slot, const Vec3& shift, int points) const {
    constexpr double root = 1.22074408460575947536;
    const Vec3 step(1.0 / root, 1.0 / (root * root), 1.0 / (root * root * root));
    const double radius = store.radius[slot] + parameters.margin;
    const Vec3 centre = store.position[slot] + shift;
    const std::vector<Sphere> spheres = images_near(centre, radius);
    std::int64_t inside = 0, solid = 0;
    const auto at = [&](int k, int axis) {  // of point k, relative to the centre
      const double turns = k * step[axis];
      return radius * (2.0 * (turns - std::floor(turns)) - 1.0);
    };
    for (int k = 1; k <= points; ++k) {
      const double x = at(k, 0), y = parameters.disks ? 0.0 : at(k, 1), z = at(k, 2);
      if (x * x + y * y + z * z > radius * radius || centre.z() + z < 0.0) continue;
      ++inside;
      for (const Sphere& s : spheres) {
        const double dx = x - s.x, dy = y - s.y, dz = z - s.z;
        solid += dx * dx + dy * dy + dz * dz < s.radius * s.radius;
      }
    }
    return static_cast<double>(solid) / static_cast<double>(inside);
  }
};

// Grains that reach below the floor count whole in the sum of common volumes; these are lifted above it.
void lift_above_floor(Packing& packing) {
  for (std::size_t s = 0; s < packing.store.total(); ++s)
    packing.store.position[s].z() = std::max(packing.store.position[s].z(), packing.store.radius[s]);
  packing.moving.gather_from(packing.store, std::vector<Vec3>(packing.store.total(), Vec3::Zero()));
}

// The count of evenly spread points in a sphere errs by about points^(-2/3) = 1e-4 of its share, and a dozen spheres
// overlap here.
TEST(LocalSolidFraction, IsTheShareOfPoints) {
  for (const bool disks : {false, true}) {
    Packing packing(disks);
    lift_above_floor(packing);
    LocalSolidFraction fraction(packing.box, packing.parameters);
    fraction.find_neighbours(packing.store, 0.1, Clumps());
    fraction.update(packing.moving, Clumps(), packing.store);
    for (const std::size_t slot : {0u, 1u, 2u, 3u}) {
      const Vec3 up(0.0, 0.0, packing.store.radius[slot]);
      EXPECT_NEAR(fraction.around(slot), packing.counted(slot, Vec3::Zero(), 1000000), 1e-3);
      EXPECT_NEAR(fraction.below_less_above(slot),
                  packing.counted(slot, -up, 1000000) - packing.counted(slot, up, 1000000), 2e-3);
    }
  }
}

// After any motion it is what a new start at the remembered positions finds, and those are within the tolerance.
TEST(LocalSolidFraction, FollowsTheGrainsToATolerance) {
  Packing packing(false);
  lift_above_floor(packing);
  LocalSolidFraction fraction(packing.box, packing.parameters);
  fraction.find_neighbours(packing.store, 0.5, Clumps());
  fraction.update(packing.moving, Clumps(), packing.store);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.008, 0.008);
  for (int step = 0; step < 20; ++step) {
    for (std::size_t s = 0; s < packing.moving.size(); s += 3)
      packing.moving[s].position += double4(Vec3(uniform(random), uniform(random), uniform(random)));
    fraction.update(packing.moving, Clumps(), packing.store);
  }
  Packing fresh(false);
  for (std::size_t s = 0; s < fresh.store.total(); ++s) {
    fresh.store.position[s] = Vec3::Map(packing.store.attached_of(s).data());
    const Vec3 now = vector_of(packing.moving[s].position);
    EXPECT_LE((now - fresh.store.position[s]).norm(), packing.parameters.tolerance * (1.0 + 1e-12));
  }
  fresh.moving.gather_from(fresh.store, std::vector<Vec3>(fresh.store.total(), Vec3::Zero()));
  LocalSolidFraction again(fresh.box, fresh.parameters);
  again.find_neighbours(fresh.store, 0.5, Clumps());
  again.update(fresh.moving, Clumps(), fresh.store);
  for (std::size_t s = 0; s < fresh.store.total(); ++s) EXPECT_EQ(fraction.around(s), again.around(s));
}

}  // namespace
}  // namespace thalweg::model_fluid::model_fluid_test
