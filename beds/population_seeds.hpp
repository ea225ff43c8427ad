// Seeds, rigid assemblies and materials that follow from populations.
#pragma once

#include "beds/packing/packing_domain.hpp"
#include "beds/population/material_keys.hpp"
#include "beds/population/population.hpp"
#include "core/geometry/periodic_box.hpp"
#include "dem/clumps/clump_seed.hpp"
#include "dem/motion/grain_seed.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::beds {

// The grains at the start that this rank knows (packing_domain.hpp), a clump with its centre at its place, and the
// members of rigid assemblies: the same grains on any number of ranks. Ids run through the populations in their order.
// Given positions are taken first, then uniform patterns, then dense and random ones, which keep clear of all others.
// Collective. Throws InputError, on every rank, where they do not fit.
dem::GrainSeeds grain_seeds(std::span<const Population> populations, const PackingDomain& ranks);

// Components of the motion of its grains that are held.
dem::Motion motion_of(const Population& population);

// The motions of the populations that move as one body, in their order.
std::vector<dem::PrescribedMotion> assemblies_of(std::span<const Population> populations);

// Number 0 is `contact` itself; every population with a material of its own has one more, in their order.
std::vector<dem::ContactParameters> materials_of(const dem::ContactParameters& contact,
                                                 std::span<const Population> populations);
int material_of(std::span<const Population> populations, std::size_t population);

// Diameters that grains from bed files may overlap by at the start; 0: none is from a file.
double allowed_overlap(std::span<const Population> populations);

}  // namespace thalweg::beds
