#include "loop/time_loop.hpp"

#include "core/error.hpp"
#include "core/mpi_session.hpp"
#include "loop/progress.hpp"
#include "loop/stop_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace thalweg::loop {

namespace {

constexpr double seconds_between_decisions = 0.2;  // mpirun kills one second after its SIGTERM
constexpr double seconds_between_lines = 1.0;
constexpr std::int64_t most_steps_between_decisions = 100000;

double seconds_since(WallClock::time_point start) {
  return std::chrono::duration<double>(WallClock::now() - start).count();
}

// Takes the request away, so that the run can go on later.
bool was_asked_to_stop(const std::filesystem::path& file) {
  std::error_code ignored;
  return !file.empty() && std::filesystem::remove(file, ignored);
}

}  // namespace

TimeLoop::TimeLoop(MPI_Comm communicator, System& system, std::vector<std::unique_ptr<analysis::Observer>>& observers,
                   const LoopPlan& plan, Log& log)
    : communicator_(communicator),
      system_(system),
      observers_(observers),
      plan_(plan),
      log_(log),
      watchdog_(communicator, system, plan.watch, plan.out_of_bounds) {
  // Rounded up, except where the quotient misses a whole number of steps by round-off only.
  final_step_ = static_cast<std::int64_t>(std::ceil(plan.until / system.time_step() * (1.0 - 1e-12)));
  for (const auto& observer : observers) {
    const double every = observer->every();
    schedules_.push_back(every > 0.0 ? Schedule(every, system.time_step()) : plan.series);
  }
  record_.first_step = record_.last_step = system.step();
}

void TimeLoop::run() {
  begin_ = WallClock::now();
  printed_step_ = decided_step_ = next_decision_ = system_.step();
  if (plan_.write_at_start) write_what_is_due();
  Decision decision = Decision::go_on;
  while (system_.step() < final_step_ && decision == Decision::go_on) {
    const WallClock::time_point before = WallClock::now();
    if (needs_momentum_at(system_.step() + 1)) system_.book_momentum();
    system_.advance();
    record_.advance_seconds += seconds_since(before);
    record_.last_step = system_.step();
    record_.wall_seconds = seconds_since(begin_);
    if (system_.step() % steps_between_health_checks == 0) look_at_health();
    write_what_is_due();
    if (plan_.checkpoint.due(system_.step())) checkpoint();
    if (system_.step() >= next_decision_) decision = decide_together();
    // At the same step on any ranks and after any restart.
    if (system_.step() % steps_between_looks_for_enough == 0 && has_enough()) decision = Decision::enough;
  }
  look_at_health();
  checkpoint();
  if (log_.prints() && printed_step_ != system_.step()) report(seconds_since(begin_));
  if (decision == Decision::enough) record_.early = plan_.enough_means;
  record_.finished = decision == Decision::enough || system_.step() >= final_step_;
  if (record_.finished) record_.reason.clear();
  record_.wall_seconds = seconds_since(begin_);
}

void TimeLoop::look_at_health() {
  if (looked_at_step_ == system_.step()) return;
  looked_at_step_ = system_.step();
  const auto scope = timer_.measure(timer_.phase("figures"));
  record_.figures = system_.figures();
  if (record_.largest.empty()) record_.largest = record_.figures;
  for (const std::string& warning : watchdog_.judge(record_.figures)) {
    ++record_.warnings;
    log_.line("warning: " + warning);
  }
  for (std::size_t f = 0; f < record_.figures.size(); ++f)
    record_.largest[f].value = std::max(record_.largest[f].value, record_.figures[f].value);
}

bool TimeLoop::needs_momentum_at(std::int64_t step) const {
  for (std::size_t o = 0; o < observers_.size(); ++o)
    if (observers_[o]->needs_momentum() && schedules_[o].due(step)) return true;
  return false;
}

void TimeLoop::measure() {
  const std::int64_t step = system_.step();
  const auto due = [step](const Schedule& schedule) { return schedule.due(step); };
  if (std::none_of(schedules_.begin(), schedules_.end(), due)) return;
  bool in_passing = true;
  for (std::size_t o = 0; o < observers_.size(); ++o)
    if (due(schedules_[o]) && !observers_[o]->in_passing()) in_passing = false;
  if (!in_passing) look_at_health();
  const auto scope = timer_.measure(timer_.phase("observers"));
  const Snapshot snapshot = system_.snapshot();
  for (std::size_t o = 0; o < observers_.size(); ++o)
    if (due(schedules_[o])) observers_[o]->observe(snapshot);
}

bool TimeLoop::has_enough() const {
  const auto below = [this](const FigureLimit& limit) {
    const std::optional<double> value = find_figure(record_.figures, limit.figure);
    return value && *value < limit.limit;
  };
  return !plan_.enough.empty() && std::all_of(plan_.enough.begin(), plan_.enough.end(), below);
}

void TimeLoop::write_what_is_due() {
  const std::int64_t step = system_.step();
  measure();
  if (plan_.series.due(step)) {
    look_at_health();
    measured_.clear();
    for (const auto& observer : observers_)
      for (const Figure& figure : observer->figures()) measured_.push_back(figure);
    if (plan_.write_row) {
      const auto scope = timer_.measure(timer_.phase("series"));
      std::vector<Figure> row = record_.figures;
      for (const Figure& figure : measured_)
        if (!find_figure(record_.figures, figure.name)) row.push_back(figure);  // a column a name
      plan_.write_row(system_.time(), step, row);
    }
  }
  for (const OutputTask& output : plan_.outputs) {
    if (!output.schedule.due(step)) continue;
    look_at_health();
    const auto scope = timer_.measure(timer_.phase(output.phase));
    output.act(system_.snapshot());
  }
}

void TimeLoop::checkpoint() {
  if (!plan_.write_checkpoint || saved_step_ == system_.step()) return;
  look_at_health();  // a broken state must not replace a good checkpoint
  const WallClock::time_point before = WallClock::now();
  std::uint64_t bytes = 0;
  {
    const auto scope = timer_.measure(timer_.phase("checkpoints"));
    bytes = plan_.write_checkpoint();
  }
  const double seconds = seconds_since(before);
  if (saved_step_ < 0)
    log_.line(fmt::format("first checkpoint: {:.1f} MB in {:.2g} s", static_cast<double>(bytes) * 1e-6, seconds));
  saved_step_ = system_.step();
  saved_at_ = seconds_since(begin_);
  longest_checkpoint_ = std::max(longest_checkpoint_, seconds);
}

TimeLoop::Decision TimeLoop::decide_together() {
  // Only rank 0 looks at the clock; all ranks may have seen a signal. One reduction settles everything.
  enum { decision, signal, print, save, steps, items };
  std::array<std::int64_t, items> votes{};
  votes[signal] = received_stop_signal();
  if (votes[signal] != 0) votes[decision] = static_cast<int>(Decision::signal);
  const double now = seconds_since(begin_);
  if (rank_of(communicator_) == 0) {
    const std::int64_t done = std::max<std::int64_t>(1, system_.step() - decided_step_);
    const double per_step = std::max(1e-9, (now - decided_at_) / static_cast<double>(done));
    votes[steps] = std::clamp<std::int64_t>(static_cast<std::int64_t>(seconds_between_decisions / per_step), 1,
                                            std::min(2 * done, most_steps_between_decisions));
    const double reserve = 3.0 * longest_checkpoint_ + std::min(60.0, 0.05 * plan_.walltime) +
                           2.0 * per_step * static_cast<double>(votes[steps]);
    if (plan_.walltime > 0.0 && seconds_since(plan_.started) + reserve > plan_.walltime)
      votes[decision] = std::max<std::int64_t>(votes[decision], static_cast<int>(Decision::wall_time_is_up));
    if (was_asked_to_stop(plan_.stop_file))
      votes[decision] = std::max<std::int64_t>(votes[decision], static_cast<int>(Decision::asked));
    votes[print] = now - printed_at_ >= seconds_between_lines ? 1 : 0;
    votes[save] = plan_.checkpoint_wall > 0.0 && now - saved_at_ >= plan_.checkpoint_wall ? 1 : 0;
    decided_at_ = now;
    decided_step_ = system_.step();
  }
  MPI_Allreduce(MPI_IN_PLACE, votes.data(), items, MPI_INT64_T, MPI_MAX, communicator_);
  next_decision_ = system_.step() + votes[steps];
  const auto agreed = static_cast<Decision>(votes[decision]);
  if (agreed == Decision::signal)
    record_.reason = fmt::format("stopped by {}", signal_name(static_cast<int>(votes[signal])));
  if (agreed == Decision::asked) record_.reason = "stopped by a file named stop";
  if (agreed == Decision::wall_time_is_up) record_.reason = "the wall time is nearly up";
  if (votes[print] != 0) report(now);
  if (votes[save] != 0) checkpoint();
  return agreed;
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
  state.figures = record_.figures;
  state.figures.insert(state.figures.end(), measured_.begin(), measured_.end());
  state.notice = watchdog_.notice();
  log_.line(progress_line(state));
  printed_at_ = now;
  printed_step_ = system_.step();
}

}  // namespace thalweg::loop
