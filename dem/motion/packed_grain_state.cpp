#include "dem/motion/packed_grain_state.hpp"

#include <cmath>

namespace thalweg::dem {

namespace {

constexpr Double4 zero{0.0, 0.0, 0.0, 0.0};

template <typename Load>
inline void kick(PackedGrain& grain, const Load& load, double half) {
  // The last entry of a load is the inverse mass or inertia, which is taken out again by the zero of first_three.
  grain.velocity += half * load.force[3] * first_three * (grain.force + load.force);
  grain.spin += half * load.torque[3] * first_three * (grain.torque + load.torque);
}

inline Double4 larger(const Double4& a, const Double4& b) { return a > b ? a : b; }

inline void move(PackedGrain& grain, double time_step) {
  grain.position += time_step * grain.velocity;
  grain.force = zero;
  grain.torque = zero;
}

}  // namespace

void PackedGrainState::gather_from(const GrainStore& store, std::span<const Vec3> body_force) {
  grains_.resize(store.total());
  loads_.resize(store.owned);
  for (std::size_t s = 0; s < store.total(); ++s)
    grains_[s] = {double4(store.position[s], store.radius[s]), double4(store.velocity[s]),
                  double4(store.angular_velocity[s]), double4(store.contact_force[s]),
                  double4(store.contact_torque[s])};
  for (std::size_t s = 0; s < store.owned; ++s)
    loads_[s] = {double4(store.load_force[s] + body_force[s], store.inverse_mass[s]),
                 double4(store.load_torque[s], store.inverse_inertia[s])};
}

void PackedGrainState::scatter_to(GrainStore& store) const {
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

void PackedGrainState::half_kick(double time_step) {
  for (std::size_t s = 0; s < loads_.size(); ++s) kick(grains_[s], loads_[s], 0.5 * time_step);
}

void PackedGrainState::drift(double time_step) {
  fastest_ = zero;
  for (std::size_t s = 0; s < loads_.size(); ++s) {
    move(grains_[s], time_step);
    fastest_ = larger(fastest_, grains_[s].velocity * grains_[s].velocity);
  }
  for (std::size_t s = loads_.size(); s < grains_.size(); ++s) grains_[s].force = grains_[s].torque = zero;
}

double PackedGrainState::speed_bound(bool written) const {
  Double4 fastest = fastest_;
  for (std::size_t s = written ? 0 : loads_.size(); s < grains_.size(); ++s)
    fastest = larger(fastest, grains_[s].velocity * grains_[s].velocity);
  return std::sqrt(fastest[0] + fastest[1] + fastest[2]);
}

void PackedGrainState::stop_along_floor(std::size_t slot) {
  PackedGrain& grain = grains_[slot];
  for (int axis = 0; axis < 2; ++axis) {
    grain.velocity[axis] = 0.0;
    grain.force[axis] = -loads_[slot].force[axis];
  }
}

void PackedGrainState::two_half_kicks_and_drift(double time_step) {
  const double half = 0.5 * time_step;
  Double4 fastest = zero;
  for (std::size_t s = 0; s < loads_.size(); ++s) {
    PackedGrain grain = grains_[s];
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
