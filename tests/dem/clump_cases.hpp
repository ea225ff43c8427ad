// Shapes, seeds and angular momentum for the tests of clumps.
#pragma once

#include "core/base/counter_random.hpp"
#include "dem/clumps/clump_seed.hpp"
#include "tests/dem/grain_cases.hpp"

#include <memory>
#include <vector>

namespace thalweg::dem::test {

inline std::shared_ptr<const ClumpShape> shape_of(const std::vector<PlacedSphere>& members, double thickness = 0.0) {
  return std::make_shared<const ClumpShape>(clump_shape(members, thickness));
}

// Two spheres of 4 mm, 3 mm apart.
inline std::shared_ptr<const ClumpShape> dumbbell() {
  return shape_of({{{0, 0, -1.5e-3}, 2e-3}, {{0, 0, 1.5e-3}, 2e-3}});
}

// Three different moments of inertia, and no plane of symmetry but one.
inline std::shared_ptr<const ClumpShape> pebble() {
  return shape_of({{{0, 0, 0}, 2e-3}, {{1.8e-3, 0.3e-3, 0}, 1.5e-3}, {{-0.5e-3, 2e-3, 0}, 1.2e-3}});
}

inline ClumpSeed glass_clump(GlobalId id, std::shared_ptr<const ClumpShape> shape, const Vec3& position,
                             const Vec3& velocity = Vec3::Zero(), const Vec3& angular_velocity = Vec3::Zero()) {
  ClumpSeed seed;
  seed.id = id;
  seed.shape = std::move(shape);
  seed.density = glass_density;
  seed.position = position;
  seed.velocity = velocity;
  seed.angular_velocity = angular_velocity;
  return seed;
}

// Any orientation: a quaternion from four draws.
inline Quaternion some_orientation(int number) {
  const auto draw = [number](int n) { return 2.0 * uniform_random(17, number, n) - 1.0; };
  return normalised({draw(0), draw(1), draw(2), draw(3)});
}

// About the origin of the box; kg m^2/s. Without periodic axes.
inline Vec3 angular_momentum(const GrainDynamics& grains) {
  const GrainStore& store = grains.store();
  Vec3 sum = Vec3::Zero();
  for (std::size_t s = 0; s < store.owned; ++s)
    if (store.clump[s] < 0)
      sum += store.mass[s] * store.position[s].cross(store.velocity[s]) + store.inertia[s] * store.angular_velocity[s];
  for (std::size_t n = 0; n < grains.clumps().size(); ++n) {
    const Clump& clump = grains.clumps()[n];
    sum += clump.mass * clump.centre.cross(clump.velocity) +
           angular_momentum_of(clump.orientation, clump.angular_velocity, clump.moments);
  }
  return sum;
}

}  // namespace thalweg::dem::test
