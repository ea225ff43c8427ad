// What is watched while a run goes on: a figure of the system, from where on it is suspicious, and from where on the
// run is not worth going on.
#pragma once

#include "core/system.hpp"
#include "driver/case.hpp"

#include <functional>
#include <string>
#include <vector>

namespace thalweg::driver {

// In the figure's unit, of its badness (WatchRule::badness); infinite: never. warn is at most stop.
struct WatchLimits {
  double warn, stop;
};

struct WatchRule {
  enum class Side { above, below, either };  // which values are bad: large ones, those far below zero, both

  std::string figure;  // its name; where the system has no such figure, the rule does not apply
  Side side;
  std::function<WatchLimits(const std::vector<Figure>&)> limits;  // at a look, from all figures of the system
  std::string meaning;                                            // of the figure, e.g. "the largest lattice velocity"
  std::string advice;                                             // likely cause and remedy, in whole sentences

  // How bad a value is, to be compared with the limits: the value, its negative or its size.
  double badness(double value) const;
};

// The rules for a case. Where the limits come from: docs/stability.md.
std::vector<WatchRule> watch_rules(const Case& c);

// m/s: what grains can reach by falling, by what moves them, and with the flow the case expects, without the flow's own
// speed at the time; an upper estimate.
double expected_grain_speed(const Case& c);

// The deviation of the mean density from which a warning is due, and that at which the run stops.
WatchLimits mean_density_limits(const Case& c);

}  // namespace thalweg::driver
