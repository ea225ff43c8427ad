// Check of overlaps between the rows of a bed file, which are spread over several ranks.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "core/parallel/ranks.hpp"
#include "core/state/bed.hpp"

#include <span>

namespace thalweg::beds {

// rows: this rank's, with their numbers as id; inside the box. Throws InputError, on every rank, for the pair of lowest
// numbers that overlaps by more than so many diameters of the smaller; members of one clump may. largest_radius: m, of
// the rows of all ranks. A rank compares the rows in a slab of the bed, at least as wide as a grain, with those within
// reach of it. Collective.
void refuse_overlaps(std::span<const BedGrain> rows, const PeriodicBox& box, double allowed_overlap,
                     double largest_radius, const Ranks& ranks);

}  // namespace thalweg::beds
