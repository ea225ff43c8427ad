#include "core/base/schedule.hpp"

#include "core/base/round_off.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg {

std::int64_t whole_steps(double steps) {
  return steps < static_cast<double>(no_step_reaches) ? static_cast<std::int64_t>(steps) : no_step_reaches;
}

namespace {

constexpr double early = 1e-3;  // steps, by which a step may come too early

// Numbers such as 0.01/1e-4 = 100.00000000000001 are whole.
double without_rounding(double steps) {
  const double whole = std::round(steps);
  return same_but_for_rounding(steps, whole) ? whole : steps;
}

}  // namespace

Schedule::Schedule(double every, double time_step)
    : interval_(every > 0.0 ? std::clamp(without_rounding(every / time_step), 1.0, most_countable_steps) : 0.0) {}

std::int64_t Schedule::interval() const { return static_cast<std::int64_t>(std::ceil(interval_)); }

// Rises with the step, whatever is rounded: no multiple is missed or met twice.
double Schedule::passed(std::int64_t step) const { return std::floor((static_cast<double>(step) + early) / interval_); }

}  // namespace thalweg
