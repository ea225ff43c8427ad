// Where the wall time goes: seconds per named phase of the step.
#pragma once

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

  // Adds the time from construction to destruction to a phase.
  class Scope {
  public:
    Scope(PhaseTimer& timer, int phase) : timer_(timer), phase_(phase), start_(Clock::now()) {}
    ~Scope() { timer_.seconds_[phase_] += std::chrono::duration<double>(Clock::now() - start_).count(); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

  private:
    PhaseTimer& timer_;
    int phase_;
    Clock::time_point start_;
  };
  Scope measure(int phase) { return Scope(*this, phase); }

  // (name, seconds) in order of creation.
  std::vector<std::pair<std::string, double>> seconds() const;
  void reset();

private:
  std::vector<std::string> names_;
  std::vector<double> seconds_;
};

}  // namespace thalweg
