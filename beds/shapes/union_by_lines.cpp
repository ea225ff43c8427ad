#include "beds/shapes/union_by_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace thalweg::beds {
namespace {

constexpr int lines = 256;  // across the longest extent

struct Interval {
  double begin, end;  // m
};

// Moments 1, x, y, z, xx, yy, zz, xy, xz, yz.
using Moments = std::array<double, 10>;

void add(const Interval& part, double y, double z, Moments& sum) {
  const double a = part.begin, b = part.end, length = b - a, first = 0.5 * (b * b - a * a);
  const Moments of_part{length,         first,          y * length, z * length, (b * b * b - a * a * a) / 3.0,
                        y * y * length, z * z * length, y * first,  z * first,  y * z * length};
  for (std::size_t m = 0; m < sum.size(); ++m) sum[m] += of_part[m];
}

void add_line(std::vector<Interval>& met, double y, double z, Moments& sum) {
  if (met.empty()) return;
  std::sort(met.begin(), met.end(), [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  Interval part = met.front();
  for (const Interval& next : met) {
    if (next.begin > part.end) {
      add(part, y, z, sum);
      part = next;
    }
    part.end = std::max(part.end, next.end);
  }
  add(part, y, z, sum);
}

}  // namespace

dem::BodyMoments union_by_lines(std::span<const dem::PlacedSphere> spheres) {
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  for (const dem::PlacedSphere& s : spheres) {
    lower = lower.cwiseMin(s.position - Vec3::Constant(s.radius));
    upper = upper.cwiseMax(s.position + Vec3::Constant(s.radius));
  }
  const Vec3 origin = 0.5 * (lower + upper);
  const Vec3 half = 0.5 * (upper - lower);
  const double step = 2.0 * half.maxCoeff() / lines;
  const int rows = static_cast<int>(std::ceil(half.z() / step)), columns = static_cast<int>(std::ceil(half.y() / step));
  Moments sum{};
  std::vector<Interval> met;
  for (int k = -rows; k < rows; ++k)
    for (int j = -columns; j < columns; ++j) {
      const double y = (j + 0.5) * step, z = (k + 0.5) * step;
      met.clear();
      for (const dem::PlacedSphere& s : spheres) {
        const double dy = y + origin.y() - s.position.y(), dz = z + origin.z() - s.position.z();
        const double squared = s.radius * s.radius - dy * dy - dz * dz;
        if (squared <= 0.0) continue;
        const double x = s.position.x() - origin.x(), along = std::sqrt(squared);
        met.push_back({x - along, x + along});
      }
      add_line(met, y, z, sum);
    }
  for (double& moment : sum) moment *= step * step;
  const Vec3 centre = Vec3(sum[1], sum[2], sum[3]) / sum[0];
  Eigen::Matrix3d second;
  second << sum[4], sum[7], sum[8], sum[7], sum[5], sum[9], sum[8], sum[9], sum[6];
  second -= sum[0] * centre * centre.transpose();
  dem::BodyMoments body;
  body.volume = sum[0];
  body.centre = origin + centre;
  body.inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  return body;
}

}  // namespace thalweg::beds
