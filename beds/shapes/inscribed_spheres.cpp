#include "beds/shapes/inscribed_spheres.hpp"

#include "core/base/error.hpp"
#include "core/geometry/triangle_crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace thalweg::beds {

InscribedSpheres::InscribedSpheres(const TriangleMesh& mesh, const MeshDistance& distance, const Vec3& centre)
    : distance_(distance) {
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  for (const Vec3& point : mesh.points) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  spacing_ = (upper - lower).maxCoeff() / resolution;
  for (int axis = 0; axis < 3; ++axis) {
    const int below = static_cast<int>(std::ceil((centre[axis] - lower[axis]) / spacing_));
    const int above = static_cast<int>(std::ceil((upper[axis] - centre[axis]) / spacing_));
    origin_[axis] = centre[axis] - below * spacing_;
    nodes_[static_cast<std::size_t>(axis)] = below + above + 1;
  }
  std::vector<char> inside;
  find_inside(mesh, inside);
  const auto width = static_cast<std::size_t>(nodes_[0]);
  left_.reserve(inside.size() / width * (width + 1));
  for (std::size_t n = 0; n < inside.size(); ++n) {
    if (n % width == 0) left_.push_back(0);
    left_.push_back(left_.back() + inside[n]);
  }
  for (std::size_t n = 0; n < inside.size(); ++n) {
    if (!inside[n]) continue;
    const auto node = static_cast<std::int64_t>(n);
    const auto radius = static_cast<float>(distance_(place(node)));
    candidates_.push({won_by({place(node), radius}), radius, node});
  }
}

Vec3 InscribedSpheres::place(std::int64_t node) const {
  const std::int64_t row = node / nodes_[0], plane = row / nodes_[1];
  return origin_ + spacing_ * Vec3(static_cast<double>(node % nodes_[0]), static_cast<double>(row % nodes_[1]),
                                   static_cast<double>(plane));
}

// Lines along x through the nodes, moved aside by so little that they meet no edge of a surface made on this grid.
void InscribedSpheres::find_inside(const TriangleMesh& mesh, std::vector<char>& inside) const {
  constexpr double aside_y = 1.23e-7, aside_z = 3.21e-7;  // spacings
  const auto rows = static_cast<std::size_t>(nodes_[1]) * static_cast<std::size_t>(nodes_[2]);
  std::vector<std::vector<Crossing>> crossings(rows);
  for (const auto& t : mesh.triangles) {
    const Corners corners{mesh.points[static_cast<std::size_t>(t[0])], mesh.points[static_cast<std::size_t>(t[1])],
                          mesh.points[static_cast<std::size_t>(t[2])]};
    const Vec3 lower = (corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]) - origin_) / spacing_;
    const Vec3 upper = (corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]) - origin_) / spacing_;
    for (int k = std::max(0, static_cast<int>(lower.z()));
         k <= std::min(nodes_[2] - 1, static_cast<int>(upper.z()) + 1); ++k)
      for (int j = std::max(0, static_cast<int>(lower.y()));
           j <= std::min(nodes_[1] - 1, static_cast<int>(upper.y()) + 1); ++j)
        if (const auto met =
                crossing(corners, origin_.y() + (j + aside_y) * spacing_, origin_.z() + (k + aside_z) * spacing_))
          crossings[static_cast<std::size_t>(k) * static_cast<std::size_t>(nodes_[1]) + static_cast<std::size_t>(j)]
              .push_back(*met);
  }
  const auto width = static_cast<std::size_t>(nodes_[0]);
  inside.assign(rows * width, 0);
  for (std::size_t row = 0; row < rows; ++row) {
    auto& met = crossings[row];
    std::sort(met.begin(), met.end(),
              [](const Crossing& a, const Crossing& b) { return a.x != b.x ? a.x < b.x : a.winding > b.winding; });
    int depth = 0;
    for (std::size_t c = 0; c < met.size(); ++c) {
      depth += met[c].winding;
      const double width_of_fold = c + 1 < met.size() ? met[c + 1].x - met[c].x : 0.0;
      constexpr double rounding = 1e-6;  // spacings
      if ((depth < 0 || depth > 1) && width_of_fold > rounding * spacing_)
        throw InputError(
            "The surface crosses itself: some of its inside is enclosed more than once, or turned outside; repair it "
            "where it was made.");
      if (depth != 1 || c + 1 == met.size()) continue;
      const double first = std::ceil((met[c].x - origin_.x()) / spacing_);
      const double last = std::floor((met[c + 1].x - origin_.x()) / spacing_);
      for (double i = std::max(0.0, first); i <= std::min(last, nodes_[0] - 1.0); ++i)
        inside[row * width + static_cast<std::size_t>(i)] = 1;
    }
  }
}

template <typename Visit>
void InscribedSpheres::for_each_row(const dem::PlacedSphere& sphere, Visit visit) const {
  const Vec3 centre = (sphere.position - origin_) / spacing_;
  const double radius = sphere.radius / spacing_;
  const auto range = [&](double middle, double half, int count) {
    return std::pair(std::max(0, static_cast<int>(std::ceil(middle - half))),
                     std::min(count - 1, static_cast<int>(std::floor(middle + half))));
  };
  const auto [first_k, last_k] = range(centre.z(), radius, nodes_[2]);
  for (int k = first_k; k <= last_k; ++k) {
    const double dz = k - centre.z(), flat = std::max(0.0, radius * radius - dz * dz);
    const auto [first_j, last_j] = range(centre.y(), std::sqrt(flat), nodes_[1]);
    for (int j = first_j; j <= last_j; ++j) {
      const double dy = j - centre.y();
      const auto [first, last] = range(centre.x(), std::sqrt(std::max(0.0, flat - dy * dy)), nodes_[0]);
      const std::size_t row =
          static_cast<std::size_t>(k) * static_cast<std::size_t>(nodes_[1]) + static_cast<std::size_t>(j);
      if (first <= last) visit(row * (static_cast<std::size_t>(nodes_[0]) + 1), first, last);
    }
  }
}

std::int64_t InscribedSpheres::won_by(const dem::PlacedSphere& sphere) const {
  std::int64_t sum = 0;
  for_each_row(sphere, [&](std::size_t row, int first, int last) {
    sum += left_[row + static_cast<std::size_t>(last) + 1] - left_[row + static_cast<std::size_t>(first)];
  });
  return sum;
}

void InscribedSpheres::cover(const dem::PlacedSphere& sphere) {
  for_each_row(sphere, [&](std::size_t row, int first, int last) {
    const auto begin = row + static_cast<std::size_t>(first), end = row + static_cast<std::size_t>(last) + 1;
    const std::int32_t held = left_[end] - left_[begin];
    std::fill(left_.begin() + static_cast<std::ptrdiff_t>(begin), left_.begin() + static_cast<std::ptrdiff_t>(end) + 1,
              left_[begin]);
    for (std::size_t n = end + 1; n <= row + static_cast<std::size_t>(nodes_[0]); ++n) left_[n] -= held;
  });
}

// The sphere with its centre moved uphill in the distance, by less than a spacing along each axis.
dem::PlacedSphere InscribedSpheres::grown(dem::PlacedSphere sphere) const {
  const Vec3 start = sphere.position;
  sphere.radius = distance_(start);
  constexpr int halvings = 12;
  double step = 0.5 * spacing_;
  for (int n = 0; n < halvings; ++n, step *= 0.5)
    for (bool moved = true; moved;) {
      moved = false;
      for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
          const Vec3 there = sphere.position + sign * step * Vec3::Unit(axis);
          if ((there - start).cwiseAbs().maxCoeff() > spacing_ || step >= sphere.radius) continue;  // stays inside
          const double radius = distance_(there);
          if (!(radius > sphere.radius)) continue;
          sphere = {there, radius};
          moved = true;
        }
    }
  return sphere;
}

bool InscribedSpheres::add(std::vector<dem::PlacedSphere>& spheres) {
  while (!candidates_.empty()) {
    Candidate best = candidates_.top();
    candidates_.pop();
    if (best.won == 0) return false;
    const std::int64_t now = won_by({place(best.node), best.radius});
    if (now < best.won) {
      best.won = now;
      candidates_.push(best);
      continue;
    }
    spheres.push_back(grown({place(best.node), best.radius}));
    cover(spheres.back());
    return true;
  }
  return false;
}

}  // namespace thalweg::beds
