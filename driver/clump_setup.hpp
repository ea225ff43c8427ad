// From clumps as a case or a bed file has them to clumps as dem wants them.
#pragma once

#include "core/periodic_box.hpp"
#include "dem/clump_seed.hpp"
#include "driver/grain_case.hpp"
#include "io/bed_file.hpp"

#include <memory>
#include <span>
#include <vector>

namespace thalweg {

// Of a population with `shape`. Throws InputError where dem cannot make one of it.
std::shared_ptr<const dem::ClumpShape> clump_shape_of(const PopulationCase& population);

// Of one clump of such a population: the given one, or one of all that are equally likely (K. Shoemake, Graphics Gems
// III (1992) 124; of disks, about y). grain: its number in the population.
dem::Quaternion orientation_of(const PopulationCase& population, std::size_t grain);

// The grains of a bed file one by one, each either one row or the members of one clump, which follow each other.
std::vector<std::span<const io::BedGrain>> bodies_of(std::span<const io::BedGrain> rows);

// The clump that its members make, as it lies and moves; its id stays 0. box: of the bed. thickness: m, of disks.
dem::ClumpSeed clump_from(std::span<const io::BedGrain> members, const PeriodicBox& box, double thickness);

// Adds what a population's figures need of `count` clumps of this shape.
void add_clumps(ClumpFigures& figures, const dem::ClumpShape& shape, double density, std::int64_t count);

}  // namespace thalweg
