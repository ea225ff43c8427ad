// Import of the rows of a bed file into a population, with their figures.
#pragma once

#include "beds/population/population.hpp"
#include "core/geometry/periodic_box.hpp"
#include "core/parallel/ranks.hpp"
#include "core/state/bed.hpp"

#include <vector>

namespace thalweg::beds {

// rows: this rank's share of the file, in its order, with all members of a clump on one rank. Those with their centre
// in the region of the placement become the population's `file`; of all ranks, they give its figures, count, diameter
// and density. box: of the bed, m. Throws InputError, on every rank, where rows make no clump. Collective.
void take_rows(Population& population, std::vector<BedGrain> rows, const PeriodicBox& box, const Ranks& ranks);

}  // namespace thalweg::beds
