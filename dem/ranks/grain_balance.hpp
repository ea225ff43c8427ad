// Cuts between ranks that follow the grains. Results do not depend on cuts, so they may move at any time.
#pragma once

#include "core/parallel/decomposition.hpp"
#include "dem/motion/grain_store.hpp"

#include <mpi.h>

#include <optional>

namespace thalweg::dem {

// Layout of the same ranks with cuts that give every slab of ranks along an axis the same number of grains; nothing if
// the fullest rank has less than a tenth more than the mean, or if no cut would move. Positions must be wrapped.
// Collective.
std::optional<Decomposition> balanced_cuts(const Decomposition& decomposition, const GrainStore& store,
                                           MPI_Comm communicator);

}  // namespace thalweg::dem
