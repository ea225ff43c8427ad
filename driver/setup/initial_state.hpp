// The start of a run from the states of other runs (`initial.from`).
#pragma once

#include "core/parallel/ranks.hpp"
#include "core/state/system.hpp"
#include "driver/case/case.hpp"

#include <mpi.h>

#include <filesystem>

namespace thalweg::driver {

// Throws InputError where a run that the case begins from is missing, or lacks what is to be taken from it: a fluid, or
// the grains that the case describes, of the same size, mass, motion and material, in a box with the same periods.
// ranks: those that have read the case together, which all throw. Collective.
void check_initial_sources(const Case& c, const Ranks& ranks = {});

// The state that the grains of a run come from; empty: the case places them. Collective.
std::filesystem::path initial_grains(const Case& c, MPI_Comm communicator);

// Grains and fluid of the system from where the case says. Throws InputError where they do not fit. Collective.
void take_initial_fields(MPI_Comm communicator, const Case& c, System& system);

}  // namespace thalweg::driver
