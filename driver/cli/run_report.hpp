// Log of a run at its start and at its end.
#pragma once

#include "analysis/observer/observer.hpp"
#include "core/state/system.hpp"
#include "driver/execution/summary.hpp"
#include "driver/input/case_changes.hpp"
#include "driver/setup/run_history.hpp"
#include "io/folder/run_folder.hpp"
#include "loop/log.hpp"
#include "loop/time_loop.hpp"

#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace thalweg::driver {

// Starting point of a run.
struct StartPoint {
  std::filesystem::path checkpoint;  // empty: from the start
  std::vector<std::string> damage;   // of checkpoints that were passed over
  std::vector<CaseChange> changes;   // since the run that is continued
  RunHistory run_history;            // of that run
};

// Describes the run that is about to start. bandwidth: of the memory, bytes/s; 0: it does not bound the speed. Sets the
// memory bound and the number of warnings in `identity`.
void print_header(const Case& c, RunIdentity& identity, const System& system, const io::RunFolder& folder,
                  const StartPoint& start_point, double bandwidth, MPI_Comm communicator, loop::Log& log);

// Prints bed, observers' remarks, speed, memory and end of a run; the table of phases goes to the file only.
void print_outcome(const RunIdentity& identity, const loop::LoopRecord& record, const System& system,
                   const Observers& observers, const std::vector<Diagnostic>& bed,
                   const std::vector<loop::PhaseShare>& phases, const io::RunFolder& folder, loop::Log& log);

// A warning where the grains of a column have reached its top, so that there is no water over them; else empty.
std::string full_column_remark(const Case& c, const System& system);

// Explains why a run with until_at_rest reached its end time; empty if its grains are at rest or the key is not set.
std::string rest_remark(const Case& c, const loop::LoopPlan& plan, const loop::LoopRecord& record,
                        const System& system);

}  // namespace thalweg::driver
