#include "core/schedule.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg {

std::int64_t whole_steps(double steps) {
  return steps < static_cast<double>(no_step_reaches) ? static_cast<std::int64_t>(steps) : no_step_reaches;
}

Schedule::Schedule(double every, double time_step)
    : interval_(every > 0.0 ? std::max<std::int64_t>(1, whole_steps(std::round(every / time_step))) : 0) {}

}  // namespace thalweg
