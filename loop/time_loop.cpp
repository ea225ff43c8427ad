#include "loop/time_loop.hpp"

#include "core/base/error.hpp"
#include "core/base/shell_word.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/sums/sum_range.hpp"
#include "loop/progress.hpp"
#include "loop/stop_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <limits>
#include <thread>

namespace thalweg::loop {

namespace {

constexpr double seconds_between_decisions = 0.2;  // mpirun kills one second after its SIGTERM
constexpr double longest_signal_delay = 0.5;
constexpr double most_of_the_time = 0.7;  // share of the time between signal and kill that a checkpoint may take
constexpr std::int64_t most_steps_between_decisions = 100000;

double seconds_since(WallClock::time_point start) {
  return std::chrono::duration<double>(WallClock::now() - start).count();
}

// False for SIGUSR1 and SIGUSR2, which mpirun passes on to the ranks and does not follow up.
bool is_followed_by_a_kill(int signal) { return signal == SIGTERM || signal == SIGINT; }

// True for a diagnostic of which the smallest value is kept.
bool is_smallest(const Diagnostic& diagnostic) { return diagnostic.name.starts_with("smallest_"); }

// True for a diagnostic of which the value furthest from zero is kept, with its sign.
bool is_bad_either_way(const Diagnostic& diagnostic, const std::vector<WatchRule>& rules) {
  return std::any_of(rules.begin(), rules.end(), [&diagnostic](const WatchRule& rule) {
    return rule.diagnostic == diagnostic.name && rule.side == WatchRule::Side::either;
  });
}

// True if the file exists; removes it, so that the run can be resumed later.
bool was_asked_to_stop(const std::filesystem::path& file) {
  std::error_code ignored;
  return !file.empty() && std::filesystem::remove(file, ignored);
}

std::vector<Diagnostic> diagnostics_of(const std::vector<std::unique_ptr<analysis::Observer>>& observers) {
  std::vector<Diagnostic> diagnostics;
  for (const auto& observer : observers)
    for (const Diagnostic& diagnostic : observer->diagnostics()) diagnostics.push_back(diagnostic);
  return diagnostics;
}

std::vector<Diagnostic> row_of(const std::vector<Diagnostic>& of_system, const std::vector<Diagnostic>& measured) {
  std::vector<Diagnostic> row = of_system;
  row.insert(row.end(), measured.begin(), measured.end());
  return row;
}

}  // namespace

std::vector<Diagnostic> series_row(const System& system,
                                   const std::vector<std::unique_ptr<analysis::Observer>>& observers) {
  return row_of(system.diagnostics(), diagnostics_of(observers));
}

// Rounded up, unless the quotient exceeds a whole number of steps by round-off only.
std::int64_t final_step(double until, double time_step) {
  return whole_steps(std::ceil(until / time_step * (1.0 - rounding_of_the_end)));
}

TimeLoop::TimeLoop(MPI_Comm communicator, System& system, std::vector<std::unique_ptr<analysis::Observer>>& observers,
                   const LoopPlan& plan, Log& log)
    : communicator_(communicator),
      system_(system),
      observers_(observers),
      plan_(plan),
      log_(log),
      watchdog_(communicator, system, plan.watch, plan.out_of_bounds) {
  final_step_ = final_step(plan.until, system.time_step());
  for (const auto& observer : observers) {
    const double every = observer->every();
    schedules_.push_back(every > 0.0 ? Schedule(every, system.time_step()) : plan.series);
  }
  record_.first_step = record_.last_step = system.step();
  record_.largest_from = plan.largest_from;
}

void TimeLoop::run() {
  begin_ = WallClock::now();
  printed_step_ = decided_step_ = next_decision_ = system_.step();
  if (plan_.write_at_start) write_what_is_due();
  if (plan_.save_at_start) checkpoint();
  Decision decision = Decision::go_on;
  while (system_.step() < final_step_ && decision == Decision::go_on) {
    const WallClock::time_point before = WallClock::now();
    announce_measurements();
    system_.advance();
    record_.advance_seconds += seconds_since(before);
    record_.last_step = system_.step();
    record_.wall_seconds = seconds_since(begin_);
    if (system_.step() % steps_between_health_checks == 0) check_health(true);
    write_what_is_due();
    if (plan_.checkpoint.due(system_.step())) checkpoint();
    if (system_.step() >= next_decision_) decision = decide_together();
    // The same step on any number of ranks and after any restart.
    if (system_.step() % plan_.steps_between_convergence_checks == 0 && stop_criteria_hold())
      decision = Decision::converged;
  }
  check_health();
  checkpoint();
  count_among_largest();
  if (log_.prints() && printed_step_ != system_.step()) report(seconds_since(begin_));
  if (decision == Decision::converged) record_.early = plan_.stop_criteria_meaning;
  record_.finished = decision == Decision::converged || system_.step() >= final_step_;
  if (record_.finished) record_.reason.clear();
  record_.wall_seconds = seconds_since(begin_);
}

void TimeLoop::check_health(bool is_regular) {
  if (checked_step_ == system_.step()) return;
  checked_step_ = system_.step();
  const auto scope = timer_.measure(timer_.phase("figures"));
  record_.diagnostics = system_.diagnostics();
  if (record_.largest.empty()) begin_largest();
  for (const std::string& warning : watchdog_.judge(record_.diagnostics)) {
    ++record_.warnings;
    log_.line("warning: " + warning);
  }
  if (any_rank(communicator_, SumRange::was_left()))
    throw RunError(fmt::format(
        "At {:.6g} s (step {}) a sum over cells, links or grains has left the range in which it is exact: the flow has "
        "broken down (shorten fluid.time_step), or the lattice is larger than these sums are made for.",
        system_.time(), system_.step()));
  if (is_regular) count_among_largest();
}

void TimeLoop::begin_largest() {
  record_.largest = record_.diagnostics;
  for (Diagnostic& diagnostic : record_.largest) {
    const double none = std::numeric_limits<double>::infinity();
    const double first = is_smallest(diagnostic) ? none : is_bad_either_way(diagnostic, plan_.watch) ? 0.0 : -none;
    diagnostic.value = find_diagnostic(plan_.largest, diagnostic.name).value_or(first);
  }
}

void TimeLoop::count_among_largest() {
  for (std::size_t f = 0; f < record_.diagnostics.size(); ++f) {
    const double now = record_.diagnostics[f].value;
    double& extreme = record_.largest[f].value;
    if (is_smallest(record_.diagnostics[f]))
      extreme = std::min(extreme, now);
    else if (is_bad_either_way(record_.diagnostics[f], plan_.watch))
      extreme = std::abs(now) > std::abs(extreme) ? now : extreme;
    else
      extreme = std::max(extreme, now);
  }
}

// Tells the system what the next step is to measure; stresses are the mean of two steps.
void TimeLoop::announce_measurements() {
  const std::int64_t next = system_.step() + 1;
  const auto due_soon = [next](const Schedule& schedule) { return schedule.due(next) || schedule.due(next + 1); };
  bool momentum = false, stress = false;
  for (std::size_t o = 0; o < observers_.size(); ++o) {
    momentum = momentum || (observers_[o]->needs_momentum() && schedules_[o].due(next));
    stress = stress || (observers_[o]->needs_grain_stress() && due_soon(schedules_[o]));
  }
  for (const OutputTask& output : plan_.outputs)
    stress = stress || (output.needs_grain_stress && due_soon(output.schedule));
  if (momentum) system_.record_momentum();
  if (stress) system_.measure_grain_stress();
}

void TimeLoop::measure() {
  const std::int64_t step = system_.step();
  const auto due = [step](const Schedule& schedule) { return schedule.due(step); };
  if (std::none_of(schedules_.begin(), schedules_.end(), due)) return;
  bool is_lightweight = true;
  for (std::size_t o = 0; o < observers_.size(); ++o)
    if (due(schedules_[o]) && !observers_[o]->is_lightweight()) is_lightweight = false;
  if (!is_lightweight) check_health();
  const auto scope = timer_.measure(timer_.phase("observers"));
  const Snapshot snapshot = system_.snapshot();
  for (std::size_t o = 0; o < observers_.size(); ++o)
    if (due(schedules_[o])) observers_[o]->observe(snapshot);
}

bool TimeLoop::stop_criteria_hold() {
  if (plan_.stop_criteria.empty() || system_.time() < plan_.stop_criteria_from) return false;
  check_health();
  const auto below = [this](const StopCriterion& limit) {
    const std::optional<double> value = find_diagnostic(record_.diagnostics, limit.diagnostic);
    return value && *value < limit.limit;
  };
  return std::all_of(plan_.stop_criteria.begin(), plan_.stop_criteria.end(), below);
}

void TimeLoop::write_what_is_due() {
  const std::int64_t step = system_.step();
  measure();
  if (plan_.series.due(step)) {
    check_health();
    measured_ = diagnostics_of(observers_);
    if (plan_.write_row) {
      const auto scope = timer_.measure(timer_.phase("series"));
      plan_.write_row(system_.time(), step, row_of(record_.diagnostics, measured_));
    }
  }
  for (const OutputTask& output : plan_.outputs) {
    if (!output.schedule.due(step)) continue;
    check_health();
    const auto scope = timer_.measure(timer_.phase(output.phase));
    output.act(system_.snapshot());
  }
}

void TimeLoop::checkpoint() {
  if (!plan_.write_checkpoint || saved_step_ == system_.step()) return;
  check_health();  // a broken state must not replace a good checkpoint
  const WallClock::time_point before = WallClock::now();
  std::uint64_t bytes = 0;
  {
    const auto scope = timer_.measure(timer_.phase("checkpoints"));
    bytes = plan_.write_checkpoint(record_);
  }
  const double seconds = seconds_since(before);
  if (saved_step_ < 0)
    log_.line(fmt::format("first checkpoint: {:.1f} MB in {:.2g} s", static_cast<double>(bytes) * 1e-6, seconds));
  if (const double left = 2.0 * plan_.sigcont_to_sigterm_delay;
      left > 0.0 && seconds > most_of_the_time * left && longest_checkpoint_ <= most_of_the_time * left)
    log_.line(
        fmt::format("warning: this checkpoint took {:.2g} s, and mpirun kills the ranks {:.2g} s after Ctrl-C or "
                    "SIGTERM: stop this run with thalweg stop {}, with SIGUSR1 or SIGUSR2 to mpirun, or by --walltime",
                    seconds, left, shell_word(plan_.stop_file.parent_path().string())));
  saved_step_ = system_.step();
  saved_at_ = seconds_since(begin_);
  longest_checkpoint_ = std::max(longest_checkpoint_, seconds);
}

double TimeLoop::seconds_per_step(double now) const {
  const std::int64_t done = std::max<std::int64_t>(1, system_.step() - decided_step_);
  return std::max(1e-9, (now - decided_at_) / static_cast<double>(done));
}

std::int64_t TimeLoop::steps_to_next_decision(double now) const {
  const std::int64_t done = std::max<std::int64_t>(1, system_.step() - decided_step_);
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(seconds_between_decisions / seconds_per_step(now)), 1,
                                  std::min(2 * done, most_steps_between_decisions));
}

// Wall time (s) that is left after `checkpoints` (s) and the steps up to the decision after this one.
double TimeLoop::time_left(double checkpoints) const {
  if (plan_.walltime <= 0.0) return std::numeric_limits<double>::infinity();
  const double now = seconds_since(begin_);
  const double reserve = checkpoints + std::min(60.0, 0.05 * plan_.walltime) +
                         2.0 * seconds_per_step(now) * static_cast<double>(steps_to_next_decision(now));
  return plan_.walltime - seconds_since(plan_.started) - reserve;
}

// Decision of rank 0, by the clock and the stop file.
std::int64_t TimeLoop::own_decision() {
  if (was_asked_to_stop(plan_.stop_file)) return static_cast<int>(Decision::asked);
  const bool is_up = time_left(3.0 * longest_checkpoint_) < 0.0;
  return static_cast<int>(is_up ? Decision::wall_time_is_up : Decision::go_on);
}

// True on rank 0 if a checkpoint is due by wall time. The time of the first checkpoint is unknown until it is written,
// so there must be time for it and for the last one.
bool TimeLoop::wants_checkpoint(double now) const {
  if (plan_.checkpoint_wall > 0.0 && now - saved_at_ >= plan_.checkpoint_wall) return true;
  return saved_step_ < 0 && time_left(2.0 * plan_.checkpoint_guess) < 0.0;
}

TimeLoop::Decision TimeLoop::decide_together() {
  // Only rank 0 reads the clock; any rank may have received a signal. One reduction combines the votes.
  enum { decision, signal, sigcont, print, save, steps, items };
  std::array<std::int64_t, items> votes{};
  votes[signal] = received_stop_signal();
  votes[sigcont] = consume_sigcont() ? 1 : 0;
  const double now = seconds_since(begin_);
  if (rank_of(communicator_) == 0) {
    votes[decision] = own_decision();
    votes[steps] = steps_to_next_decision(now);
    votes[print] = now - printed_at_ >= seconds_to_next_line(printed_at_) ? 1 : 0;
    votes[save] = wants_checkpoint(now) ? 1 : 0;
    decided_at_ = now;
    decided_step_ = system_.step();
  }
  if (votes[signal] != 0) votes[decision] = std::max<std::int64_t>(votes[decision], static_cast<int>(Decision::signal));
  MPI_Allreduce(MPI_IN_PLACE, votes.data(), items, MPI_INT64_T, MPI_MAX, communicator_);
  next_decision_ = system_.step() + votes[steps];
  const auto agreed = static_cast<Decision>(votes[decision]);
  if (agreed == Decision::signal) {
    record_.reason = fmt::format("stopped by {}", signal_name(static_cast<int>(votes[signal])));
    if (saved_step_ != system_.step() && is_followed_by_a_kill(static_cast<int>(votes[signal])))
      log_.line(fmt::format("{}: saving{}", signal_name(static_cast<int>(votes[signal])), danger_of_being_killed()));
  }
  record_.asked = agreed == Decision::asked;
  if (record_.asked) record_.reason = stopped_on_request;
  if (agreed == Decision::wall_time_is_up) record_.reason = "the wall time is nearly up";
  if (votes[print] != 0) report(now);
  if (votes[save] != 0) checkpoint();
  if (agreed == Decision::go_on && votes[sigcont] != 0) return decide_after_sigcont();
  return agreed;
}

// Saves while there is time, then waits for the signal that follows SIGCONT. If none comes, the run continues.
TimeLoop::Decision TimeLoop::decide_after_sigcont() {
  const WallClock::time_point sigcont = WallClock::now();
  log_.line("SIGCONT (mpirun sends it before it kills the ranks): saving" + danger_of_being_killed());
  checkpoint();
  while (rank_of(communicator_) == 0 && received_stop_signal() == 0 &&
         seconds_since(sigcont) < plan_.sigcont_to_sigterm_delay + longest_signal_delay)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return decide_together();
}

// Appended to a log line; empty if no danger is known.
std::string TimeLoop::danger_of_being_killed() const {
  const double left = 2.0 * plan_.sigcont_to_sigterm_delay;
  if (left <= 0.0 || longest_checkpoint_ < most_of_the_time * left) return "";
  return fmt::format(
      ", which took up to {:.2g} s so far, and mpirun leaves {:.2g} s; if this checkpoint is lost, restart from "
      "the one of step {}",
      longest_checkpoint_, left, saved_step_);
}

void TimeLoop::report(double now) {
  const double interval = std::max(1e-9, now - printed_at_);
  const auto steps = static_cast<double>(system_.step() - printed_step_);
  const auto done = static_cast<double>(system_.step() - record_.first_step);
  ProgressState state;
  state.time = system_.time();
  state.until = plan_.until;
  state.share_done = final_step_ > 0 ? static_cast<double>(system_.step()) / static_cast<double>(final_step_) : 1.0;
  state.seconds_left = done > 0.0 ? now / done * static_cast<double>(final_step_ - system_.step()) : -1.0;
  state.steps_per_second = steps / interval;
  state.mlups = state.steps_per_second * static_cast<double>(system_.cells()) * 1e-6;
  state.diagnostics = record_.diagnostics;
  state.diagnostics.insert(state.diagnostics.end(), measured_.begin(), measured_.end());
  state.notice = watchdog_.notice();
  log_.line(progress_line(state));
  printed_at_ = now;
  printed_step_ = system_.step();
}

}  // namespace thalweg::loop
