#include "driver/cli/run_command.hpp"

#include "continuum/continuum_system.hpp"
#include "core/base/error.hpp"
#include "core/base/shell_word.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "dem/grain_system.hpp"
#include "driver/cli/error_message.hpp"
#include "driver/cli/resume.hpp"
#include "driver/cli/run_places.hpp"
#include "driver/cost/cores.hpp"
#include "driver/cost/disk_space.hpp"
#include "driver/cost/machine.hpp"
#include "driver/cost/memory.hpp"
#include "driver/cost/work_cuts.hpp"
#include "driver/estimate/reference_grain.hpp"
#include "driver/execution/final_bed.hpp"
#include "driver/execution/run_output.hpp"
#include "driver/execution/summary.hpp"
#include "driver/execution/watch_rules.hpp"
#include "driver/input/case_changes.hpp"
#include "driver/input/case_reader.hpp"
#include "driver/input/run_facts.hpp"
#include "driver/plan/case_warnings.hpp"
#include "driver/setup/bed_archive.hpp"
#include "driver/setup/build_system.hpp"
#include "driver/setup/checkpoint_file.hpp"
#include "driver/setup/initial_state.hpp"
#include "driver/setup/version.hpp"
#include "io/files/atomic_file.hpp"
#include "io/folder/folder_lock.hpp"
#include "io/hdf5/bed_file.hpp"
#include "loop/progress.hpp"
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

std::vector<std::string> settings_of(const Command& command) {
  std::vector<std::string> settings = command.settings;
  if (command.until) settings.push_back(fmt::format("run.until={}", *command.until));
  return settings;
}

// Puts what --resume finds into the command, as if its user had looked and given --restart, --overwrite or neither;
// lock: of the folder, where there is a run that is not finished. Returns the outcome where there is nothing to run.
std::optional<Outcome> resume(Command& command, std::optional<io::FolderLock>& lock, MPI_Comm communicator,
                              loop::Log& log) {
  const io::RunFolder folder(folder_without_restart(command));
  const std::string name = folder.path().string();
  io::FolderLock taken;
  int found = 0;
  on_first_rank(communicator, [&] {
    found = static_cast<int>(resumption_of(folder, wanted_end(command.path, settings_of(command)), taken));
  });
  MPI_Bcast(&found, 1, MPI_INT, 0, communicator);
  switch (static_cast<Resumption>(found)) {
    case Resumption::finished:
      log.line(fmt::format("{} is finished: nothing to do (a later --until goes on)", name));
      return Outcome::finished;
    case Resumption::asked_to_stop:
      log.line(
          fmt::format("{}: thalweg stop came after the last run there had ended, and ends this one before it begins; "
                      "the same command goes on",
                      name));
      return Outcome::asked_to_stop;
    case Resumption::go_on:
      command.restart = name;
      break;
    case Resumption::begin_again:
      log.line(fmt::format("{}: the run there ended before its first checkpoint, and begins again", name));
      command.overwrite = true;
      break;
    case Resumption::begin:
      return {};
  }
  lock = std::move(taken);
  return {};
}

// What a run begins with.
struct Beginning {
  fs::path checkpoint;              // empty: from the start
  std::vector<std::string> damage;  // of checkpoints that were passed over
  std::vector<CaseChange> changes;  // since the run that is continued
  RunHistory run_history;           // of that run
};

// Throws InputError where the case is not one with which that run can go on.
std::vector<CaseChange> changes_since(const Places& places, const Case& c, MPI_Comm communicator) {
  if (places.origin.empty()) return {};
  const std::string before = told_by_first_rank(
      communicator, [&] { return io::read_text(io::RunFolder(places.origin).case_of(places.checkpoints.front())); });
  std::vector<CaseChange> changes = case_changes(before, resolved_yaml(c));
  refuse_changes_of_state(changes, !has_fluid(c));
  return changes;
}

// Says what is about to run. bandwidth: of the memory, bytes/s; 0: there is no lattice.
void print_header(const Case& c, RunIdentity& identity, const System& system, const Places& places,
                  const Beginning& beginning, double bandwidth, MPI_Comm communicator, loop::Log& log) {
  log.line(fmt::format("Thalweg {}: {}", version_text(), c.name));
  log.line(
      fmt::format("{} on {} rank{}, layout {} x {} x {}; {} grains, {} cells; {:.6g} s a step, {:.0f} steps to {:g} s",
                  identity.system, identity.ranks, identity.ranks == 1 ? "" : "s", identity.layout[0],
                  identity.layout[1], identity.layout[2], system.snapshot().grains.body_count(), system.cells(),
                  system.time_step(), c.run.until / system.time_step(), c.run.until));
  if (const std::string cuts = cuts_text(c, *system.snapshot().decomposition); !cuts.empty()) log.line(cuts);
  for (const std::string& damage : beginning.damage) log.line("warning: " + damage);
  if (!beginning.checkpoint.empty())
    log.line(fmt::format("going on from {} at {:.6g} s", beginning.checkpoint.string(), system.time()));
  for (const CaseChange& change : beginning.changes)
    log.line(fmt::format("changed since then: {}: {} -> {}", change.key, change.before, change.now));
  for (const auto& [observer, time] : beginning.run_history.since)
    log.line(fmt::format("analysis.{}: its sums count from {:.6g} s on", observer, time));
  log.line(fmt::format("writing {}", places.folder.path().string()));
  if (const double strokes = loop::seconds_between_strokes(); strokes > 0.0)
    log.line(fmt::format("to stop early: thalweg stop {} (after Ctrl-C or SIGTERM mpirun leaves only {:.2g} s to save)",
                         shell_word(places.folder.path().string()), 2.0 * strokes));
  if (!c.grains.empty()) log.line("reference grain: " + reference_text(c));
  if (bandwidth > 0.0) {
    const double bytes = bytes_per_cell_update(c.fluid.precision == coupling::Precision::single ? 4 : 8);
    identity.memory_bound_mlups = bandwidth / bytes * 1e-6;
    log.line(fmt::format("memory bandwidth {:.1f} GB/s; {:.0f} bytes a cell update: at most {:.0f} MLUPS",
                         bandwidth * 1e-9, bytes, identity.memory_bound_mlups));
  }
  std::vector<std::string> all = warnings(c);
  for (const std::string& warning : warnings_of_plan(c)) all.push_back(warning);
  if (const std::string warning = crowding_warning(communicator); !warning.empty()) all.push_back(warning);
  for (const std::string& warning : all) log.line("warning: " + warning);
  identity.warnings = static_cast<std::int64_t>(all.size());
}

// Keeps others out of the folder as long as the lock lives, on the first rank. From now on a request to stop is meant
// for this run.
io::FolderLock lock_folder(const Places& places, MPI_Comm communicator) {
  io::FolderLock lock;
  on_first_rank(communicator, [&] {
    lock = io::FolderLock(places.folder.path());
    std::error_code ignored;
    fs::remove(places.folder.stop(), ignored);  // meant an earlier run
  });
  return lock;
}

// step: of the state the run begins with.
void prepare_folder(const Places& places, const Case& c, const Command& command, std::int64_t step,
                    MPI_Comm communicator, loop::Log& log) {
  on_first_rank(communicator, [&] {
    if (places.same_folder) {
      places.folder.keep_case(step);
      places.folder.go_on_from(step);
    } else {
      places.folder.create(command.overwrite);
    }
    // First of all, because the folder is known by it.
    places.folder.write_case(fmt::format("version {}\ncommand {}{}{}", version_text(), command.line,
                                         c.filled_in.preset.empty() ? "" : "\npreset ", c.filled_in.preset),
                             resolved_yaml(c));
    std::error_code ignored;
    fs::remove(places.folder.summary(), ignored);  // told of an earlier run
    io::make_folder(places.folder.checkpoints());
    log.copy_to(places.folder.log().string());
  });
}

void print_outcome(const RunIdentity& identity, const loop::LoopRecord& record, const System& system,
                   const Observers& observers, const std::vector<Diagnostic>& bed,
                   const std::vector<loop::PhaseShare>& phases, const io::RunFolder& folder, loop::Log& log) {
  log.line("");
  if (!bed.empty()) log.line(final_bed_text(bed));
  for (const auto& observer : observers)
    for (const std::string& remark : observer->remarks()) log.line(remark);
  for (const std::string& line : loop::phase_table(phases)) log.file_line(line);
  const loop::Speeds speeds = loop::speeds_of(system, record);
  std::string speed = fmt::format("{:.4g} steps/s", speeds.steps_per_second);
  if (speeds.mlups > 0.0) speed += fmt::format(", {:.3g} MLUPS", speeds.mlups);
  if (identity.memory_bound_mlups > 0.0)
    speed += fmt::format(" ({:.0f} % of the memory bound while advancing)",
                         100.0 * speeds.mlups_advancing / identity.memory_bound_mlups);
  if (speeds.grain_steps_per_second > 0.0)
    speed += fmt::format(", {:.3g} million grain-steps/s", speeds.grain_steps_per_second * 1e-6);
  log.line(fmt::format("{} steps in {}: {}", record.last_step - record.first_step,
                       loop::clock_text(record.wall_seconds), speed));
  log.line(fmt::format("memory: {} on all ranks, at most {} on one", bytes_text(identity.memory->all_ranks),
                       bytes_text(identity.memory->largest_rank)));
  if (record.finished)
    log.line(fmt::format("finished{} at {:.6g} s: {}", record.early.empty() ? "" : ", " + record.early + ",",
                         system.time(), folder.summary().string()));
  else
    log.line(fmt::format("not finished, {}: at {:.6g} s; to go on: the same command with --restart {}", record.reason,
                         system.time(), shell_word(folder.path().string())));
}

// How many free grains need not be at rest.
std::int64_t allowed_restless(const Case& c) {
  std::int64_t free = 0;
  for (const beds::Population& population : c.grains)
    if (!population.held()) free += population.count;
  constexpr double rounding = 1e-9;
  return static_cast<std::int64_t>((1.0 - c.run.until_at_rest->quantile) * static_cast<double>(free) + rounding);
}

// Of a run that was to end when its grains are at rest, and ended at its time; empty: they are, or nobody asked.
std::string rest_remark(const Case& c, const loop::LoopPlan& plan, const loop::LoopRecord& record,
                        const System& system) {
  if (!c.run.until_at_rest || !record.finished || !record.early.empty()) return {};
  if (c.run.until_at_rest->quantile < 1.0)
    return fmt::format(
        "not at rest when last looked at, every {} steps: {:.0f} grains move, and a share of {:g} at rest leaves {}; a "
        "later --until goes on with --restart",
        plan.steps_between_looks_for_enough,
        find_diagnostic(system.diagnostics(), dem::GrainSystem::restless_diagnostic).value_or(0.0),
        c.run.until_at_rest->quantile, allowed_restless(c));
  const double speed = find_diagnostic(system.diagnostics(), dem::GrainSystem::largest_speed_diagnostic).value_or(0.0);
  return fmt::format(
      "not at rest: the fastest grain moves at {:.2g} m/s (run.until_at_rest asks for {:g} m/s and {:g} "
      "m/s^2); a later --until goes on with --restart",
      speed, c.run.until_at_rest->largest_speed, c.run.until_at_rest->largest_acceleration);
}

// What may finish the run before its time.
void set_end(const Case& c, loop::LoopPlan& plan) {
  if (c.run.until_at_rest && c.run.until_at_rest->quantile < 1.0) {
    plan.enough = {{dem::GrainSystem::restless_diagnostic, static_cast<double>(allowed_restless(c) + 1)}};
    plan.enough_means = fmt::format("a share of {:g} of the grains at rest", c.run.until_at_rest->quantile);
  } else if (c.run.until_at_rest) {
    plan.enough = {{dem::GrainSystem::largest_speed_diagnostic, c.run.until_at_rest->largest_speed},
                   {dem::GrainSystem::largest_acceleration_diagnostic, c.run.until_at_rest->largest_acceleration}};
    plan.enough_means = "all grains at rest";
  } else if (c.run.until_steady) {
    plan.enough = {{continuum::ContinuumSystem::unsteadiness_diagnostic, c.run.until_steady->unsteadiness}};
    plan.enough_means = "steady";
    plan.steps_between_looks_for_enough = 1;  // its steps are long
  } else if (c.system == SystemKind::model_fluid && c.model_fluid.ramp) {
    plan.enough = {
        {model_fluid::ModelFluidField::hold_left_diagnostic, std::numeric_limits<double>::min()}};  // none is left
    plan.enough_means = "motion without end";
    plan.steps_between_looks_for_enough = 20;  // grains that take off are soon too fast for the time step
  }
}

// Bytes/s that a disk takes which is no faster than it must be, or is shared with many.
constexpr double slow_disk = 1e8;

Outcome outcome_of(const loop::LoopRecord& record) {
  if (record.finished) return Outcome::finished;
  return record.asked ? Outcome::asked_to_stop : Outcome::interrupted;
}

// Which checkpoint a run that has failed can go on from, in a sentence.
std::string last_good(const Places& places) {
  fs::path checkpoint = places.checkpoints.empty() ? fs::path() : places.checkpoints.front();
  try {
    checkpoint = places.folder.latest_checkpoint();
  } catch (const InputError&) {  // none has been written in this folder
  }
  if (checkpoint.empty())
    return "There is no checkpoint to go on from: output.checkpoint.every (s) says how often one is written.";
  return fmt::format("The last good checkpoint is {}.", checkpoint.string());
}

}  // namespace

Outcome run_case(Command command, MPI_Comm communicator, loop::WallClock::time_point started, FailureBarrier& failures,
                 loop::Log& log) {
  loop::listen_for_stop_signals();
  std::optional<io::FolderLock> lock;
  if (command.resume)
    if (const std::optional<Outcome> outcome = resume(command, lock, communicator, log)) return *outcome;
  Places places = places_of(command, communicator);
  if (places.same_folder &&
      !lock) {  // whoever still writes there may save once more: checkpoints are looked for under the lock
    lock = lock_folder(places, communicator);
    places = places_of(command, communicator);
  }
  const Case c = read_case(command.path, settings_of(command), beds_of(places.checkpoints), communicator);
  on_first_rank(communicator, [&] {
    if (!places.same_folder) places.folder.check_new(command.overwrite);
    places.folder.check_writable();
  });
  Beginning beginning;
  beginning.changes = changes_since(places, c, communicator);
  const Index3 layout = choose_layout(c, size_of(communicator), command.layout);
  const bool restarts = !places.checkpoints.empty();
  if (!restarts) about_case(command.path, [&] { check_initial_sources(c, Ranks(communicator)); });
  const Start start = restarts || c.initial.takes(InitialField::grains) ? Start::from_checkpoint : Start::as_placed;
  about_case(command.path, [&] { refuse_without_memory(c, communicator, layout); });
  const double bandwidth = has_fluid(c) ? measure_bandwidth(communicator) : 0.0;  // while there is room for its array
  forget_largest_memory();
  const fs::path state = restarts ? places.checkpoints.front() : initial_grains(c, communicator);
  const Decomposition cuts = about_case(command.path, [&] { return cuts_of_run(c, communicator, layout, state); });
  const std::unique_ptr<System> system =
      about_case(command.path, [&] { return build_system(c, communicator, cuts, start); });
  Observers observers = make_observers(c.analysis.observers, run_facts(c),
                                       {communicator, *system->snapshot().decomposition, system->time_step()});
  if (!restarts)
    about_case(command.path, [&] { take_initial_fields(communicator, c, *system); });
  else
    beginning.checkpoint = read_first_whole_checkpoint(communicator, places.checkpoints, c, *system, observers,
                                                       beginning.damage, beginning.run_history);
  if (restarts && system->step() > loop::final_step(c.run.until, system->time_step()))
    throw InputError(fmt::format("{} is at {:.6g} s already and the run ends at {:.6g} s: give a later --until.",
                                 beginning.checkpoint.string(), system->time(), c.run.until));

  if (!lock) lock = lock_folder(places, communicator);
  RunOutput output(communicator, c, places.folder, *system, observers, loop::series_row(*system, observers),
                   beginning.run_history.since,
                   places.same_folder ? std::optional<double>(system->time()) : std::nullopt);
  prepare_folder(places, c, command, system->step(), communicator, log);
  RunIdentity identity{c.name, name_of(c.system), command.line, c.run.until, layout, size_of(communicator)};
  if (!c.grains.empty()) identity.reference = reference_grain(c);
  print_header(c, identity, *system, places, beginning, bandwidth, communicator, log);
  if (!lock->keeps_others_out())
    log.line(fmt::format("warning: the file system of {} has no locks: see to it that no second run writes there",
                         places.folder.path().string()));
  output.begin();
  loop::LoopPlan plan;
  plan.until = c.run.until;
  set_end(c, plan);
  plan.watch = watch_rules(c);
  plan.out_of_bounds = c.run.watchdog;
  plan.walltime = command.walltime;
  plan.started = started;
  plan.checkpoint_guess = bytes_of_checkpoint(c) / slow_disk;
  plan.stop_file = places.folder.stop();
  plan.between_strokes = loop::seconds_between_strokes();
  plan.largest = beginning.run_history.largest;
  plan.largest_from = beginning.run_history.largest_from;
  plan.write_at_start = !places.same_folder;
  output.add_to(plan);
  loop::TimeLoop time_loop(communicator, *system, observers, plan, log);
  try {
    time_loop.run();
    if (!c.grains.empty()) io::write_bed_file(communicator, places.folder.bed(), system->snapshot());
  } catch (const std::exception& error) {  // whatever it is, it is the run that has failed
    const RunError told(fmt::format("{} {}", error_message(error), last_good(places)));
    loop::LoopRecord record = time_loop.record();
    record.finished = false;
    record.reason = told.what();
    try {
      if (!failures.all_ranks_failed(seconds_to_wait_for_others) || log.prints())
        summary_of(identity, *system, record, observers, beginning.run_history, {}, {}).write(places.folder.summary());
    } catch (const RunError&) {  // the first error is the one to tell
    }
    throw told;
  }
  const std::vector<loop::PhaseShare> phases = loop::collect_phases(communicator, *system, time_loop);
  const std::vector<Diagnostic> bed = final_bed(communicator, c, *system);
  identity.memory = memory_use(communicator);
  print_outcome(identity, time_loop.record(), *system, observers, bed, phases, places.folder, log);
  if (const std::string remark = rest_remark(c, plan, time_loop.record(), *system); !remark.empty()) log.line(remark);
  const io::JsonObject summary =
      summary_of(identity, *system, time_loop.record(), observers, beginning.run_history, bed, phases);
  on_first_rank(communicator, [&] {
    summary.write(places.folder.summary());
    std::error_code ignored;  // a request that came too late
    if (time_loop.record().finished) fs::remove(places.folder.stop(), ignored);
  });
  return outcome_of(time_loop.record());
}

}  // namespace thalweg::driver
