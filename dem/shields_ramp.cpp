#include "dem/shields_ramp.hpp"

#include <cmath>

namespace thalweg::dem {

bool ShieldsRamp::advance(double time, double largest_speed, double largest_acceleration) {
  const bool at_rest =
      largest_speed < parameters_.largest_speed && largest_acceleration < parameters_.largest_acceleration;
  if (!at_rest || time - last_step_ < parameters_.every) return false;
  ++steps_;
  last_step_ = time;
  return true;
}

double ShieldsRamp::hold_left(double time) const {
  if (mobile_) return 0.0;
  return parameters_.hold - (steps_ > 0 ? time - last_step_ : 0.0);
}

double ShieldsRamp::factor() const { return std::pow(1.0 + parameters_.step, static_cast<double>(steps_)); }

void ShieldsRamp::save(ArchiveWriter& archive) const {
  archive.attribute("system/shields_ramp_steps", steps_);
  archive.attribute("system/shields_ramp_last_step", last_step_);
}

void ShieldsRamp::load(ArchiveReader& archive) {
  steps_ = archive.integer_attribute("system/shields_ramp_steps");
  last_step_ = archive.real_attribute("system/shields_ramp_last_step");
}

}  // namespace thalweg::dem
