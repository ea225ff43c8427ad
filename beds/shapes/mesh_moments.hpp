// Volume, centre, inertia, area and mean curvature of a closed triangle surface.
//
// The divergence theorem makes volume integrals sums over triangles: each triangle and an origin span a tetrahedron of
// signed volume V_t = a.(b x c)/6, with the first moment V_t (a + b + c)/4 and the second moment
// V_t/20 (a a' + b b' + c c' + s s'), s = a + b + c. The sums are exact for a surface of triangles, whatever the
// origin. The integral of the mean curvature is half the sum, over all edges, of length times exterior angle (J.
// Steiner).
#pragma once

#include "core/geometry/triangle_mesh.hpp"
#include "dem/clumps/sphere_union_inertia.hpp"

namespace thalweg::beds {

// Of a surface that is closed and wound outwards; at 1 kg/m^3 and m where points are in m.
dem::BodyMoments body_moments(const TriangleMesh& mesh);

double surface_area(const TriangleMesh& mesh);                // m^2
double integral_of_mean_curvature(const TriangleMesh& mesh);  // m; 4 pi R of a sphere

}  // namespace thalweg::beds
