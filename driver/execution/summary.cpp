#include "driver/execution/summary.hpp"

#include "driver/setup/version.hpp"

#include <fmt/format.h>

namespace thalweg::driver {

namespace {

io::JsonObject diagnostics_as_json(const std::vector<Diagnostic>& diagnostics, io::JsonObject& units) {
  io::JsonObject object;
  for (const Diagnostic& diagnostic : diagnostics) {
    object.set(diagnostic.name, diagnostic.value);
    units.set(diagnostic.name, diagnostic.unit);
  }
  return object;
}

}  // namespace

io::JsonObject summary_of(const RunIdentity& identity, const System& system, const loop::LoopRecord& record,
                          const Observers& observers, const RunHistory& run_history, const std::vector<Diagnostic>& bed,
                          const std::vector<loop::PhaseShare>& phases) {
  const loop::Speeds speeds = loop::speeds_of(system, record);
  io::JsonObject summary;
  summary.set("finished", record.finished).set("reason", record.finished ? "" : record.reason);
  summary.set("name", identity.name).set("system", identity.system);
  summary.set("version", version_text()).set("command", identity.command);
  summary.set("simulated_time", static_cast<double>(record.last_step) * system.time_step());
  summary.set("until", identity.until).set("time_step", system.time_step());
  summary.set("steps", record.last_step).set("steps_in_this_session", record.last_step - record.first_step);
  summary.set("ranks", identity.ranks);
  summary.set("layout", fmt::format("{},{},{}", identity.layout[0], identity.layout[1], identity.layout[2]));
  summary.set("cells", system.cells()).set("grains", system.snapshot().grains.body_count());
  if (identity.reference)
    summary.set("reference_diameter", identity.reference->diameter)
        .set("reference_density", identity.reference->density);
  summary.set("wall_seconds", record.wall_seconds).set("steps_per_second", speeds.steps_per_second);
  summary.set("mlups", speeds.mlups).set("mlups_advancing", speeds.mlups_advancing);
  if (identity.memory_bound_mlups > 0.0)
    summary.set("memory_bound_mlups", identity.memory_bound_mlups)
        .set("share_of_memory_bound", speeds.mlups_advancing / identity.memory_bound_mlups);
  summary.set("grain_steps_per_second", speeds.grain_steps_per_second);
  if (identity.memory)
    summary.set("memory_bytes", identity.memory->all_ranks)
        .set("memory_bytes_of_largest_rank", identity.memory->largest_rank);
  io::JsonObject table;
  for (const loop::PhaseShare& phase : phases)
    table.set(phase.name, io::JsonObject()
                              .set("mean_seconds", phase.mean_seconds)
                              .set("largest_seconds", phase.largest_seconds)
                              .set("share", phase.share));
  summary.set("phases", table);
  summary.set("warnings_at_start", identity.warnings).set("warnings", record.warnings);
  io::JsonObject units;  // of diagnostics and results, by name
  summary.set("figures", diagnostics_as_json(record.diagnostics, units))
      .set("largest", diagnostics_as_json(record.largest, units));
  summary.set("largest_from", record.largest_from);
  for (const auto& observer : observers)
    if (observer->every() > 0.0 || identity.has_series)  // else it has measured nothing
      summary.set(observer->name(), diagnostics_as_json(run_history.results_of(*observer), units));
  if (!bed.empty()) summary.set("bed", diagnostics_as_json(bed, units));
  summary.set("provenance", as_json(identity.provenance));
  if (identity.reference) units.set("reference_diameter", "m").set("reference_density", "kg/m^3");
  summary.set("units", units);
  return summary;
}

}  // namespace thalweg::driver
