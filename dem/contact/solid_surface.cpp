#include "dem/contact/solid_surface.hpp"

#include "core/geometry/triangle_crossing.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace thalweg::dem {

namespace {

// A foot that is beyond the end of its part by less than this share of its size counts: better twice than not at all,
// since keep_contacts() leaves one.
constexpr double slack = 1e-9;

constexpr std::size_t most_cells = 1 << 22;

double distance_to_segment(const Vec3& point, const Vec3& begin, const Vec3& along, double length) {
  const Vec3 from = point - begin;
  return (from - std::clamp(from.dot(along), 0.0, length) * along).norm();
}

// Distance of a point from a triangle, on either side (m); within round-off of its sides.
template <typename Triangle>
double distance_to_triangle(const Vec3& point, const Triangle& t) {
  bool above = true;
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vec3 side = t.corner[(k + 1) % 3] - t.corner[k];
    above = above && (point - t.corner[k]).dot(t.inward[k]) >= 0.0;
    const double length = side.norm();
    nearest = std::min(nearest, distance_to_segment(point, t.corner[k], side / length, length));
  }
  return above ? std::abs((point - t.corner[0]).dot(t.normal)) : nearest;
}

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

void sort_and_drop_repeated(std::vector<std::uint32_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

SolidSurface::SolidSurface(const TriangleMesh& mesh) {
  std::vector<std::array<int, 3>> kept;
  for (const auto& t : mesh.triangles) {
    Triangle triangle;
    for (int k = 0; k < 3; ++k) triangle.corner[k] = mesh.points[t[k]];
    const Vec3 first = triangle.corner[1] - triangle.corner[0], second = triangle.corner[2] - triangle.corner[0];
    const Vec3 area = first.cross(second);
    if (!(area.norm() > 1e-12 * first.norm() * second.norm())) continue;
    triangle.normal = area.normalized();
    for (int k = 0; k < 3; ++k)
      triangle.inward[k] = triangle.normal.cross(triangle.corner[(k + 1) % 3] - triangle.corner[k]).normalized();
    triangles_.push_back(triangle);
    kept.push_back(t);
  }
  add_edges(mesh, kept);
  lower_ = upper_ = mesh.points.front();
  for (const Vec3& point : mesh.points) lower_ = lower_.cwiseMin(point), upper_ = upper_.cwiseMax(point);
  build_grid();
}

SolidSurface SolidSurface::sphere(const Vec3& centre, double radius) {
  SolidSurface surface;
  surface.corners_.push_back({centre, {}, Vec3::Zero()});
  surface.rounding_ = radius;
  surface.lower_ = centre.array() - radius;
  surface.upper_ = centre.array() + radius;
  return surface;
}

// Edges and corners of the triangles that were kept.
void SolidSurface::add_edges(const TriangleMesh& mesh, const std::vector<std::array<int, 3>>& triangles) {
  std::map<std::pair<int, int>, std::pair<std::size_t, int>>
      other;  // the triangle on the left of a side, and which side
  for (std::size_t n = 0; n < triangles.size(); ++n)
    for (int k = 0; k < 3; ++k) other[{triangles[n][k], triangles[n][(k + 1) % 3]}] = {n, k};
  edges_of_.assign(triangles.size(), {-1, -1, -1});
  corners_of_.assign(triangles.size(), {});
  std::map<int, std::int32_t> corner_at;
  for (std::size_t n = 0; n < triangles.size(); ++n)
    for (int k = 0; k < 3; ++k) {
      const int a = triangles[n][k], b = triangles[n][(k + 1) % 3], c = triangles[n][(k + 2) % 3];
      const auto [place, is_new] = corner_at.try_emplace(a, static_cast<std::int32_t>(corners_.size()));
      if (is_new) corners_.push_back({mesh.points[a], {}, Vec3::Zero()});
      Corner& corner = corners_[static_cast<std::size_t>(place->second)];
      const Vec3 side = mesh.points[b] - mesh.points[a];
      corner.along.push_back(side.normalized());
      corner.outward += angle_between(side, mesh.points[c] - mesh.points[a]) * triangles_[n].normal;
      corners_of_[n][k] = place->second;

      // Beside a triangle without an area an edge has one triangle only, which is taken for both.
      const auto across = other.find({b, a});
      const auto [m, j] = across == other.end() ? std::pair(n, k) : across->second;
      if (m != n && a > b) continue;  // each edge once
      const Triangle &left = triangles_[n], &right = triangles_[m];
      // Along a hollow the other triangle rises above the plane of this one.
      if (right.inward[j].dot(left.normal) > slack) continue;
      edges_of_[n][k] = edges_of_[m][j] = static_cast<std::int32_t>(edges_.size());
      edges_.push_back({mesh.points[a],
                        side.normalized(),
                        side.norm(),
                        {left.inward[k], right.inward[j]},
                        left.normal + right.normal});
    }
}

void SolidSurface::build_grid() {
  const Vec3 size = upper_ - lower_;
  // About one triangle a cell, if they covered the surface of the extent.
  const double area = 2.0 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
  cell_ = std::sqrt(std::max(area, 1e-300) / static_cast<double>(std::max<std::size_t>(triangles_.size(), 1)));
  const auto count = [&] {
    double cells = 1.0;
    for (int a = 0; a < 3; ++a) cells *= std::floor(size[a] / cell_) + 1.0;
    return cells;
  };
  while (count() > static_cast<double>(most_cells)) cell_ *= 1.5;
  for (int a = 0; a < 3; ++a) cells_[a] = static_cast<int>(size[a] / cell_) + 1;
  std::vector<std::vector<std::uint32_t>> in(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2]);
  for (std::size_t n = 0; n < triangles_.size(); ++n) {
    const auto& c = triangles_[n].corner;
    const Index3 first = cell_of(c[0].cwiseMin(c[1]).cwiseMin(c[2])),
                 last = cell_of(c[0].cwiseMax(c[1]).cwiseMax(c[2]));
    for (int z = first[2]; z <= last[2]; ++z)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int x = first[0]; x <= last[0]; ++x)
          in[(static_cast<std::size_t>(z) * cells_[1] + y) * cells_[0] + x].push_back(static_cast<std::uint32_t>(n));
  }
  for (const std::vector<std::uint32_t>& cell : in) {
    first_.push_back(static_cast<std::uint32_t>(in_cell_.size()));
    in_cell_.insert(in_cell_.end(), cell.begin(), cell.end());
  }
  first_.push_back(static_cast<std::uint32_t>(in_cell_.size()));
}

// The nearest cell.
Index3 SolidSurface::cell_of(const Vec3& point) const {
  Index3 cell;
  for (int a = 0; a < 3; ++a)
    cell[a] = static_cast<int>(std::clamp((point[a] - lower_[a]) / cell_, 0.0, cells_[a] - 1.0));
  return cell;
}

// Calls visit(number) for the triangles of all cells of a box, some of them several times.
template <typename Visit>
void SolidSurface::for_each_triangle_in(const Vec3& lower, const Vec3& upper, Visit visit) const {
  if ((lower.array() > upper_.array()).any() || (upper.array() < lower_.array()).any() || triangles_.empty()) return;
  const Index3 first = cell_of(lower), last = cell_of(upper);
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y) {
      const std::size_t row = (static_cast<std::size_t>(z) * cells_[1] + y) * cells_[0];
      for (std::uint32_t n = first_[row + first[0]]; n < first_[row + last[0] + 1]; ++n) visit(in_cell_[n]);
    }
}

SolidSurface::Parts SolidSurface::parts_near(const Vec3& point, double distance) const {
  Parts parts;
  if (rounding_ > 0.0) {
    if ((point - corners_.front().point).norm() <= rounding_ + distance) parts.corners.push_back(0);
    return parts;
  }
  for_each_triangle_in(point.array() - distance, point.array() + distance, [&](std::uint32_t n) {
    if (distance_to_triangle(point, triangles_[n]) <= distance) parts.triangles.push_back(n);
  });
  sort_and_drop_repeated(parts.triangles);
  for (const std::uint32_t n : parts.triangles)
    for (int k = 0; k < 3; ++k) {
      if (const std::int32_t e = edges_of_[n][k]; e >= 0) {
        const Edge& edge = edges_[static_cast<std::size_t>(e)];
        if (distance_to_segment(point, edge.begin, edge.along, edge.length) <= distance)
          parts.edges.push_back(static_cast<std::uint32_t>(e));
      }
      const auto c = static_cast<std::uint32_t>(corners_of_[n][k]);
      if ((point - corners_[c].point).norm() <= distance) parts.corners.push_back(c);
    }
  sort_and_drop_repeated(parts.edges);
  sort_and_drop_repeated(parts.corners);
  return parts;
}

void SolidSurface::look(const Parts& parts, const Vec3& point, double distance, std::vector<SurfaceView>& views) const {
  for (const std::uint32_t n : parts.triangles) {
    const Triangle& t = triangles_[n];
    const double height = (point - t.corner[0]).dot(t.normal);
    if (!(height > 0.0 && height < distance)) continue;
    const double size = slack * (t.corner[1] - t.corner[0]).norm();
    bool above = true;
    for (int k = 0; k < 3; ++k) above = above && (point - t.corner[k]).dot(t.inward[k]) >= -size;
    if (above) views.push_back({height, t.normal, point - height * t.normal, 3, t.corner});
  }
  for (const std::uint32_t n : parts.edges) {
    const Edge& e = edges_[n];
    const Vec3 from_begin = point - e.begin;
    const double way = from_begin.dot(e.along);
    if (way < -slack * e.length || way > (1.0 + slack) * e.length) continue;
    const Vec3 from = from_begin - way * e.along;
    const double length = from.norm();
    if (!(length < distance && from.dot(e.outward) > 0.0)) continue;
    if (from.dot(e.inward[0]) > slack * length || from.dot(e.inward[1]) > slack * length) continue;
    views.push_back({length, from / length, point - from, 2, {e.begin, e.begin + e.length * e.along, Vec3::Zero()}});
  }
  for (const std::uint32_t n : parts.corners) {
    const Corner& c = corners_[n];
    const Vec3 from = point - c.point;
    const double length = from.norm();
    if (!(length < distance + rounding_ && length > 0.0)) continue;
    if (rounding_ == 0.0 && !(from.dot(c.outward) > 0.0)) continue;
    if (std::any_of(c.along.begin(), c.along.end(), [&](const Vec3& e) { return from.dot(e) > slack * length; }))
      continue;
    const Vec3 normal = from / length;
    views.push_back(
        {length - rounding_, normal, c.point + rounding_ * normal, 1, {c.point, Vec3::Zero(), Vec3::Zero()}});
  }
}

double SolidSurface::distance_to(const Parts& parts, const Vec3& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  if (rounding_ > 0.0) return parts.empty() ? nearest : std::abs((point - corners_.front().point).norm() - rounding_);
  for (const std::uint32_t n : parts.triangles) nearest = std::min(nearest, distance_to_triangle(point, triangles_[n]));
  return nearest;
}

// Counts the triangles that a line from the point along x crosses.
bool SolidSurface::holds(const Vec3& point) const {
  if (rounding_ > 0.0) return (point - corners_.front().point).norm() < rounding_;
  if ((point.array() < lower_.array()).any() || (point.array() > upper_.array()).any()) return false;
  std::vector<std::uint32_t> met;
  for_each_triangle_in(point, Vec3(upper_.x(), point.y(), point.z()), [&](std::uint32_t n) { met.push_back(n); });
  sort_and_drop_repeated(met);
  int winding = 0;
  for (const std::uint32_t n : met)
    if (const auto hit = crossing(triangles_[n].corner, point.y(), point.z()); hit && hit->x > point.x())
      winding -= hit->winding;
  return winding > 0;
}

std::vector<std::array<Vec3, 3>> SolidSurface::triangles_along(const Vec3& begin, const Vec3& end) const {
  std::vector<std::uint32_t> met;
  for_each_triangle_in(begin.cwiseMin(end), begin.cwiseMax(end), [&](std::uint32_t n) { met.push_back(n); });
  sort_and_drop_repeated(met);
  std::vector<std::array<Vec3, 3>> corners;
  for (const std::uint32_t n : met) corners.push_back(triangles_[n].corner);
  return corners;
}

namespace {

bool share_a_corner(const SurfaceView& a, const SurfaceView& b, double tolerance) {
  for (int i = 0; i < a.corners; ++i)
    for (int j = 0; j < b.corners; ++j)
      if ((a.corner[i] - b.corner[j]).squaredNorm() < tolerance * tolerance) return true;
  return false;
}

}  // namespace

void keep_contacts(std::vector<SurfaceView>& views, double tolerance) {
  if (views.size() < 2) return;
  std::stable_sort(views.begin(), views.end(),
                   [](const SurfaceView& a, const SurfaceView& b) { return a.distance < b.distance; });
  const double alike = std::cos(seam_angle);
  std::size_t kept = 1;
  for (std::size_t n = 1; n < views.size(); ++n) {
    const bool repeated =
        std::any_of(views.begin(), views.begin() + static_cast<std::ptrdiff_t>(kept), [&](auto& near) {
          if (!(near.normal.dot(views[n].normal) > alike)) return false;
          // One in the plane of a nearer one is a seam between triangles that do not share corners.
          const double rise = near.distance - views[n].distance * views[n].normal.dot(near.normal);
          return std::abs(rise) < tolerance || share_a_corner(near, views[n], tolerance);
        });
    if (!repeated) views[kept++] = views[n];
  }
  views.resize(kept);
}

}  // namespace thalweg::dem
