// A body force that holds a target mean velocity, in place of a given force.
//
// With e = target - mean of rho u over the fluid cells, T the response time and k the interval between updates:
//   integral += k e,   F = e/T + integral/(4 T^2).
// On fluid that answers a force by du/dt = F this is the critically damped oscillator e'' + e'/T + e/(4 T^2) = 0;
// whatever resists the flow is taken up by the integral, so that e vanishes in a steady state. With a drag F = -l u
// that takes a time of 4 T^2 l if T l is above 1: choose T no longer than the flow itself needs to come to rest.
#pragma once

#include "core/base/archive.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace thalweg::lbm {

struct FlowTarget {
  int axis = 0;
  double velocity = 0.0;          // mean of rho u over fluid cells, lattice units
  double response_time = 1000.0;  // T, steps
  int interval = 10;              // k, steps
};

class FlowControl {
public:
  // Throws InputError unless the interval is at least 1 and the response time at least ten intervals (stability).
  explicit FlowControl(const FlowTarget& target);

  const FlowTarget& target() const { return target_; }
  double force() const { return force_; }  // density of the force along the axis, lattice units

  // True once in every interval of steps; call it once a step.
  bool due() { return countdown_-- <= 0; }
  // Takes the mean velocity along the axis; sets the force for the next interval.
  void update(double mean_velocity);
  // The force of a control: `held` balances what resists the flow, the rest answers the error of the moment.
  struct Force {
    double whole, held;
  };
  // Begins with a force (lattice units); of a flow that goes on as it was, the next force is what it would have been.
  void begin_with(const Force& force);
  // The force that was saved, in its lattice units: of a control or, of a flow that none controlled, the given one
  // along the axis. None in older checkpoints of such flows.
  static std::optional<Force> saved_force(const ArchiveReader& archive, int axis);
  // Attribute of a given force along an axis.
  static std::string name_of_force(int axis);

  void save(ArchiveWriter& archive) const;
  // Goes on with the force of a control with another response time.
  void load(ArchiveReader& archive);

private:
  // Brings the integral from another response time (steps) to this one, so that at the same error the force is the
  // same.
  void go_on_from(double response_time);

  FlowTarget target_;
  double integral_ = 0.0, force_ = 0.0;
  std::int64_t countdown_ = 0;
};

}  // namespace thalweg::lbm
