#include "dem/motion/moving_grains.hpp"

#include <cmath>

namespace thalweg::dem {

namespace {

constexpr Row zero{0.0, 0.0, 0.0, 0.0};

template <typename Load>
inline void kick(MovingGrain& grain, const Load& load, double half) {
  // The last entry of a load is the inverse mass or inertia, which is taken out again by the zero of first_three.
  grain.velocity += half * load.force[3] * first_three * (grain.force + load.force);
  grain.spin += half * load.torque[3] * first_three * (grain.torque + load.torque);
}

inline Row larger(const Row& a, const Row& b) { return a > b ? a : b; }

inline void move(MovingGrain& grain, double time_step) {
  grain.position += time_step * grain.velocity;
  grain.force = zero;
  grain.torque = zero;
}

}  // namespace

void MovingGrains::load(const GrainStore& store, std::span<const Vec3> body_force) {
  grains_.resize(store.total());
  loads_.resize(store.owned);
  for (std::size_t s = 0; s < store.total(); ++s)
    grains_[s] = {row_of(store.position[s], store.radius[s]), row_of(store.velocity[s]),
                  row_of(store.angular_velocity[s]), row_of(store.contact_force[s]), row_of(store.contact_torque[s])};
  for (std::size_t s = 0; s < store.owned; ++s)
    loads_[s] = {row_of(store.load_force[s] + body_force[s], store.inverse_mass[s]),
                 row_of(store.load_torque[s], store.inverse_inertia[s])};
}

void MovingGrains::unload(GrainStore& store) const {
  for (std::size_t s = 0; s < grains_.size(); ++s) {
    store.position[s] = vector_of(grains_[s].position);
    store.velocity[s] = vector_of(grains_[s].velocity);
    store.angular_velocity[s] = vector_of(grains_[s].spin);
  }
  for (std::size_t s = 0; s < loads_.size(); ++s) {
    store.contact_force[s] = vector_of(grains_[s].force);
    store.contact_torque[s] = vector_of(grains_[s].torque);
  }
}

void MovingGrains::half_kick(double time_step) {
  for (std::size_t s = 0; s < loads_.size(); ++s) kick(grains_[s], loads_[s], 0.5 * time_step);
}

void MovingGrains::drift(double time_step) {
  fastest_ = zero;
  for (std::size_t s = 0; s < loads_.size(); ++s) {
    move(grains_[s], time_step);
    fastest_ = larger(fastest_, grains_[s].velocity * grains_[s].velocity);
  }
  for (std::size_t s = loads_.size(); s < grains_.size(); ++s) grains_[s].force = grains_[s].torque = zero;
}

double MovingGrains::speed_bound(bool written) const {
  Row fastest = fastest_;
  for (std::size_t s = written ? 0 : loads_.size(); s < grains_.size(); ++s)
    fastest = larger(fastest, grains_[s].velocity * grains_[s].velocity);
  return std::sqrt(fastest[0] + fastest[1] + fastest[2]);
}

void MovingGrains::stop_along_floor(std::size_t slot) {
  MovingGrain& grain = grains_[slot];
  for (int axis = 0; axis < 2; ++axis) {
    grain.velocity[axis] = 0.0;
    grain.force[axis] = -loads_[slot].force[axis];
  }
  stopped_.push_back(slot);
}

void MovingGrains::forget_forces() {
  for (MovingGrain& grain : grains_) grain.force = grain.torque = zero;
}

void MovingGrains::two_half_kicks_and_drift(double time_step) {
  const double half = 0.5 * time_step;
  Row fastest = zero;
  for (std::size_t s = 0; s < loads_.size(); ++s) {
    MovingGrain grain = grains_[s];
    kick(grain, loads_[s], half);
    kick(grain, loads_[s], half);
    move(grain, time_step);
    fastest = larger(fastest, grain.velocity * grain.velocity);
    grains_[s] = grain;
  }
  fastest_ = fastest;
  for (std::size_t s = loads_.size(); s < grains_.size(); ++s) grains_[s].force = grains_[s].torque = zero;
}

}  // namespace thalweg::dem
