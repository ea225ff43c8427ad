// Grains on solids: surfaces of triangles and spheres, at rest and moving.
#include "core/base/counter_random.hpp"
#include "core/base/error.hpp"
#include "tests/dem/grain_cases.hpp"
#include "tests/support/meshes.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

namespace thalweg::dem::solid_test {
namespace {

constexpr double radius = test::glass_radius, g = 9.8;

Solid solid_of(const TriangleMesh& mesh, double friction = 0.5) {
  EXPECT_EQ(what_is_open(mesh), "");
  EXPECT_GT(signed_volume(mesh), 0.0);
  return {std::make_shared<SolidSurface>(mesh), friction, 0.0, {}};
}

GrainParameters with(std::vector<Solid> solids, double restitution = 1.0) {
  GrainParameters p = test::parameters(test::glass(restitution), 5e-6, 25);
  p.solids = std::move(solids);
  return p;
}

GrainParameters with_gravity(GrainParameters p, const Vec3& gravity) {
  p.body_force = [gravity](double mass, double) { return Vec3(mass * gravity); };
  return p;
}

// A floor of many triangles of all shapes, over the whole of the cube.
TriangleMesh rough_triangulation(double top, int fields) {
  const double field = 0.05 / fields;
  return thalweg::test::slab_mesh(
      Vec3(0.0, 0.0, top - 4e-3), Vec3(0.05, 0.05, top), fields, fields, [top](double, double) { return top; },
      [field](int i, int j) {
        const auto draw = [&](int n) { return uniform_random(5, 100 * i + j, n) - 0.5; };
        return Vec3(0.7 * field * draw(0), 0.7 * field * draw(1), 0.0);
      });
}

// The path of a grain that bounces, slides and rolls over a triangulated floor, across both periodic ends, is that over
// a plane, whether the triangles are larger or much smaller than the contact.
TEST(Solids, FlatOnesArePlanesWhateverTheirTriangles) {
  const double top = 0.01;
  const Vec3 velocity(0.35, 0.22, -0.1);
  const auto path = [&](std::vector<Solid> solids) {
    GrainParameters p = with(std::move(solids), 0.6);
    if (p.solids.empty()) {
      p.walls = {face_plane(test::cube().box(), 2, false, 0.3)};
      p.walls[0].point[2] = top;
      p.walls[0].rolling_friction = 0.02;
    }
    p = with_gravity(p, Vec3(0.3, 0.1, -g));
    return std::make_unique<GrainDynamics>(
        test::cube(), MPI_COMM_SELF, p,
        std::vector{test::glass_sphere(0, Vec3(0.0131, 0.0217, top + 1.1 * radius), velocity)});
  };
  for (const int fields : {3, 24, 150}) {
    Solid floor = solid_of(rough_triangulation(top, fields), 0.3);
    floor.rolling_friction = 0.02;
    const auto on_plane = path({}), on_solid = path({floor});
    double gone = 0.0;
    for (int n = 0; n < 3000; ++n) {  // 0.375 s: nearly three times the length of the box
      test::step(*on_plane);
      test::step(*on_solid);
      const Vec3 &v = on_plane->store().velocity[0], &u = on_solid->store().velocity[0];
      ASSERT_LT((u - v).norm(), 1e-6 * v.norm()) << fields << " fields, step " << n;
      gone += v.x() * 1.25e-4;
    }
    EXPECT_GT(gone, 0.1);
    EXPECT_LT((on_solid->store().angular_velocity[0] - on_plane->store().angular_velocity[0]).norm() * radius, 1e-6);
    EXPECT_GT(on_plane->store().angular_velocity[0].norm() * radius, 0.3);
    EXPECT_EQ(on_solid->wall_forces().size(), 1u);
  }
}

// A sphere set down sliding on an incline of triangles: u0 + (sin a - mu cos a) g t, until it rolls.
TEST(Solids, FrictionOnAnInclineIsCoulombs) {
  const double u0 = 0.1, friction = 0.3, slope = 0.1;
  const Vec3 normal = Vec3(-slope, 0.0, 1.0).normalized(), down = Vec3(-1.0, 0.0, -slope).normalized();
  const auto top = [slope](double x, double) { return 8e-3 + slope * x; };
  const Solid floor = solid_of(thalweg::test::slab_mesh(Vec3(0.0, 0.0, 0.0), Vec3(0.05, 0.05, 0.0), 40, 40, top,
                                                        [](int, int) { return Vec3::Zero(); }),
                               friction);
  GrainParameters p = with_gravity(with({floor}, 0.5), Vec3(0.0, 0.0, -g));
  const double weight = g * test::glass_sphere(0, Vec3::Zero()).mass() * normal.z();
  const double height = radius - 0.06 * weight / p.contact.normal_stiffness;
  const Vec3 start = Vec3(0.03, 0.025, top(0.03, 0.0)) + height * normal;
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {test::glass_sphere(0, start, u0 * down)});
  const double a = -g * down.z() - friction * g * normal.z();
  for (int n = 0; n < 64; ++n) {
    test::step(grains);
    const double time = (n + 1) * 1.25e-4;
    if (time > 4e-3) {
      EXPECT_NEAR(grains.store().velocity[0].dot(down), u0 + a * time, 0.01 * u0) << time;
    }
  }
  EXPECT_NEAR(grains.store().velocity[0].y(), 0.0, 1e-9);
}

// A smooth grain that falls on an edge or a corner is turned back along the line from there to its centre.
TEST(Solids, TurnAGrainBackFromEdgesAndCorners) {
  const Vec3 corner(0.025, 0.02, 0.02);
  for (const Vec3& beyond : {Vec3(0.6, 0.0, 0.8), Vec3(0.48, 0.36, 0.8)}) {
    GrainParameters p = with({solid_of(thalweg::test::box_mesh(corner - Vec3(9e-3, 8e-3, 7e-3), corner), 0.0)});
    p.time_step = 2e-6;
    const double speed = 0.01;
    Vec3 start = corner + 1.001 * radius * beyond;
    if (beyond.y() == 0.0) start.y() -= 2e-3;
    GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {test::glass_sphere(0, start, Vec3(0.0, 0.0, -speed))});
    for (int n = 0; n < 40; ++n) test::step(grains);  // 2 ms; they meet after 0.3 ms, for 0.3 ms
    ASSERT_EQ(grains.contacts().size(), 0u);
    const Vec3 before(0.0, 0.0, -speed), after = before - 2.0 * before.dot(beyond) * beyond;
    // The line turns while they touch: 0.3 ms at 0.01 m/s over the radius is 1e-3.
    EXPECT_LT((grains.store().velocity[0] - after).norm(), 3e-3 * speed);
  }
}

// In the corner of a room the three sides carry a grain, each with its share of the weight.
TEST(Solids, SidesOfACornerActTogether) {
  // A block with a notch: the floor, and two walls that meet at (0.02, 0.02).
  const double edge = 0.02;
  std::vector<Solid> solids{solid_of(thalweg::test::box_mesh(Vec3(0.01, 0.01, 0.005), Vec3(0.04, 0.04, 0.01)), 0.0),
                            solid_of(thalweg::test::box_mesh(Vec3(0.01, 0.01, 0.01), Vec3(edge, 0.04, 0.03)), 0.0),
                            solid_of(thalweg::test::box_mesh(Vec3(0.021, 0.01, 0.01), Vec3(0.04, edge, 0.03)), 0.0)};
  const Vec3 pull(-3.0, -4.0, -g);
  GrainParameters p = with_gravity(with(solids, 0.3), pull);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p,
                       {test::glass_sphere(0, Vec3(edge + 1.01 * radius, edge + 1.01 * radius, 0.01 + 1.01 * radius))});
  for (int n = 0; n < 1000; ++n) test::step(grains);
  EXPECT_EQ(grains.contacts().size(), 3u);
  const std::vector<Vec3> forces = grains.wall_forces();
  const double mass = grains.store().mass[0];
  EXPECT_NEAR(forces[0].z(), mass * pull.z(), 1e-4 * mass * g);
  EXPECT_NEAR(forces[1].x(), mass * pull.x(), 1e-4 * mass * g);
  EXPECT_NEAR(forces[2].y(), mass * pull.y(), 1e-4 * mass * g);
}

// A grain in a trough of facets swings as one that rolls in a cylinder, with 7/5 of its mass: of period
// 2 pi sqrt(7 (Rc - R)/(5 g)). At each hollow seam, where the facets turn by `seam`, it may lose what of its energy is
// across the next facet, seam^2, and no more.
TEST(Solids, HollowFacetsAreASmoothTrough) {
  const double hollow = 0.02;
  const Vec3 axis(0.025, 0.0, 0.03);
  const int fields = 180;  // over the lower half
  const double seam = std::numbers::pi / fields;
  TriangleMesh mesh;
  const auto point = [&](int i, int j, bool high) { return (high ? 2 * (fields + 1) : 0) + j * (fields + 1) + i; };
  for (const bool high : {false, true})
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i <= fields; ++i) {
        const double angle = std::numbers::pi * i / fields;
        mesh.points.emplace_back(axis.x() - hollow * std::cos(angle), 0.05 * j,
                                 high ? axis.z() - hollow * std::sin(angle) : 2e-3);
      }
  const auto top = [&](int i, int j) { return point(i, j, true); };
  const auto low = [&](int i, int j) { return point(i, j, false); };
  for (int i = 0; i < fields; ++i) {
    thalweg::test::add_quadrilateral(mesh, top(i, 0), top(i + 1, 0), top(i + 1, 1), top(i, 1));
    thalweg::test::add_quadrilateral(mesh, low(i, 0), low(i, 1), low(i + 1, 1), low(i + 1, 0));
    thalweg::test::add_quadrilateral(mesh, low(i, 0), low(i + 1, 0), top(i + 1, 0), top(i, 0));
    thalweg::test::add_quadrilateral(mesh, low(i + 1, 1), low(i, 1), top(i, 1), top(i + 1, 1));
  }
  thalweg::test::add_quadrilateral(mesh, low(0, 1), low(0, 0), top(0, 0), top(0, 1));
  thalweg::test::add_quadrilateral(mesh, low(fields, 0), low(fields, 1), top(fields, 1), top(fields, 0));

  const double arm = hollow - radius - 1e-6;
  const double start = 0.3;  // rad
  GrainParameters p = with_gravity(with({solid_of(mesh, 1.0)}, 0.9), Vec3(0.0, 0.0, -g));
  p.time_step = 1e-5;
  GrainDynamics grains(
      test::cube(), MPI_COMM_SELF, p,
      {test::glass_sphere(0, Vec3(axis.x() - arm * std::sin(start), 0.03, axis.z() - arm * std::cos(start)))});
  // Longer by 1 + start^2/16 at this amplitude.
  const double period = 2.0 * std::numbers::pi * std::sqrt(1.4 * arm / g) * (1.0 + start * start / 16.0);
  double crossed = 0.0, before = -1.0, time = 0.0, largest = 0.0;
  int crossings = 0;
  while (time < 5.2 * period) {
    test::step(grains);
    time += 2.5e-4;
    const double x = grains.store().position[0].x() - axis.x();
    if (before < 0.0 && x >= 0.0) {
      if (crossings == 0) crossed = time;
      if (++crossings == 5) {
        EXPECT_NEAR((time - crossed) / 4.0, period, 0.02 * period);
      }
    }
    if (time > 4.0 * period) largest = std::max(largest, std::abs(x) / arm);
    before = x;
  }
  EXPECT_GE(crossings, 5);
  // In five periods it crosses 5 4 start/seam of them, at half the largest speed squared in the mean; the amplitude
  // loses half of what the energy does.
  EXPECT_LT(largest, std::sin(start));
  EXPECT_GT(largest, std::sin(start) * (1.0 - 5.0 * start * seam));
}

// Elastic, smooth grains in a closed room of triangles, with a block in it, keep their energy.
TEST(Solids, ElasticRoomKeepsTheEnergy) {
  const TriangleMesh outside = thalweg::test::box_mesh(Vec3(0.004, 0.004, 0.004), Vec3(0.046, 0.046, 0.046));
  TriangleMesh room = thalweg::test::box_mesh(Vec3(0.008, 0.008, 0.008), Vec3(0.042, 0.042, 0.042));
  turn_inside_out(room);
  TriangleMesh shell = outside;
  for (const auto& t : room.triangles) shell.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  shell.points.insert(shell.points.end(), room.points.begin(), room.points.end());
  const TriangleMesh block = thalweg::test::sphere_mesh(Vec3(0.025, 0.025, 0.02), 7e-3, 1);
  GrainParameters p = with({solid_of(shell, 0.0), solid_of(block, 0.0)});
  p.contact.friction = 0.0;
  p.contact.normal_stiffness = 2000.0;
  p.contact.tangential_stiffness = 500.0;
  p.time_step = 1e-5;
  std::vector<GrainSeed> seeds;
  for (const double x : {0.012, 0.025, 0.038})
    for (const double y : {0.012, 0.038}) {
      const auto n = static_cast<GlobalId>(seeds.size());
      const auto draw = [n](int k) { return 0.6 * (uniform_random(7, static_cast<int>(n), k) - 0.5); };
      seeds.push_back(test::glass_sphere(n, Vec3(x, y, 0.036), Vec3(draw(0), draw(1), draw(2))));
    }
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, seeds);
  const double energy = grains.kinetic_energy();
  double most = 0.0, least = 1.0;
  int free = 0;
  for (int n = 0; n < 40000; ++n) {  // 1e6 sub-steps, 10 s, some hundreds of impacts of each
    test::step(grains);
    if (!grains.contacts().empty()) continue;
    ++free;
    most = std::max(most, grains.kinetic_energy() / energy);
    least = std::min(least, grains.kinetic_energy() / energy);
  }
  EXPECT_GT(free, 1000);
  // An impact of 280 steps leaves the energy within (pi/280)^2/8; a thousand at random add up to 30 times that.
  EXPECT_LT(most, 1.0 + 2e-3);
  EXPECT_GT(least, 1.0 - 2e-3);
}

// A sphere of many triangles turns a grain away as a sphere does.
TEST(Solids, FineMeshOfASphereIsThatSphere) {
  const Vec3 centre(0.025, 0.025, 0.02);
  const auto after = [&](SolidSurface surface) {
    Solid ball{std::make_shared<SolidSurface>(std::move(surface)), 0.4, 0.0, {}};
    GrainDynamics grains(test::cube(), MPI_COMM_SELF, with({ball}, 0.8),
                         {test::glass_sphere(0, centre + Vec3(3e-3, 2e-3, 9e-3), Vec3(0.0, 0.0, -0.2))});
    for (int n = 0; n < 200; ++n) test::step(grains);
    return grains.store().velocity[0];
  };
  const Vec3 exact = after(SolidSurface::sphere(centre, 6e-3));
  EXPECT_GT((exact - Vec3(0.0, 0.0, -0.2)).norm(), 0.1);
  // Facets lean by up to their size over twice the radius: 1.1/64 rad with five divisions.
  EXPECT_LT((after(SolidSurface(thalweg::test::sphere_mesh(centre, 6e-3, 5))) - exact).norm(), 2.0 * 0.2 * 1.1 / 64.0);
  EXPECT_LT((after(SolidSurface(thalweg::test::sphere_mesh(centre, 6e-3, 3))) - exact).norm(), 2.0 * 0.2 * 1.1 / 16.0);
}

// On a belt a grain rolls up to the speed of the belt's friction, and what the belt does is the same in its own frame.
TEST(Solids, MovingOnesActAsTheyDoInTheirOwnFrame) {
  const Vec3 drift(0.2, 0.1, 0.0);
  const auto run = [&](bool moving) {
    Solid floor = solid_of(rough_triangulation(0.01, 20), 0.3);
    if (moving) floor.motion.velocity = drift;
    const GrainParameters p = with_gravity(with({floor}, 0.5), Vec3(0.0, 0.0, -g));
    const Vec3 velocity = Vec3(0.1, 0.05, -0.1) + (moving ? drift : Vec3::Zero());
    auto grains = std::make_unique<GrainDynamics>(
        test::cube(), MPI_COMM_SELF, p,
        std::vector{test::glass_sphere(0, Vec3(0.02, 0.02, 0.01 + 1.2 * radius), velocity)});
    for (int n = 0; n < 1600; ++n) test::step(*grains);  // 0.2 s: the belt moves nearly its length
    return grains;
  };
  const auto moving = run(true), still = run(false);
  const GrainStore &a = moving->store(), &b = still->store();
  EXPECT_LT((a.velocity[0] - drift - b.velocity[0]).norm(), 1e-9);
  EXPECT_LT((a.angular_velocity[0] - b.angular_velocity[0]).norm() * radius, 1e-9);
  EXPECT_GT(b.angular_velocity[0].norm() * radius, 0.05);
}

// A paddle that turns throws a grain at twice the speed of the place where it hits.
TEST(Solids, TurningPaddleThrowsAGrain) {
  Solid paddle = solid_of(thalweg::test::box_mesh(Vec3(0.025, 0.02, 0.02), Vec3(0.045, 0.022, 0.03)), 0.0);
  paddle.motion.centre = Vec3(0.025, 0.021, 0.025);
  paddle.motion.angular_velocity = 10.0;  // about z: towards +y at +x
  GrainParameters p = with({paddle});
  p.time_step = 2e-6;
  const double arm = 0.012;
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p,
                       {test::glass_sphere(0, paddle.motion.centre + Vec3(arm, 1e-3 + radius + 1e-5, 0.0))});
  for (int n = 0; n < 40; ++n) test::step(grains);  // 2 ms
  const Vec3& v = grains.store().velocity[0];
  EXPECT_NEAR(v.norm(), 2.0 * 10.0 * arm, 0.02 * 0.24);  // the paddle has turned by 0.3 % of a turn meanwhile
  EXPECT_GT(v.y(), 0.99 * v.norm());
}

// Rolling friction holds a grain on a sphere that turns, up to a slope of mu_r: they go round as one body, and the
// grain has the spin of the sphere.
TEST(Solids, TurningOneCarriesAGrainThatDoesNotRoll) {
  const double ball = 0.01, spin = 1.0, friction = 0.3;  // m, rad/s
  const Vec3 centre(0.025, 0.025, 0.02);
  Solid solid{std::make_shared<SolidSurface>(SolidSurface::sphere(centre, ball)), 0.6, friction, {}};
  solid.motion.centre = centre;
  solid.motion.axis = Vec3::UnitY();
  solid.motion.angular_velocity = spin;
  GrainParameters p = with_gravity(with({solid}, 0.5), Vec3(0.0, 0.0, -g));
  p.time_step = 1e-5;
  GrainSeed seed = test::glass_sphere(0, centre);
  const double arm = ball + radius;  // it touches; its weight presses it in by 8e-8 m
  seed.position.z() += arm;
  seed.velocity = Vec3(spin * arm, 0.0, 0.0);
  seed.angular_velocity = Vec3(0.0, spin, 0.0);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {seed});
  for (int n = 1; n <= 800; ++n) {  // 0.2 s; tan(0.2) is 0.2, below both frictions
    test::step(grains);
    // The springs give way by m g sin(0.2)/k_t, 6e-8 m, and by m g R sin(0.2)/k_r with k_r 2.25 k_n (mu_r R_r)^2,
    // 5e-5 rad, which is 1.3e-7 m.
    const double angle = spin * n * 2.5e-4;
    ASSERT_NEAR(grains.store().position[0].x() - centre.x(), arm * std::sin(angle), 5e-7) << n;
    ASSERT_NEAR(grains.store().angular_velocity[0].y(), spin, 0.01 * spin) << n;
  }
}

TEST(Solids, RefuseGrainsInThem) {
  const Solid block = solid_of(thalweg::test::box_mesh(Vec3(0.01, 0.01, 0.01), Vec3(0.04, 0.04, 0.03)));
  const auto refusal = [&](const Vec3& at) -> std::string {
    try {
      GrainDynamics(test::cube(), MPI_COMM_SELF, with({block}), {test::glass_sphere(0, at)});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal(Vec3(0.025, 0.025, 0.02)).find("is inside solid 0"), std::string::npos);
  EXPECT_NE(refusal(Vec3(0.025, 0.025, 0.031)).find("reaches 0.0015 m into solid 0"), std::string::npos);
  EXPECT_EQ(refusal(Vec3(0.025, 0.025, 0.0325)), "");
  // A grain that is pressed half its radius deep ends the run.
  GrainParameters p = with_gravity(with({block}), Vec3(0.0, 0.0, -1e6));
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {test::glass_sphere(0, Vec3(0.025, 0.025, 0.0325))});
  EXPECT_THROW(
      {
        for (int n = 0; n < 20; ++n) test::step(grains);
      },
      RunError);
}

}  // namespace
}  // namespace thalweg::dem::solid_test
