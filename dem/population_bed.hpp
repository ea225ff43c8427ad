// What follows from the keys of a population but is not in them: grains from a bed, sizes of a distribution, figures of
// clumps.
#pragma once

#include "core/bed.hpp"
#include "core/periodic_box.hpp"
#include "dem/population.hpp"

#include <optional>

namespace thalweg::dem {

// disk_thickness: m; 0: spheres. bed: of placement.file, where there is one. Throws KeyError where no clump can be made
// of a shape, or where the bed was made in a periodic box of another size or of disks of another thickness, or has
// grains outside the box or overlapping too much.
void complete(Population& population, double disk_thickness, const std::optional<Bed>& bed, const PeriodicBox& box);

}  // namespace thalweg::dem
