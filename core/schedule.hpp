// When something is due: every n steps, counted from step 0, so that a restarted run keeps the same schedule.
#pragma once

#include <cstdint>

namespace thalweg {

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
