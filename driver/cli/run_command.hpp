// `thalweg run`: from a case file to a run folder.
#pragma once

#include "core/parallel/failure_barrier.hpp"
#include "driver/cli/command_line.hpp"
#include "loop/log.hpp"
#include "loop/time_loop.hpp"

#include <mpi.h>

namespace thalweg::driver {

enum class Outcome {
  finished,       // or was already, with --resume
  interrupted,    // by a signal or the wall time; it wants to go on
  asked_to_stop,  // by thalweg stop; its user says when it goes on
};

// Runs the case to its end, or until something stops it. Throws InputError before anything was written; throws RunError
// after summary.json has been written with the reason. Collective.
Outcome run_case(Command command, MPI_Comm communicator, loop::WallClock::time_point started, FailureBarrier& failures,
                 loop::Log& log);

}  // namespace thalweg::driver
