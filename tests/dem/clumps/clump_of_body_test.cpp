#include "dem/clumps/clump_of_body.hpp"

#include "core/base/error.hpp"
#include "dem/clumps/clumps.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <numbers>
#include <vector>

namespace thalweg::dem::clump_of_body_test {
namespace {

const std::vector<PlacedSphere> three{
    {{0.01, 0, 0}, 2e-3}, {{0.0118, 0.3e-3, 0}, 1.5e-3}, {{0.0095, 2e-3, 0.4e-3}, 1.2e-3}};

TEST(ClumpOfBody, OfItsUnionIsTheClumpItself) {
  const ClumpShape own = clump_shape(three), of_body = clump_shape(three, union_of_spheres(three));
  EXPECT_EQ(of_body.volume, own.volume);
  EXPECT_EQ(of_body.moments, own.moments);
  EXPECT_EQ(of_body.centre, own.centre);
  EXPECT_EQ(of_body.bounding_radius, own.bounding_radius);
  for (std::size_t n = 0; n < three.size(); ++n) EXPECT_EQ(of_body.members[n].position, own.members[n].position);
}

// Volume grows with the third power of the size and moments with the fifth; of disks with the second and the fourth.
TEST(ClumpOfBody, ScaledIsTheSameShape) {
  const ClumpShape shape = clump_shape(three), twice = scaled(shape, 2.0);
  EXPECT_EQ(twice.volume, 8.0 * shape.volume);
  EXPECT_EQ(twice.moments, 32.0 * shape.moments);
  EXPECT_EQ(twice.bounding_radius, 2.0 * shape.bounding_radius);
  EXPECT_EQ(twice.members[1].position, 2.0 * shape.members[1].position);
  EXPECT_EQ(twice.members[1].radius, 2.0 * shape.members[1].radius);
  EXPECT_EQ(twice.equivalent_radius(), 2.0 * shape.equivalent_radius());
  const std::vector<PlacedSphere> pair{{{0.01, 0, 0}, 2e-3}, {{0.013, 0, 0}, 2e-3}};
  const ClumpShape disks = clump_shape(pair, 1e-3), wide = scaled(disks, 2.0);
  EXPECT_EQ(wide.volume, 4.0 * disks.volume);
  EXPECT_EQ(wide.moments, 16.0 * disks.moments);
  EXPECT_EQ(wide.thickness, disks.thickness);
}

// One sphere that stands for an ellipsoid of half axes 3, 2 and 1 mm, turned: mass and moments are those of theory, on
// the way to another rank too.
TEST(ClumpOfBody, HasMassAndMomentsOfTheBody) {
  const Vec3 half(3e-3, 2e-3, 1e-3), squares = half.cwiseProduct(half), centre(0.1, -0.2, 0.3);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -2.0) / 3.0).toRotationMatrix();
  BodyMoments body;
  body.volume = 4.0 / 3.0 * std::numbers::pi * half.prod();
  body.centre = centre;
  const Vec3 moments = body.volume / 5.0 * (Vec3::Constant(squares.sum()) - squares);
  body.inertia = turn * moments.asDiagonal() * turn.transpose();
  ClumpSeed seed;
  seed.shape = std::make_shared<const ClumpShape>(
      clump_shape(std::vector<PlacedSphere>{{centre + Vec3(0.0, 0.0, 1e-3), 1e-3}}, body));
  seed.density = 2650.0;
  seed.position = Vec3::Constant(0.05);
  PeriodicBox box;
  box.size = Vec3::Constant(0.1);
  const Clump clump = clump_of(row_of(clump_of(seed, box)));
  EXPECT_NEAR(clump.mass, 2650.0 * body.volume, 1e-12 * clump.mass);
  EXPECT_EQ(clump.volume, body.volume);
  for (int n = 0; n < 3; ++n) EXPECT_NEAR(clump.moments[n], 2650.0 * moments[n], 1e-12 * clump.moments[2]) << n;
  // In space the body is as it was given, and the member stays where it was, off the centre.
  const Eigen::Matrix3d axes = rotation_matrix(clump.orientation);
  EXPECT_LT((axes * clump.moments.asDiagonal() * axes.transpose() - 2650.0 * body.inertia).norm(),
            1e-12 * clump.moments[2]);
  EXPECT_LT((axes * seed.shape->members[0].position - Vec3(0.0, 0.0, 1e-3)).norm(), 1e-15);
  EXPECT_NEAR(seed.shape->bounding_radius, 2e-3, 1e-15);
}

TEST(ClumpOfBody, ThatCannotBeIsRefused) {
  BodyMoments body = union_of_spheres(three);
  EXPECT_THROW(clump_shape(std::vector<PlacedSphere>{}, body), InputError);
  BodyMoments hollow = body;
  hollow.volume = 0.0;
  EXPECT_THROW(clump_shape(three, hollow), InputError);
  BodyMoments flat = body;
  flat.inertia = Vec3(1e-14, 1e-14, 3e-14).asDiagonal();  // no body is so flat: I3 <= I1 + I2
  EXPECT_THROW(clump_shape(three, flat), InputError);
}

}  // namespace
}  // namespace thalweg::dem::clump_of_body_test
