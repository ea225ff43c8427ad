// Description of a location and its surroundings for a message.
#pragma once

#include "core/state/location.hpp"
#include "core/state/snapshot.hpp"

#include <mpi.h>

#include <string>

namespace thalweg::loop {

// A cell of fluid is "in the cell at (0.012, 0.003, 0.041) m, in open water", "beside grain 7" or "in the pore between
// grains 3, 7 and 12": grains with a surface within two cells of its centre, at most four of them, those with the
// lowest ids. Grains are "grain 17 at (..) m" or "grains 3 and 17 at (..) m". Collective, the same on every rank.
std::string location_text(MPI_Comm communicator, const Location& location, const Snapshot& snapshot);

}  // namespace thalweg::loop
