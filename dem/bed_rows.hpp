// Takes the rows of a bed file into a population, and finds what there is to know of all of them.
#pragma once

#include "core/bed.hpp"
#include "core/periodic_box.hpp"
#include "core/ranks.hpp"
#include "dem/population.hpp"

#include <vector>

namespace thalweg::dem {

// rows: of the file, this rank's share in their order, the members of a clump on one rank. Those of grains and clumps
// with their centre in the region of the placement become the population's `file`, all of them its figures, count,
// diameter and density. box: of the bed, m. Throws InputError, on every rank, where rows make no clump. Collective.
void take_rows(Population& population, std::vector<BedGrain> rows, const PeriodicBox& box, const Ranks& ranks);

}  // namespace thalweg::dem
