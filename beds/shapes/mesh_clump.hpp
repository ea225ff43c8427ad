// A clump of spheres that stands for a closed triangle surface.
//
// Spheres are inscribed one after the other (inscribed_spheres.hpp) and hold less than the whole volume. All radii then
// grow by one length, until the union has the volume of the surface, and the union moves so that both have one centre:
// whatever follows from volume and centre - mass, buoyancy, the water displaced - is that of the surface. The moments
// of inertia are those of the surface too; those of the union differ a little (shape_figures.hpp). SI units.
#pragma once

#include "core/geometry/triangle_mesh.hpp"
#include "dem/clumps/placed_sphere.hpp"
#include "dem/clumps/sphere_union_inertia.hpp"

#include <optional>
#include <vector>

namespace thalweg::beds {

// When enough spheres are inscribed; whichever comes first.
struct ClumpFit {
  static constexpr int most_spheres = 500;  // where there is a tolerance alone

  std::optional<int> spheres;       // number
  std::optional<double> tolerance;  // mean distance of the surface from the inscribed spheres, equivalent diameters
};

struct MeshClump {
  std::vector<dem::PlacedSphere> inscribed;  // in the order in which they were chosen
  std::vector<dem::PlacedSphere> spheres;    // the same, grown and moved: the clump
  dem::BodyMoments body;                     // of the surface
  double growth = 0.0;                       // m, of the radii
  double equivalent_diameter = 0.0;          // m, of the sphere of its volume
};

// Throws InputError where the surface is open, wound inwards, of several parts, crosses itself as far as lines on the
// grid show, or is no grain for its size (1 um to 1 m); where neither number nor tolerance is given; where the
// tolerance is not reached with most_spheres. Fewer spheres than asked for where no room is left for more.
MeshClump clump_of(const TriangleMesh& mesh, const ClumpFit& fit);

}  // namespace thalweg::beds
