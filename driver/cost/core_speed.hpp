// Time of a step on one core of this machine, measured on a sample of the case.
#pragma once

#include "driver/case/case.hpp"

#include <mpi.h>

namespace thalweg::driver {

struct CoreSpeed {
  int cores = 1;           // cores that were busy at the same time
  double of_cells = 0.0;   // s a step of the whole case on one of them: sweep, walls
  double of_grains = 0.0;  // s, the same, in the mean of the run: map, links, loads, sub-steps

  double step() const { return of_cells + of_grains; }
};

// Every rank times a piece of its own, at the same time. Takes about ten seconds, some of them to place grains. Mean
// over ranks. Of a case that sample_of() takes. Collective.
CoreSpeed measure_core_speed(const Case& c, MPI_Comm communicator);

}  // namespace thalweg::driver
