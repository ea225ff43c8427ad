// Closed surfaces of triangles, wound outwards.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/triangle_mesh.hpp"

#include <cmath>
#include <functional>
#include <map>
#include <utility>

namespace thalweg::test {

// The quadrilateral of four points, seen anticlockwise, as two triangles.
inline void add_quadrilateral(TriangleMesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

inline TriangleMesh box_mesh(const Vec3& lower, const Vec3& upper) {
  TriangleMesh mesh;
  for (int n = 0; n < 8; ++n)
    mesh.points.emplace_back(n & 1 ? upper[0] : lower[0], n & 2 ? upper[1] : lower[1], n & 4 ? upper[2] : lower[2]);
  add_quadrilateral(mesh, 0, 2, 3, 1);
  add_quadrilateral(mesh, 4, 5, 7, 6);
  add_quadrilateral(mesh, 0, 1, 5, 4);
  add_quadrilateral(mesh, 2, 6, 7, 3);
  add_quadrilateral(mesh, 0, 4, 6, 2);
  add_quadrilateral(mesh, 1, 3, 7, 5);
  return mesh;
}

// A slab of nx x ny fields between two corners whose top is at top(x, y); points inside the top are moved by
// shift(i, j) along x and y.
inline TriangleMesh slab_mesh(const Vec3& lower, const Vec3& upper, int nx, int ny,
                              const std::function<double(double, double)>& top,
                              const std::function<Vec3(int, int)>& shift) {
  TriangleMesh mesh;
  const auto point = [&](int i, int j, bool high) { return (high ? (nx + 1) * (ny + 1) : 0) + j * (nx + 1) + i; };
  for (const bool high : {false, true})
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) {
        Vec3 p(lower[0] + (upper[0] - lower[0]) * i / nx, lower[1] + (upper[1] - lower[1]) * j / ny, lower[2]);
        if (i > 0 && i < nx && j > 0 && j < ny) p += shift(i, j);
        if (high) p[2] = top(p[0], p[1]);
        mesh.points.push_back(p);
      }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      add_quadrilateral(mesh, point(i, j, true), point(i + 1, j, true), point(i + 1, j + 1, true),
                        point(i, j + 1, true));
      add_quadrilateral(mesh, point(i, j, false), point(i, j + 1, false), point(i + 1, j + 1, false),
                        point(i + 1, j, false));
    }
  for (int i = 0; i < nx; ++i) {
    add_quadrilateral(mesh, point(i, 0, false), point(i + 1, 0, false), point(i + 1, 0, true), point(i, 0, true));
    add_quadrilateral(mesh, point(i + 1, ny, false), point(i, ny, false), point(i, ny, true), point(i + 1, ny, true));
  }
  for (int j = 0; j < ny; ++j) {
    add_quadrilateral(mesh, point(0, j + 1, false), point(0, j, false), point(0, j, true), point(0, j + 1, true));
    add_quadrilateral(mesh, point(nx, j, false), point(nx, j + 1, false), point(nx, j + 1, true), point(nx, j, true));
  }
  return mesh;
}

// An icosahedron whose triangles are each divided into four, `times` times, with all corners on the sphere: 20 4^times
// triangles.
inline TriangleMesh sphere_mesh(const Vec3& centre, double radius, int times) {
  const double t = 0.5 * (1.0 + std::sqrt(5.0));
  TriangleMesh mesh;
  mesh.points = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                 {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Vec3& p : mesh.points) p.normalize();
  for (int n = 0; n < times; ++n) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.points.size()));
      if (is_new) mesh.points.push_back((mesh.points[a] + mesh.points[b]).normalized());
      return place->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  for (Vec3& p : mesh.points) p = centre + radius * p;
  return mesh;
}

}  // namespace thalweg::test
