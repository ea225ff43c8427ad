// The surface of a solid as grains meet it: a closed one of triangles, or a sphere. At the place it has at the start,
// SI units.
//
// A grain touches a surface wherever the distance from its centre has a minimum: in the inside of a triangle, on an
// edge from which both triangles fall away, at a corner from which all do. On a surface that is flat or bulges that is
// one place, whatever triangles it is made of: a grain that rolls from one to the next feels no seam. In a corner of a
// room there are several, and all count. Where a surface is hollow but its triangles turn by less than `seam_angle`,
// they stand for a smooth one: of minima in neighbouring triangles the nearest alone counts.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"
#include "core/geometry/triangle_mesh.hpp"

#include <array>
#include <cstdint>
#include <numbers>
#include <vector>

namespace thalweg::dem {

// Minima in neighbouring triangles whose normals differ by less are one contact. A turn of twelve facets is smooth, and
// the minimum that goes out at a seam is no contact as long as grains overlap by less than 1 - cos(30 degrees), 13 % of
// their radius.
inline constexpr double seam_angle = std::numbers::pi / 6.0;

// A place on a surface at which the distance from a point has a minimum.
struct SurfaceView {
  double distance;  // m
  Vec3 normal;      // unit, from there to the point
  Vec3 foot;        // m
  int corners;      // of the triangle, edge or corner it is on
  std::array<Vec3, 3> corner;
  std::uint32_t owner = 0;  // the caller's
};

class SolidSurface {
public:
  // A closed surface wound outwards: what_is_open() finds nothing. Triangles without an area are left out.
  explicit SolidSurface(const TriangleMesh& mesh);
  static SolidSurface sphere(const Vec3& centre, double radius);

  const Vec3& lower() const { return lower_; }  // its extent, m
  const Vec3& upper() const { return upper_; }
  double rounding() const { return rounding_; }  // m, radius of a sphere; 0 of triangles

  // The parts of the surface within a distance (m) of a point: triangles, edges, corners, in the order of the surface.
  struct Parts {
    std::vector<std::uint32_t> triangles, edges, corners;
    bool empty() const { return triangles.empty() && edges.empty() && corners.empty(); }
  };
  Parts parts_near(const Vec3& point, double distance) const;

  // The minima among these parts that are nearer than a distance (m), appended to `views`.
  void look(const Parts& parts, const Vec3& point, double distance, std::vector<SurfaceView>& views) const;

  // Distance (m) of a point from the nearest of these parts, on either side of the surface; infinite if there are
  // none.
  double distance_to(const Parts& parts, const Vec3& point) const;

  bool holds(const Vec3& point) const;  // true if it is inside

  // Corners of the triangles that a straight line between two points may cross, and of others; of a sphere there are
  // none.
  std::vector<std::array<Vec3, 3>> triangles_along(const Vec3& begin, const Vec3& end) const;

private:
  SolidSurface() = default;

  struct Triangle {
    std::array<Vec3, 3> corner;
    Vec3 normal;                 // unit, outwards
    std::array<Vec3, 3> inward;  // unit, in the plane, from the side between corners k and k + 1 to the inside
  };
  struct Edge {
    Vec3 begin, along;  // along: unit
    double length;
    std::array<Vec3, 2> inward;  // of the triangles that meet there
    Vec3 outward;                // sum of their normals
  };
  struct Corner {
    Vec3 point;
    std::vector<Vec3> along;  // unit: the edges that meet there
    Vec3 outward;             // sum of normals, each times the angle of its triangle; zero: of a sphere, every side
  };

  void add_edges(const TriangleMesh& mesh, const std::vector<std::array<int, 3>>& triangles);
  void build_grid();
  Index3 cell_of(const Vec3& point) const;
  template <typename Visit>
  void for_each_triangle_in(const Vec3& lower, const Vec3& upper, Visit visit) const;

  std::vector<Triangle> triangles_;
  std::vector<Edge> edges_;  // edges that do not run along a hollow
  std::vector<Corner> corners_;
  std::vector<std::array<std::int32_t, 3>> edges_of_, corners_of_;  // of each triangle; -1: a hollow edge
  double rounding_ = 0.0;
  Vec3 lower_ = Vec3::Zero(), upper_ = Vec3::Zero();

  // Triangles by the cells of a grid that their boxes reach into.
  double cell_ = 1.0;  // m
  Index3 cells_{1, 1, 1};
  std::vector<std::uint32_t> first_, in_cell_;
};

// Leaves of the minima that are one contact (seam_angle) the nearest, the nearest first. tolerance: m, by which corners
// at one place may differ.
void keep_contacts(std::vector<SurfaceView>& views, double tolerance);

}  // namespace thalweg::dem
