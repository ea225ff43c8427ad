#include "core/base/phase_timer.hpp"

#include <algorithm>

namespace thalweg {

int PhaseTimer::phase(const std::string& name) {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found != names_.end()) return static_cast<int>(found - names_.begin());
  names_.push_back(name);
  seconds_.push_back(0.0);
  return static_cast<int>(names_.size()) - 1;
}

void PhaseTimer::switch_to(int phase) {
  const Clock::time_point now = Clock::now();
  if (running_ != none) seconds_[running_] += std::chrono::duration<double>(now - since_).count();
  running_ = phase;
  since_ = now;
}

std::vector<std::pair<std::string, double>> PhaseTimer::seconds() const {
  std::vector<std::pair<std::string, double>> table;
  for (std::size_t p = 0; p < names_.size(); ++p) table.emplace_back(names_[p], seconds_[p]);
  return table;
}

void PhaseTimer::reset() { std::fill(seconds_.begin(), seconds_.end(), 0.0); }

}  // namespace thalweg
