#include "dem/clumps/sphere_union_inertia.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace thalweg::dem {

namespace {

struct Disk {
  double x, y, radius;
};

// Area, first and second moments of a plane region.
struct PlaneMoments {
  enum { a, x, y, xx, yy, xy, count };
  std::array<double, count> value{};
};

// Adds the part of Green's integrals that belongs to an arc.
void add_arc(const Disk& d, double from, double to, PlaneMoments& sum) {
  // Integrals of c^m s^n over the arc (c and s are cosine and sine), as differences of primitives.
  const auto difference = [from, to](auto&& primitive) {
    return primitive(to, std::cos(to), std::sin(to)) - primitive(from, std::cos(from), std::sin(from));
  };
  const double t = to - from;
  const double c1 = difference([](double, double, double s) { return s; });
  const double s1 = difference([](double, double c, double) { return -c; });
  const double cs = difference([](double, double, double s) { return 0.5 * s * s; });
  const double cc = 0.5 * t + 0.5 * difference([](double, double c, double s) { return s * c; });
  const double ss = t - cc;
  const double ccc = difference([](double, double, double s) { return s - s * s * s / 3.0; });
  const double sss = difference([](double, double c, double) { return c * c * c / 3.0 - c; });
  const double ccs = difference([](double, double c, double) { return -c * c * c / 3.0; });
  const double cccs = difference([](double, double c, double) { return -c * c * c * c / 4.0; });
  const double twice = difference([](double, double c, double s) { return 0.5 * s * c; });  // sin(2t)/4
  const double fourfold =
      difference([](double, double c, double s) { return s * c * (c * c - s * s) / 8.0; });  // sin(4t)/32
  const double cccc = 0.375 * t + twice + fourfold, ssss = 0.375 * t - twice + fourfold;

  const double r = d.radius, x = d.x, y = d.y, r2 = r * r, r3 = r2 * r, r4 = r2 * r2;
  sum.value[PlaneMoments::a] += 0.5 * (r2 * t + r * (x * c1 + y * s1));
  sum.value[PlaneMoments::x] += 0.5 * (x * x * r * c1 + 2.0 * x * r2 * cc + r3 * ccc);
  sum.value[PlaneMoments::y] += 0.5 * (y * y * r * s1 + 2.0 * y * r2 * ss + r3 * sss);
  sum.value[PlaneMoments::xx] += (x * x * x * r * c1 + 3.0 * x * x * r2 * cc + 3.0 * x * r3 * ccc + r4 * cccc) / 3.0;
  sum.value[PlaneMoments::yy] += (y * y * y * r * s1 + 3.0 * y * y * r2 * ss + 3.0 * y * r3 * sss + r4 * ssss) / 3.0;
  sum.value[PlaneMoments::xy] += 0.5 * (y * (x * x * r * c1 + 2.0 * x * r2 * cc + r3 * ccc) +
                                        r * (x * x * r * cs + 2.0 * x * r2 * ccs + r3 * cccs));
}

// Angles [first, last) of one disk that another covers.
struct Covered {
  double first, last;
  bool operator<(const Covered& other) const { return first < other.first; }
};

// Finds the covered arcs of disk n; among equal disks the first one stays. False: the disk is covered altogether.
bool find_covered(const std::vector<Disk>& disks, std::size_t n, std::vector<Covered>& covered) {
  covered.clear();
  const Disk& d = disks[n];
  for (std::size_t m = 0; m < disks.size(); ++m) {
    if (m == n) continue;
    const Disk& other = disks[m];
    const double dx = other.x - d.x, dy = other.y - d.y, distance = std::hypot(dx, dy);
    if (distance >= d.radius + other.radius) continue;
    if (distance + d.radius <= other.radius) {
      const bool equal = distance == 0.0 && d.radius == other.radius;
      if (!equal || m < n) return false;
      continue;
    }
    if (distance + other.radius <= d.radius) continue;
    const double cosine =
        (distance * distance + (d.radius - other.radius) * (d.radius + other.radius)) / (2.0 * distance * d.radius);
    const double half = std::acos(std::clamp(cosine, -1.0, 1.0)), middle = std::atan2(dy, dx);
    constexpr double turn = 2.0 * std::numbers::pi;
    double first = middle - half, last = middle + half;
    if (first < -std::numbers::pi) {
      covered.push_back({first + turn, std::numbers::pi});
      first = -std::numbers::pi;
    }
    if (last > std::numbers::pi) {
      covered.push_back({-std::numbers::pi, last - turn});
      last = std::numbers::pi;
    }
    covered.push_back({first, last});
  }
  std::sort(covered.begin(), covered.end());
  return true;
}

PlaneMoments moments_of(const std::vector<Disk>& disks) {
  PlaneMoments sum;
  std::vector<Covered> covered;
  for (std::size_t n = 0; n < disks.size(); ++n) {
    if (!find_covered(disks, n, covered)) continue;
    double free_from = -std::numbers::pi;
    for (const Covered& c : covered) {
      if (c.first > free_from) add_arc(disks[n], free_from, c.first, sum);
      free_from = std::max(free_from, c.last);
    }
    if (free_from < std::numbers::pi) add_arc(disks[n], free_from, std::numbers::pi, sum);
  }
  return sum;
}

// Moments of the body that the heights z build up: 1, x, y, z, xx, yy, zz, xy, xz, yz.
using SolidMoments = std::array<double, 10>;

SolidMoments slice(const std::vector<PlacedSphere>& spheres, double z) {
  std::vector<Disk> disks;
  for (const PlacedSphere& s : spheres) {
    const double height = z - s.position.z(), squared = (s.radius - height) * (s.radius + height);
    if (squared > 0.0) disks.push_back({s.position.x(), s.position.y(), std::sqrt(squared)});
  }
  const PlaneMoments plane = moments_of(disks);
  const auto& p = plane.value;
  using P = PlaneMoments;
  return {p[P::a],  p[P::x],         p[P::y],  z * p[P::a], p[P::xx],
          p[P::yy], z * z * p[P::a], p[P::xy], z * p[P::x], z * p[P::y]};
}

// Gauss and Legendre: nodes in [-1, 1] by Newton's method on the polynomial.
struct Gauss {
  static constexpr int points = 16;
  std::array<double, points> node{}, weight{};

  Gauss() {
    for (int k = 0; k < points; ++k) {
      double x = std::cos(std::numbers::pi * (k + 0.75) / (points + 0.5)), slope = 1.0;
      for (int iteration = 0; iteration < 20; ++iteration) {
        double before = 1.0, value = x;
        for (int n = 2; n <= points; ++n) {
          const double next = ((2.0 * n - 1.0) * x * value - (n - 1.0) * before) / n;
          before = value;
          value = next;
        }
        slope = points * (x * value - before) / (x * x - 1.0);
        x -= value / slope;
      }
      node[static_cast<std::size_t>(k)] = x;
      weight[static_cast<std::size_t>(k)] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
  }
};

class Integration {
public:
  Integration(const std::vector<PlacedSphere>& spheres, double size) : spheres_(spheres) {
    for (std::size_t m = 0; m < tolerance_.size(); ++m) {
      const double order = m == 0 ? 3.0 : m < 4 ? 4.0 : 5.0;
      tolerance_[m] = 1e-14 * std::pow(size, order);
    }
  }

  void add(double lower, double upper) { add(lower, upper, rule(lower, upper), most_halvings); }
  const SolidMoments& sum() const { return sum_; }

private:
  static constexpr int most_halvings = 30;

  SolidMoments rule(double lower, double upper) const {
    static const Gauss gauss;
    const double middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
    SolidMoments sum{};
    for (std::size_t k = 0; k < Gauss::points; ++k) {
      const double theta = 0.5 * std::numbers::pi * (1.0 + gauss.node[k]);
      const double weight = 0.5 * std::numbers::pi * gauss.weight[k] * half * std::sin(theta);
      const SolidMoments at = slice(spheres_, middle - half * std::cos(theta));
      for (std::size_t m = 0; m < sum.size(); ++m) sum[m] += weight * at[m];
    }
    return sum;
  }

  void add(double lower, double upper, const SolidMoments& whole, int halvings) {
    const double middle = 0.5 * (lower + upper);
    const SolidMoments first = rule(lower, middle), second = rule(middle, upper);
    bool settled = true;
    for (std::size_t m = 0; m < whole.size(); ++m)
      settled = settled && std::abs(first[m] + second[m] - whole[m]) <= tolerance_[m];
    if (settled || halvings == 0) {
      for (std::size_t m = 0; m < whole.size(); ++m) sum_[m] += first[m] + second[m];
      return;
    }
    add(lower, middle, first, halvings - 1);
    add(middle, upper, second, halvings - 1);
  }

  const std::vector<PlacedSphere>& spheres_;
  SolidMoments tolerance_{}, sum_{};
};

// The circle in which two spheres meet.
struct Circle {
  Vec3 centre, axis;  // m; unit
  double radius;      // m; below zero: they do not meet
};

Circle circle_of(const PlacedSphere& a, const PlacedSphere& b) {
  const Vec3 apart = b.position - a.position;
  const double distance = apart.norm();
  if (distance == 0.0 || distance >= a.radius + b.radius || distance <= std::abs(a.radius - b.radius))
    return {Vec3::Zero(), Vec3::Zero(), -1.0};
  const double along = 0.5 * (distance + (a.radius - b.radius) * (a.radius + b.radius) / distance);
  const Vec3 axis = apart / distance;
  const double squared = (a.radius - along) * (a.radius + along);
  return {a.position + along * axis, axis, std::sqrt(std::max(0.0, squared))};
}

// Heights of the points where the circle pierces the sphere.
void add_triple_points(const Circle& circle, const PlacedSphere& sphere, std::vector<double>& heights) {
  const Vec3 any = std::abs(circle.axis.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 u = circle.axis.cross(any).normalized(), v = circle.axis.cross(u);
  const Vec3 away = circle.centre - sphere.position;
  // |away + r (cos u + sin v)|^2 = R^2: p cos + q sin = e
  const double r = circle.radius, p = 2.0 * r * away.dot(u), q = 2.0 * r * away.dot(v);
  const double e = sphere.radius * sphere.radius - away.squaredNorm() - r * r, size = std::hypot(p, q);
  if (!(std::abs(e) <= size) || size == 0.0) return;
  for (const double sign : {-1.0, 1.0}) {
    const double angle = std::atan2(q, p) + sign * std::acos(e / size);
    heights.push_back((circle.centre + r * (std::cos(angle) * u + std::sin(angle) * v)).z());
  }
}

std::vector<double> heights_of_change(const std::vector<PlacedSphere>& spheres) {
  std::vector<double> heights;
  for (const PlacedSphere& s : spheres)
    heights.insert(heights.end(), {s.position.z() - s.radius, s.position.z() + s.radius});
  for (std::size_t a = 0; a < spheres.size(); ++a)
    for (std::size_t b = a + 1; b < spheres.size(); ++b) {
      const Circle circle = circle_of(spheres[a], spheres[b]);
      if (circle.radius < 0.0) continue;
      const double tilt = std::sqrt(std::max(0.0, 1.0 - circle.axis.z() * circle.axis.z()));
      for (const double sign : {-1.0, 1.0}) heights.push_back(circle.centre.z() + sign * circle.radius * tilt);
      for (std::size_t c = b + 1; c < spheres.size(); ++c) add_triple_points(circle, spheres[c], heights);
    }
  std::sort(heights.begin(), heights.end());
  return heights;
}

// Origin with the least rounding: the mean of the centres.
Vec3 mean_centre(std::span<const PlacedSphere> spheres) {
  Vec3 sum = Vec3::Zero();
  for (const PlacedSphere& s : spheres) sum += s.position;
  return sum / static_cast<double>(spheres.size());
}

}  // namespace

BodyMoments union_of_spheres(std::span<const PlacedSphere> given) {
  const Vec3 origin = mean_centre(given);
  std::vector<PlacedSphere> spheres(given.begin(), given.end());
  double size = 0.0;
  for (PlacedSphere& s : spheres) {
    s.position -= origin;
    size = std::max(size, s.position.norm() + s.radius);
  }
  Integration integration(spheres, size);
  const std::vector<double> heights = heights_of_change(spheres);
  for (std::size_t n = 0; n + 1 < heights.size(); ++n)
    if (heights[n + 1] > heights[n]) integration.add(heights[n], heights[n + 1]);

  const SolidMoments& m = integration.sum();
  BodyMoments body;
  body.volume = m[0];
  const Vec3 centre = Vec3(m[1], m[2], m[3]) / m[0];
  body.centre = origin + centre;
  Eigen::Matrix3d second;
  second << m[4], m[7], m[8], m[7], m[5], m[9], m[8], m[9], m[6];
  second -= m[0] * centre * centre.transpose();
  body.inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  return body;
}

BodyMoments union_of_disks(std::span<const PlacedSphere> given, double thickness) {
  const Vec3 origin = mean_centre(given);
  std::vector<Disk> disks;
  for (const PlacedSphere& d : given)
    disks.push_back({d.position.x() - origin.x(), d.position.z() - origin.z(), d.radius});
  const PlaneMoments plane = moments_of(disks);
  using P = PlaneMoments;
  const double area = plane.value[P::a];
  const double x = plane.value[P::x] / area, z = plane.value[P::y] / area;
  BodyMoments body;
  body.volume = area * thickness;
  body.centre = origin + Vec3(x, 0.0, z);
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  second(0, 0) = thickness * (plane.value[P::xx] - area * x * x);
  second(2, 2) = thickness * (plane.value[P::yy] - area * z * z);
  second(0, 2) = second(2, 0) = thickness * (plane.value[P::xy] - area * x * z);
  second(1, 1) = body.volume * thickness * thickness / 12.0;
  body.inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  return body;
}

}  // namespace thalweg::dem
