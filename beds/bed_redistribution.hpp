// Redistribution of the rows of bed files to the ranks that need them when a run begins.
#pragma once

#include "beds/packing/packing_domain.hpp"
#include "beds/packing/random_packing.hpp"
#include "beds/population/population.hpp"
#include "core/state/bed.hpp"

#include <functional>
#include <span>
#include <vector>

namespace thalweg::beds {

// Centre (m) of the grain or clump that some rows make.
using CentreOf = std::function<Vec3(std::span<const BedGrain> body)>;

// Rows, in the order of the file, of the grains and clumps with their centre in the part of the box that this rank
// knows; all rows of a population that moves as one body. Needs several ranks. Collective.
std::vector<BedGrain> rows_known(const Population& population, const PackingDomain& ranks, const CentreOf& centre_of);

// Grains and members of clumps that this rank knows, numbered by row, as obstacles for others. Collective.
std::vector<Obstacle> spheres_of_file(const Population& population, const PackingDomain& ranks);

}  // namespace thalweg::beds
