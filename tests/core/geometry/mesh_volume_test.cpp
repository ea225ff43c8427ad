#include "core/geometry/mesh_volume.hpp"

#include "tests/support/meshes.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace thalweg::mesh_volume_test {
namespace {

using test::box_mesh;

const PeriodicBox walled{Vec3(4.0, 3.0, 2.0), {false, false, false}}, open{Vec3(4.0, 3.0, 2.0), {true, true, false}};

// Half a column, 1/300 of the plan, at each of the faces that stand inside the plan of all: m^3.
constexpr double half_columns = 0.02;
constexpr double exact = 1e-9;  // of faces along the axes: round-off of 90,000 terms

void expect_near(const std::vector<double>& values, const std::vector<double>& expected, double tolerance = exact) {
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_NEAR(values[k], expected[k], tolerance) << k;
}

std::vector<double> below(const std::vector<TriangleMesh>& meshes, const PeriodicBox& box, int layers) {
  return volume_below(meshes, box, layers);
}

TEST(MeshVolume, OfABlockGrowsWithItsHeight) {
  expect_near(below({box_mesh(Vec3(1.0, 1.0, 0.5), Vec3(3.0, 2.0, 1.75))}, walled, 4), {0.0, 0.0, 1.0, 2.0, 2.5});
}

// What is below the floor, above the top or beyond a wall does not count; what is beyond a periodic face comes in
// again.
TEST(MeshVolume, CountsWhatIsInTheBox) {
  const TriangleMesh beyond = box_mesh(Vec3(-1.0, 2.0, -1.0), Vec3(1.0, 5.0, 3.0));
  expect_near(below({beyond}, walled, 2), {0.0, 1.0, 2.0});
  expect_near(below({beyond}, open, 2), {0.0, 6.0, 12.0}, 6.0 * half_columns);  // two faces, 3 m long and 2 m high
  expect_near(below({box_mesh(Vec3(-2.0, -2.0, 0.0), Vec3(-1.0, -1.0, 1.0))}, walled, 2), {0.0, 0.0, 0.0});
  expect_near(below({}, walled, 2), {0.0, 0.0, 0.0});
}

// A rib along x that is longer than the periodic box fills it from end to end, wherever it begins.
TEST(MeshVolume, OfWhatIsLongerThanThePeriodicBox) {
  for (const double beginning : {-1.0, 0.0, 1.0, -9.0})
    expect_near(below({box_mesh(Vec3(beginning, 1.0, 0.0), Vec3(beginning + 5.0, 2.0, 1.0))}, open, 2),
                {0.0, 4.0, 4.0});
}

TEST(MeshVolume, CountsWhatSeveralEncloseOnce) {
  const TriangleMesh low = box_mesh(Vec3(1.0, 1.0, 0.0), Vec3(3.0, 2.0, 1.0)),
                     tall = box_mesh(Vec3(2.0, 1.0, 0.0), Vec3(4.0, 2.0, 2.0)),
                     inside = box_mesh(Vec3(2.25, 1.25, 0.5), Vec3(2.75, 1.75, 1.5)),
                     on_top = box_mesh(Vec3(1.0, 1.0, 1.0), Vec3(2.0, 2.0, 2.0));
  expect_near(below({low, low}, walled, 2), {0.0, 2.0, 2.0});
  expect_near(below({low, tall, inside}, walled, 2), {0.0, 3.0, 5.0}, 2.0 * half_columns);  // a face, 2 m high
  expect_near(below({low, tall, on_top}, walled, 2), {0.0, 3.0, 6.0}, 2.0 * half_columns);
}

// A wedge whose top rises from 0 to 2 along x: up to z, all that is beyond x = 2 z, and the slope before it.
TEST(MeshVolume, OfASlope) {
  const TriangleMesh wedge = test::slab_mesh(
      Vec3(0.0, 0.0, -1.0), Vec3(4.0, 3.0, 0.0), 1, 1, [](double x, double) { return 0.5 * x; },
      [](int, int) { return Vec3::Zero(); });
  std::vector<double> expected;
  for (const double z : {0.0, 0.5, 1.0, 1.5, 2.0}) expected.push_back(3.0 * (4.0 * z - z * z));
  const double midpoints = 1e-4;  // the square of a column's width, 1/300 of the plan: of the column where z is the top
  expect_near(below({wedge}, open, 4), expected, midpoints);
  TriangleMesh inside_out = wedge;
  turn_inside_out(inside_out);
  expect_near(below({inside_out}, open, 4), expected, midpoints);
}

}  // namespace
}  // namespace thalweg::mesh_volume_test
