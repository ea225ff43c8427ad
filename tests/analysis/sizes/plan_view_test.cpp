#include "analysis/sizes/plan_view.hpp"

#include "core/parallel/mpi_session.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace thalweg::analysis::plan_view_test {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

// Every rank has some of the spheres.
std::vector<SeenSphere> mine(const std::vector<SeenSphere>& all) {
  std::vector<SeenSphere> some;
  for (std::size_t n = 0; n < all.size(); ++n)
    if (static_cast<int>(n) % size_of(world) == rank_of(world)) some.push_back(all[n]);
  return some;
}

std::vector<double> areas(const PeriodicBox& box, const std::vector<SeenSphere>& spheres, int kinds) {
  const PlanView view(world, box, 0.01, false);
  std::vector<double> found;
  for (const std::int64_t pixels : view.pixels_of(mine(spheres), kinds))
    found.push_back(static_cast<double>(pixels) * 1e-4);
  return found;
}

constexpr double pi = std::numbers::pi;
// The pixels at the edge of a disk of radius 1 are known to about their root, some 25 of 31416.
constexpr double pixel_error = 5e-3;

TEST(PlanView, ShowsTheUpperOfTwoSpheres) {
  const PeriodicBox box{{8.0, 4.0, 4.0}, {true, true, false}};
  // Concentric from above: the small one on top covers its own area of the large one.
  const std::vector<double> on_top = areas(box, {{0, 2.0, 2.0, 1.0, 1.0, 0}, {1, 2.0, 2.0, 2.5, 0.5, 1}}, 2);
  EXPECT_NEAR(on_top[1], 0.25 * pi, pixel_error);
  EXPECT_NEAR(on_top[0], 0.75 * pi, pixel_error);
  // Below it, it is not seen, and what counts nowhere hides it just so.
  EXPECT_EQ(areas(box, {{0, 2.0, 2.0, 2.5, 1.0, 0}, {1, 2.0, 2.0, 0.5, 0.5, 1}}, 2)[1], 0.0);
  const std::vector<double> hidden = areas(box, {{0, 2.0, 2.0, 2.5, 1.0, -1}, {1, 2.0, 2.0, 0.5, 0.5, 1}}, 2);
  EXPECT_EQ(hidden[0] + hidden[1], 0.0);
}

// Two alike side by side at a distance of their radius: each shows its disk up to the line half-way, that is the disk
// less half of the lens that both cover, pi (1/3) - sqrt(3)/4.
TEST(PlanView, DividesSpheresThatOverlapHalfWay) {
  const PeriodicBox box{{8.0, 4.0, 4.0}, {true, true, false}};
  const double half_of_lens = pi / 3.0 - 0.25 * std::numbers::sqrt3;
  for (const double area : areas(box, {{0, 3.0, 2.0, 1.0, 1.0, 0}, {1, 4.0, 2.0, 1.0, 1.0, 1}}, 2))
    EXPECT_NEAR(area, pi - half_of_lens, pixel_error);
}

TEST(PlanView, GoesOnAcrossPeriodicFacesAndEndsAtWalls) {
  const std::vector<SeenSphere> at_corner{{0, 0.0, 0.0, 1.0, 1.0, 0}};
  EXPECT_NEAR(areas({{8.0, 4.0, 4.0}, {true, true, false}}, at_corner, 1)[0], pi, pixel_error);
  EXPECT_NEAR(areas({{8.0, 4.0, 4.0}, {true, false, false}}, at_corner, 1)[0], 0.5 * pi, pixel_error);
  EXPECT_NEAR(areas({{8.0, 4.0, 4.0}, {false, false, false}}, at_corner, 1)[0], 0.25 * pi, pixel_error);
}

// Disks across the plane x-z: what counts is the length along x. A disk of radius 1 shows all of its 2 m but for the
// 1 m under the one on top.
TEST(PlanView, OfDisksIsALine) {
  const PlanView view(world, {{8.0, 4.0, 4.0}, {true, true, false}}, 0.01, true);
  const std::vector<std::int64_t> pixels =
      view.pixels_of(mine({{0, 2.003, 2.0, 1.0, 1.0, 0}, {1, 2.003, 2.0, 2.5, 0.5, 1}}), 2);
  EXPECT_EQ(view.pixels(), 800);
  EXPECT_EQ(pixels[0], 100);
  EXPECT_EQ(pixels[1], 100);
}

}  // namespace
}  // namespace thalweg::analysis::plan_view_test
