// Walls that are plates: parts of planes with two sides and edges.
#include "core/base/error.hpp"
#include "tests/dem/grain_cases.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <memory>
#include <string>

namespace thalweg::dem::plate_test {
namespace {

constexpr double radius = test::glass_radius;

Plane plate(const Vec3& point, double half_length, double half_width, const Vec3& normal = Vec3::UnitZ()) {
  Plane wall;
  wall.point = point;
  wall.normal = normal;
  wall.plate = {Vec3::UnitX(), half_length, half_width};
  return wall;
}

GrainParameters with(std::vector<Plane> walls, double restitution = 1.0) {
  GrainParameters p = test::parameters(test::glass(restitution), 2e-6, 25);
  p.walls = std::move(walls);
  return p;
}

TEST(Plate, ShowsItsNearestPoint) {
  const double tilt = 0.3;
  Plane wall = plate(Vec3(0.01, 0.02, 0.03), 4e-3, 2e-3, Vec3(0.0, -std::sin(tilt), std::cos(tilt)));
  const Vec3 across(0.0, std::cos(tilt), std::sin(tilt));
  // Many places in a plane parallel to it, on either side: the nearest of a fine grid of its points is it.
  for (const double height : {1.3e-3, -0.8e-3})
    for (double u = -6e-3; u <= 6e-3; u += 1.5e-3)
      for (double v = -4e-3; v <= 4e-3; v += 1.0e-3) {
        const Vec3 at = wall.point + height * wall.normal + u * Vec3::UnitX() + v * across;
        double nearest = 1.0;
        for (int i = -8; i <= 8; ++i)
          for (int j = -8; j <= 8; ++j)
            nearest = std::min(nearest, (at - wall.point - i * 0.5e-3 * Vec3::UnitX() - j * 0.25e-3 * across).norm());
        const WallView view = wall.seen_from(at, PeriodicBox{});
        EXPECT_NEAR(view.distance, nearest, 1e-15);  // all u and v are at points of the grid
        EXPECT_NEAR(view.normal.norm(), 1.0, 1e-14);
        // From the grain back along the normal one is on the plate.
        const Vec3 foot = at - view.distance * view.normal - wall.point;
        EXPECT_NEAR(foot.dot(wall.normal), 0.0, 1e-16);
        EXPECT_LE(std::abs(foot.x()), 4e-3 + 1e-15);
        EXPECT_LE(std::abs(foot.dot(across)), 2e-3 + 1e-15);
      }
}

// Over its middle a plate is a plane, to the last bit; from below it is one turned over.
TEST(Plate, IsAPlaneAwayFromItsEdges) {
  const Vec3 start(0.02, 0.03, 0.025 + 1.2 * radius), velocity(0.2, -0.1, -0.3);
  const auto flight = [&](bool finite, bool from_below) {
    Plane wall;
    wall.point = Vec3(0.0, 0.0, 0.025);
    wall.friction = 0.3, wall.rolling_friction = 0.05;
    if (finite)
      wall.plate = {Vec3::UnitX(), 1.0, 1.0};
    else if (from_below)
      wall.normal = -Vec3::UnitZ();
    Vec3 at = start, v = velocity;
    if (from_below) at.z() = 2.0 * 0.025 - at.z(), v.z() = -v.z();
    auto grains = std::make_unique<GrainDynamics>(test::cube(), MPI_COMM_SELF, with({wall}, 0.8),
                                                  std::vector{test::glass_sphere(0, at, v)});
    for (int n = 0; n < 400; ++n) test::step(*grains);  // 20 ms; they meet after 1.7 ms
    return grains;
  };
  for (const bool from_below : {false, true}) {
    const auto on_plane = flight(false, from_below), on_plate = flight(true, from_below);
    const GrainStore &a = on_plane->store(), &b = on_plate->store();
    EXPECT_NE(a.angular_velocity[0].norm(), 0.0);
    EXPECT_EQ(a.position[0], b.position[0]);
    EXPECT_EQ(a.velocity[0], b.velocity[0]);
    EXPECT_EQ(a.angular_velocity[0], b.angular_velocity[0]);
  }
}

// A smooth grain that falls on an edge is turned about the line from the edge to its centre: an elastic impact reverses
// the part of its velocity along that line and keeps the rest.
TEST(Plate, TurnsAGrainBackFromItsEdgeAndItsCorner) {
  const Vec3 corner(0.025, 0.02, 0.02);
  Plane wall = plate(corner - Vec3(5e-3, 4e-3, 0.0), 5e-3, 4e-3);  // ends at `corner` along x and y
  wall.friction = 0.0;
  for (const Vec3& beyond : {Vec3(0.6, -1.0, 0.8), Vec3(0.48, 0.36, 0.8)}) {
    const bool at_corner = beyond.y() > 0.0;
    Vec3 line = beyond;
    if (!at_corner) line.y() = 0.0;
    ASSERT_NEAR(line.norm(), 1.0, 1e-15);
    const double speed = 0.01;
    Vec3 start = corner + 1.001 * radius * line;
    if (!at_corner) start.y() -= 2e-3;
    GrainDynamics grains(test::cube(), MPI_COMM_SELF, with({wall}),
                         {test::glass_sphere(0, start, Vec3(0.0, 0.0, -speed))});
    for (int n = 0; n < 40; ++n) test::step(grains);  // 2 ms; they meet after 0.3 ms, for 0.3 ms
    ASSERT_EQ(grains.contacts().size(), 0u);
    const Vec3 before(0.0, 0.0, -speed), after = before - 2.0 * before.dot(line) * line;
    // The line turns while they touch: 0.3 ms at 0.01 m/s over the radius is 1e-3.
    EXPECT_LT((grains.store().velocity[0] - after).norm(), 3e-3 * speed);
    EXPECT_EQ(grains.store().angular_velocity[0], Vec3::Zero());
  }
}

// A grain that rolls over the edge of a table falls past it.
TEST(Plate, LetsAGrainRollOffItsEdge) {
  Plane table = plate(Vec3(0.02, 0.025, 0.03), 5e-3, 1.0);
  table.friction = 0.5;
  GrainParameters p = with({table, face_plane(test::cube().box(), 2, false, 0.5)}, 0.5);
  p.body_force = [](double mass, double) { return Vec3(0.0, 0.0, -9.8 * mass); };
  GrainSeed seed = test::glass_sphere(0, Vec3(0.02, 0.025, 0.03 + radius), Vec3(0.05, 0.0, 0.0));
  seed.angular_velocity = Vec3(0.0, 0.05 / radius, 0.0);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {seed});
  const GrainStore& store = grains.store();
  while (store.position[0].x() < 0.0245) {
    ASSERT_LT(grains.time(), 0.11);  // 4.5 mm at 0.05 m/s take 0.09 s
    EXPECT_NEAR(store.position[0].z(), 0.03 + radius, 1e-5);
    test::step(grains);
  }
  while (grains.time() < 0.4) test::step(grains);
  // The grain is on the floor, but for the overlap that bears its weight.
  EXPECT_NEAR(store.position[0].z(), radius - 9.8 * store.mass[0] / 20000.0, 1e-8);
}

// A plate that is drawn away from under a grain lets it fall.
TEST(Plate, MovesAlongItselfToo) {
  Plane gate = plate(Vec3(0.025, 0.025, 0.03), 5e-3, 1.0);
  gate.velocity = Vec3(0.2, 0.0, 0.0);
  GrainParameters p = with({gate, face_plane(test::cube().box(), 2, false, 0.5)}, 0.5);
  p.walls[0].friction = 0.0;
  p.body_force = [](double mass, double) { return Vec3(0.0, 0.0, -9.8 * mass); };
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p,
                       {test::glass_sphere(0, Vec3(0.025, 0.025, 0.03 + radius - 1e-9))});
  const GrainStore& store = grains.store();
  while (grains.time() < 0.024) {  // the edge is under its centre after 0.025 s
    test::step(grains);
    ASSERT_NEAR(store.position[0].z(), 0.03 + radius, 1e-5);
  }
  while (grains.time() < 0.045) test::step(grains);  // the edge has gone by after 0.0375 s
  EXPECT_LT(store.position[0].z(), 0.03 + 0.9 * radius);
  EXPECT_EQ(grains.wall_forces()[0], Vec3::Zero());
}

// A sudden 30 N on 20000 N/m push a grain 3 mm deep, more than its radius of 2.5 mm.
TEST(Plate, DoesNotLetAGrainThroughUnseen) {
  GrainParameters p = with({plate(Vec3(0.025, 0.025, 0.025), 0.01, 0.01)});
  p.body_force = [](double, double) { return Vec3(0.0, 0.0, -30.0); };
  p.sub_steps = 5;  // it moves 0.16 mm between two looks, less than half the skin
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {test::glass_sphere(0, Vec3(0.025, 0.025, 0.025 + radius))});
  std::string what;
  try {
    for (int n = 0; n < 1000; ++n) test::step(grains);
  } catch (const RunError& error) {
    what = error.what();
  }
  EXPECT_NE(what.find("deep in a plate"), std::string::npos) << what;
}

// Far from the box's end and across it the same plate looks the same, and one as long as the box has no ends.
TEST(Plate, HasPeriodicImages) {
  const PeriodicBox box = test::cube().box();  // 50 mm, periodic along x and y
  const Plane inside = plate(Vec3(0.025, 0.025, 0.02), 5e-3, 4e-3), across = plate(Vec3(0.0, 0.05, 0.02), 5e-3, 4e-3);
  for (double x = 0.4e-3; x < 0.05; x += 1.7e-3)
    for (double y = 0.4e-3; y < 0.05; y += 2.3e-3) {
      const WallView there = inside.seen_from(Vec3(x, y, 0.021), box);
      const WallView here = across.seen_from(box.wrapped(Vec3(x + 0.025, y + 0.025, 0.021)), box);
      EXPECT_NEAR(here.distance, there.distance, 1e-15);
      EXPECT_LT((here.normal - there.normal).norm(), 1e-12);
      EXPECT_EQ(plate(Vec3(0.01, 0.0, 0.02), 0.025, 1.0).seen_from(Vec3(x, y, 0.021), box).normal, Vec3::UnitZ());
    }
  // A grain on the end of the box rests on a plate that ends beyond it.
  GrainParameters p = with({across}, 0.5);
  p.body_force = [](double mass, double) { return Vec3(0.0, 0.0, -9.8 * mass); };
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {test::glass_sphere(0, Vec3(0.048, 0.002, 0.02 + radius))});
  for (int n = 0; n < 4000; ++n) test::step(grains);  // 0.2 s
  EXPECT_NEAR(grains.store().position[0].z(), 0.02 + radius - 9.8 * grains.store().mass[0] / 20000.0, 1e-9);
  // Askew to a periodic axis it must be short.
  Plane askew = plate(Vec3(0.025, 0.025, 0.02), 0.02, 0.02);
  check_images(askew, box, radius);
  askew.plate->along = Vec3(0.6, 0.8, 0.0);
  EXPECT_THROW(check_images(askew, box, radius), InputError);
  // Sloping along one, too: at the foot of this one, below its middle, the head of its image would not be seen.
  Plane sloping = plate(Vec3(0.025, 0.025, 0.03), 0.029, 0.02, Vec3(-0.6, 0.0, 0.8));
  sloping.plate->along = Vec3(0.8, 0.0, 0.6);
  EXPECT_THROW(check_images(sloping, box, radius), InputError);
  sloping.plate->half_length = 0.028;  // 22.4 mm along x, and a grain of 2.5 mm
  check_images(sloping, box, radius);
  for (double x = 0.0; x < 0.05; x += 1e-3) {
    // Nearest of many points of the plate and its images.
    const Vec3 at(x, 0.025, 0.045);
    double nearest = 1.0;
    for (int image = -1; image <= 1; ++image)
      for (int n = -1000; n <= 1000; ++n)
        nearest = std::min(
            nearest, (at - sloping.point - Vec3(0.05 * image, 0.0, 0.0) - n * 28e-6 * sloping.plate->along).norm());
    if (nearest < radius) {
      EXPECT_NEAR(sloping.seen_from(at, box).distance, nearest, 1.5e-5) << x;
    }
  }
}

// A grain that goes round a periodic face comes out 35 mm behind a plane at 45 degrees.
TEST(Plane, HasNoImagesAGrainCouldGoRoundTo) {
  Plane slope;
  slope.normal = Vec3(-1.0, 0.0, 1.0).normalized();
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, with({slope}),
                       {test::glass_sphere(0, Vec3(0.002, 0.025, 0.025), Vec3(-0.1, 0.0, 0.0))});
  std::string message;
  for (int n = 0; n < 500 && message.empty(); ++n) try {  // 25 ms; it needs 20 ms
      test::step(grains);
    } catch (const RunError& error) {
      message = error.what();
    }
  EXPECT_NE(message.find("moving at 0.1 m/s, is more than its radius beyond a wall"), std::string::npos) << message;
}

TEST(Plate, IsRefusedWithoutLengthOrOffItsPlane) {
  EXPECT_THROW(check(plate(Vec3::Zero(), 0.0, 1.0)), InputError);
  EXPECT_THROW(check(plate(Vec3::Zero(), 1.0, 1.0, Vec3::UnitX())), InputError);
  const std::vector<GrainSeed> inside{test::glass_sphere(0, Vec3(0.025, 0.025, 0.026))};
  EXPECT_THROW(GrainDynamics(test::cube(), MPI_COMM_SELF, with({plate(Vec3(0.025, 0.025, 0.025), 0.01, 0.01)}), inside),
               InputError);
}

}  // namespace
}  // namespace thalweg::dem::plate_test
