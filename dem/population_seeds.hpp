// From populations to single grains at the start, to rigid assemblies and to materials.
#pragma once

#include "core/periodic_box.hpp"
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

// The grains at the start that this rank knows (placing_ranks.hpp), a clump with its centre at its place, and the
// members of rigid assemblies: the same grains on any number of ranks. Ids run through the populations in their order.
// Given positions are taken first, then uniform patterns, then dense and random ones, which keep clear of all others.
// Collective. Throws InputError, on every rank, where they do not fit.
GrainSeeds grain_seeds(std::span<const Population> populations, const PlacingRanks& ranks);

// Which components of the motion of its grains are held.
Motion motion_of(const Population& population);

// The motions of the populations that move as one body, in their order.
std::vector<PrescribedMotion> assemblies_of(std::span<const Population> populations);

// Number 0 is `contact` itself; every population with a material of its own has one more, in their order.
std::vector<ContactParameters> materials_of(const ContactParameters& contact, std::span<const Population> populations);
int material_of(std::span<const Population> populations, std::size_t population);

// Diameters that grains from bed files may overlap by at the start; 0: none is from a file.
double allowed_overlap(std::span<const Population> populations);

}  // namespace thalweg::dem
