#include "beds/shapes/mesh_clump.hpp"

#include "beds/shapes/inscribed_spheres.hpp"
#include "beds/shapes/mesh_distance.hpp"
#include "beds/shapes/mesh_moments.hpp"
#include "beds/shapes/surface_points.hpp"
#include "beds/shapes/union_by_lines.hpp"
#include "core/base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace thalweg::beds {
namespace {

// Number of parts of the surface that no edge joins.
int part_count(const TriangleMesh& mesh) {
  std::vector<std::size_t> parent(mesh.points.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](int point) {
    auto at = static_cast<std::size_t>(point);
    while (parent[at] != at) at = parent[at] = parent[parent[at]];
    return at;
  };
  for (const auto& t : mesh.triangles) {
    parent[root(t[1])] = root(t[0]);
    parent[root(t[2])] = root(t[0]);
  }
  std::vector<std::size_t> roots;
  for (const auto& t : mesh.triangles) roots.push_back(root(t[0]));
  std::sort(roots.begin(), roots.end());
  return static_cast<int>(std::unique(roots.begin(), roots.end()) - roots.begin());
}

double diameter_of_volume(double volume) { return std::cbrt(6.0 * volume / std::numbers::pi); }

void check_surface(const TriangleMesh& mesh) {
  if (const std::string open = what_is_open(mesh); !open.empty())
    throw InputError(fmt::format("The surface is not closed: {}; repair it where it was made.", open));
  if (const int parts = part_count(mesh); parts > 1)
    throw InputError(
        fmt::format("The surface has {} separate parts, and a grain is one body; keep only the outer one.", parts));
  const double volume = signed_volume(mesh);
  if (!(volume > 0.0))
    throw InputError(fmt::format(
        "The surface encloses {:g} m^3: it is flat, or its triangles are wound inwards; turn them over.", volume));
  constexpr double smallest = 1e-6, largest = 1.0;  // m
  const double diameter = diameter_of_volume(volume);
  if (!(diameter >= smallest && diameter <= largest))
    throw InputError(
        fmt::format("The surface is as large as a sphere of {:g} m, and a grain has {:g} to {:g} m; give the scale "
                    "that converts the unit of the file to m: 0.001 for mm.",
                    diameter, smallest, largest));
}

// Mean distance of points of the surface from the spheres inscribed so far, as these are added.
class MeanDistance {
public:
  MeanDistance(const TriangleMesh& mesh, double size) : points_(points_of(mesh, size)) {
    nearest_.assign(points_.size(), std::numeric_limits<double>::infinity());
  }
  double with(const dem::PlacedSphere& sphere) {
    double sum = 0.0, area = 0.0;
    for (std::size_t n = 0; n < points_.size(); ++n) {
      const double gap = std::max(0.0, (points_[n].position - sphere.position).norm() - sphere.radius);
      nearest_[n] = std::min(nearest_[n], gap);
      sum += points_[n].area * nearest_[n];
      area += points_[n].area;
    }
    return sum / area;
  }

private:
  std::vector<SurfacePoint> points_;
  std::vector<double> nearest_;
};

std::vector<dem::PlacedSphere> inscribe(const TriangleMesh& mesh, const ClumpFit& fit, const MeshClump& clump) {
  const MeshDistance distance(mesh);
  InscribedSpheres next(mesh, distance, clump.body.centre);
  MeanDistance mean_distance(mesh, 0.05 * clump.equivalent_diameter);
  const double wanted = fit.tolerance.value_or(0.0) * clump.equivalent_diameter;
  const int most = fit.spheres.value_or(ClumpFit::most_spheres);
  std::vector<dem::PlacedSphere> spheres;
  double reached = std::numeric_limits<double>::infinity();
  while (static_cast<int>(spheres.size()) < most && !(fit.tolerance && reached <= wanted) && next.add(spheres))
    reached = mean_distance.with(spheres.back());
  if (spheres.empty())
    throw InputError("The surface is too thin for a sphere that a grid of 64 spacings resolves; give a thicker body.");
  if (fit.tolerance && !fit.spheres && reached > wanted)
    throw InputError(fmt::format(
        "With {} spheres the surface is still {:.3g} equivalent diameters away on average, and the tolerance is {:g}; "
        "give a larger tolerance, or a number of spheres.",
        spheres.size(), reached / clump.equivalent_diameter, *fit.tolerance));
  return spheres;
}

std::vector<dem::PlacedSphere> with_growth(std::vector<dem::PlacedSphere> spheres, double growth) {
  for (dem::PlacedSphere& sphere : spheres) sphere.radius += growth;
  return spheres;
}

// The growth of all radii that gives the union a volume: Newton's method with the slope of a secant.
double growth_to(const std::vector<dem::PlacedSphere>& spheres, double volume) {
  const auto excess = [&](double growth) { return union_by_lines(with_growth(spheres, growth)).volume / volume - 1.0; };
  double before = 0.0, at_before = excess(before);
  double growth = 0.05 * diameter_of_volume(volume) * std::max(1e-3, std::abs(at_before));
  constexpr int most_steps = 30;
  for (int n = 0; n < most_steps; ++n) {
    const double at = excess(growth);
    constexpr double enough = 1e-12;
    if (std::abs(at) < enough || at == at_before) break;
    const double next = growth - at * (growth - before) / (at - at_before);
    before = growth;
    at_before = at;
    growth = next;
  }
  return growth;
}

}  // namespace

MeshClump clump_of(const TriangleMesh& mesh, const ClumpFit& fit) {
  if (!fit.spheres && !fit.tolerance)
    throw InputError("The number of spheres is missing; give spheres, tolerance, or both.");
  check_surface(mesh);
  MeshClump clump;
  clump.body = body_moments(mesh);
  clump.equivalent_diameter = diameter_of_volume(clump.body.volume);
  clump.inscribed = inscribe(mesh, fit, clump);
  clump.growth = growth_to(clump.inscribed, clump.body.volume);
  clump.spheres = with_growth(clump.inscribed, clump.growth);
  const Vec3 aside = clump.body.centre - union_by_lines(clump.spheres).centre;
  for (dem::PlacedSphere& sphere : clump.spheres) sphere.position += aside;
  return clump;
}

}  // namespace thalweg::beds
