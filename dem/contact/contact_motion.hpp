// The relative motion of two grains, or of a grain and a wall, at their contact, one contact at a time. The loop over
// all pairs of a sub-step has the same formulas for many at once (contact_kernel.hpp).
//
// The lever arm of a grain reaches to the middle of the overlap (to the surface of a wall): l = R - delta/2.
#pragma once

#include "core/base/types.hpp"
#include "dem/laws/contact_law.hpp"
#include "dem/motion/grain_store.hpp"
#include "dem/motion/packed_grain_state.hpp"
#include "dem/motion/walls.hpp"

#include <Eigen/Geometry>

namespace thalweg::dem {

struct ContactBody {
  Vec3 velocity;  // m/s
  Vec3 spin;      // rad/s
  double radius;  // m
};

// Grains of a sub-step and those of the store, read in the same way.
inline Vec3 position_of(const PackedGrainState& grains, std::size_t slot) { return vector_of(grains[slot].position); }
inline Vec3 position_of(const GrainStore& store, std::size_t slot) { return store.position[slot]; }
inline double radius_of(const PackedGrainState& grains, std::size_t slot) { return grains[slot].position[3]; }
inline double radius_of(const GrainStore& store, std::size_t slot) { return store.radius[slot]; }
inline ContactBody body_of(const PackedGrainState& grains, std::size_t slot) {
  return {vector_of(grains[slot].velocity), vector_of(grains[slot].spin), grains[slot].position[3]};
}
inline ContactBody body_of(const GrainStore& store, std::size_t slot) {
  return {store.velocity[slot], store.angular_velocity[slot], store.radius[slot]};
}

// separation: from the second centre to the first, m, not zero. They touch where the overlap is positive.
inline ContactMotion motion_of(const ContactBody& first, const ContactBody& second, const Vec3& separation) {
  const double distance = separation.norm(), reach = first.radius + second.radius;
  const Vec3 n = separation / distance;
  const double overlap = reach - distance, half = 0.5 * overlap;
  const Vec3 turning = (first.radius - half) * first.spin + (second.radius - half) * second.spin;
  const Vec3 v = first.velocity - second.velocity - turning.cross(n);
  const Vec3 w = first.spin - second.spin;
  return {overlap, n[0], n[1], n[2], v[0], v[1], v[2], first.radius * second.radius / reach, w[0], w[1], w[2]};
}

// wall_velocity: m/s, of its surface there; wall_spin: rad/s.
inline ContactMotion motion_of(const ContactBody& grain, const WallView& wall, const Vec3& wall_velocity,
                               const Vec3& wall_spin) {
  const Vec3& n = wall.normal;
  const Vec3 v = grain.velocity - wall_velocity - wall.distance * grain.spin.cross(n);
  const Vec3 w = grain.spin - wall_spin;
  return {grain.radius - wall.distance, n[0], n[1], n[2], v[0], v[1], v[2], grain.radius, w[0], w[1], w[2]};
}

inline Vec3 normal_of(const ContactMotion& c) { return {c.nx, c.ny, c.nz}; }

}  // namespace thalweg::dem
