#include "core/geometry/mesh_volume.hpp"

#include "tests/support/meshes.hpp"

#include <gtest/gtest.h>

namespace thalweg::mesh_volume_test {
namespace {

using test::box_mesh;

const PeriodicBox walled{Vec3(4.0, 3.0, 2.0), {false, false, false}}, open{Vec3(4.0, 3.0, 2.0), {true, true, false}};

void expect_near(const std::vector<double>& values, const std::vector<double>& expected) {
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_NEAR(values[k], expected[k], 1e-12) << k;
}

TEST(MeshVolume, OfABlockGrowsWithItsHeight) {
  expect_near(volume_below(box_mesh(Vec3(1.0, 1.0, 0.5), Vec3(3.0, 2.0, 1.75)), walled, 4), {0.0, 0.0, 1.0, 2.0, 2.5});
}

// What is below the floor, above the top or beyond a wall does not count; what is beyond a periodic face comes in
// again.
TEST(MeshVolume, CountsWhatIsInTheBox) {
  const TriangleMesh beyond = box_mesh(Vec3(-1.0, 2.0, -1.0), Vec3(1.0, 5.0, 3.0));
  expect_near(volume_below(beyond, walled, 2), {0.0, 1.0, 2.0});
  expect_near(volume_below(beyond, open, 2), {0.0, 6.0, 12.0});
  // Longer than the periodic box.
  expect_near(volume_below(box_mesh(Vec3(-1.0, -1.0, 0.0), Vec3(1.0, 7.0, 1.0)), open, 2), {0.0, 6.0, 6.0});
}

// A wedge whose top rises from 0 to 2 along x: up to z, all that is beyond x = 2 z, and the slope before it.
TEST(MeshVolume, IsExactOfSlopes) {
  const TriangleMesh wedge = test::slab_mesh(
      Vec3(0.0, 0.0, -1.0), Vec3(4.0, 3.0, 0.0), 1, 1, [](double x, double) { return 0.5 * x; },
      [](int, int) { return Vec3::Zero(); });
  std::vector<double> expected;
  for (const double z : {0.0, 0.5, 1.0, 1.5, 2.0}) expected.push_back(3.0 * (4.0 * z - z * z));
  expect_near(volume_below(wedge, open, 4), expected);
  TriangleMesh inside_out = wedge;
  turn_inside_out(inside_out);
  expect_near(volume_below(inside_out, open, 4), expected);
}

}  // namespace
}  // namespace thalweg::mesh_volume_test
