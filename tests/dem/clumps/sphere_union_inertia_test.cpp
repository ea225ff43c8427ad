// Volume, centre and inertia of overlapping spheres and disks against closed forms. Bounds: the integration is adaptive
// to 1e-14 of the body's size cubed (to the fifth for the inertia), a few intervals of it; 1e-11 relative holds it to
// that with room for a body thinner than it is long.
#include "dem/clumps/sphere_union_inertia.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <vector>

namespace thalweg::dem::sphere_union_inertia_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double bound = 1e-11;

void expect_same(const BodyMoments& body, double volume, const Vec3& centre, const Eigen::Matrix3d& inertia) {
  EXPECT_NEAR(body.volume / volume, 1.0, bound);
  EXPECT_LT((body.centre - centre).norm(), bound);
  EXPECT_LT((body.inertia - inertia).norm() / inertia.norm(), bound);
}

Eigen::Matrix3d of_ball(double radius) {
  return 0.4 * (4.0 / 3.0 * pi * std::pow(radius, 5)) * Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d of_point(double mass, const Vec3& arm) {
  return mass * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
}

// A solid of revolution about x: integral of f(x) pi y^2 for a slice of radius y(x); what a lens or a dumbbell is.
// Each part is a piece [from, to] of a ball of `radius` centred at x = c, so all integrands are polynomials.
struct Revolution {
  double volume = 0.0, along = 0.0, along2 = 0.0, quartic = 0.0;  // int y^2, x y^2, x^2 y^2, y^4 (times pi)

  void add(double c, double radius, double from, double to) {
    const double r2 = radius * radius, a = from - c, b = to - c;
    const auto power = [a, b](int n) { return (std::pow(b, n + 1) - std::pow(a, n + 1)) / (n + 1); };
    const double v = r2 * power(0) - power(2), m1 = r2 * power(1) - power(3), m2 = r2 * power(2) - power(4);
    volume += pi * v;
    along += pi * (m1 + c * v);
    along2 += pi * (m2 + 2.0 * c * m1 + c * c * v);
    quartic += pi * (r2 * r2 * power(0) - 2.0 * r2 * power(2) + power(4));
  }
  double centre() const { return along / volume; }
  // int (y^2 + z^2) over a slice is pi y^4/2; int y^2 over it pi y^4/4.
  Eigen::Matrix3d inertia() const {
    const double axial = 0.5 * quartic, across = 0.25 * quartic + along2 - volume * centre() * centre();
    return Vec3(axial, across, across).asDiagonal();
  }
};

// Two balls on the x axis, the second at `distance`, that meet: what they make together.
Revolution dumbbell(double r1, double r2, double distance) {
  const double meet = 0.5 * (distance + (r1 * r1 - r2 * r2) / distance);
  Revolution body;
  body.add(0.0, r1, -r1, meet);
  body.add(distance, r2, meet, distance + r2);
  return body;
}

std::vector<Eigen::Quaterniond> some_rotations() {
  std::vector<Eigen::Quaterniond> rotations{Eigen::Quaterniond::Identity()};
  for (const auto& [axis, angle] : {std::pair<Vec3, double>{{0, 1, 0}, 0.5 * pi},
                                    {{0, 1, 0}, 1e-7},
                                    {{1, 2, 3}, 1.1},
                                    {{-1, 0.3, 0.1}, 2.7},
                                    {{0, 0, 1}, 0.4}})
    rotations.emplace_back(Eigen::AngleAxisd(angle, axis.normalized()));
  return rotations;
}

TEST(SphereUnionInertia, OneSphereAndManyTimesTheSame) {
  const Vec3 place(0.3, -0.2, 0.7);
  for (const std::size_t copies : {1u, 2u, 5u})
    expect_same(union_of_spheres(std::vector<PlacedSphere>(copies, PlacedSphere{place, 0.8})),
                4.0 / 3.0 * pi * std::pow(0.8, 3), place, of_ball(0.8));
}

TEST(SphereUnionInertia, SphereInsideAnotherAddsNothing) {
  const std::vector<PlacedSphere> spheres{{{0.1, 0.2, 0.3}, 0.2}, {{0.0, 0.2, 0.25}, 1.0}};
  expect_same(union_of_spheres(spheres), 4.0 / 3.0 * pi, spheres[1].position, of_ball(1.0));
}

TEST(SphereUnionInertia, TwoSpheresApartAndTouching) {
  for (const double distance : {1.5, 2.3}) {
    for (const Eigen::Quaterniond& turn : some_rotations()) {
      const std::vector<PlacedSphere> spheres{{Vec3::Zero(), 0.5}, {turn * Vec3(distance, 0, 0), 1.0}};
      const double m1 = 4.0 / 3.0 * pi * 0.125, m2 = 4.0 / 3.0 * pi;
      const Vec3 centre = m2 * spheres[1].position / (m1 + m2);
      expect_same(union_of_spheres(spheres), m1 + m2, centre,
                  of_ball(0.5) + of_ball(1.0) + of_point(m1, -centre) + of_point(m2, spheres[1].position - centre));
    }
  }
}

TEST(SphereUnionInertia, TwoOverlappingSpheresInAnyOrientation) {
  for (const auto& [r1, r2, distance] :
       {std::array{1.0, 1.0, 1.0}, {1.0, 0.6, 0.9}, {1.0, 0.5, 0.51}, {1.0, 1.0, 1.99}, {1.0, 0.3, 1.0}}) {
    const Revolution exact = dumbbell(r1, r2, distance);
    for (const Eigen::Quaterniond& turn : some_rotations()) {
      const Eigen::Matrix3d q = turn.toRotationMatrix();
      const std::vector<PlacedSphere> spheres{{Vec3::Zero(), r1}, {q * Vec3(distance, 0, 0), r2}};
      expect_same(union_of_spheres(spheres), exact.volume, q * Vec3(exact.centre(), 0, 0),
                  q * exact.inertia() * q.transpose());
    }
  }
}

TEST(SphereUnionInertia, ThreeSpheresInARow) {
  // The outer ones meet the middle one only: a body of revolution again.
  const double a = 0.8, b = 0.5, d1 = 0.7, d2 = 1.0;
  Revolution exact;
  const double left = -0.5 * (d1 + (1.0 - a * a) / d1), right = 0.5 * (d2 + (1.0 - b * b) / d2);
  exact.add(-d1, a, -d1 - a, left);
  exact.add(0.0, 1.0, left, right);
  exact.add(d2, b, right, d2 + b);
  for (const Eigen::Quaterniond& turn : some_rotations()) {
    const Eigen::Matrix3d q = turn.toRotationMatrix();
    const std::vector<PlacedSphere> spheres{{q * Vec3(d2, 0, 0), b}, {Vec3::Zero(), 1.0}, {q * Vec3(-d1, 0, 0), a}};
    expect_same(union_of_spheres(spheres), exact.volume, q * Vec3(exact.centre(), 0, 0),
                q * exact.inertia() * q.transpose());
  }
}

TEST(SphereUnionInertia, TetrahedronWithACommonCoreIsTheSameFromEverySide) {
  // Four unit spheres round a common middle: every pair, every triple and all four share space. By symmetry the centre
  // is the middle and the inertia isotropic; from other sides the slices differ, the result must not.
  std::vector<PlacedSphere> spheres;
  for (const Vec3& corner : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)})
    spheres.push_back({0.35 * corner, 1.0});
  const BodyMoments first = union_of_spheres(spheres);
  EXPECT_LT((first.inertia - first.inertia(0, 0) * Eigen::Matrix3d::Identity()).norm() / first.inertia.norm(), bound);
  for (const Eigen::Quaterniond& turn : some_rotations()) {
    std::vector<PlacedSphere> turned = spheres;
    for (PlacedSphere& s : turned) s.position = turn * s.position;
    expect_same(union_of_spheres(turned), first.volume, Vec3::Zero(), first.inertia);
  }
  // Inclusion and exclusion with the lens volume of a pair bounds it on both sides: pairs all subtracted is too little,
  // triples (at most the lens each) given back is too much.
  const double ball = 4.0 / 3.0 * pi, d = 0.35 * std::sqrt(8.0);
  const double lens = pi / 12.0 * (4.0 + d) * (2.0 - d) * (2.0 - d);
  EXPECT_GT(first.volume, 4.0 * ball - 6.0 * lens);
  EXPECT_LT(first.volume, 4.0 * ball - 6.0 * lens + 4.0 * lens);
}

TEST(SphereUnionInertia, DisksApartTheSameAndOverlapping) {
  const double thickness = 0.3;
  const auto polar = [](const BodyMoments& body) { return body.inertia(1, 1); };
  const BodyMoments one = union_of_disks(std::vector<PlacedSphere>(3, PlacedSphere{{1.0, 0.5, -2.0}, 0.7}), thickness);
  EXPECT_NEAR(one.volume / (pi * 0.49 * thickness), 1.0, bound);
  EXPECT_NEAR(polar(one) / (0.5 * pi * std::pow(0.7, 4) * thickness), 1.0, bound);
  EXPECT_LT((one.centre - Vec3(1.0, 0.5, -2.0)).norm(), bound);

  const double m1 = pi * 0.25 * thickness, m2 = pi * thickness;
  const BodyMoments two = union_of_disks(std::vector<PlacedSphere>{{{0, 0, 0}, 0.5}, {{1.2, 0, 1.6}, 1.0}}, thickness);
  EXPECT_NEAR(two.volume / (m1 + m2), 1.0, bound);
  EXPECT_NEAR(polar(two) / (0.125 * m1 + 0.5 * m2 + m1 * m2 / (m1 + m2) * 4.0), 1.0, bound);

  // Two unit disks whose centres are the radius apart: area 4 pi/3 + sqrt(3)/2. By symmetry the centre is half way;
  // the polar moment is twice that of the part beyond the line of symmetry, the disk cut by its chord at x = 1/2.
  // Of the disk about its own centre, x < 1/2: angles pi/3 .. 5 pi/3 as sector plus the triangle with the chord.
  const double area = 2.0 * pi / 3.0 + std::sqrt(3.0) / 4.0, first = -std::pow(0.75, 1.5) * 2.0 / 3.0;
  const double sector = pi / 3.0, triangle = 0.5 * std::sqrt(3.0) * 0.5 * (0.25 / 2.0 + 0.75 / 6.0);
  // About the point x = 1/2: I_0 - 2 (1/2) S_x + A/4.
  const double half = sector + triangle - first + 0.25 * area;
  for (const double angle : {0.0, 0.3, 2.0}) {
    const Vec3 apart(std::cos(angle), 0.0, std::sin(angle));
    const BodyMoments lens = union_of_disks(std::vector<PlacedSphere>{{Vec3::Zero(), 1.0}, {apart, 1.0}}, thickness);
    EXPECT_NEAR(lens.volume / (2.0 * area * thickness), 1.0, bound);
    EXPECT_LT((lens.centre - 0.5 * apart).norm(), bound);
    EXPECT_NEAR(polar(lens) / (2.0 * half * thickness), 1.0, bound);
  }
}

}  // namespace
}  // namespace thalweg::dem::sphere_union_inertia_test
