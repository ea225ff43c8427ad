// A clump whose spheres stand for another body: it has the volume, centre and moments of that body.
#pragma once

#include "dem/clumps/clump_seed.hpp"
#include "dem/clumps/sphere_union_inertia.hpp"

#include <span>

namespace thalweg::dem {

// members: m, in the frame of the body. Throws InputError for members that make no clump (clump_shape()), and for a
// body without a positive volume or whose principal moments are not positive or break the triangle inequality.
ClumpShape clump_shape(std::span<const PlacedSphere> members, const BodyMoments& body);

}  // namespace thalweg::dem
