// `thalweg run`: from a case file to a run folder.
#pragma once

#include "driver/collective_failure.hpp"
#include "driver/command_line.hpp"
#include "driver/log.hpp"
#include "driver/time_loop.hpp"

#include <mpi.h>

namespace thalweg::driver {

// Runs the case to its end, or until it is told to stop. Throws InputError before anything was written; throws RunError
// after summary.json has been written with the reason. Collective.
void run_case(const Command& command, MPI_Comm communicator, WallClock::time_point started, FailureCouncil& council,
              Log& log);

}  // namespace thalweg::driver
