// Rule of the watchdog: the values of a diagnostic beyond which it warns, and beyond which it stops the run.
#pragma once

#include "core/state/system.hpp"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace thalweg::loop {

// Limits of the badness (WatchRule::badness), in the diagnostic's unit; infinite: never. warn is at most stop.
struct WatchLimits {
  double warn, stop;
};

struct WatchRule {
  enum class Side { above, below, either };  // values that are bad: large, far below zero, or both

  std::string diagnostic;  // name; the rule does not apply to a system without it
  Side side;
  std::function<WatchLimits(const std::vector<Diagnostic>&)> limits;  // from all diagnostics of the system
  std::string meaning;  // of the diagnostic, e.g. "the largest lattice velocity"
  std::string advice;   // likely cause and remedy, in whole sentences

  // Badness of a value, to be compared with the limits: the value, its negative or its magnitude.
  double badness(double value) const {
    return side == Side::above ? value : side == Side::below ? -value : std::abs(value);
  }
};

}  // namespace thalweg::loop
