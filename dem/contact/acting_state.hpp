// Velocities that the contact forces of the last sub-step were evaluated with, kept for observers. Velocity Verlet
// evaluates them in the middle of the sub-step, and the store has those of its end: with these the forces of single
// contacts are, to rounding, the terms of the sum that moved the grain.
#pragma once

#include "dem/contact/contact_motion.hpp"
#include "dem/contact/solid.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace thalweg::dem {

struct ActingVelocity {
  Vec3 velocity;  // m/s
  Vec3 spin;      // rad/s
};

struct ActingState {
  std::vector<ActingVelocity> grains;  // of every slot; empty: unknown
  std::vector<Plane> walls;            // where the grains are known
  std::vector<PlacedSolid> solids;
};

// Grains of the store with these velocities in place of their own, if there are any.
struct ActingGrains {
  const GrainStore& store;
  std::span<const ActingVelocity> velocities;  // of every slot, or empty
};

inline Vec3 position_of(const ActingGrains& grains, std::size_t slot) { return grains.store.position[slot]; }
inline double radius_of(const ActingGrains& grains, std::size_t slot) { return grains.store.radius[slot]; }
inline ContactBody body_of(const ActingGrains& grains, std::size_t slot) {
  if (grains.velocities.empty()) return body_of(grains.store, slot);
  return {grains.velocities[slot].velocity, grains.velocities[slot].spin, grains.store.radius[slot]};
}

}  // namespace thalweg::dem
