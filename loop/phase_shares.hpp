// Shares of the phases in the wall time of a run, and the speeds it reached.
#pragma once

#include "loop/time_loop.hpp"

#include <mpi.h>

#include <string>
#include <vector>

namespace thalweg::loop {

// Wall time of a phase over all ranks.
struct PhaseShare {
  std::string name;
  double mean_seconds;     // over ranks
  double largest_seconds;  // of the slowest rank
  double share;            // of the wall time of the loop, 0 .. 1 (from the mean)
};

// Phases of the system's timer, then of the loop's, then "other", the unmeasured rest. Phases may differ between ranks.
// The result is complete on rank 0 only. Collective.
std::vector<PhaseShare> collect_phases(MPI_Comm communicator, System& system, TimeLoop& loop);

// Table with a heading and one line per phase: name, mean and largest seconds, share.
std::vector<std::string> phase_table(const std::vector<PhaseShare>& phases);

// Speeds over the whole loop, output included.
struct Speeds {
  double steps_per_second;
  double mlups;            // million cell updates per second over all cells of the domain; 0 without a lattice
  double mlups_advancing;  // the same without output and checkpoints
  double grain_steps_per_second;
};
Speeds speeds_of(const System& system, const LoopRecord& record);

}  // namespace thalweg::loop
