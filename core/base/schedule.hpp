// When something is due: at the first step at or after each multiple of an interval, counted from step 0. Whether a
// step is due follows from its number alone, so that a restarted run keeps the same schedule.
#pragma once

#include <cstdint>

namespace thalweg {

// A whole number of steps as an integer. More than no_step_reaches (infinity, too) counts as that many, so that a time
// written as 1e30 s stands for never.
inline constexpr std::int64_t no_step_reaches = std::int64_t{1} << 62;
std::int64_t whole_steps(double steps);

// Steps, 2^53: more are not told apart where their number or their time is in double precision.
inline constexpr double most_countable_steps = 0x1p53;

class Schedule {
public:
  Schedule() = default;  // never due

  // Due every `every` seconds of simulated time, at most once a step; a step that comes too early by less than a
  // thousandth of its length counts. every <= 0: never.
  Schedule(double every, double time_step);

  bool due(std::int64_t step) const { return interval_ > 0.0 && (step == 0 || passed(step) != passed(step - 1)); }
  std::int64_t interval() const;  // steps, the most from one that is due to the next; 0: never

private:
  double passed(std::int64_t step) const;  // how many multiples of the interval, 0 not counted

  double interval_ = 0.0;  // steps
};

}  // namespace thalweg
