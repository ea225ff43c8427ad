// Contact parameters of 5 mm glass spheres, boxes, and a step for the tests of the grains.
#pragma once

#include "core/parallel/mpi_session.hpp"
#include "dem/grain_dynamics.hpp"

#include <cmath>

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

// Glass with a tangential dashpot, so that the swing of the tangential spring dies out; elastic: Hertz and Mindlin.
inline ContactParameters damped_glass(bool elastic) {
  ContactParameters contact = glass(0.5);
  contact.tangential_damping = 1.0;
  if (elastic) {
    contact.law = Law::hertz_mindlin;
    contact.youngs_modulus = 5e6;
    contact.poisson_ratio = 0.3;
  }
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

// A floor of that cube under gravity (9.8 m/s^2) that leans by `slope` towards +x; 25 steps of 1e-5 s at a time.
inline GrainParameters on_floor(const ContactParameters& contact, double rolling_friction, double slope) {
  GrainParameters p = parameters(contact, 1e-5, 25);
  p.walls = {face_plane(cube().box(), 2, false, contact.wall_friction)};
  p.walls[0].rolling_friction = rolling_friction;
  const double angle = std::atan(slope);
  p.body_force = [angle](double mass, double) {
    return Vec3(9.8 * mass * std::sin(angle), 0.0, -9.8 * mass * std::cos(angle));
  };
  return p;
}

// One step of the caller.
inline void step(GrainDynamics& grains) {
  grains.prepare();
  grains.advance(grains.parameters().sub_steps);
  grains.refresh_ghosts();
}

}  // namespace thalweg::dem::test
