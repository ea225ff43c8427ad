// The level of the bed under a place at which a grain may come in: the highest point, from the floor of the box on, of
//
//   - the tops, z + R, of the grains of the bed that a vertical column about the place, as wide as what comes in, cuts,
//   - walls and solids on the vertical line through the place, below the upper end of the entrance.
//
// Grains of the bed are held, or touch another grain, a wall or a solid: those that lie, roll or slide, not those that
// hop or are carried above them. A body whose centre is above this level by its own radius touches none of them.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"
#include "dem/contact/neighbour_list.hpp"
#include "dem/motion/grain_store.hpp"

#include <cstddef>
#include <span>

namespace thalweg::dem {

// The highest point (m) of walls and solids on the vertical line down from a point to the floor of the box, at least 0.
double level_of_surroundings(const Vec3& from, const Surroundings& around);

// The highest top (m) of these grains that a vertical column with this axis and radius (m) cuts; 0 where there is none.
double level_of_grains(const Vec3& axis, double radius, const GrainStore& store, std::span<const std::size_t> slots,
                       const PeriodicBox& box);

}  // namespace thalweg::dem
