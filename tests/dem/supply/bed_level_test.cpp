// Grains that come in above the bed: the level of walls, solids and grains, and where grains come in.
#include "dem/supply/bed_level.hpp"
#include "tests/dem/supply/supply_cases.hpp"
#include "tests/support/meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace thalweg::dem::bed_level_test {
namespace {

using test::supply::box_on;
using test::supply::diagnostic;
using test::supply::large;
using test::supply::parameters;
using test::supply::run;
using test::supply::spheres;

// A box of 40 x 20 x 40 mm, periodic along x and y, with these walls and solids at one time (s).
class Level {
public:
  Level(std::vector<Plane> walls, std::vector<Solid> solids, double time = 0.0)
      : walls_(std::move(walls)), solids_(std::move(solids)) {
    for (const Solid& solid : solids_) placed_.emplace_back(solid, time, time);
  }
  double at(double x, double y, double from = 0.04) const {
    return level_of_surroundings({x, y, from}, {box_on(1).box(), walls_, placed_, solids_});
  }

private:
  std::vector<Plane> walls_;
  std::vector<Solid> solids_;
  std::vector<PlacedSolid> placed_;
};

Solid block(const Vec3& lower, const Vec3& upper) {
  Solid solid;
  solid.surface = std::make_shared<SolidSurface>(thalweg::test::box_mesh(lower, upper));
  return solid;
}

Plane wall_at(const Vec3& point, const Vec3& normal) {
  Plane wall;
  wall.point = point;
  wall.normal = normal;
  return wall;
}

TEST(BedLevel, OfWalls) {
  const Vec3 uphill = Vec3(-1.0, 0.0, 1.0).normalized();  // 45 degrees, upwards along x from x = 0.01
  std::vector<Plane> walls{wall_at({0.0, 0.0, 0.002}, Vec3::UnitZ()), wall_at({0.01, 0.0, 0.0}, uphill),
                           wall_at({0.0, 0.0, 0.035}, -Vec3::UnitZ())};
  walls.push_back(face_plane(box_on(1).box(), 0, false, 0.0));
  const Level level(walls, {});
  EXPECT_EQ(level.at(0.005, 0.01), 0.002);
  EXPECT_NEAR(level.at(0.03, 0.01), 0.02, 1e-15);

  Plane plate;  // 10 x 4 mm, 15 mm high, across the end of the box
  plate.point = Vec3(0.039, 0.01, 0.015);
  plate.plate = PlateExtent{Vec3::UnitX(), 0.005, 0.002};
  for (const double normal : {1.0, -1.0}) {
    plate.normal.z() = normal;
    const Level on_plate({plate}, {});
    EXPECT_NEAR(on_plate.at(0.035, 0.0115), 0.015, 1e-15);
    EXPECT_NEAR(on_plate.at(0.003, 0.0085), 0.015, 1e-15);
    EXPECT_EQ(on_plate.at(0.005, 0.01), 0.0);
    EXPECT_EQ(on_plate.at(0.039, 0.0125), 0.0);
    EXPECT_EQ(on_plate.at(0.039, 0.01, 0.014), 0.0);  // from below it
  }
}

// A tilted plate has the same level after it has travelled through the periodic box three and a half times.
TEST(BedLevel, OfAPlateThatHasTravelledFar) {
  Plane plate;  // 10 mm wide, 4 mm long across the slope, 15 mm high in the middle, 30 degrees upwards along x
  plate.point = Vec3(0.01, 0.01, 0.015);
  plate.normal = Vec3(-0.5, 0.0, std::sqrt(0.75));
  plate.plate = PlateExtent{Vec3(std::sqrt(0.75), 0.0, 0.5), 0.005, 0.002};
  plate.velocity = Vec3(0.14, -0.1, 0.0);  // m/s: by 3.5 boxes of 40 mm and 5 of 20 mm in a second
  const Level level({plate.at(1.0, 1.0)}, {});
  const double slope = std::sqrt(1.0 / 3.0);
  EXPECT_NEAR(level.at(0.03, 0.01), 0.015, 1e-12);
  EXPECT_NEAR(level.at(0.033, 0.0115), 0.015 + 0.003 * slope, 1e-12);
  EXPECT_NEAR(level.at(0.027, 0.009), 0.015 - 0.003 * slope, 1e-12);
  EXPECT_EQ(level.at(0.01, 0.01), 0.0);
}

TEST(BedLevel, OfSolids) {
  const Level step({},
                   {block({0.01, -0.005, -0.001}, {0.02, 0.025, 0.008}), block({0.01, 0, 0.03}, {0.02, 0.02, 0.04})});
  EXPECT_NEAR(step.at(0.015, 0.01, 0.025), 0.008, 1e-15);  // under the upper block
  EXPECT_EQ(step.at(0.0201, 0.01, 0.025), 0.0);
  EXPECT_NEAR(step.at(0.015, 0.01, 0.04), 0.04, 1e-15);

  // Across the end of the box, and on its diagonal, where two triangles meet.
  const Level image({}, {block({0.036, -0.001, 0.001}, {0.044, 0.003, 0.005})});
  EXPECT_NEAR(image.at(0.002, 0.019999), 0.005, 1e-15);
  EXPECT_NEAR(image.at(0.038, 0.0), 0.005, 1e-15);
  EXPECT_EQ(image.at(0.005, 0.001), 0.0);

  Solid sphere;
  sphere.surface = std::make_shared<SolidSurface>(SolidSurface::sphere(Vec3(0.001, 0.01, 0.004), 0.005));
  const Level dome({}, {sphere});
  EXPECT_NEAR(dome.at(0.001, 0.01), 0.009, 1e-15);
  EXPECT_NEAR(dome.at(0.038, 0.01), 0.008, 1e-12);
  EXPECT_EQ(dome.at(0.007, 0.01), 0.0);
}

// A beam that has been lifted by 4 mm and turned by 30 degrees about y: its top, 2 mm above its axis, is now 2 mm /
// cos(30 degrees) above it, and sinks along x.
TEST(BedLevel, OfASolidThatMoves) {
  Solid beam = block({0.01, 0.005, 0.008}, {0.03, 0.015, 0.012});
  beam.motion.centre = Vec3(0.02, 0.01, 0.01);
  beam.motion.velocity = Vec3(0.0, 0.0, 0.004);
  beam.motion.axis = Vec3::UnitY();
  beam.motion.angular_velocity = M_PI / 6.0;
  const Level level({}, {beam}, 1.0);
  const double above = 0.014 + 0.002 / std::cos(M_PI / 6.0), slope = std::tan(M_PI / 6.0);
  EXPECT_NEAR(level.at(0.02, 0.01), above, 1e-12);
  EXPECT_NEAR(level.at(0.024, 0.012), above - 0.004 * slope, 1e-12);
  EXPECT_NEAR(level.at(0.014, 0.008), above + 0.006 * slope, 1e-12);
  EXPECT_EQ(level.at(0.02, 0.016), 0.0);
}

struct Sphere {
  GlobalId id;
  double x, y, z, radius;
  bool held;
  Vec3 centre() const { return {x, y, z}; }
};

std::map<GlobalId, Sphere> all_spheres(const GrainDynamics& grains) {
  const GrainStore& store = grains.store();
  std::vector<Sphere> mine;
  for (std::size_t s = 0; s < store.owned; ++s) {
    const Vec3& p = store.position[s];
    mine.push_back({store.id[s], p.x(), p.y(), p.z(), store.radius[s], holds_translation(store.motion[s])});
  }
  std::map<GlobalId, Sphere> all;
  for (const Sphere& sphere : Ranks(MPI_COMM_WORLD).gathered(mine)) all[sphere.id] = sphere;
  return all;
}

// The level by its definition, of spheres on the floor z = 0.
double level_under(const Sphere& place, const std::map<GlobalId, Sphere>& spheres) {
  const PeriodicBox box = box_on(1).box();
  double level = 0.0;
  for (const auto& [id, one] : spheres) {
    bool touches = one.z < one.radius;
    for (const auto& [other_id, other] : spheres)
      touches = touches ||
                (id != other_id && box.difference(one.centre(), other.centre()).norm() < one.radius + other.radius);
    const Vec3 apart = box.difference(one.centre(), place.centre());
    if ((one.held || touches) && std::hypot(apart.x(), apart.y()) < place.radius + one.radius)
      level = std::max(level, one.z + one.radius);
  }
  return level;
}

// Grains rain on a bed that has a held sphere on it and one that hangs in the air.
GrainParameters rain() {
  GrainParameters p = parameters();
  p.supplies = {spheres(1500.0)};
  p.supplies[0].entrance.zone = {Vec3::Zero(), Vec3(0.04, 0.02, 0.036)};
  p.supplies[0].entrance.velocity = std::nullopt;  // at rest
  p.supplies[0].entrance.above_bed = HeightRange{0.003, 0.006};
  return p;
}

GrainSeeds two_held() {
  GrainSeed low = test::glass_sphere(0, Vec3(0.01, 0.01, 0.002), Vec3::Zero(), large),
            high = test::glass_sphere(1, Vec3(0.03, 0.01, 0.02), Vec3::Zero(), large);
  low.motion = high.motion = Motion::fixed;
  return {{low, high}, {}};
}

TEST(BedLevel, GrainsComeInAboveIt) {
  const GrainParameters p = rain();
  GrainDynamics grains(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p, two_held());
  int on_grains = 0, in_all = 0, above_the_high = 0;
  double highest = 0.0;
  for (int n = 0; n < 600; ++n) {
    const std::map<GlobalId, Sphere> before = all_spheres(grains);
    grains.turn_over();
    for (const auto& [id, sphere] : all_spheres(grains)) {
      if (before.contains(id)) continue;
      const double level = level_under(sphere, before);
      ASSERT_GE(sphere.z, level + 0.003 - 1e-12);
      ASSERT_LE(sphere.z, level + 0.006 + 1e-12);
      ++in_all;
      on_grains += level > 0.0;
      above_the_high += level == 0.02 + large;
      highest = std::max(highest, sphere.z);
    }
    grains.prepare();
    grains.advance(p.sub_steps);
    grains.refresh_ghosts();
  }
  // About 220 come in, and lie several layers deep in the end; 0.03 of the plan is under the high sphere.
  EXPECT_GT(in_all, 200);
  EXPECT_GT(on_grains, 150);
  EXPECT_GE(above_the_high, 3);
  EXPECT_GE(highest, 0.0255);
  EXPECT_LT(diagnostic(grains, "supply_lag"), 0.02);
  EXPECT_LT(grains.largest_overlap(), 0.05);
}

// The region ends below the level of the bed plus the least height: everything waits.
TEST(BedLevel, GrainsWaitWhereTheBedIsTooHigh) {
  GrainParameters p = rain();
  Zone& zone = p.supplies[0].entrance.zone;
  zone = {Vec3(0.029, 0.009, 0.0), Vec3(0.031, 0.011, 0.02 + large + 0.0029)};
  GrainDynamics grains(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p, two_held());
  run(grains, 20);
  EXPECT_EQ(diagnostic(grains, "supplied_grains"), 0.0);
  EXPECT_GT(diagnostic(grains, "supply_lag"), 0.004);

  zone.upper.z() += 0.0002;
  GrainDynamics others(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p, two_held());
  run(others, 20);
  EXPECT_GE(diagnostic(others, "supplied_grains"), 1.0);
}

// What has just come in hangs above the bed and is no part of it: with no gravity nothing comes in
// above the first layer.
TEST(BedLevel, GrainsThatTouchNothingAreNoBed) {
  GrainParameters p = rain();
  p.body_force = {};
  GrainDynamics grains(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p,
                       GrainSeeds{{test::glass_sphere(0, Vec3(0.01, 0.01, 0.003), Vec3::Zero(), large)}, {}});
  run(grains, 200);
  EXPECT_GT(diagnostic(grains, "supplied_grains"), 10.0);
  for (const auto& [id, sphere] : all_spheres(grains)) EXPECT_LE(sphere.z, 0.006);
}

}  // namespace
}  // namespace thalweg::dem::bed_level_test
