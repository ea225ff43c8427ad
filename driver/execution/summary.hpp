// Results of a run for scripts: summary.json.
#pragma once

#include "driver/bed/reference_grain.hpp"
#include "driver/cost/memory.hpp"
#include "driver/setup/provenance.hpp"
#include "driver/setup/run_history.hpp"
#include "io/files/json_object.hpp"
#include "loop/phase_shares.hpp"

#include <mpi.h>

#include <optional>
#include <string>
#include <vector>

namespace thalweg::driver {

// Metadata of a run.
struct RunIdentity {
  std::string name, system, command;
  double until;  // s
  Index3 layout;
  int ranks;
  std::optional<ReferenceGrain> reference = {};  // none without grains
  double memory_bound_mlups = 0.0;               // rate that the memory bandwidth allows; 0: caches hold the lattice
  std::optional<MemoryUse> memory = {};          // once it has ended in good order
  std::int64_t warnings = 0;                     // about the case, printed when the run begins
  bool has_series = true;      // with whose rows, the first of the start, observers measure that have no interval
  Provenance provenance = {};  // once the run folder is there
};

// summary.json of a run that has ended in whatever way. `bed` (final_bed.hpp) and `phases` may be empty.
io::JsonObject summary_of(const RunIdentity& identity, const System& system, const loop::LoopRecord& record,
                          const Observers& observers, const RunHistory& run_history, const std::vector<Diagnostic>& bed,
                          const std::vector<loop::PhaseShare>& phases);

}  // namespace thalweg::driver
