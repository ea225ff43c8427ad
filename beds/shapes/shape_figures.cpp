#include "beds/shapes/shape_figures.hpp"

#include "beds/shapes/mesh_distance.hpp"
#include "beds/shapes/mesh_moments.hpp"
#include "beds/shapes/surface_points.hpp"
#include "beds/shapes/union_by_lines.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace thalweg::beds {
namespace {

Vec3 principal_moments(const dem::BodyMoments& body) {  // rising
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(body.inertia, Eigen::EigenvaluesOnly).eigenvalues();
}

struct Distances {
  double mean = 0.0, largest = 0.0;
};

template <typename Distance>
Distances distances(const std::vector<SurfacePoint>& points, const Distance& distance) {
  Distances found;
  double area = 0.0;
  for (const SurfacePoint& point : points) {
    const double d = distance(point.position);
    found.mean += point.area * d;
    area += point.area;
    found.largest = std::max(found.largest, d);
  }
  found.mean /= area;
  return found;
}

// Distance (m) of a point from the surface of a union of spheres. Outside it is that from the nearest sphere; inside,
// that of the nearest foot on a sphere that no other holds, or of the nearest of the free points.
double distance_from_union(const Vec3& point, const std::vector<dem::PlacedSphere>& spheres,
                           const std::vector<SurfacePoint>& free_points) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const dem::PlacedSphere& s : spheres) nearest = std::min(nearest, (point - s.position).norm() - s.radius);
  if (nearest >= 0.0) return nearest;
  nearest = std::numeric_limits<double>::infinity();
  for (const SurfacePoint& free : free_points) nearest = std::min(nearest, (point - free.position).norm());
  for (const dem::PlacedSphere& s : spheres) {
    const double distance = (point - s.position).norm();
    if (!(distance > 0.0) || std::abs(s.radius - distance) >= nearest) continue;
    const Vec3 foot = s.position + s.radius / distance * (point - s.position);
    const bool held = std::any_of(spheres.begin(), spheres.end(), [&](const dem::PlacedSphere& other) {
      return &other != &s && (foot - other.position).squaredNorm() < other.radius * other.radius;
    });
    if (!held) nearest = std::abs(s.radius - distance);
  }
  return nearest;
}

}  // namespace

ShapeFigures shape_figures(const TriangleMesh& mesh) {
  const dem::BodyMoments body = body_moments(mesh);
  const Vec3 moments = principal_moments(body);
  const double area = surface_area(mesh), diameter = std::cbrt(6.0 * body.volume / std::numbers::pi);
  ShapeFigures figures;
  for (int n = 0; n < 3; ++n)
    figures.axes[n] = std::sqrt(10.0 * std::max(0.0, moments.sum() - 2.0 * moments[n]) / body.volume);
  figures.sphericity = std::numbers::pi * diameter * diameter / area;
  figures.corey = figures.axes[2] / std::sqrt(figures.axes[0] * figures.axes[1]);
  figures.curvature = 0.5 * diameter * integral_of_mean_curvature(mesh) / area;
  return figures;
}

FitFigures fit_figures(const TriangleMesh& mesh, const MeshClump& clump) {
  const double diameter = clump.equivalent_diameter;
  FitFigures figures;
  figures.inscribed_volume = union_by_lines(clump.inscribed).volume / clump.body.volume;
  const Vec3 moments = principal_moments(clump.body);
  figures.moment_errors = (principal_moments(union_by_lines(clump.spheres)) - moments).cwiseQuotient(moments);

  std::vector<std::size_t> sphere_of;
  const std::vector<SurfacePoint> on_clump = points_of(clump.spheres, &sphere_of);
  std::vector<SurfacePoint> on_union = on_clump;
  const std::vector<SurfacePoint> creases = crease_points(clump.spheres);
  on_union.insert(on_union.end(), creases.begin(), creases.end());
  const Distances to_clump = distances(points_of(mesh, 0.05 * diameter), [&](const Vec3& point) {
    return distance_from_union(point, clump.spheres, on_union);
  });
  const MeshDistance from_mesh(mesh);
  const Distances to_surface = distances(on_union, [&](const Vec3& point) { return from_mesh(point); });
  figures.mean_to_clump = to_clump.mean / diameter;
  figures.largest_to_clump = to_clump.largest / diameter;
  figures.mean_to_surface = to_surface.mean / diameter;
  figures.largest_to_surface = to_surface.largest / diameter;

  double area = 0.0, bent = 0.0;
  for (std::size_t n = 0; n < on_clump.size(); ++n) {
    area += on_clump[n].area;
    bent += on_clump[n].area / clump.spheres[sphere_of[n]].radius;
  }
  figures.curvature = 0.5 * diameter * bent / area;
  return figures;
}

}  // namespace thalweg::beds
