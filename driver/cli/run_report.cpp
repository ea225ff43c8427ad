#include "driver/cli/run_report.hpp"

#include "core/base/shell_word.hpp"
#include "dem/grain_system.hpp"
#include "driver/bed/reference_grain.hpp"
#include "driver/cost/cores.hpp"
#include "driver/cost/load_balance.hpp"
#include "driver/cost/machine.hpp"
#include "driver/cost/memory.hpp"
#include "driver/cost/run_cost.hpp"
#include "driver/execution/final_bed.hpp"
#include "driver/setup/version.hpp"
#include "driver/warnings/case_warnings.hpp"
#include "loop/progress.hpp"
#include "loop/stop_request.hpp"
#include "loop/time_loop.hpp"

#include <fmt/format.h>

namespace thalweg::driver {

// e.g. "the grains of run/checkpoints/step_1000.h5"
static std::vector<std::string> sources_of_start(const Case& c) {
  const std::string grains = c.initial.source_of(InitialField::grains).path,
                    fluid = c.initial.source_of(InitialField::fluid).path;
  if (!grains.empty() && grains == fluid) return {"grains and fluid of " + grains};
  std::vector<std::string> sources;
  if (!grains.empty()) sources.push_back("the grains of " + grains);
  if (!fluid.empty()) sources.push_back("the fluid of " + fluid);
  return sources;
}

void print_header(const Case& c, RunIdentity& identity, const System& system, const io::RunFolder& folder,
                  const StartPoint& start_point, double bandwidth, MPI_Comm communicator, loop::Log& log) {
  log.line(fmt::format("Thalweg {}: {}", version_text(), c.name));
  log.line(fmt::format("{} on {} rank{}, layout {} x {} x {}; {} grains, {} cells; {:.6g} s a step, {} steps to {:g} s",
                       identity.system, identity.ranks, identity.ranks == 1 ? "" : "s", identity.layout[0],
                       identity.layout[1], identity.layout[2], system.snapshot().grains.body_count(), system.cells(),
                       system.time_step(), loop::final_step(c.run.until, system.time_step()), c.run.until));
  if (const std::string text = partition_text(c, *system.snapshot().decomposition); !text.empty()) log.line(text);
  for (const std::string& damage : start_point.damage) log.line("warning: " + damage);
  if (!start_point.checkpoint.empty())
    log.line(fmt::format("resuming from {} at {:.6g} s", start_point.checkpoint.string(), system.time()));
  else
    for (const std::string& source : sources_of_start(c)) log.line("beginning with " + source);
  for (const CaseChange& change : start_point.changes)
    log.line(fmt::format("changed since then: {}: {} -> {}", change.key, change.before, change.now));
  for (const auto& [observer, time] : start_point.run_history.since)
    log.line(fmt::format("analysis.{}: averaging starts at {:.6g} s", observer, time));
  for (const std::string& line : as_text(identity.provenance)) log.file_line(line);
  log.line(fmt::format("writing {}", folder.path().string()));
  if (const double delay = loop::sigcont_to_sigterm_delay(); delay > 0.0)
    log.line(fmt::format("to stop early: thalweg stop {} (after Ctrl-C or SIGTERM mpirun allows only {:.2g} s to save)",
                         shell_word(folder.path().string()), 2.0 * delay));
  if (!c.grains.empty()) log.line("reference grain: " + reference_text(c));
  if (const auto units = units_text(c.model_fluid); units && c.system == SystemKind::model_fluid) log.line(*units);
  if (bandwidth > 0.0) {
    const double bytes = bytes_per_cell_update(bytes_per_value(c));
    identity.memory_bound_mlups = bandwidth / bytes * 1e-6;
    log.line(fmt::format("memory bandwidth {:.1f} GB/s; {:.0f} bytes per cell update: at most {:.0f} MLUPS",
                         bandwidth * 1e-9, bytes, identity.memory_bound_mlups));
  }
  std::vector<std::string> all = warnings(c);
  if (const std::string warning = crowding_warning(communicator); !warning.empty()) all.push_back(warning);
  for (const std::string& warning : all) log.line("warning: " + warning);
  identity.warnings = static_cast<std::int64_t>(all.size());
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
    log.line(fmt::format(
        "not finished, {}: at {:.6g} s; to continue, repeat the command with --resume (and without --restart)",
        record.reason, system.time()));
}

std::string full_column_remark(const Case& c, const System& system) {
  if (c.system != SystemKind::continuum) return {};
  const double surface = find_diagnostic(system.diagnostics(), "surface_height").value_or(0.0);
  if (surface < column_of(c).column.height()) return {};
  return "warning: the grains fill the column up to its top, so that no clear water is left over them, and bed_stress "
         "and shields_number are 0; give deeper water (column.depth, or a smaller gravity.slope with the same "
         "column.shields_number)";
}

std::string rest_remark(const Case& c, const loop::LoopPlan& plan, const loop::LoopRecord& record,
                        const System& system) {
  if (!c.run.until_at_rest || !record.finished || !record.early.empty()) return {};
  const std::vector<Diagnostic> figures = system.diagnostics();
  const auto figure = [&figures](const char* name) { return find_diagnostic(figures, name).value_or(0.0); };
  if (system.time() < plan.stop_criteria_from || figure("supply_lag") > 0.0 || figure("returning_grains") > 0.0)
    return "not at rest: grains were still to come in, by a supply or on their way back; continue with --restart and a "
           "later --until";
  if (c.run.until_at_rest->quantile < 1.0)
    return fmt::format(
        "not at rest at the last check (every {} steps): a share of {:.3g} of the grains is moving, and a share "
        "of {:g} at rest allows {:.3g}; continue with --restart and a later --until",
        plan.steps_between_convergence_checks, figure(dem::GrainSystem::restless_share_diagnostic),
        c.run.until_at_rest->quantile, 1.0 - c.run.until_at_rest->quantile);
  return fmt::format(
      "not at rest: the fastest grain moves at {:.2g} m/s (run.until_at_rest asks for {:g} m/s and {:g} "
      "m/s^2); continue with --restart and a later --until",
      figure(dem::GrainSystem::largest_speed_diagnostic), c.run.until_at_rest->largest_speed,
      c.run.until_at_rest->largest_acceleration);
}

}  // namespace thalweg::driver
