// Progress line: once a second at first, every ten minutes after half an hour.
#pragma once

#include "core/state/system.hpp"

#include <string>
#include <vector>

namespace thalweg::loop {

struct ProgressState {
  double time;          // s, simulated
  double until;         // s
  double share_done;    // 0 .. 1, of the whole run
  double seconds_left;  // s of wall time; negative: not known yet
  double steps_per_second;
  double mlups;  // million lattice cell updates a second; 0: no lattice
  std::vector<Diagnostic> diagnostics;
  std::string notice = {};  // of the watchdog; empty: none
};

// e.g. "t 1.2345 of 3 s   41 %   left 1:23   812 steps/s   12.3 MLUPS   moving 23   q* 0.0123   u_max 0.081"
// It shows the diagnostics moving_grains, q_star and largest_lattice_velocity where they exist, and last a notice:
// "warning: mean_density_deviation -0.0031".
std::string progress_line(const ProgressState& state);

// Wall time (s) from a progress line at `now` (s after the start of the run) to the next: short at first, and long
// enough for a few hundred lines in a run of days.
double seconds_to_next_line(double now);

// Duration as text: "59 s", "12:03" (minutes and seconds), "3:04:05", "2 d 03:04" (hours and minutes).
std::string clock_text(double seconds);

}  // namespace thalweg::loop
