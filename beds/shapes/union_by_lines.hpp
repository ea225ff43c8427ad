// Volume, centre and inertia of a union of spheres by parallel lines: exact along x, by the midpoint rule across.
//
// Relative error below 1e-4, in a time proportional to the number of spheres; sphere_union_inertia.hpp is exact, and
// takes a time that grows with the fourth power of how many overlap.
#pragma once

#include "dem/clumps/placed_sphere.hpp"
#include "dem/clumps/sphere_union_inertia.hpp"

#include <span>

namespace thalweg::beds {

dem::BodyMoments union_by_lines(std::span<const dem::PlacedSphere> spheres);  // at least one; at 1 kg/m^3

}  // namespace thalweg::beds
