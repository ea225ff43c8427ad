// `thalweg run`: from a case file to a run folder.
#pragma once

#include "core/failure_barrier.hpp"
#include "driver/command_line.hpp"
#include "loop/log.hpp"
#include "loop/time_loop.hpp"

#include <mpi.h>

namespace thalweg::driver {

// Runs the case to its end (true), or until a signal, the wall time or a stop file stops it (false). Throws InputError
// before anything was written; throws RunError after summary.json has been written with the reason. Collective.
bool run_case(const Command& command, MPI_Comm communicator, loop::WallClock::time_point started,
              FailureBarrier& failures, loop::Log& log);

}  // namespace thalweg::driver
