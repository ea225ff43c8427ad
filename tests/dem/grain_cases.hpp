// Contact parameters of 5 mm glass spheres, boxes, and a step for the tests of the grains.
#pragma once

#include "core/parallel/mpi_session.hpp"
#include "dem/grain_dynamics.hpp"

namespace thalweg::dem::test {

inline constexpr double glass_density = 2550.0;  // kg/m^3
inline constexpr double glass_radius = 2.5e-3;   // m

inline ContactParameters glass(double restitution, bool attraction = false) {
  ContactParameters contact;
  contact.normal_stiffness = 20000.0;
  contact.tangential_stiffness = 2.0 / 7.0 * 20000.0;
  contact.restitution = restitution;
  contact.friction = 0.5;
  contact.wall_friction = 0.5;
  contact.attraction = attraction;
  return contact;
}

inline GrainSeed glass_sphere(GlobalId id, const Vec3& position, const Vec3& velocity = Vec3::Zero(),
                              double radius = glass_radius) {
  GrainSeed seed;
  seed.id = id;
  seed.radius = radius;
  seed.density = glass_density;
  seed.position = position;
  seed.velocity = velocity;
  return seed;
}

// time_step: s; skin: m.
inline GrainParameters parameters(const ContactParameters& contact, double time_step, int sub_steps,
                                  double skin = 1e-3) {
  GrainParameters p;
  p.contact = contact;
  p.time_step = time_step;
  p.sub_steps = sub_steps;
  p.skin = skin;
  return p;
}

// A cube of 20 x 20 x 20 cells, 50 mm wide, periodic along x and y, on one rank.
inline Decomposition cube(bool periodic_z = false) {
  return Decomposition({20, 20, 20}, 2.5e-3, {true, true, periodic_z}, {1, 1, 1});
}

// One step of the caller.
inline void step(GrainDynamics& grains) {
  grains.prepare();
  grains.advance(grains.parameters().sub_steps);
  grains.refresh_ghosts();
}

}  // namespace thalweg::dem::test
