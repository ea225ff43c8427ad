// Records of an observer for a file of its own that grows during the run: growing arrays, and events with arrays of
// their own.
#pragma once

#include "core/state/profile.hpp"
#include "core/state/system.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace thalweg {

// Whole numbers without a unit, e.g. ids.
struct WholeNumbers {
  std::string name, axis;  // axis: of its dimension, as those of Profile
  std::vector<std::int64_t> values;
};

struct Event {
  std::string name;  // of its group; unique
  double time;       // s
  std::vector<Diagnostic> diagnostics;
  std::vector<WholeNumbers> numbers;
  std::vector<Profile> arrays;
};

struct Records {
  std::vector<WholeNumbers> fixed;  // the same from the first to the last time of a run
  std::vector<Profile> places;      // the same: where the values of rows lie, coordinates such as x
  std::vector<Profile> rows;        // new rows: the first dimension is that of time; `time` (s) is one of them
  std::vector<Event> events;        // new ones, in order of time
};

}  // namespace thalweg
