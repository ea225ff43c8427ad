// Validity of the grains, checked at every prepare(): a fault stops the run and reports the grain's id, position and
// speed.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "dem/grain_space.hpp"
#include "dem/motion/grain_store.hpp"

#include <mpi.h>

#include <cstddef>
#include <vector>

namespace thalweg::dem {

enum class GrainFault { none, not_finite, outside, beyond_wall, in_plate, in_solid, too_fast, outran };

struct GrainValidity {
  GrainSpace space;
  double skin;                         // m, of the neighbour list: a grain may move half of it
  double time_step;                    // s
  int sub_steps;                       // in the caller's step, in which a grain may move its radius
  std::vector<std::size_t> in_solids;  // slots of grains that are half their radius deep in a solid, rising

  // displacement: m, since the neighbour list was built.
  GrainFault fault_of(const GrainStore& store, std::size_t owned_slot, double displacement) const;

  // Throws RunError, the same on every rank, about the faulty grain with the lowest id; some rank must have one.
  // listed: positions of owned grains when the list was built. Collective.
  [[noreturn]] void throw_first(const GrainStore& store, const PeriodicBox& box, const std::vector<Vec3>& listed,
                                MPI_Comm communicator) const;
};

}  // namespace thalweg::dem
