#include "beds/shapes/mesh_clump.hpp"

#include "beds/population/population_clumps.hpp"
#include "beds/shapes/shape_figures.hpp"
#include "core/base/error.hpp"
#include "tests/beds/shapes/made_up_surfaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace thalweg::beds::mesh_clump_test {
namespace {

std::string refusal(const TriangleMesh& mesh, const ClumpFit& fit = {.spheres = 3, .tolerance = {}}) {
  try {
    clump_of(mesh, fit);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(MeshClump, OfASphereIsOneSphereOfItsVolumeAtItsCentre) {
  const Vec3 centre(1e-2, -2e-2, 3e-3);
  const TriangleMesh mesh = ellipsoid(Vec3::Constant(2e-3), centre);
  const MeshClump clump = clump_of(mesh, {.spheres = {}, .tolerance = 0.01});
  ASSERT_EQ(clump.spheres.size(), 1u);
  EXPECT_LT((clump.spheres[0].position - centre).norm(), 1e-8);
  EXPECT_NEAR(clump.spheres[0].radius, 0.5 * clump.equivalent_diameter, 1e-5 * clump.equivalent_diameter);
  const FitFigures figures = fit_figures(mesh, clump);
  EXPECT_LT(figures.largest_to_clump, 2e-3);
  EXPECT_LT(figures.largest_to_surface, 2e-3);
  EXPECT_NEAR(figures.curvature, 1.0, 1e-4);
  EXPECT_LT(figures.moment_errors.cwiseAbs().maxCoeff(), 1e-3);
}

// Two spheres whose axis is inclined, as one surface seen from between them.
TEST(MeshClump, OfTwoSpheresIsThoseTwo) {
  const Vec3 axis = Vec3(2.0, 1.0, 2.0) / 3.0;
  const double radius = 1e-3, apart = 0.6e-3;  // of each centre from the middle
  const TriangleMesh mesh = star_surface(96, [&](const Vec3& direction) {
    const double along = apart * std::abs(direction.dot(axis));
    return along + std::sqrt(radius * radius - apart * apart + along * along);
  });
  const MeshClump clump = clump_of(mesh, {.spheres = 2, .tolerance = {}});
  ASSERT_EQ(clump.spheres.size(), 2u);
  for (const auto& sphere : clump.spheres) {
    EXPECT_NEAR(sphere.radius, radius, 2e-3 * radius);
    EXPECT_NEAR(std::abs(sphere.position.dot(axis)), apart, 4e-3 * radius);
    EXPECT_LT((sphere.position - sphere.position.dot(axis) * axis).norm(), 4e-3 * radius);
  }
  EXPECT_LT(clump.spheres[0].position.dot(clump.spheres[1].position), 0.0);
}

TEST(MeshClump, HasVolumeAndCentreOfTheSurface) {
  const Vec3 half(3e-3, 2e-3, 1.2e-3), centre(0.01, 0.0, 0.02);
  const TriangleMesh mesh = ellipsoid(half, centre);
  const MeshClump clump = clump_of(mesh, {.spheres = 12, .tolerance = {}});
  ASSERT_EQ(clump.spheres.size(), 12u);
  const dem::BodyMoments exact = dem::union_of_spheres(clump.spheres);
  EXPECT_NEAR(exact.volume, clump.body.volume, 1e-4 * clump.body.volume);
  EXPECT_LT((exact.centre - clump.body.centre).norm(), 1e-4 * clump.equivalent_diameter);
  EXPECT_NEAR(clump.body.volume, signed_volume(mesh), 1e-10 * clump.body.volume);
}

// Inscribed: no sphere leaves the ellipsoid. 30 spheres hold more and lie nearer than 10.
TEST(MeshClump, ComesNearerWithMoreSpheres) {
  const Vec3 half(2e-3, 1.5e-3, 1e-3);
  const TriangleMesh mesh = ellipsoid(half);
  const MeshClump few = clump_of(mesh, {.spheres = 10, .tolerance = {}}),
                  many = clump_of(mesh, {.spheres = 30, .tolerance = {}});
  for (const auto& sphere : many.inscribed)
    for (const Vec3& point : mesh.points) EXPECT_GE((point - sphere.position).norm(), sphere.radius * (1.0 - 1e-12));
  const FitFigures of_few = fit_figures(mesh, few), of_many = fit_figures(mesh, many);
  EXPECT_GT(of_many.inscribed_volume, of_few.inscribed_volume);
  EXPECT_GT(of_many.inscribed_volume, 0.9);
  EXPECT_LT(of_many.inscribed_volume, 1.0);
  EXPECT_LT(of_many.mean_to_clump, of_few.mean_to_clump);
  EXPECT_LT(of_many.moment_errors.cwiseAbs().maxCoeff(), 0.03);
}

// The largest sphere in a cube has pi/6 of it. One in a plate has the height t of the plate, so that 20 of them hold at
// most 20 pi t^2/6 of a plate of 1 x 1 x t.
TEST(MeshClump, SaysHowMuchOfASurfaceItsSpheresHeldBeforeTheyGrew) {
  const auto held = [](double height) {
    ShapeKeys shape;
    shape.spheres = 20;
    take_surface(shape, block(Vec3::Zero(), 0.01 * Vec3(1.0, 1.0, height)));
    return shape.inscribed;
  };
  EXPECT_EQ(ShapeKeys{}.inscribed, 1.0);  // of spheres that are given
  EXPECT_GT(held(1.0), M_PI / 6.0 + 0.1);
  EXPECT_LT(held(1.0), 1.0);
  const double most = 20.0 * M_PI / 6.0 * 0.05 * 0.05;
  EXPECT_GT(held(0.05), 0.9 * most);
  EXPECT_LT(held(0.05), 1.01 * most);
}

TEST(MeshClump, StopsAtTheToleranceAndIsTheSameOnEveryCall) {
  const TriangleMesh mesh = ellipsoid(Vec3(2e-3, 1.5e-3, 1e-3));
  const MeshClump first = clump_of(mesh, {.spheres = {}, .tolerance = 0.02}),
                  again = clump_of(mesh, {.spheres = {}, .tolerance = 0.02}),
                  nearer = clump_of(mesh, {.spheres = {}, .tolerance = 0.01});
  ASSERT_EQ(first.spheres.size(), again.spheres.size());
  for (std::size_t n = 0; n < first.spheres.size(); ++n) {
    EXPECT_EQ(first.spheres[n].position, again.spheres[n].position);
    EXPECT_EQ(first.spheres[n].radius, again.spheres[n].radius);
  }
  EXPECT_GT(nearer.spheres.size(), first.spheres.size());
  EXPECT_NE(refusal(ellipsoid(Vec3(2e-3, 1.5e-3, 1e-3)), {.spheres = {}, .tolerance = 1e-6}).find("tolerance"),
            std::string::npos);
}

TEST(MeshClump, RefusesSurfacesThatEncloseNoGrain) {
  TriangleMesh open = ellipsoid(Vec3::Constant(1e-3));
  open.triangles.pop_back();
  EXPECT_NE(refusal(open).find("not closed"), std::string::npos);

  TriangleMesh inside_out = ellipsoid(Vec3::Constant(1e-3));
  turn_inside_out(inside_out);
  EXPECT_NE(refusal(inside_out).find("inwards"), std::string::npos);

  TriangleMesh two = ellipsoid(Vec3::Constant(1e-3));
  add(two, ellipsoid(Vec3::Constant(1e-3), Vec3(5e-3, 0.0, 0.0)));
  EXPECT_NE(refusal(two).find("2 separate parts"), std::string::npos);

  EXPECT_NE(refusal(ellipsoid(Vec3::Constant(5.0))).find("scale"), std::string::npos);
  EXPECT_NE(refusal(ellipsoid(Vec3::Constant(1e-3)), {}).find("give spheres"), std::string::npos);

  // A point pulled through the body and out on the other side.
  TriangleMesh crossed = ellipsoid(Vec3::Constant(1e-3), Vec3::Zero(), 16);
  crossed.points[1] = Vec3(0.0, 0.0, -3e-3);
  EXPECT_NE(refusal(crossed).find("crosses itself"), std::string::npos) << refusal(crossed);
}

}  // namespace
}  // namespace thalweg::beds::mesh_clump_test
