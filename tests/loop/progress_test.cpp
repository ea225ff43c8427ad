#include "loop/progress.hpp"

#include <gtest/gtest.h>

namespace thalweg::loop::progress_test {
namespace {

TEST(Progress, ShowsWhatAPersonWantsToSee) {
  ProgressState state{1.25, 3.0, 1.25 / 3.0, 83.0, 812.0, 12.34, {}};
  state.diagnostics = {{"largest_lattice_velocity", "1", 0.081},
                       {"q_s", "m^2/s", 1.0},
                       {"q_star", "1", 0.0123},
                       {"moving_grains", "1", 23.0}};
  EXPECT_EQ(progress_line(state),
            "t 1.25      of 3 s   42 %  left 1:23          812 steps/s    12.3 MLUPS  moving 23      q* 0.0123     "
            "u_max 0.081");
  state.notice = "mean_density_deviation -0.0031";
  EXPECT_TRUE(progress_line(state).ends_with("u_max 0.081  warning: mean_density_deviation -0.0031"));
}

TEST(Progress, LeavesOutWhatIsNotThere) {
  const ProgressState state{0.0, 0.5, 0.0, -1.0, 1e5, 0.0, {}};
  EXPECT_EQ(progress_line(state), "t 0         of 0.5 s    0 %  left ?           1e+05 steps/s");
}

// The lines of a batch job in run.log: one a second while somebody may be watching, and few in a run of a week.
TEST(Progress, LinesOfALongRunAreFew) {
  EXPECT_EQ(seconds_to_next_line(0.0), 1.0);
  EXPECT_EQ(seconds_to_next_line(1e6), 600.0);
  const double week = 7 * 86400.0;
  int lines = 0, in_first_minute = 0;
  for (double now = 0.0; now < week; now += seconds_to_next_line(now)) {
    ++lines;
    if (now < 60.0) ++in_first_minute;
  }
  EXPECT_GE(in_first_minute, 10);
  EXPECT_LT(lines, 1100);  // 1008 intervals of ten minutes, and those of the first half-hour
}

TEST(Progress, ClockTexts) {
  EXPECT_EQ(clock_text(0.2), "0 s");
  EXPECT_EQ(clock_text(59.4), "59 s");
  EXPECT_EQ(clock_text(723.0), "12:03");
  EXPECT_EQ(clock_text(11045.0), "3:04:05");
  EXPECT_EQ(clock_text(2 * 86400.0 + 3 * 3600.0 + 4 * 60.0 + 5.0), "2 d 03:04");
}

}  // namespace
}  // namespace thalweg::loop::progress_test
