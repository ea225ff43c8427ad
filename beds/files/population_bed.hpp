// Completion of a population: grains from a bed, sizes of a distribution, figures of clumps.
#pragma once

#include "beds/population/population.hpp"
#include "core/geometry/periodic_box.hpp"
#include "core/parallel/ranks.hpp"
#include "core/state/bed.hpp"

#include <optional>

namespace thalweg::beds {

// disk_thickness: m; 0: spheres. bed: of placement.file, where there is one, with this rank's share of its rows.
// reference_diameter: m, of the layers of a fill; none: the median by volume of the population itself. Throws KeyError,
// on every rank, where no clump can be made of a shape or of rows, where more grains are asked for than can be counted
// or a fill is deeper than its room, or where the bed was made in a periodic box of another size or of disks of another
// thickness, or has grains outside the box or overlapping too much. Collective.
void complete(Population& population, double disk_thickness, std::optional<Bed> bed, const PeriodicBox& box,
              std::optional<double> reference_diameter, const Ranks& ranks = {});

}  // namespace thalweg::beds
