// Memory bandwidth of this machine, which bounds the speed of the lattice.
#pragma once

#include <mpi.h>

namespace thalweg::driver {

// Bytes per second read and written by this process alone, as below. Needs no MPI.
double measure_bandwidth();

// Bytes per second read and written by all ranks together updating arrays much larger than their caches in place.
// Takes about 0.1 s. Collective.
double measure_bandwidth(MPI_Comm communicator);

// Whether memory bounds the speed of a lattice of so many bytes on all ranks: the caches hold a smaller one.
inline bool exceeds_caches(double bytes) { return bytes > 32.0 * 1024.0 * 1024.0; }

// Bytes a cell update must move at least: 19 populations of `bytes_per_value` read and written once.
inline double bytes_per_cell_update(double bytes_per_value) { return 2.0 * 19.0 * bytes_per_value; }

}  // namespace thalweg::driver
