#include "loop/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::loop {

std::string clock_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(std::max(0.0, seconds)));
  const long long days = whole / 86400, hours = whole / 3600, minutes = whole / 60;
  if (days > 0) return fmt::format("{} d {:02}:{:02}", days, hours % 24, minutes % 60);
  if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, minutes % 60, whole % 60);
  if (minutes > 0) return fmt::format("{}:{:02}", minutes, whole % 60);
  return fmt::format("{} s", whole);
}

double seconds_to_next_line(double now) { return std::clamp(now / 3.0, 1.0, 600.0); }

std::string progress_line(const ProgressState& state) {
  std::string line = fmt::format(
      "t {:<9.5g} of {:g} s  {:3.0f} %  left {:<9} {:>7.4g} steps/s", state.time, state.until, 100.0 * state.share_done,
      state.seconds_left < 0.0 ? "?" : clock_text(state.seconds_left), state.steps_per_second);
  if (state.mlups > 0.0) line += fmt::format("  {:>6.3g} MLUPS", state.mlups);
  if (const auto moving = find_diagnostic(state.diagnostics, "moving_grains"))
    line += fmt::format("  moving {:<6.0f}", *moving);
  if (const auto q_star = find_diagnostic(state.diagnostics, "q_star")) line += fmt::format("  q* {:<9.3g}", *q_star);
  if (const auto speed = find_diagnostic(state.diagnostics, "largest_lattice_velocity"))
    line += fmt::format("  u_max {:.3g}", *speed);
  if (!state.notice.empty()) line += "  warning: " + state.notice;
  return line.substr(0, line.find_last_not_of(' ') + 1);
}

}  // namespace thalweg::loop
