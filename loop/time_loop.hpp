// Time loop: drives any system through time, measures, writes, saves, reports, and stops cleanly.
//
// A step is: advance; check the system's health if due (watchdog.hpp judges it); measure and write if due; checkpoint
// if due; and every few steps the ranks agree (one small reduction) whether to print a progress line or to stop early.
// Those decisions never touch the state, so the clock cannot change one bit of the run. Nor does it decide when health
// is checked: a progress line shows the diagnostics of the latest check.
#pragma once

#include "analysis/observer/observer.hpp"
#include "core/base/schedule.hpp"
#include "core/state/system.hpp"
#include "loop/log.hpp"
#include "loop/watchdog.hpp"

#include <mpi.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace thalweg::loop {

using WallClock = std::chrono::steady_clock;

// Output at regular simulated times, e.g. of VTK files.
struct OutputTask {
  std::string phase;  // its line in the table of phases
  Schedule schedule;
  std::function<void(const Snapshot&)> act;  // collective
  bool needs_grain_stress = false;           // as Observer::needs_grain_stress()
};

using SeriesRow = std::function<void(double time, std::int64_t step, const std::vector<Diagnostic>&)>;  // collective

inline constexpr const char* stopped_on_request = "stopped on request (thalweg stop)";  // LoopRecord::reason

// The outcome of a run so far.
struct LoopRecord {
  bool finished = false;
  std::string early;   // LoopPlan::stop_criteria_meaning if they finished the run
  std::string reason;  // the reason why it is not finished; empty if it is
  bool asked = false;  // stopped by LoopPlan::stop_file
  std::int64_t first_step = 0, last_step = 0;
  double wall_seconds = 0.0;            // in run(), this time
  double advance_seconds = 0.0;         // the part in System::advance()
  std::vector<Diagnostic> diagnostics;  // of the system, at the latest health check
  // Largest value of each diagnostic of the system since largest_from (s, simulated), at the regular health checks and
  // at the end. A diagnostic named smallest_... has its smallest value here, and one that is bad either way the value
  // furthest from zero. Before the first check: an infinity, or 0 for the last kind.
  std::vector<Diagnostic> largest;
  double largest_from = 0.0;
  std::int64_t warnings = 0;  // of the watchdog
};

using WriteCheckpoint =
    std::function<std::uint64_t(const LoopRecord&)>;  // collective; returns its bytes, on the first rank

// A limit below which a diagnostic of the system must fall.
struct StopCriterion {
  std::string diagnostic;
  double limit;
};

struct LoopPlan {
  double until = 0.0;                        // s, simulated
  std::vector<StopCriterion> stop_criteria;  // the run finishes when all hold; none: at `until` only
  double stop_criteria_from = 0.0;           // s, simulated: they hold no earlier
  std::int64_t steps_between_convergence_checks = 200;
  std::string stop_criteria_meaning;                 // in words for the log, e.g. "all grains at rest"
  std::vector<WatchRule> watch;                      // limits of the diagnostics of the system
  OutOfBounds out_of_bounds = OutOfBounds::stop;     // reaction to a diagnostic beyond its second limit
  double walltime = 0.0;                             // s of wall time from `started` on; 0: as long as it takes
  WallClock::time_point started = WallClock::now();  // of the program
  std::filesystem::path stop_file;                   // if it appears, the run stops and removes it; empty: none
  double sigcont_to_sigterm_delay = 0.0;             // s, stop_request.hpp; 0: no kill follows a signal
  std::vector<Diagnostic> largest;                   // before the loop, since largest_from
  double largest_from = 0.0;                         // s, simulated
  bool write_at_start = true;                        // false in a continued run: its first frame exists
  bool save_at_start = false;                        // writes a checkpoint before the first step
  Schedule series;                                   // of measurements and rows of diagnostics
  Schedule checkpoint;                               // of checkpoints; a last one is written in any case
  double checkpoint_wall = 0.0;                      // s of wall time since the last one; 0: only as scheduled
  // Upper bound (s) of the time of the first checkpoint. With a wall time, it is written while twice that is left.
  double checkpoint_guess = 0.0;
  SeriesRow write_row;               // none: not written
  WriteCheckpoint write_checkpoint;  // none: not written
  std::vector<OutputTask> outputs;
};

// Row of the series with the current values: the diagnostics of the system, then those of the observers. Collective.
std::vector<Diagnostic> series_row(const System& system,
                                   const std::vector<std::unique_ptr<analysis::Observer>>& observers);

// Last step of a run: the first at or after `until` (s), or before it by at most rounding_of_the_end, relative.
constexpr double rounding_of_the_end = 1e-12;
std::int64_t final_step(double until, double time_step);

class TimeLoop {
public:
  // Everything referred to must outlive the loop.
  TimeLoop(MPI_Comm communicator, System& system, std::vector<std::unique_ptr<analysis::Observer>>& observers,
           const LoopPlan& plan, Log& log);

  // Runs to plan.until, or until a stop signal or the end of the wall time (record().finished is false then).
  // Throws RunError when the watchdog does; nothing of such a state is written. The record is valid then, too.
  void run();

  const LoopRecord& record() const { return record_; }
  PhaseTimer& timer() { return timer_; }  // phases outside System::advance()

  // A check costs less than a step (lbm/fluid/fluid_survey.hpp), so these take less than 1 % of the time.
  static constexpr std::int64_t steps_between_health_checks = 100;

private:
  // Among the decisions of several ranks the largest counts: a request to stop outranks the end of a job.
  enum class Decision : int { go_on = 0, wall_time_is_up = 1, signal = 2, asked = 3, converged = 4 };

  // Regular checks follow from the number of the step alone. Only they count among the largest diagnostics, so that a
  // run that writes more, or is saved elsewhere, has the same checkpoints.
  void check_health(bool is_regular = false);
  void begin_largest();
  void count_among_largest();
  void announce_measurements();
  void measure();
  bool stop_criteria_hold();
  void write_what_is_due();
  void checkpoint();
  double time_left(double checkpoints) const;
  bool wants_checkpoint(double now) const;
  std::int64_t own_decision();
  std::int64_t steps_to_next_decision(double now) const;
  double seconds_per_step(double now) const;
  Decision decide_together();
  Decision decide_after_sigcont();
  std::string danger_of_being_killed() const;
  void report(double now);

  MPI_Comm communicator_;
  System& system_;
  std::vector<std::unique_ptr<analysis::Observer>>& observers_;
  const LoopPlan& plan_;
  Log& log_;
  PhaseTimer timer_;
  Watchdog watchdog_;
  LoopRecord record_;
  std::vector<Schedule> schedules_;  // of each observer
  WallClock::time_point begin_;
  std::int64_t final_step_ = 0;
  std::int64_t checked_step_ = -1, saved_step_ = -1, next_decision_ = 0;
  std::vector<Diagnostic> measured_;  // latest diagnostics of the observers
  double longest_checkpoint_ = 0.0;   // s
  double saved_at_ = 0.0;             // s since the beginning of run()
  // Time (s) and step of the last progress line and of the latest decision, on rank 0.
  double printed_at_ = 0.0, decided_at_ = 0.0;
  std::int64_t printed_step_ = 0, decided_step_ = 0;
};

}  // namespace thalweg::loop
