// Gear's predictor-corrector of six values: the second way to move grains.
//
// Of every grain the position and its first five derivatives are kept, scaled: q_k = dt^k/k! d^k x/dt^k. A step
// predicts them by Taylor's series, evaluates the forces once there, and corrects all by the difference between the
// acceleration found and the one predicted, q_k += c_k (a - a_predicted) dt^2/2, with
//   c = 3/16, 251/360, 1, 11/18, 1/6, 1/60,
// the values for forces that depend on the velocity (Allen & Tildesley, Computer Simulation of Liquids, 1987, app. E;
// Gear 1971). The rotation is treated in the same way, as an angle of which no value is kept. Smooth motion is followed
// to a higher order than by velocity Verlet; where forces begin and end with a contact it is not, and it does not
// conserve energy in the long run. SI units.
#pragma once

#include "dem/motion/grain_store.hpp"
#include "dem/motion/packed_grain_state.hpp"

#include <cstddef>
#include <vector>

namespace thalweg::dem {

class GearPredictor {
public:
  // Values a grain carries besides its position, velocity, spin and forces: q_3 to q_5 of position and angle. They are
  // the last columns attached to every grain, zero at first: a grain starts with constant acceleration.
  static constexpr int columns = 18;

  // Takes the higher derivatives of owned grains, and their accelerations by the present forces. grains: loaded from
  // the same store; time_step: s.
  void gather_from(const GrainStore& store, const PackedGrainState& grains, double time_step);
  void scatter_to(GrainStore& store) const;

  // Moves owned grains to the predicted state, and sets the contact forces of all grains to zero.
  void predict(PackedGrainState& grains);
  // Moves owned grains to the corrected state, by the forces at the predicted one; those that have been stopped stay
  // where they are along the floor.
  void correct(PackedGrainState& grains);

private:
  // q of the second to the fifth derivative of position (m) and angle (rad).
  struct Derivatives {
    Double4 q[4], angle[4];
  };
  double half_square() const { return 0.5 * time_step_ * time_step_; }

  double time_step_ = 0.0;
  std::vector<Derivatives> derivatives_;
};

}  // namespace thalweg::dem
