// Grain state during the sub-steps, packed so that a contact finds all of a grain in neighbouring cache lines and
// takes three components with one load. It holds all grains that a rank knows. GrainStore has the same numbers for all
// other code; they are copied here before the sub-steps of a fluid step and back after them.
#pragma once

#include "dem/motion/grain_store.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::dem {

// Four doubles in one register: x, y, z and one more.
using Double4 = double __attribute__((vector_size(32)));

inline constexpr Double4 first_three{1.0, 1.0, 1.0, 0.0};  // as a factor: without the last entry
inline Double4 double4(const Vec3& v, double last = 0.0) { return Double4{v[0], v[1], v[2], last}; }
inline Vec3 vector_of(const Double4& r) { return {r[0], r[1], r[2]}; }

struct PackedGrain {
  Double4 position;  // m; last: radius, m
  Double4 velocity;  // m/s; last: 0
  Double4 spin;      // rad/s; last: 0
  Double4 force;     // N, of contacts; last: 0
  Double4 torque;    // N m, of contacts; last: 0
};

class PackedGrainState {
public:
  // Copies the state of all grains and the loads of owned ones. body_force: N, of owned grains.
  void gather_from(const GrainStore& store, std::span<const Vec3> body_force);

  // Copies position, velocity and spin of all grains back, and the contact forces of owned ones.
  void scatter_to(GrainStore& store) const;

  // v += dt/2 F/m, w += dt/2 T/I of owned grains (s).
  void half_kick(double time_step);
  // x += dt v of owned grains; sets the contact forces of all grains to zero.
  void drift(double time_step);
  // half_kick(), half_kick(), drift(): from the end of one sub-step to the forces of the next, in one pass.
  void two_half_kicks_and_drift(double time_step);

  // Replaces the force (N) on an owned grain besides its contacts, until the next gather_from().
  void set_load(std::size_t slot, const Vec3& force) { loads_[slot].force = double4(force, loads_[slot].force[3]); }

  // An owned grain does not move along the floor, in x and y: stops it, and has its contacts take the load along them.
  void stop_along_floor(std::size_t slot);

  // Upper bound of the present speeds (m/s) of ghosts and of owned grains, for the latter at the last drift;
  // `written`: velocities have been written since, so all are searched.
  double speed_bound(bool written) const;

  std::size_t size() const { return grains_.size(); }
  PackedGrain* data() { return grains_.data(); }
  const PackedGrain& operator[](std::size_t slot) const { return grains_[slot]; }
  PackedGrain& operator[](std::size_t slot) { return grains_[slot]; }

private:
  // Load on an owned grain besides its contacts, with its inverse mass and inertia.
  struct Load {
    Double4 force;   // N; last: 1/m, 1/kg
    Double4 torque;  // N m; last: 1/I, 1/(kg m^2)
  };

  std::vector<PackedGrain> grains_;
  std::vector<Load> loads_;
  Double4 fastest_{};  // of the last drift: the largest squares of the components of a velocity
};

}  // namespace thalweg::dem
