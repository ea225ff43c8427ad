#include "lbm/fluid/flow_control.hpp"

#include "core/base/error.hpp"

#include <fmt/format.h>

namespace thalweg::lbm {

FlowControl::FlowControl(const FlowTarget& target) : target_(target) {
  if (target.interval < 1 || !(target.response_time >= 10.0 * target.interval))
    throw InputError(
        fmt::format("The flow control looks every {} steps and responds in {} steps; it needs at least one step "
                    "and a response time of at least ten intervals.",
                    target.interval, target.response_time));
}

void FlowControl::update(double mean_velocity) {
  const double error = target_.velocity - mean_velocity, t = target_.response_time;
  integral_ += target_.interval * error;
  force_ = error / t + integral_ / (4.0 * t * t);
  countdown_ = target_.interval - 1;
}

void FlowControl::begin_with(const Force& force) {
  const double t = target_.response_time;
  integral_ = 4.0 * t * t * force.held;
  force_ = force.whole;
}

std::string FlowControl::name_of_force(int axis) { return fmt::format("fluid/force_{}", "xyz"[axis]); }

std::optional<FlowControl::Force> FlowControl::saved_force(const ArchiveReader& archive, int axis) {
  if (archive.has(name_of_force(axis))) {
    const double given = archive.real_attribute(name_of_force(axis));
    return Force{given, given};
  }
  if (!archive.has("fluid/flow_control_force")) return std::nullopt;
  const double whole = archive.real_attribute("fluid/flow_control_force");
  if (!archive.has("fluid/flow_control_response_time")) return Force{whole, whole};  // older checkpoints have none
  const double t = archive.real_attribute("fluid/flow_control_response_time");
  return Force{whole, archive.real_attribute("fluid/flow_control_integral") / (4.0 * t * t)};
}

void FlowControl::save(ArchiveWriter& archive) const {
  archive.attribute("fluid/flow_control_integral", integral_);
  archive.attribute("fluid/flow_control_force", force_);
  archive.attribute("fluid/flow_control_countdown", countdown_);
  archive.attribute("fluid/flow_control_response_time", target_.response_time);
}

void FlowControl::load(ArchiveReader& archive) {
  integral_ = archive.real_attribute("fluid/flow_control_integral");
  force_ = archive.real_attribute("fluid/flow_control_force");
  countdown_ = archive.integer_attribute("fluid/flow_control_countdown");
  if (!archive.has("fluid/flow_control_response_time")) return;  // older checkpoints have none: taken as the same
  go_on_from(archive.real_attribute("fluid/flow_control_response_time"));
}

// With F = e/T + integral/(4 T^2) of both times.
void FlowControl::go_on_from(double response_time) {
  const double t = target_.response_time;
  if (response_time == t) return;
  const double proportional = force_ - integral_ / (4.0 * response_time * response_time);
  integral_ = 4.0 * t * t * (force_ - proportional * response_time / t);
}

}  // namespace thalweg::lbm
