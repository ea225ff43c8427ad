// Memory that an observer keeps for the grains or points it looks at, from one measurement to the next: what `thalweg
// check` adds to the run's own. Every observer says it beside its keys (observer_keys.hpp), by the sizes of what it
// stores, and tests/analysis/observers/observer_memory_test.cpp compares it with what the observers allocate.
#pragma once

#include <algorithm>
#include <cstddef>

namespace thalweg::analysis {

// What the memory depends on besides the case.
struct RunSize {
  double ids;   // grains and members of clumps that have been in the box by the end of the run, as ids count them
  double step;  // s, between states of the system
};

// Bytes.
struct ObserverMemory {
  double of_ids = 0.0;         // on all ranks together, each with its share of the ids (distribution_by_id.hpp)
  double while_saved = 0.0;    // more of the ids, while it is saved; observers are saved one after the other
  double on_first_rank = 0.0;  // records, which pass through rank 0

  ObserverMemory& operator+=(const ObserverMemory& more) {
    of_ids += more.of_ids;
    while_saved = std::max(while_saved, more.while_saved);
    on_first_rank += more.on_first_rank;
    return *this;
  }
};

// Of one allocation, what the C library adds to it (glibc).
inline constexpr double bytes_of_allocation = 8.0;
// Part of its content that a list which grows number by number holds, in the mean of its lengths: it doubles when full.
inline constexpr double grown_list = 1.5;

// Measurements of which records are kept until they are handed over, every hundred steps: of one every so many seconds.
inline double kept_measurements(double every, double step) {
  constexpr double steps_between = 100.0;
  return std::max(1.0, steps_between * std::min(1.0, step / std::max(every, step)));
}

}  // namespace thalweg::analysis
