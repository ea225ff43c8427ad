// The volume of a box that a closed surface encloses below a height:
//
//   O(z) = integral over the surface below z of (z' - z) n_z dA           (divergence theorem; the cut at z adds
//   nothing)
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "core/geometry/triangle_mesh.hpp"

#include <vector>

namespace thalweg {

// O (m^3) at `layers` + 1 heights from the floor of the box to its top, which are no periodic faces; exact. What lies
// beyond a periodic face counts, as it comes in again at the other one, up to the length of the box; what lies beyond
// another face does not. mesh: in m.
std::vector<double> volume_below(const TriangleMesh& mesh, const PeriodicBox& box, int layers);

}  // namespace thalweg
