// When something is due: every n steps, counted from step 0, so that a restarted run keeps the same schedule.
#pragma once

#include <cstdint>

namespace thalweg {

// A whole number of steps as an integer. More than no_step_reaches (infinity, too) counts as that many, so that a time
// written as 1e30 s stands for never.
inline constexpr std::int64_t no_step_reaches = std::int64_t{1} << 62;
std::int64_t whole_steps(double steps);

class Schedule {
public:
  Schedule() = default;  // never due

  // Due every `every` seconds of simulated time (rounded to whole steps, at least one). every <= 0: never.
  Schedule(double every, double time_step);

  bool due(std::int64_t step) const { return interval_ > 0 && step % interval_ == 0; }
  std::int64_t interval() const { return interval_; }  // steps; 0: never

private:
  std::int64_t interval_ = 0;
};

}  // namespace thalweg
