// Watchdog limits that follow from a case.
#pragma once

#include "driver/case/case.hpp"
#include "loop/watch_rule.hpp"

#include <vector>

namespace thalweg::driver {

// The rules for a case. Where the limits come from: docs/stability.md.
std::vector<loop::WatchRule> watch_rules(const Case& c);

// m/s: what grains can reach by falling, by what moves them, and with the flow the case expects, without the flow's own
// speed at the time; an upper estimate.
double expected_grain_speed(const Case& c);

// The deviation of the mean density from which a warning is due, and that at which the run stops.
loop::WatchLimits mean_density_limits(const Case& c);

}  // namespace thalweg::driver
