// Volume, centre and inertia of bodies made of overlapping spheres, each part of space counted once.
//
// The plane at height z cuts the union of spheres in a union of disks. Its area and its first and second moments are
// those of Green's theorem over the arcs that no other disk covers, in closed form; for example
//   A = 1/2 oint (x dy - y dx),  S_x = 1/2 oint x^2 dy,  S_xx = 1/3 oint x^3 dy.
// Along z they are integrated by Gauss and Legendre between the heights where the arcs change: ends of the spheres,
// ends of the circles in which two spheres meet, points where three meet. With z = m - h cos(theta) in each interval
// the square roots at its ends become smooth; intervals are halved until nothing changes any more. SI units.
#pragma once

#include "core/base/types.hpp"
#include "dem/clumps/placed_sphere.hpp"

#include <Eigen/Core>

#include <span>

namespace thalweg::dem {

// Volume, centre and inertia of a body of density 1 kg/m^3.
struct BodyMoments {
  double volume = 0.0;                                // m^3
  Vec3 centre = Vec3::Zero();                         // m
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // kg m^2, about the centre
};

// Relative error about 1e-12. There must be one sphere at least, and all radii positive.
BodyMoments union_of_spheres(std::span<const PlacedSphere> spheres);

// Disks in one plane x-z with their axis along y, `thickness` (m) high, that reach as far on both sides of the plane.
BodyMoments union_of_disks(std::span<const PlacedSphere> disks, double thickness);

}  // namespace thalweg::dem
