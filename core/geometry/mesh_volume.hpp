// The volume of a box that closed surfaces enclose together below a height:
//
//   O(z) = integral over the plan of the length, below z, of what is inside any of the surfaces
//
// from columns along z, whose ends are exact, at the midpoints of a grid of 90,000 over the plan of the surfaces. O is
// exact of one block with faces along the axes, and right to 3e-3 of others.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "core/geometry/triangle_mesh.hpp"

#include <span>
#include <vector>

namespace thalweg {

// O (m^3) at `layers` + 1 heights from the floor of the box to its top, which are no periodic faces. A place counts
// once, however many surfaces enclose it. What lies beyond a periodic face comes in again at the other one; what lies
// beyond another face does not count. meshes: in m.
std::vector<double> volume_below(std::span<const TriangleMesh> meshes, const PeriodicBox& box, int layers);

}  // namespace thalweg
