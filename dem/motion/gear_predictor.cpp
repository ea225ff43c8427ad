#include "dem/motion/gear_predictor.hpp"

namespace thalweg::dem {

namespace {

constexpr double of_position = 3.0 / 16.0, of_velocity = 251.0 / 360.0;
constexpr double of_higher[4] = {1.0, 11.0 / 18.0, 1.0 / 6.0, 1.0 / 60.0};

// Pascal's triangle on q_2 ... q_5; returns what they add to q_1 and, with that, to q_0.
struct Advance {
  Double4 first, zeroth;
};
inline Advance predicted(Double4 (&q)[4], const Double4& q1) {
  const Double4 first = q1 + 2.0 * q[0] + 3.0 * q[1] + 4.0 * q[2] + 5.0 * q[3];
  const Double4 zeroth = q1 + q[0] + q[1] + q[2] + q[3];
  q[0] += 3.0 * q[1] + 6.0 * q[2] + 10.0 * q[3];
  q[1] += 4.0 * q[2] + 10.0 * q[3];
  q[2] += 5.0 * q[3];
  return {first, zeroth};
}

// Corrects q_2 ... q_5 towards the q_2 found; returns the difference.
inline Double4 corrected(Double4 (&q)[4], const Double4& found) {
  const Double4 difference = found - q[0];
  for (int k = 0; k < 4; ++k) q[k] += of_higher[k] * difference;
  return difference;
}

// dt^2/2 times the acceleration (of the rotation); the last entry of a load is the inverse mass or moment of inertia.
inline Double4 found(const Double4& contacts, const Double4& load, double half_square) {
  return half_square * load[3] * first_three * (contacts + load);
}

}  // namespace

void GearPredictor::gather_from(const GrainStore& store, const PackedGrainState& grains, double time_step) {
  time_step_ = time_step;
  derivatives_.resize(store.owned);
  for (std::size_t s = 0; s < store.owned; ++s) {
    Derivatives& d = derivatives_[s];
    d.q[0] = found(grains[s].force, grains.load_force(s), half_square());
    d.angle[0] = found(grains[s].torque, grains.load_torque(s), half_square());
    const double* value = store.attached_of(s).data() + store.attached_width - columns;
    for (int k = 1; k < 4; ++k, value += 3) d.q[k] = Double4{value[0], value[1], value[2], 0.0};
    for (int k = 1; k < 4; ++k, value += 3) d.angle[k] = Double4{value[0], value[1], value[2], 0.0};
  }
}

void GearPredictor::scatter_to(GrainStore& store) const {
  for (std::size_t s = 0; s < store.owned; ++s) {
    double* value = store.attached_of(s).data() + store.attached_width - columns;
    for (const auto* rows : {&derivatives_[s].q, &derivatives_[s].angle})
      for (int k = 1; k < 4; ++k)
        for (int axis = 0; axis < 3; ++axis) *value++ = (*rows)[k][axis];
  }
}

void GearPredictor::predict(PackedGrainState& grains) {
  grains.forget_forces();
  for (std::size_t s = 0; s < derivatives_.size(); ++s) {
    PackedGrain& grain = grains[s];
    const Advance way = predicted(derivatives_[s].q, time_step_ * grain.velocity);
    const Advance turn = predicted(derivatives_[s].angle, time_step_ * grain.spin);
    grain.position += way.zeroth;
    grain.velocity = way.first / time_step_;
    grain.spin = turn.first / time_step_;
  }
}

void GearPredictor::correct(PackedGrainState& grains) {
  for (const std::size_t s : grains.stopped())
    for (Double4& q : derivatives_[s].q) q[0] = q[1] = 0.0;
  for (std::size_t s = 0; s < derivatives_.size(); ++s) {
    PackedGrain& grain = grains[s];
    const Double4 way = corrected(derivatives_[s].q, found(grain.force, grains.load_force(s), half_square()));
    const Double4 turn = corrected(derivatives_[s].angle, found(grain.torque, grains.load_torque(s), half_square()));
    grain.position += of_position * way;
    grain.velocity += of_velocity / time_step_ * way;
    grain.spin += of_velocity / time_step_ * turn;
  }
}

}  // namespace thalweg::dem
