// Wall time of each named phase of the step, in seconds.
#pragma once

#include "core/base/check.hpp"

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace thalweg {

class PhaseTimer {
public:
  using Clock = std::chrono::steady_clock;

  // Index of the phase of that name, created on first use. Look it up once, outside the loop.
  int phase(const std::string& name);

  // Adds the time from construction to destruction to a phase. A scope inside another takes its time from the outer
  // one, so that the phases add up to the whole.
  class Scope {
  public:
    Scope(PhaseTimer& timer, int phase) : timer_(timer), outer_(timer.running_) { timer_.switch_to(phase); }
    ~Scope() { timer_.switch_to(outer_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

  private:
    PhaseTimer& timer_;
    int outer_;
  };
  Scope measure(int phase) {
    CHECK(phase >= 0 && static_cast<std::size_t>(phase) < names_.size());
    return Scope(*this, phase);
  }

  // (name, seconds) in order of creation.
  std::vector<std::pair<std::string, double>> seconds() const;
  void reset();

private:
  static constexpr int none = -1;
  void switch_to(int phase);

  std::vector<std::string> names_;
  std::vector<double> seconds_;
  int running_ = none;
  Clock::time_point since_;
};

}  // namespace thalweg
