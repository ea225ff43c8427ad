#include "model_fluid/shields_ramp.hpp"

namespace thalweg::model_fluid {

bool ShieldsRamp::advance(double time, double largest_speed, double largest_acceleration) {
  const bool at_rest =
      largest_speed < parameters_.largest_speed && largest_acceleration < parameters_.largest_acceleration;
  if (!at_rest || time - last_step_ < parameters_.every) return false;
  factor_ *= 1.0 + parameters_.step;
  last_step_ = time;
  return true;
}

double ShieldsRamp::hold_left(double time) const {
  if (mobile_) return 0.0;
  return parameters_.hold - (has_risen() ? time - last_step_ : 0.0);
}

void ShieldsRamp::save(ArchiveWriter& archive) const {
  archive.attribute("system/shields_ramp_factor", factor_);
  archive.attribute("system/shields_ramp_last_step", last_step_);
  archive.attribute("system/shields_ramp_mobile", std::int64_t(mobile_));
}

void ShieldsRamp::load(ArchiveReader& archive) {
  factor_ = archive.real_attribute("system/shields_ramp_factor");
  last_step_ = archive.real_attribute("system/shields_ramp_last_step");
  if (archive.has("system/shields_ramp_mobile"))  // older checkpoints have none
    mobile_ = archive.integer_attribute("system/shields_ramp_mobile") != 0;
}

}  // namespace thalweg::model_fluid
