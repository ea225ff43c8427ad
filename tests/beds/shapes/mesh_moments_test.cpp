#include "beds/shapes/mesh_moments.hpp"

#include "beds/shapes/shape_figures.hpp"
#include "beds/shapes/union_by_lines.hpp"
#include "tests/beds/shapes/made_up_surfaces.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace thalweg::beds::mesh_moments_test {
namespace {

constexpr double pi = std::numbers::pi;

// A block of sides 1, 2, 3 mm far from the origin: exact whatever the triangles.
TEST(MeshMoments, OfABlockAreExact) {
  const Vec3 sides(1e-3, 2e-3, 3e-3), lower(0.5, -0.2, 0.1);
  const TriangleMesh mesh = block(lower, lower + sides);
  const dem::BodyMoments body = body_moments(mesh);
  EXPECT_NEAR(body.volume, 6e-9, 6e-9 * 1e-10);
  EXPECT_LT((body.centre - lower - 0.5 * sides).norm(), 1e-13);
  const double m = 6e-9 / 12.0;
  const Vec3 wanted(m * 13e-6, m * 10e-6, m * 5e-6);
  EXPECT_LT((body.inertia.diagonal() - wanted).norm(), 1e-10 * wanted.norm());
  EXPECT_NEAR(surface_area(mesh), 22e-6, 1e-15);
  // Twelve edges with a quarter turn: half of 4 (1 + 2 + 3) mm pi/2.
  EXPECT_NEAR(integral_of_mean_curvature(mesh), pi * 6e-3, 1e-12);
}

// A triangulation inside a sphere is smaller by the square of the angle between its points, here 2 pi/96.
TEST(MeshMoments, OfAnEllipsoidAreThoseOfTheory) {
  const Vec3 half(3e-3, 2e-3, 1e-3);
  const TriangleMesh mesh = ellipsoid(half, Vec3(1.0, 2.0, 3.0) * 1e-2);
  const dem::BodyMoments body = body_moments(mesh);
  const double volume = 4.0 / 3.0 * pi * half.prod();
  EXPECT_NEAR(body.volume, volume, 4e-3 * volume);
  EXPECT_LT(body.volume, volume);
  EXPECT_LT((body.centre - Vec3(1.0, 2.0, 3.0) * 1e-2).norm(), 1e-9);
  const Vec3 squares = half.cwiseProduct(half);
  const Vec3 wanted = volume / 5.0 * (Vec3::Constant(squares.sum()) - squares);
  for (int n = 0; n < 3; ++n) EXPECT_NEAR(body.inertia(n, n), wanted[n], 7e-3 * wanted[n]) << n;
  const ShapeFigures figures = shape_figures(mesh);
  for (int n = 0; n < 3; ++n) EXPECT_NEAR(figures.axes[n], 2.0 * half[n], 2e-3 * half[n]) << n;
  EXPECT_NEAR(figures.corey, 1.0 / std::sqrt(6.0), 1e-3);
  // Area of this ellipsoid: 48.8822 mm^2 (elliptic integrals).
  EXPECT_NEAR(figures.sphericity, std::cbrt(36.0 * pi * volume * volume) / 48.8822e-6, 4e-3);
}

TEST(MeshMoments, OfASphereGiveSphericityAndCurvatureOne) {
  const ShapeFigures figures = shape_figures(ellipsoid(Vec3::Constant(2e-3)));
  EXPECT_NEAR(figures.sphericity, 1.0, 1e-3);
  EXPECT_NEAR(figures.corey, 1.0, 1e-3);
  EXPECT_NEAR(figures.curvature, 1.0, 2e-3);
}

TEST(UnionByLines, AgreesWithTheExactUnion) {
  const std::vector<dem::PlacedSphere> spheres{{Vec3(0.1, 0.0, 0.0), 1.0},
                                               {Vec3(0.9, 0.5, -0.2), 0.8},
                                               {Vec3(-0.7, 0.3, 0.4), 0.5},
                                               {Vec3(0.2, -0.9, 0.8), 0.6}};
  const dem::BodyMoments exact = dem::union_of_spheres(spheres), here = union_by_lines(spheres);
  EXPECT_NEAR(here.volume, exact.volume, 1e-4 * exact.volume);
  EXPECT_LT((here.centre - exact.centre).norm(), 2e-5);
  EXPECT_LT((here.inertia - exact.inertia).norm(), 5e-5 * exact.inertia.norm());
}

}  // namespace
}  // namespace thalweg::beds::mesh_moments_test
