// A rank's share of the seeds of a run.
#pragma once

#include "core/parallel/decomposition.hpp"
#include "dem/clumps/clump_seed.hpp"
#include "dem/clumps/clumps.hpp"
#include "dem/motion/grain_seed.hpp"
#include "dem/ranks/grain_batch.hpp"

#include <vector>

namespace thalweg::dem {

// Largest radius (m) of grains and members of clumps.
double largest_radius_of(const std::vector<GrainSeed>& seeds, const std::vector<ClumpSeed>& clumps);
// Largest distance (m) of a member from its clump's centre.
double largest_offset_of(const std::vector<ClumpSeed>& clumps);

// The clumps whose centre a rank owns, sorted by id.
std::vector<Clump> clumps_of(const std::vector<ClumpSeed>& seeds, const Decomposition& decomposition, int rank);

// The row of a seed with its position wrapped, without forces.
GrainRow row_of(const GrainSeed& seed, const PeriodicBox& box);

// The grains and members a rank owns, sorted by id, positions wrapped. clumps: those of this rank, sorted by id; width:
// of the attached columns, which are zero.
GrainBatch batch_of(const std::vector<GrainSeed>& seeds, const std::vector<Clump>& clumps,
                    const Decomposition& decomposition, int rank, int width);

}  // namespace thalweg::dem
