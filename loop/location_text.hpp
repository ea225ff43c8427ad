// A place in words, with what is around it.
#pragma once

#include "core/state/location.hpp"
#include "core/state/snapshot.hpp"

#include <mpi.h>

#include <string>

namespace thalweg::loop {

// Of fluid: "in the cell at (0.012, 0.003, 0.041) m, in open water", or "beside grain 7", or "in the pore between
// grains 3, 7 and 12": grains whose surface is within two cells of the centre, at most four of them, the lowest ids. Of
// grains: "grain 17 at (..) m", "grains 3 and 17 at (..) m". Collective, the same on every rank.
std::string location_text(MPI_Comm communicator, const Location& place, const Snapshot& snapshot);

}  // namespace thalweg::loop
