// The law of dem/contact/lubrication.hpp against the leading terms as Jeffrey and Onishi 1984 and Goldman, Cox and
// Brenner 1967 give them, and what no such force may do: feel a common motion, or create momentum or angular momentum.
#include "dem/contact/lubrication.hpp"

#include "core/base/counter_random.hpp"
#include "tests/dem/grain_cases.hpp"
#include "tests/support/meshes.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace thalweg::dem::lubrication_test {
namespace {

constexpr double eta = 0.8;             // Pa s
constexpr double cut_off = 3e-4;        // m
constexpr double a = 2e-3, b = 3.5e-3;  // m, the two radii

struct Body {
  double radius;
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
};

struct Loads {
  Vec3 force[2], torque[2];
};

LubricationParameters parameters() {
  LubricationParameters p;
  p.viscosity = eta;
  p.normal_cut_off = p.tangential_cut_off = cut_off;
  p.minimum_gap = 1e-6;
  p.walls = {true};
  return p;
}

// The force that observers see is the one that acts, and meets in the middle of the gap.
void expect_seen(GrainStore& store, const PackedGrainState& grains, const NeighbourList& list, const PeriodicBox& box,
                 std::span<const Plane> walls) {
  store.owned = store.total();
  std::vector<Vec3> force(store.owned, Vec3::Zero()), place(store.owned, Vec3::Zero());
  for_each_lubrication_end({store, {}}, list, {box, walls, {}, {}}, parameters(),
                           [&](std::size_t slot, const Vec3& arm, const Vec3& on_it) {
                             force[slot] += on_it;
                             place[slot] = store.position[slot] + arm;
                           });
  for (std::size_t slot = 0; slot < store.owned; ++slot) EXPECT_EQ(force[slot], vector_of(grains[slot].force));
  if (store.owned == 2) {
    EXPECT_LT((place[0] - place[1]).norm(), 1e-15);
  } else if (!force[0].isZero(0.0)) {
    EXPECT_NEAR(place[0].z(), 0.0, 1e-15);
  }
}

// Two bodies along `direction` (from the first to the second) with a gap between them.
Loads pair_loads(const Body& first, const Body& second, const Vec3& direction, double gap) {
  GrainStore store;
  const Vec3 centre(0.05, 0.05, 0.05);
  const double distance = first.radius + second.radius + gap;
  for (const Body* body : {&first, &second}) {
    store.append(body == &first ? 0 : 1, body->radius, 1e-4, Motion::free,
                 body == &first ? centre : Vec3(centre + distance * direction));
    store.velocity.back() = body->velocity, store.angular_velocity.back() = body->spin;
  }
  PackedGrainState grains;
  grains.gather_from(store, {});
  NeighbourList list;
  list.pairs.push_back({0, 1, first.radius + second.radius});
  const PeriodicBox box{Vec3(0.1, 0.1, 0.1), {false, false, false}};
  add_lubrication(grains, list, {box, {}, {}, {}}, {}, parameters());
  expect_seen(store, grains, list, box, {});
  return {{vector_of(grains[0].force), vector_of(grains[1].force)},
          {vector_of(grains[0].torque), vector_of(grains[1].torque)}};
}

Loads wall_loads(const Body& body, double gap) {
  GrainStore store;
  store.append(0, body.radius, 1e-4, Motion::free, Vec3(0.05, 0.05, body.radius + gap));
  store.velocity.back() = body.velocity, store.angular_velocity.back() = body.spin;
  PackedGrainState grains;
  grains.gather_from(store, {});
  NeighbourList list;
  list.walls.push_back({0, 0});
  const Plane floor;
  const PeriodicBox box{Vec3(0.1, 0.1, 0.1), {false, false, false}};
  add_lubrication(grains, list, {box, {&floor, 1}, {}, {}}, {}, parameters());
  expect_seen(store, grains, list, box, {&floor, 1});
  return {{vector_of(grains[0].force), Vec3::Zero()}, {vector_of(grains[0].torque), Vec3::Zero()}};
}

// The load on a body above a solid that turns about a pivot.
Loads solid_loads(const Body& body, SolidSurface surface, const Vec3& position, const Vec3& pivot, const Vec3& spin) {
  GrainStore store;
  store.append(0, body.radius, 1e-4, Motion::free, position);
  store.owned = 1;
  store.velocity.back() = body.velocity, store.angular_velocity.back() = body.spin;
  Solid solid{std::make_shared<SolidSurface>(std::move(surface)), 0.0, 0.0, {}};
  solid.motion.centre = pivot;
  solid.motion.axis = spin.normalized();
  solid.motion.angular_velocity = spin.norm();
  const PlacedSolid placed(solid, 0.0, 0.0);
  const Surroundings around{{Vec3(0.1, 0.1, 0.1), {false, false, false}}, {}, {&placed, 1}, {&solid, 1}};
  const std::vector glass{test::glass(0.9)};
  const MaterialTable materials(glass, std::nullopt);
  NeighbourList list = find_contacts(store, around, materials, cut_off, body.radius);
  const Vec3 weightless = Vec3::Zero();
  PackedGrainState grains;
  grains.gather_from(store, {&weightless, 1});
  add_lubrication(grains, list, around, {}, parameters());
  return {{vector_of(grains[0].force), Vec3::Zero()}, {vector_of(grains[0].torque), Vec3::Zero()}};
}

const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
constexpr double pi = std::numbers::pi;

// The gap is so small that lever arms differ from the radii by less than 1e-5 of them.
constexpr double gap = 1e-8;
constexpr double tolerance = 3e-5;  // relative; a moment may be a quarter of a force times its arm

void expect_along(const Vec3& found, const Vec3& direction, double value) {
  EXPECT_NEAR(found.dot(direction), value, tolerance * std::abs(value));
  EXPECT_LT((found - found.dot(direction) * direction).norm(), 1e-12 * std::abs(value));
}

// Their functions of the ratio of the radii l = b/a, times ln(1/gap): Y11A (over 6 pi eta a), Y11B (4 pi eta a^2), Y11C
// (8 pi eta a^3), Y12C (pi eta (a + b)^3), and X11A with xi = 2 gap/(a + b).
TEST(Lubrication, LeadingTermsOfUnequalSpheres) {
  const double l = b / a, s = 1.0 + l, log = std::log(cut_off / gap), xi = 2.0 * gap / (a + b);
  const double x11a = 2.0 * l * l / (s * s * s) / xi * (1.0 - gap / cut_off);
  const double y11a = 4.0 * l * (2.0 + l + 2.0 * l * l) / (15.0 * s * s * s) * log;
  const double y11b = l * (4.0 + l) / (5.0 * s * s) * log, y11c = 2.0 * l / (5.0 * s) * log;
  const double y12c = 4.0 * l * l / (5.0 * s * s * s * s) * log;
  const Body still_a{a}, still_b{b};

  expect_along(pair_loads({a, z}, still_b, z, gap).force[0], z, -6.0 * pi * eta * a * x11a);
  const Loads slides = pair_loads({a, x}, still_b, z, gap);
  expect_along(slides.force[0], x, -6.0 * pi * eta * a * y11a);
  expect_along(slides.torque[0], y, -4.0 * pi * eta * a * a * y11b);
  const Loads turns = pair_loads({a, Vec3::Zero(), y}, still_b, z, gap);
  expect_along(turns.force[0], x, -4.0 * pi * eta * a * a * y11b);  // the reciprocal theorem
  expect_along(turns.torque[0], y, -8.0 * pi * eta * a * a * a * y11c);
  expect_along(turns.torque[1], y, -pi * eta * std::pow(a + b, 3.0) * y12c);
  // The larger body first: the same functions of 1/l.
  const Loads other = pair_loads(still_a, {b, Vec3::Zero(), y}, z, gap);
  expect_along(other.torque[1], y, -8.0 * pi * eta * b * b * b * 2.0 / (5.0 * (1.0 + l)) * log);
}

// Over 6 pi eta a: 1/h, 8/15 ln(1/h) sliding, with 2/15 as the moment over 6 pi eta a^2 and the force of a turning
// sphere; over 8 pi eta a^3: 2/5 ln(1/h).
TEST(Lubrication, LeadingTermsAtAWall) {
  const double log = std::log(cut_off / gap), stokes = 6.0 * pi * eta * a;
  expect_along(wall_loads({a, -z}, gap).force[0], z, stokes * (a / gap - a / cut_off));
  const Loads slides = wall_loads({a, x}, gap), turns = wall_loads({a, Vec3::Zero(), y}, gap);
  expect_along(slides.force[0], x, -stokes * 8.0 / 15.0 * log);
  // Here the gap is below the sphere: a turn about y moves its lowest point along -x.
  expect_along(slides.torque[0], y, stokes * a * 2.0 / 15.0 * log);
  expect_along(turns.force[0], x, stokes * a * 2.0 / 15.0 * log);
  expect_along(turns.torque[0], y, -8.0 * pi * eta * a * a * a * 0.4 * log);
}

// What a solid's spin does to a grain at rest: a flat one that turns about the grain's centre does what the grain would
// feel that turned the other way, 2/15 and 2/5 ln(1/h) as above; a sphere that turns about its own centre has Y12C.
TEST(Lubrication, LeadingTermsAtASolidThatTurns) {
  const double log = std::log(cut_off / gap), stokes = 6.0 * pi * eta * a, s = 1.0 + b / a;
  const Vec3 centre(0.05, 0.05, 0.05), foot = centre - (a + gap) * z;
  const auto block = [&] {
    return SolidSurface(thalweg::test::box_mesh(foot - Vec3(0.03, 0.03, 0.01), foot + 0.03 * (x + y)));
  };
  const Loads flat = solid_loads({a}, block(), centre, centre, y);
  expect_along(flat.force[0], x, -stokes * a * 2.0 / 15.0 * log);
  expect_along(flat.torque[0], y, 8.0 * pi * eta * a * a * a * 0.4 * log);
  const Vec3 middle = foot - b * z;
  const Loads round = solid_loads({a}, SolidSurface::sphere(middle, b), centre, middle, y);
  expect_along(round.torque[0], y,
               -pi * eta * std::pow(a + b, 3.0) * 4.0 * b * b / (5.0 * a * a * s * s * s * s) * log);
  // A grain that moves with the solid as one body feels nothing.
  const Vec3 spin(20.0, -35.0, 9.0);
  const double scale = stokes * a / gap;  // of a force at 1 m/s
  for (const bool is_round : {false, true}) {
    const Loads rigid = solid_loads({a, spin.cross(centre - middle), spin},
                                    is_round ? SolidSurface::sphere(middle, b) : block(), centre, middle, spin);
    EXPECT_LT(rigid.force[0].norm(), 1e-13 * scale);
    EXPECT_LT(rigid.torque[0].norm(), 1e-13 * scale * a);
  }
}

TEST(Lubrication, ConservesMomentumAndAngularMomentumAtAnyGap) {
  const Vec3 n = Vec3(0.3, -0.5, 0.7).normalized();
  for (const double wide : {1e-8, 1e-5, 1e-4, 2.9e-4}) {
    const Loads l = pair_loads({a, Vec3(0.1, -0.7, 0.4), Vec3(30.0, 8.0, -50.0)},
                               {b, Vec3(0.5, 0.2, -0.9), Vec3(7.0, 40.0, 20.0)}, n, wide);
    EXPECT_EQ(l.force[0], Vec3(-l.force[1]));  // to the last bit
    EXPECT_GT(l.force[0].norm(), 0.0);
    const Vec3 moment = l.torque[0] + l.torque[1] + ((a + b + wide) * n).cross(l.force[1]);
    EXPECT_LT(moment.norm(), 1e-12 * (l.torque[0].norm() + l.torque[1].norm() + (a + b) * l.force[0].norm()));
  }
}

TEST(Lubrication, FeelsNoCommonMotion) {
  const Vec3 n = Vec3(0.3, -0.5, 0.7).normalized(), velocity(0.4, 0.1, -0.3), spin(20.0, -35.0, 9.0);
  const double wide = 1e-5, distance = a + b + wide;
  const Loads l = pair_loads({a, velocity, spin}, {b, velocity + spin.cross(distance * n), spin}, n, wide);
  const double scale = 6.0 * pi * eta * a * a / wide;  // of a force at 1 m/s
  EXPECT_LT(l.force[0].norm(), 1e-13 * scale);
  EXPECT_LT(l.torque[0].norm() + l.torque[1].norm(), 1e-13 * scale * a);
}

TEST(Lubrication, ActsBetweenTouchAndCutOffAlone) {
  const Body first{a, Vec3(0.1, -0.7, 0.4), Vec3(30.0, 8.0, -50.0)}, second{b};
  for (const double outside : {-1e-7, 3.01e-4, 5e-3}) {
    EXPECT_EQ(pair_loads(first, second, z, outside).force[0], Vec3::Zero());
    EXPECT_EQ(pair_loads(first, second, z, outside).torque[0], Vec3::Zero());
    EXPECT_EQ(wall_loads(first, outside).force[0], Vec3::Zero());
  }
  // Sets in without a jump: at 0.1 % below the cut-off 1/h - 1/h_c is 0.1 % of 1/h_c.
  const double set_in = pair_loads({a, z}, second, z, 0.999 * cut_off).force[0].norm();
  const double reduced = a * b / (a + b);
  EXPECT_NEAR(set_in, 6.0 * pi * eta * reduced * reduced / cut_off * (1.0 / 0.999 - 1.0), 1e-9 * set_in);
}

// A sphere thrown at a wall in vacuum, but for this force: m dv/dt = -6 pi eta a^2 (1/h - 1/h_c) v, so that with the
// path h(t) m (v - v0) = -6 pi eta a^2 [ln(h_c/h) - (h_c - h)/h_c], whatever the time step: nothing is lost between
// lists.
TEST(Lubrication, SlowsASphereOnItsWayToAWallAsThePathSays) {
  GrainParameters p = test::parameters(test::glass(0.9), 2e-6, 10, 1e-4);
  p.walls = face_planes(test::cube().box(), p.contact);
  LubricationParameters lubrication = parameters();
  lubrication.viscosity = 0.05;
  lubrication.minimum_gap = 1e-3;
  lubrication.walls.assign(p.walls.size(), true);
  p.lubrication = lubrication;
  const double radius = test::glass_radius, speed = 0.2;  // m, m/s
  const GrainSeed seed = test::glass_sphere(0, Vec3(0.02, 0.02, radius + 2e-3), -speed * z);
  GrainDynamics grains(test::cube(), MPI_COMM_SELF, p, {seed});
  double h = 2e-3;
  while (h > 1e-5) {
    test::step(grains);
    h = grains.store().position[0].z() - radius;
    const double expected = h > cut_off ? speed
                                        : speed - 6.0 * pi * lubrication.viscosity * radius * radius / seed.mass() *
                                                      (std::log(cut_off / h) - (cut_off - h) / cut_off);
    // The force changes over a sub-step by dt v/h of itself, 4 % in the end; half of that is the error of the sum.
    ASSERT_NEAR(-grains.store().velocity[0].z(), expected, 2e-3 * speed) << "gap " << h;
    ASSERT_GT(expected, 0.3 * speed);
    const double slope =
        h > cut_off ? 0.0 : 6.0 * pi * lubrication.viscosity * radius * radius * (1.0 / h - 1.0 / cut_off);
    double on_walls = 0.0;  // the floor is pushed by what holds the sphere back
    for (const Vec3& force : grains.wall_forces()) on_walls += force.z();
    // The force acts with the velocity of the middle of the sub-step; that of its end is half a kick later.
    const double middle = grains.store().velocity[0].z() + 0.5 * p.time_step / seed.mass() * on_walls;
    ASSERT_NEAR(on_walls, slope * middle, 1e-9 * slope * speed) << "gap " << h;
  }
}

// A cloud that drifts and spreads, its list of near pairs kept from step to step, against one that looks at all pairs
// in every step; across periodic faces.
TEST(Lubrication, OfNearPairsIsThatOfAllPairs) {
  const PeriodicBox box{Vec3(0.02, 0.02, 0.02), {true, true, true}};
  GrainStore store;
  for (int n = 0; n < 60; ++n) {
    const auto draw = [n](std::uint64_t k) { return uniform_random(5, static_cast<std::uint64_t>(n), k); };
    store.append(n, 1e-3 + 5e-4 * draw(0), 1e-5, Motion::free, 0.02 * Vec3(draw(1), draw(2), draw(3)));
    store.velocity.back() = 0.1 * Vec3(draw(4) - 0.5, draw(5) - 0.5, draw(6) - 0.5);
    store.angular_velocity.back() = Vec3(draw(7), draw(8), draw(9));
  }
  NeighbourList kept;
  kept.near_surfaces = InnerNeighbourList(1e-4);
  for (std::uint32_t i = 0; i < 60; ++i)
    for (std::uint32_t j = i + 1; j < 60; ++j) kept.pairs.push_back({i, j, store.radius[i] + store.radius[j]});
  const double dt = 5e-5, fastest = 0.1 * std::sqrt(0.75);  // s, m/s: each moves less than 4.4e-6 m in a step
  bool any_near = false, any_far = false;
  for (int step = 0; step < 100; ++step) {
    PackedGrainState by_near, by_all;
    by_near.gather_from(store, {});
    by_all.gather_from(store, {});
    NeighbourList whole = kept;
    whole.near_surfaces = InnerNeighbourList(1.0);  // all are near
    add_lubrication(by_near, kept, {box, {}, {}, {}}, {}, parameters());
    add_lubrication(by_all, whole, {box, {}, {}, {}}, {}, parameters());
    ASSERT_EQ(whole.near_surfaces.pairs().size(), kept.pairs.size());
    any_far = any_far || kept.near_surfaces.pairs().size() < kept.pairs.size();
    for (std::size_t n = 0; n < 60; ++n) {
      ASSERT_EQ(vector_of(by_near[n].force), vector_of(by_all[n].force)) << step;
      ASSERT_EQ(vector_of(by_near[n].torque), vector_of(by_all[n].torque)) << step;
      any_near = any_near || !vector_of(by_near[n].force).isZero(0.0);
      store.position[n] = box.wrapped(store.position[n] + dt * store.velocity[n]);
    }
    kept.grains_moved(dt * fastest);
  }
  EXPECT_TRUE(any_near && any_far);
}

// Bodies of two members on a floor, or above a sphere, that approach with 1 m/s.
double force_on(const std::vector<PlacedSphere>& members, double gap, bool on_sphere) {
  double lowest = 0.0;
  for (const PlacedSphere& member : members) lowest = std::min(lowest, member.position.z() - member.radius);
  const Vec3 partner(0.05, 0.05, 0.02), centre = partner + Vec3(0.0, 0.0, (on_sphere ? b : -0.02) + gap - lowest);
  GrainStore store;
  for (const PlacedSphere& member : members) {
    store.append(static_cast<GlobalId>(store.total()), member.radius, 1e-4, Motion::free, centre + member.position);
    store.clump.back() = 0;
    store.velocity.back() = -z;
  }
  store.append(static_cast<GlobalId>(members.size()), b, 1e-4, Motion::free,
               on_sphere ? partner : Vec3(0.05, 0.05, 0.09));
  PackedGrainState grains;
  grains.gather_from(store, {});
  NeighbourList list;
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    list.pairs.push_back({m, static_cast<std::uint32_t>(members.size()), members[m].radius + b});
    list.walls.push_back({m, 0});
  }
  const Plane floor;
  const Surroundings around{{Vec3(0.1, 0.1, 0.1), {false, false, false}}, {&floor, 1}, {}, {}};
  add_lubrication(grains, list, around, store.clump, parameters());
  double force = 0.0, seen = 0.0;
  for (std::uint32_t m = 0; m < members.size(); ++m) force += grains[m].force[2];
  store.owned = members.size();
  for_each_lubrication_end({store, {}}, list, around, parameters(),
                           [&](std::size_t, const Vec3&, const Vec3& part) { seen += part.z(); });
  EXPECT_NEAR(seen, force, 1e-12 * force);
  return force;
}

// A sphere is the same body however many members describe it, and two spheres beside each other are two.
TEST(Lubrication, MembersOfAClumpShareAFilm) {
  const PlacedSphere sphere{Vec3::Zero(), a};
  const double near = 0.1 * cut_off;
  for (const bool on_sphere : {false, true}) {
    const double alone = force_on({sphere}, near, on_sphere);
    EXPECT_GT(alone, 0.0);
    const Vec3 aside(1e-6 * a, 0.0, 0.0);
    EXPECT_NEAR(force_on({sphere, {aside, a}, {-aside, a}}, near, on_sphere), alone, 1e-4 * alone);
    EXPECT_NEAR(force_on({sphere, {Vec3(0.0, 0.0, -0.2 * a), 0.79 * a}}, near, on_sphere), alone, 1e-12 * alone);
  }
  // With 2 a between the near points of two spheres on a floor, k = (1 + 2 a/h)^-2.
  const double pair = force_on({{Vec3(-a, 0.0, 0.0), a}, {Vec3(a, 0.0, 0.0), a}}, near, false);
  EXPECT_NEAR(pair, 2.0 * force_on({sphere}, near, false) / (1.0 + std::pow(1.0 + 2.0 * a / near, -2)), 1e-12 * pair);
}

}  // namespace
}  // namespace thalweg::dem::lubrication_test
