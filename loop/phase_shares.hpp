// Where the wall time of a run went, and the speeds it reached.
#pragma once

#include "loop/time_loop.hpp"

#include <mpi.h>

#include <string>
#include <vector>

namespace thalweg::loop {

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

// A table with a heading and one line a phase: name, mean and largest seconds, share.
std::vector<std::string> phase_table(const std::vector<PhaseShare>& phases);

// Speeds over the whole loop, output included.
struct Speeds {
  double steps_per_second;
  double mlups;            // million cell updates a second over all cells of the domain; 0 without a lattice
  double mlups_advancing;  // the same without output and checkpoints
  double grain_steps_per_second;
};
Speeds speeds_of(const System& system, const LoopRecord& record);

}  // namespace thalweg::loop
