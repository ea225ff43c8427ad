// What a run leaves behind in figures: summary.json for scripts, a table of phases for people.
#pragma once

#include "analysis/observer.hpp"
#include "driver/time_loop.hpp"
#include "io/json_object.hpp"

#include <mpi.h>

#include <memory>
#include <string>
#include <vector>

namespace thalweg::driver {

// Where the wall time went, over all ranks.
struct PhaseShare {
  std::string name;
  double mean_seconds;     // over ranks
  double largest_seconds;  // of the slowest rank
  double share;            // of the wall time of the loop, 0 .. 1 (from the mean)
};

// Phases of the system's timer, then of the loop's, then "other": what neither measured. Collective; the result is
// complete on rank 0 only. Phases need not be the same on every rank.
std::vector<PhaseShare> collect_phases(MPI_Comm communicator, System& system, TimeLoop& loop);

// A table, one line a phase, widest column first.
std::vector<std::string> phase_table(const std::vector<PhaseShare>& phases);

// Speeds over the whole loop, output included.
struct Speeds {
  double steps_per_second;
  double mlups;            // million cell updates a second over all cells of the domain; 0 without a lattice
  double mlups_advancing;  // the same without output and checkpoints
  double grain_steps_per_second;
};
Speeds speeds_of(const System& system, const LoopRecord& record);

// What is known of a run before it starts.
struct RunIdentity {
  std::string name, system, command;
  double until;  // s
  Index3 layout;
  int ranks;
  double memory_bound_mlups = 0.0;  // what the measured memory bandwidth allows; 0 without a lattice
};

// summary.json of a run that has ended in whatever way. `phases` may be empty.
io::JsonObject summary_of(const RunIdentity& identity, const System& system, const LoopRecord& record,
                          const std::vector<std::unique_ptr<analysis::Observer>>& observers,
                          const std::vector<PhaseShare>& phases);

}  // namespace thalweg::driver
