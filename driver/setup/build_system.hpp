// The system that runs a case.
#pragma once

#include "core/parallel/decomposition.hpp"
#include "core/state/system.hpp"
#include "driver/case/case.hpp"

#include <mpi.h>

#include <memory>
#include <optional>

namespace thalweg::driver {

// The layout of ranks a run uses: the one asked for, or the best one. Throws InputError where the layout does not use
// every rank, or blocks would get too small.
Index3 choose_layout(const Case& c, int ranks, const std::optional<Index3>& requested);

// Cells, axes and blocks of the case's domain, cut evenly.
Decomposition decomposition_of(const Case& c, const Index3& layout);

// Grains that a system is built with: those placed by the case, or none because a checkpoint has them.
enum class Start { as_placed, from_checkpoint };

// The system the case names, at its initial state, or to be loaded. Throws InputError. Collective.
std::unique_ptr<System> build_system(const Case& c, MPI_Comm communicator, const Decomposition& cuts,
                                     Start start = Start::as_placed);

// One builder a system; build_system() chooses.
std::unique_ptr<System> build_lattice_system(const Case& c, MPI_Comm communicator, const Decomposition& cuts,
                                             Start start);
std::unique_ptr<System> build_grains_system(const Case& c, MPI_Comm communicator, const Decomposition& cuts,
                                            Start start);
std::unique_ptr<System> build_continuum_system(const Case& c, MPI_Comm communicator, const Decomposition& cuts,
                                               Start start);

}  // namespace thalweg::driver
