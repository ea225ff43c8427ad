// From populations to single grains at the start, to rigid assemblies and to materials.
#pragma once

#include "dem/clump_seed.hpp"
#include "dem/grain_seed.hpp"
#include "dem/material_keys.hpp"
#include "dem/placing_ranks.hpp"
#include "dem/population.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::dem {

// All grains at the start, a clump with its centre at its place. Ids run through the populations in their order. Given
// positions are taken first, then uniform patterns, then dense and random ones, which keep clear of all others. Throws
// InputError where they do not fit. A rank gets those with their centre where it knows the box, and the members of
// rigid assemblies, with the ids that they have among all; of the others of a uniform pattern nothing is kept, and
// those of a file come from the ranks in whose share they are. Collective.
GrainSeeds grain_seeds(std::span<const Population> populations, const PlacingRanks& ranks);

// What of its motion is prescribed, of all its grains.
Motion motion_of(const Population& population);

// Of the populations that move as one body, in their order.
std::vector<PrescribedMotion> assemblies_of(std::span<const Population> populations);

// Number 0 is `contact` itself; every population with a material of its own has one more, in their order.
std::vector<ContactParameters> materials_of(const ContactParameters& contact, std::span<const Population> populations);
int material_of(std::span<const Population> populations, std::size_t population);

// Diameters that grains from bed files may overlap by at the start; 0: none is from a file.
double allowed_overlap(std::span<const Population> populations);

}  // namespace thalweg::dem
