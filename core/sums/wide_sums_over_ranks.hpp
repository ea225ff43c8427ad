// Sums of 128-bit integers over all ranks: exact, so the same whatever the ranks.
#pragma once

#include "core/base/types.hpp"
#include "core/sums/fixed_point.hpp"
#include "core/sums/wide_sum.hpp"

#include <mpi.h>

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

// Replaces every sum by its total over the ranks, on every rank. Sums and totals must be below 2^94 in magnitude, ranks
// fewer than 2^31. Collective.
void sum_over_ranks(MPI_Comm communicator, std::span<WideSum> sums);

// Totals of sums that every rank has in 64 bits; and of vectors of LatticeFixed sums, in lattice units. Collective.
std::vector<WideSum> wide_sums_over_ranks(MPI_Comm communicator, std::span<const std::int64_t> sums);
std::vector<Vec3> vectors_over_ranks(MPI_Comm communicator, std::span<const FixedVec3> sums);

}  // namespace thalweg
