// What describes the shape of a grain, and how far a clump is from the surface that it stands for.
//
//   sphericity          surface of the sphere of the same volume over the surface (H. Wadell 1932)
//   axes a >= b >= c    of the ellipsoid with the same volume ratio of moments: a^2 = 10 (I_b + I_c - I_a)/V, full axes
//   Corey shape factor  c/sqrt(a b)
//   curvature           mean curvature, averaged over the surface, times half the equivalent diameter: 1 of a sphere.
//                       Of the clump that of its spheres' outer parts, 1/R, with which it touches others
#pragma once

#include "beds/shapes/mesh_clump.hpp"

namespace thalweg::beds {

struct ShapeFigures {
  Vec3 axes = Vec3::Zero();  // m: long, intermediate, short
  double sphericity = 0.0, corey = 0.0, curvature = 0.0;
};

// Distances in equivalent diameters: of the surface from the clump, and of the clump from the surface.
struct FitFigures {
  double inscribed_volume = 0.0;      // of the inscribed spheres over that of the surface
  Vec3 moment_errors = Vec3::Zero();  // of the union's principal moments, relative, the least moment first
  double mean_to_clump = 0.0, largest_to_clump = 0.0, mean_to_surface = 0.0, largest_to_surface = 0.0;
  double curvature = 0.0;
};

ShapeFigures shape_figures(const TriangleMesh& mesh);
FitFigures fit_figures(const TriangleMesh& mesh, const MeshClump& clump);

}  // namespace thalweg::beds
