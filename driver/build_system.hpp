// From a case to the system that runs it.
#pragma once

#include "core/decomposition.hpp"
#include "core/system.hpp"
#include "driver/case.hpp"

#include <mpi.h>

#include <memory>
#include <optional>

namespace thalweg::driver {

// The layout of ranks a run uses: the one asked for, or the best one. Throws InputError where the layout does not use
// every rank, or blocks would get too small.
Index3 choose_layout(const Case& c, int ranks, const std::optional<Index3>& requested);

// Cells, axes and blocks of the case's domain.
Decomposition decomposition_of(const Case& c, const Index3& layout);

// The system the case names, at its initial state. Throws InputError. Collective.
std::unique_ptr<System> build_system(const Case& c, MPI_Comm communicator, const Index3& layout);

// One builder a system; build_system() chooses.
std::unique_ptr<System> build_resolved_system(const Case& c, MPI_Comm communicator, const Index3& layout);
std::unique_ptr<System> build_fluid_system(const Case& c, MPI_Comm communicator, const Index3& layout);
std::unique_ptr<System> build_grains_system(const Case& c, MPI_Comm communicator, const Index3& layout);

// The name of a kind of system in a case file: "resolved", "fluid", "grains".
const char* name_of(SystemKind kind);

}  // namespace thalweg::driver
