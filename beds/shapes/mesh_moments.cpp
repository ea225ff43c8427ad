#include "beds/shapes/mesh_moments.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <utility>

namespace thalweg::beds {
namespace {

Vec3 area_vector(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const Vec3& a = mesh.points[static_cast<std::size_t>(t[0])];
  return 0.5 * (mesh.points[static_cast<std::size_t>(t[1])] - a).cross(mesh.points[static_cast<std::size_t>(t[2])] - a);
}

}  // namespace

dem::BodyMoments body_moments(const TriangleMesh& mesh) {
  Vec3 origin = Vec3::Zero();  // the mean of the points, which leaves the least rounding
  for (const Vec3& point : mesh.points) origin += point;
  origin /= static_cast<double>(mesh.points.size());
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.points[static_cast<std::size_t>(t[0])] - origin,
               b = mesh.points[static_cast<std::size_t>(t[1])] - origin,
               c = mesh.points[static_cast<std::size_t>(t[2])] - origin;
    const double v = a.dot(b.cross(c)) / 6.0;
    const Vec3 s = a + b + c;
    volume += v;
    first += 0.25 * v * s;
    second += v / 20.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  dem::BodyMoments body;
  body.volume = volume;
  const Vec3 centre = first / volume;
  body.centre = origin + centre;
  second -= volume * centre * centre.transpose();
  body.inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  return body;
}

double surface_area(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const auto& t : mesh.triangles) area += area_vector(mesh, t).norm();
  return area;
}

double integral_of_mean_curvature(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, std::size_t> triangle_at;  // by the directed edge
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n)
    for (int k = 0; k < 3; ++k)
      triangle_at[{mesh.triangles[n][static_cast<std::size_t>(k)],
                   mesh.triangles[n][static_cast<std::size_t>((k + 1) % 3)]}] = n;
  double sum = 0.0;
  for (const auto& [edge, n] : triangle_at) {
    if (edge.first > edge.second) continue;
    const auto other = triangle_at.find({edge.second, edge.first});
    if (other == triangle_at.end()) continue;
    const Vec3 along =
        mesh.points[static_cast<std::size_t>(edge.second)] - mesh.points[static_cast<std::size_t>(edge.first)];
    const Vec3 here = area_vector(mesh, mesh.triangles[n]), there = area_vector(mesh, mesh.triangles[other->second]);
    // Positive where the surface bulges: seen along the edge, the normal turns from this side to the other.
    sum += std::atan2(along.dot(here.cross(there)), along.norm() * here.dot(there)) * along.norm();
  }
  return 0.5 * sum;
}

}  // namespace thalweg::beds
