// Points that cover a surface evenly, each with its share of the area.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/triangle_mesh.hpp"
#include "dem/clumps/placed_sphere.hpp"

#include <span>
#include <vector>

namespace thalweg::beds {

struct SurfacePoint {
  Vec3 position;  // m
  double area;    // m^2
};

// Of triangles: centroids of their equal parts, of edges no longer than `size` (m).
std::vector<SurfacePoint> points_of(const TriangleMesh& mesh, double size);

// Points without an area along the creases of a union of spheres, where two of them meet and no other holds the place.
std::vector<SurfacePoint> crease_points(std::span<const dem::PlacedSphere> spheres);

// Of a union of spheres: of each sphere the points of a spiral that no other sphere holds. sphere: its number, if not
// null, one a point.
std::vector<SurfacePoint> points_of(std::span<const dem::PlacedSphere> spheres, std::vector<std::size_t>* sphere);

}  // namespace thalweg::beds
