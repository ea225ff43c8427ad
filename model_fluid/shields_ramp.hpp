// A Shields number that is raised in small steps, and held as soon as grains move until all are at rest again: the
// second protocol of Clark et al. (2017). Motion that outlasts a given time is taken for motion without end; the
// Shields number is then the threshold of this bed.
#pragma once

#include "core/base/archive.hpp"

namespace thalweg::model_fluid {

struct ShieldsRampParameters {
  double step = 0.05;                 // relative, of the Shields number
  double every = 0.0;                 // s, at least, between two steps
  double hold = 0.0;                  // s, motion that lasts longer has no end
  double mobile_share = 1.0;          // of the grains; when more move, their motion has no end. 1: not looked at
  double largest_speed = 0.0;         // of v_0: grains that are slower
  double largest_acceleration = 0.0;  // m/s^2, and accelerated by less, are at rest
  double moving_speed = 0.0;          // m/s: grains that are faster move, for mobile_share
};

class ShieldsRamp {
public:
  explicit ShieldsRamp(const ShieldsRampParameters& parameters) : parameters_(parameters) {}

  // Raises the Shields number, if it is time, and returns true if it has. Call it after every step with the diagnostics
  // of all free grains, the speed in v_0 of the fluid as it is.
  bool advance(double time, double largest_speed, double largest_acceleration);

  // True if watch() is to be called after every step, with the share of free grains faster than moving_speed().
  bool watches_share() const { return parameters_.mobile_share < 1.0; }
  double moving_speed() const { return parameters_.moving_speed; }
  void watch(double moving_share) { mobile_ = has_risen() && moving_share > parameters_.mobile_share; }

  // The Shields number over that at the start.
  double factor() const { return factor_; }
  // s, until the motion since the last step counts as one without end; before the first step, all of `hold`.
  double hold_left(double time) const;

  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);

private:
  bool has_risen() const { return factor_ > 1.0; }

  ShieldsRampParameters parameters_;
  double factor_ = 1.0;
  double last_step_ = 0.0;  // s
  bool mobile_ = false;     // at the end of the last time step
};

}  // namespace thalweg::model_fluid
