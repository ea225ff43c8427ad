#include "driver/cli/run_command.hpp"

#include "continuum/continuum_system.hpp"
#include "core/base/error.hpp"
#include "core/base/error_message.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "dem/grain_system.hpp"
#include "driver/bed/reference_grain.hpp"
#include "driver/cli/resume.hpp"
#include "driver/cli/run_paths.hpp"
#include "driver/cli/run_report.hpp"
#include "driver/cost/disk_space.hpp"
#include "driver/cost/load_balance.hpp"
#include "driver/cost/machine.hpp"
#include "driver/cost/memory.hpp"
#include "driver/cost/run_cost.hpp"
#include "driver/execution/final_bed.hpp"
#include "driver/execution/run_output.hpp"
#include "driver/execution/summary.hpp"
#include "driver/execution/watch_rules.hpp"
#include "driver/input/case_changes.hpp"
#include "driver/input/case_reader.hpp"
#include "driver/input/run_context.hpp"
#include "driver/setup/bed_archive.hpp"
#include "driver/setup/build_system.hpp"
#include "driver/setup/checkpoint_file.hpp"
#include "driver/setup/initial_state.hpp"
#include "driver/setup/input_files.hpp"
#include "driver/setup/provenance.hpp"
#include "driver/setup/version.hpp"
#include "io/files/atomic_file.hpp"
#include "io/folder/folder_lock.hpp"
#include "io/hdf5/bed_file.hpp"
#include "loop/stop_request.hpp"
#include "model_fluid/model_fluid_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

namespace thalweg::driver {

namespace {

namespace fs = std::filesystem;

// Replaces --resume in the command by --restart, --overwrite or neither, as the folder requires. lock: of the folder,
// if it holds an unfinished run. Returns an outcome if there is nothing to run.
std::optional<Outcome> resume(Command& command, std::optional<io::FolderLock>& lock, MPI_Comm communicator,
                              loop::Log& log) {
  const io::RunFolder folder(folder_without_restart(command));
  const std::string name = folder.path().string();
  io::FolderLock taken;
  int found = 0;
  on_first_rank(communicator, [&] {
    found = static_cast<int>(resumption_of(folder, wanted_end(command.path, command.all_settings()), taken));
  });
  MPI_Bcast(&found, 1, MPI_INT, 0, communicator);
  switch (static_cast<Resumption>(found)) {
    case Resumption::finished:
      log.line(
          fmt::format("{} is finished: nothing to do (to continue it, give an --until beyond its run.until)", name));
      return Outcome::finished;
    case Resumption::asked_to_stop:
      log.line(
          fmt::format("{}: thalweg stop was given after the last run had ended, so this one does not start; repeat the "
                      "command to continue the run",
                      name));
      return Outcome::asked_to_stop;
    case Resumption::go_on:
      command.restart = name;
      break;
    case Resumption::begin_again:
      log.line(fmt::format("{}: the previous run ended before its first checkpoint; starting again", name));
      command.overwrite = true;
      break;
    case Resumption::begin:
      return {};
  }
  lock = std::move(taken);
  return {};
}

// The case with the states that the run begins, or has begun, from.
Case with_its_sources(Case c, const RunPaths& paths, MPI_Comm communicator) {
  if (paths.checkpoints.empty()) return with_checkpoints_found(std::move(c), communicator);
  if (paths.origin.empty()) return c;
  const io::RunFolder origin(paths.origin);
  return with_sources_of(
      paths.origin,
      told_by_first_rank(communicator, [&] { return io::read_text(origin.case_of(paths.checkpoints.front())); }),
      std::move(c));
}

// Changes since this checkpoint of the run that is continued. Throws InputError if it cannot go on with the case.
std::vector<CaseChange> changes_since(const fs::path& checkpoint, const RunPaths& paths, const Case& c,
                                      MPI_Comm communicator) {
  if (paths.origin.empty()) return {};
  const std::string before =
      told_by_first_rank(communicator, [&] { return io::read_text(io::RunFolder(paths.origin).case_of(checkpoint)); });
  std::vector<CaseChange> changes = case_changes(before, resolved_yaml(c));
  // A surface stands there with its path from the folder.
  std::erase_if(changes, [&](const CaseChange& change) {
    return change.key.ends_with(".stl") && change.before == path_from(paths.origin, change.now);
  });
  refuse_changes_of_state(changes, !has_fluid(c));
  return changes;
}

// Locks the folder on the first rank for the lifetime of the lock. Later requests to stop concern this run.
io::FolderLock lock_folder(const RunPaths& paths, MPI_Comm communicator) {
  io::FolderLock lock;
  on_first_rank(communicator, [&] {
    lock = io::FolderLock(paths.folder.path());
    std::error_code ignored;
    fs::remove(paths.folder.stop(), ignored);  // for an earlier run
  });
  return lock;
}

// step: of the initial state.
void prepare_folder(const RunPaths& paths, const Case& c, const Command& command, std::int64_t step,
                    MPI_Comm communicator, loop::Log& log) {
  on_first_rank(communicator, [&] {
    if (paths.same_folder) {
      paths.folder.keep_case(step);
      paths.folder.go_on_from(step);
    } else {
      paths.folder.create(command.overwrite);
    }
    // First, because it identifies the folder.
    paths.folder.write_case(fmt::format("version {}\ncommand {}{}{}", version_text(), command.line,
                                        c.filled_in.preset.empty() ? "" : "\npreset ", c.filled_in.preset),
                            resolved_yaml(with_paths_from(paths.folder.path(), c)));
    std::error_code ignored;
    fs::remove(paths.folder.summary(), ignored);  // of an earlier run
    io::make_folder(paths.folder.checkpoints());
    log.copy_to(paths.folder.log().string());
  });
}

// Bandwidth of a slow or shared disk, bytes/s.
constexpr double slow_disk = 1e8;

// Grains are at rest only when no more come in: all supplies are over, no grain waits for a place, and none is on its
// way back.
void wait_for_turnover(const Case& c, loop::LoopPlan& plan) {
  constexpr double none = std::numeric_limits<double>::min();
  if (c.supplies.empty() && c.sinks.empty()) return;
  for (const beds::SupplyKeys& supply : c.supplies)
    plan.stop_criteria_from = std::max(plan.stop_criteria_from, supply.until.value_or(c.run.until));
  plan.stop_criteria.push_back({"supply_lag", none});
  const auto returns = [](const beds::SinkKeys& sink) { return sink.recirculation.has_value(); };
  if (std::any_of(c.sinks.begin(), c.sinks.end(), returns)) plan.stop_criteria.push_back({"returning_grains", none});
}

// Sets the criteria that end the run early.
void set_end(const Case& c, loop::LoopPlan& plan) {
  if (c.run.until_at_rest && c.run.until_at_rest->quantile < 1.0) {
    constexpr double rounding = 1e-9;
    plan.stop_criteria = {
        {dem::GrainSystem::restless_share_diagnostic, 1.0 - c.run.until_at_rest->quantile + rounding}};
    plan.stop_criteria_meaning = fmt::format("a share of {:g} of the grains at rest", c.run.until_at_rest->quantile);
  } else if (c.run.until_at_rest) {
    plan.stop_criteria = {
        {dem::GrainSystem::largest_speed_diagnostic, c.run.until_at_rest->largest_speed},
        {dem::GrainSystem::largest_acceleration_diagnostic, c.run.until_at_rest->largest_acceleration}};
    plan.stop_criteria_meaning = "all grains at rest";
  } else if (c.run.until_steady) {
    plan.stop_criteria = {{continuum::ContinuumSystem::unsteadiness_diagnostic, c.run.until_steady->unsteadiness}};
    plan.stop_criteria_meaning = "steady";
    plan.steps_between_convergence_checks = 1;  // its steps are long
  } else if (c.system == SystemKind::model_fluid && c.model_fluid.ramp) {
    plan.stop_criteria = {
        {model_fluid::ModelFluidField::hold_left_diagnostic, std::numeric_limits<double>::min()}};  // none is left
    plan.stop_criteria_meaning = "motion without end";
    plan.steps_between_convergence_checks = 20;  // grains that take off are soon too fast for the time step
  }
  if (c.run.until_at_rest) wait_for_turnover(c, plan);
}

loop::LoopPlan plan_of(const Case& c, const Command& command, const RunPaths& paths, const RunHistory& history,
                       loop::WallClock::time_point started) {
  loop::LoopPlan plan;
  plan.until = c.run.until;
  set_end(c, plan);
  plan.watch = watch_rules(c);
  plan.out_of_bounds = c.run.watchdog;
  plan.walltime = command.walltime;
  plan.started = started;
  plan.checkpoint_guess = bytes_of_checkpoint(c) / slow_disk;
  plan.stop_file = paths.folder.stop();
  plan.sigcont_to_sigterm_delay = loop::sigcont_to_sigterm_delay();
  plan.largest = history.largest;
  plan.largest_from = history.largest_from;
  plan.write_at_start = !paths.same_folder;
  plan.save_at_start = !paths.same_folder && !paths.checkpoints.empty();  // or --resume would begin at the start
  return plan;
}

Outcome outcome_of(const loop::LoopRecord& record) {
  if (record.finished) return Outcome::finished;
  return record.asked ? Outcome::asked_to_stop : Outcome::interrupted;
}

// Names the checkpoint from which a failed run can be restarted, in one sentence.
std::string last_good(const RunPaths& paths, double checkpoint_interval) {
  fs::path checkpoint = paths.checkpoints.empty() ? fs::path() : paths.checkpoints.front();
  try {
    checkpoint = paths.folder.latest_checkpoint();
  } catch (const InputError&) {  // none has been written in this folder
  }
  if (checkpoint.empty())
    return fmt::format("There is no checkpoint to restart from in {}; {}.", paths.folder.path().string(),
                       checkpoint_interval > 0.0 ? "none had been written, or the folder has been moved"
                                                 : "set output.checkpoint.every (s)");
  return fmt::format("The last good checkpoint is {}.", checkpoint.string());
}

// One run from its starting point to its summary. Members in the order in which they come into being.
class CaseRun {
public:
  // Builds the system and reads the state it starts from. Throws InputError. Collective.
  CaseRun(const Command& command, const RunPaths& paths, const Case& c, MPI_Comm communicator)
      : command_(command),
        paths_(paths),
        case_(c),
        communicator_(communicator),
        identity_{c.name,
                  name_of(c.system),
                  command.line,
                  c.run.until,
                  choose_layout(c, size_of(communicator), command.layout),
                  size_of(communicator)} {
    if (restarts()) start_point_.changes = changes_since(paths.checkpoints.front(), paths, c, communicator);
    if (!c.grains.empty()) identity_.reference = reference_grain(c);
    identity_.has_series = c.output.series.every > 0.0;
    build();
    read_state();
  }

  // Prepares the folder and prints the header. lock: of the folder, taken here if need be.
  void begin(std::optional<io::FolderLock>& lock, FailureBarrier& failures, loop::Log& log) {
    if (!lock) lock = lock_folder(paths_, communicator_);
    output_.emplace(communicator_, case_, paths_.folder, *system_, observers_, loop::series_row(*system_, observers_),
                    start_point_.run_history.since,
                    paths_.same_folder ? std::optional<double>(system_->time()) : std::nullopt);
    prepare_folder(paths_, case_, command_, system_->step(), communicator_, log);
    try {
      identity_.provenance = provenance_of(case_, paths_.folder.path(), communicator_);
      print_header(case_, identity_, *system_, paths_.folder, start_point_, bandwidth_, communicator_, log);
      if (!lock->keeps_others_out())
        log.line(fmt::format("warning: {} cannot be locked: make sure that no other run writes there",
                             paths_.folder.path().string()));
      if (const std::string gap = output_->begin(); !gap.empty()) log.line("warning: " + gap);
    } catch (const std::exception& error) {
      fail(error, before_the_first_step(), failures, log);
    }
  }

  Outcome advance(loop::WallClock::time_point started, FailureBarrier& failures, loop::Log& log) {
    loop::LoopPlan plan = plan_of(case_, command_, paths_, start_point_.run_history, started);
    output_->add_to(plan);
    loop::TimeLoop time_loop(communicator_, *system_, observers_, plan, log);
    try {
      time_loop.run();
      if (!case_.grains.empty()) io::write_bed_file(communicator_, paths_.folder.bed(), system_->snapshot());
      conclude(plan, time_loop, log);
    } catch (const std::exception& error) {  // whatever it is, it is the run that has failed
      fail(error, time_loop.record(), failures, log);
    }
    return outcome_of(time_loop.record());
  }

private:
  bool restarts() const { return !paths_.checkpoints.empty(); }

  loop::LoopRecord before_the_first_step() const {
    loop::LoopRecord record;
    record.first_step = record.last_step = system_->step();
    record.largest = start_point_.run_history.largest;
    record.largest_from = start_point_.run_history.largest_from;
    return record;
  }

  void build() {
    const Case& c = case_;
    if (!restarts()) about_case(command_.path, [&] { check_initial_sources(c, Ranks(communicator_)); });
    about_case(command_.path, [&] { refuse_without_memory(c, communicator_, identity_.layout); });
    if (exceeds_caches(bytes_of_lattice(c))) bandwidth_ = measure_bandwidth(communicator_);  // while its array has room
    forget_largest_memory();
    const Start start = restarts() || c.initial.takes(InitialField::grains) ? Start::from_checkpoint : Start::as_placed;
    const fs::path state = restarts() ? paths_.checkpoints.front() : initial_grains(c, communicator_);
    const Decomposition partition =
        about_case(command_.path, [&] { return partition_of_run(c, communicator_, identity_.layout, state); });
    system_ = about_case(command_.path, [&] { return build_system(c, communicator_, partition, start); });
    observers_ = new_observers();
  }

  Observers new_observers() const {
    return make_observers(case_.analysis.observers, run_context(case_),
                          {communicator_, *system_->snapshot().decomposition, system_->time_step()});
  }

  void read_state() {
    if (!restarts()) {
      about_case(command_.path, [&] { take_initial_fields(communicator_, case_, *system_); });
      return;
    }
    start_point_.checkpoint = read_first_whole_checkpoint(
        communicator_, paths_.checkpoints, case_, *system_, observers_, [&] { return new_observers(); },
        start_point_.damage, start_point_.run_history);
    if (!start_point_.damage.empty())
      start_point_.changes = changes_since(start_point_.checkpoint, paths_, case_, communicator_);
    if (system_->step() > loop::final_step(case_.run.until, system_->time_step()))
      throw InputError(fmt::format("{} is at {:.6g} s already and the run ends at {:.6g} s: give a later --until.",
                                   start_point_.checkpoint.string(), system_->time(), case_.run.until));
  }

  // Throws the error again, with the last good checkpoint, after it has gone into the summary.
  [[noreturn]] void fail(const std::exception& error, loop::LoopRecord record, FailureBarrier& failures,
                         const loop::Log& log) const {
    const RunError told(fmt::format("{} {}", error_message(error), last_good(paths_, case_.output.checkpoint.every)));
    record.finished = false;
    record.reason = told.what();
    try {
      if (!failures.all_ranks_failed(seconds_to_wait_for_others) || log.prints())
        summary_of(identity_, *system_, record, observers_, start_point_.run_history, {}, {})
            .write(paths_.folder.summary());
    } catch (const RunError&) {  // the first error is the one to report
    }
    throw told;
  }

  // Reports the result in the log and the summary.
  void conclude(const loop::LoopPlan& plan, loop::TimeLoop& time_loop, loop::Log& log) {
    const loop::LoopRecord& record = time_loop.record();
    const std::vector<loop::PhaseShare> phases = loop::collect_phases(communicator_, *system_, time_loop);
    const std::vector<Diagnostic> bed = final_bed(communicator_, case_, *system_);
    identity_.memory = memory_use(communicator_);
    print_outcome(identity_, record, *system_, observers_, bed, phases, paths_.folder, log);
    if (const std::string remark = full_column_remark(case_, *system_); !remark.empty()) log.line(remark);
    if (const std::string remark = rest_remark(case_, plan, record, *system_); !remark.empty()) log.line(remark);
    const io::JsonObject summary =
        summary_of(identity_, *system_, record, observers_, start_point_.run_history, bed, phases);
    on_first_rank(communicator_, [&] {
      summary.write(paths_.folder.summary());
      std::error_code ignored;  // a request that came too late
      if (record.finished) fs::remove(paths_.folder.stop(), ignored);
    });
  }

  const Command& command_;
  const RunPaths& paths_;
  const Case& case_;
  MPI_Comm communicator_;
  RunIdentity identity_;
  StartPoint start_point_;
  double bandwidth_ = 0.0;  // of the memory, bytes/s; 0: it does not bound the speed
  std::unique_ptr<System> system_;
  Observers observers_;
  std::optional<RunOutput> output_;
};

}  // namespace

Outcome run_case(Command command, MPI_Comm communicator, loop::WallClock::time_point started, FailureBarrier& failures,
                 loop::Log& log) {
  std::optional<io::FolderLock> lock;
  if (command.resume)
    if (const std::optional<Outcome> outcome = resume(command, lock, communicator, log)) return *outcome;
  RunPaths paths = paths_of(command, communicator);
  if (paths.same_folder && !lock) {  // a run that ends there may still save: look for checkpoints under the lock
    lock = lock_folder(paths, communicator);
    paths = paths_of(command, communicator);
  }
  const Case c = with_its_sources(
      read_case(command.path, command.all_settings(), beds_of(paths.checkpoints), communicator), paths, communicator);
  on_first_rank(communicator, [&] {
    if (!paths.same_folder) paths.folder.check_new(command.overwrite);
    paths.folder.check_writable();
  });
  CaseRun run(command, paths, c, communicator);
  loop::listen_for_stop_signals();
  MPI_Barrier(communicator);  // a rank that was ended instead keeps the others from beginning
  run.begin(lock, failures, log);
  return run.advance(started, failures, log);
}

}  // namespace thalweg::driver
