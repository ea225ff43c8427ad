// A diagnostic of the system that is watched while a run goes on: beyond which value it is suspicious, and beyond which
// the run stops.
#pragma once

#include "core/state/system.hpp"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace thalweg::loop {

// In the diagnostic's unit, of its badness (WatchRule::badness); infinite: never. warn is at most stop.
struct WatchLimits {
  double warn, stop;
};

struct WatchRule {
  enum class Side { above, below, either };  // which values are bad: large ones, those far below zero, both

  std::string diagnostic;  // its name; where the system has no such diagnostic, the rule does not apply
  Side side;
  std::function<WatchLimits(const std::vector<Diagnostic>&)> limits;  // at a look, from all diagnostics of the system
  std::string meaning;  // of the diagnostic, e.g. "the largest lattice velocity"
  std::string advice;   // likely cause and remedy, in whole sentences

  // How bad a value is, to be compared with the limits: the value, its negative or its size.
  double badness(double value) const {
    return side == Side::above ? value : side == Side::below ? -value : std::abs(value);
  }
};

}  // namespace thalweg::loop
