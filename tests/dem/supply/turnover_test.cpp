// Supplies and sinks: when grains come and go, that nothing is lost, and the same bits on any number of ranks.
#include "tests/dem/supply/supply_cases.hpp"
#include "tests/support/damaged_archive.hpp"
#include "tests/support/meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace thalweg::dem::turnover_test {
namespace {

using test::supply::all_ids;
using test::supply::bodies_at_start;
using test::supply::box_on;
using test::supply::busy_box;
using test::supply::clump_mass_rate;
using test::supply::clumps;
using test::supply::diagnostic;
using test::supply::few_at_start;
using test::supply::ids_a_round;
using test::supply::ids_at_start;
using test::supply::large;
using test::supply::parameters;
using test::supply::run;
using test::supply::small;
using test::supply::spheres;
using test::supply::step;
using thalweg::test::saved;

void expect_same_bits(const GrainParameters& p) {
  const int steps = 600;
  GrainDynamics alone(box_on(1), MPI_COMM_SELF, p, few_at_start());
  run(alone, steps / 2);
  const thalweg::test::MemoryArchive half = saved(alone, MPI_COMM_SELF);
  run(alone, steps / 2);
  const thalweg::test::MemoryArchive reference = saved(alone, MPI_COMM_SELF);
  // Worth comparing: grains of both kinds have gone for good and come back, and some are on their way at the restart.
  EXPECT_GT(diagnostic(alone, "left_grains"), 10.0);
  EXPECT_GT(diagnostic(alone, "recirculated_grains"), 10.0);
  EXPECT_TRUE(half.datasets.contains("grains/returning/due"));
  EXPECT_TRUE(half.datasets.contains("grains/returning/clump_id"));

  GrainDynamics grains(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p, few_at_start());
  run(grains, steps / 2);
  EXPECT_EQ(thalweg::test::first_difference(saved(grains, MPI_COMM_WORLD), half), "");
  run(grains, steps / 2);
  EXPECT_EQ(thalweg::test::first_difference(saved(grains, MPI_COMM_WORLD), reference), "");

  GrainDynamics restarted(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p, GrainSeeds{});
  thalweg::test::load(restarted, half);
  EXPECT_EQ(thalweg::test::first_difference(saved(restarted, MPI_COMM_WORLD), half), "");
  run(restarted, steps / 2);
  EXPECT_EQ(thalweg::test::first_difference(saved(restarted, MPI_COMM_WORLD), reference), "");
}

TEST(Turnover, SameBitsOnAnyRanksAndAfterARestart) { expect_same_bits(busy_box()); }

TEST(Turnover, SameBitsOfGrainsThatComeInAboveTheBed) {
  GrainParameters p = busy_box();
  for (Supply& supply : p.supplies) {
    supply.entrance.zone.lower.z() = 0.0;
    supply.entrance.above_bed = HeightRange{0.003, 0.009};
  }
  expect_same_bits(p);
}

// A hundred bodies of one sink find no place, and one of another sink comes after them.
TEST(Turnover, BodiesThatFindNoPlaceBlockNoOtherSink) {
  const Decomposition cuts = box_on(1);
  Sink full, free;
  full.zone = free.zone = {Vec3::Zero(), Vec3(0.01, 0.01, 0.01)};
  full.recirculation = free.recirculation = {{{Vec3(0.01, 0.0, 0.03), Vec3(0.03, 0.02, 0.038)}, std::nullopt, 5}, 0.0};
  Turnover book({}, {full, free}, cuts.box());
  const TravellingBody body =
      bodies_of(GrainSeeds{{test::glass_sphere(0, Vec3(0.005, 0.005, 0.005), Vec3::Zero(), small)}, {}}, cuts.box())
          .front();
  for (GlobalId id = 0; id <= 100; ++id) {
    TravellingBody next = body;
    next.renumber(id);
    book.leave(std::move(next), id < 100 ? 0 : 1, 1.0);
  }
  const std::vector<PlaceSeeker> due = book.due(2.0);
  EXPECT_TRUE(std::any_of(due.begin(), due.end(), [](const PlaceSeeker& seeker) { return seeker.body.id() == 100; }));
  EXPECT_LT(due.size(), 70u);
}

TEST(Turnover, ACheckpointThatHasLostGrainsIsRefused) {
  const GrainParameters p = busy_box();
  const Decomposition cuts = box_on(size_of(MPI_COMM_WORLD));
  GrainDynamics grains(cuts, MPI_COMM_WORLD, p, few_at_start());
  run(grains, 300);
  const thalweg::test::MemoryArchive whole = saved(grains, MPI_COMM_WORLD);
  // The whole one is taken: what is refused below is so for its loss.
  GrainDynamics undamaged(cuts, MPI_COMM_WORLD, p, GrainSeeds{});
  EXPECT_FALSE(thalweg::test::is_refused(whole, [&](thalweg::test::MemoryReader& reader) { undamaged.load(reader); }));
  EXPECT_EQ(thalweg::test::first_difference(whole, saved(undamaged, MPI_COMM_WORLD)), "");
  int refused = 0;
  for (const thalweg::test::Loss& loss : thalweg::test::losses_of(whole)) {
    if (loss.what == "all of grains/contact_spring") continue;  // the law may have been another
    GrainDynamics again(cuts, MPI_COMM_WORLD, p, GrainSeeds{});
    const auto load = [&](thalweg::test::MemoryReader& reader) { again.load(reader); };
    if (thalweg::test::is_refused(loss.left, load)) {
      ++refused;
      continue;
    }
    EXPECT_EQ(thalweg::test::first_difference(whole, saved(again, MPI_COMM_WORLD)), "") << loss.what;
  }
  EXPECT_GT(refused, 0);
}

TEST(Turnover, EveryGrainIsAccountedFor) {
  GrainDynamics grains(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, busy_box(), few_at_start());
  std::set<GlobalId> seen;
  for (int n = 0; n < 300; ++n) {
    const double left_before = diagnostic(grains, "left_grains");
    step(grains);
    ASSERT_GE(diagnostic(grains, "left_grains"), left_before);
    ASSERT_EQ(
        bodies_at_start + diagnostic(grains, "supplied_grains"),
        diagnostic(grains, "grains") + diagnostic(grains, "left_grains") + diagnostic(grains, "returning_grains"));
    const std::vector<GlobalId> ids = all_ids(grains);
    ASSERT_EQ(std::set<GlobalId>(ids.begin(), ids.end()).size(), ids.size());
    for (const GlobalId id : ids) ASSERT_LT(id, grains.id_limit());
    seen.insert(ids.begin(), ids.end());
  }
  // The ids of a round are those of a sphere and of a clump of three.
  std::int64_t supplied_spheres = 0, members = 0;
  for (const GlobalId id : seen)
    if (id >= ids_at_start) ++((id - ids_at_start) % ids_a_round == 0 ? supplied_spheres : members);
  EXPECT_EQ(static_cast<double>(supplied_spheres + members / 3), diagnostic(grains, "supplied_grains"));
  EXPECT_EQ(members % 3, 0);
}

// The spheres due by t are floor(rate t). Of the supply by mass the next clump would exceed what is due.
TEST(Turnover, SuppliesBringWhatIsDue) {
  GrainParameters p = parameters();
  p.supplies = {spheres(200.0), clumps(clump_mass_rate)};
  p.supplies[0].from = 0.0105;
  p.supplies[0].until = 0.0805;
  Sink everywhere;  // below the entrance: none gathers
  everywhere.zone = {Vec3::Zero(), Vec3(0.04, 0.02, 0.015)};
  p.sinks = {everywhere};
  GrainDynamics grains(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p, few_at_start());
  const double sphere_mass = 4.0 / 3.0 * M_PI * test::glass_density * (std::pow(small, 3) + std::pow(large, 3)) / 2.0;
  const double clump_mass = test::glass_density * test::pebble()->volume;
  for (int n = 0; n < 500; ++n) {
    const double time = grains.time();
    step(grains);
    const double due = std::floor(200.0 * (std::min(time, 0.0805) - 0.0105) + 1e-6);
    const double due_spheres = std::max(0.0, due), due_clumps = std::floor(clump_mass_rate * time / clump_mass + 1e-6);
    ASSERT_EQ(diagnostic(grains, "supplied_grains"), due_spheres + due_clumps) << time;
    const double odd = static_cast<std::int64_t>(due_spheres) % 2 == 1 ? std::pow(small, 3) - std::pow(large, 3) : 0.0;
    const double mass =
        due_spheres * sphere_mass + due_clumps * clump_mass + 2.0 / 3.0 * M_PI * test::glass_density * odd;
    ASSERT_NEAR(diagnostic(grains, "supplied_mass"), mass, 1e-12 * (mass + 1e-9));
  }
  EXPECT_EQ(grains.body_count(), static_cast<std::int64_t>(diagnostic(grains, "grains")));
  EXPECT_GT(diagnostic(grains, "left_grains"), 30.0);
}

// Without gravity nothing moves: the box fills up until no place is free, and no two grains touch.
TEST(Turnover, GrainsWaitForAFreePlace) {
  GrainParameters p = parameters();
  p.body_force = {};
  p.supplies = {spheres(4000.0), clumps(0.2)};
  for (Supply& supply : p.supplies) supply.entrance.velocity = Vec3::Zero();
  GrainDynamics grains(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p, few_at_start());
  run(grains, 400);
  EXPECT_EQ(grains.largest_overlap(), 0.0);
  EXPECT_EQ(grains.contact_count(), 0);
  EXPECT_GT(grains.body_count(), 20);
  EXPECT_LT(diagnostic(grains, "supplied_grains"), 150.0);
  EXPECT_GT(diagnostic(grains, "supply_lag"), 0.05);
  EXPECT_LE(diagnostic(grains, "supply_lag"), grains.time());
  const GrainStore& store = grains.store();
  for (std::size_t s = 0; s < store.owned; ++s) EXPECT_GE(store.position[s].z(), store.radius[s]);
}

// More is due than can seek a place at once: every supply gets its share.
TEST(Turnover, NoSupplyWaitsForAnother) {
  GrainParameters p = parameters();
  Supply many = spheres(1e6);
  many.entrance.zone = {Vec3(0.0, 0.0, 0.003), Vec3(0.04, 0.02, 0.037)};
  many.entrance.velocity = std::nullopt;
  Sink all;
  all.zone = {Vec3::Zero(), Vec3(0.04, 0.02, 0.04)};
  p.supplies = {many, many};
  p.supplies[1].entrance.seed = 9;
  p.sinks = {all};
  GrainDynamics grains(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p, few_at_start());
  run(grains, 40);
  std::vector<std::int64_t> from(2);
  for (const GlobalId id : all_ids(grains)) ++from[static_cast<std::size_t>((id - ids_at_start) % 2)];
  EXPECT_GT(from[0], 5);
  EXPECT_GT(from[1], 5);
}

// A sphere and a clump fall into a sink and come in again after the delay, with the ids and sizes they had, at rest.
TEST(Turnover, GrainsComeBackAsTheyWere) {
  GrainParameters p = parameters();
  Sink back;
  back.zone = {Vec3::Zero(), Vec3(0.04, 0.02, 0.008)};
  back.recirculation = {{{Vec3(0.005, 0.005, 0.03), Vec3(0.035, 0.015, 0.03)}, std::nullopt, 1}, 0.05};
  p.sinks = {back};
  GrainDynamics grains(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p,
                       {{test::glass_sphere(0, Vec3(0.02, 0.01, 0.012), Vec3::Zero(), large)},
                        {test::glass_clump(1, test::pebble(), Vec3(0.03, 0.01, 0.012), Vec3::Zero(), Vec3(0, 30, 0))}});
  const double mass = 4.0 / 3.0 * M_PI * test::glass_density * std::pow(large, 3);
  double left_at = -1.0;
  int came_back = 0;
  for (int n = 0; n < 400 && came_back == 0; ++n) {
    const double time = grains.time();
    const std::int64_t before = grains.body_count();
    grains.turn_over();
    if (grains.body_count() < 2 && left_at < 0.0) left_at = time;
    if (grains.body_count() > before) {
      ++came_back;
      EXPECT_GE(time, left_at + 0.05 - 1e-9);
      EXPECT_LE(time, left_at + 0.05 + 2.5e-4);
      const GrainStore& store = grains.store();
      for (std::size_t s = 0; s < store.owned; ++s) {
        EXPECT_EQ(store.velocity[s], Vec3::Zero());
        EXPECT_EQ(store.angular_velocity[s], Vec3::Zero());
        if (store.clump[s] >= 0) continue;
        EXPECT_EQ(store.position[s].z(), 0.03);
        EXPECT_NEAR(store.mass[s], mass, 1e-12 * mass);
      }
      for (std::size_t c = 0; c < grains.clumps().size(); ++c) EXPECT_EQ(grains.clumps()[c].centre.z(), 0.03);
    }
    grains.prepare();
    grains.advance(grains.parameters().sub_steps);
    grains.refresh_ghosts();
  }
  EXPECT_EQ(came_back, 1);
  run(grains, 40);
  EXPECT_EQ(grains.body_count(), 2);
  const std::vector<GlobalId> ids = all_ids(grains);
  EXPECT_EQ(std::set<GlobalId>(ids.begin(), ids.end()), (std::set<GlobalId>{0, 1, 2, 3}));
  EXPECT_EQ(grains.member_count(), 3);
}

// A box without gravity in which what reaches the right end comes in again on the left, between the heights of 10 and
// 30 mm.
GrainParameters box_that_recirculates() {
  GrainParameters p = parameters();
  p.body_force = {};
  Sink end;
  end.zone = {Vec3(0.034, 0.0, 0.0), Vec3(0.04, 0.02, 0.04)};
  end.recirculation = {{{Vec3(0.004, 0.0, 0.01), Vec3(0.01, 0.02, 0.03)}, std::nullopt, 7}, 0.01};
  p.sinks = {end};
  return p;
}

GrainSeed flying_sphere(GlobalId id, double height) {
  GrainSeed sphere = test::glass_sphere(id, Vec3(0.03, 0.01, height), Vec3(0.5, 0.0, 0.0), small);
  sphere.angular_velocity = Vec3(1.0, 2.0, 3.0);
  return sphere;
}

// At 0.5 m/s the sphere is beyond 34 mm after 8 ms and back 10 ms later; nothing touches it before 22 ms.
TEST(Turnover, AGrainKeepsHeightAndMotion) {
  GrainDynamics grains(
      box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, box_that_recirculates(),
      {{flying_sphere(0, 0.02)},
       {test::glass_clump(1, test::pebble(), Vec3(0.03, 0.01, 0.012), Vec3(0.4, 0.0, 0.0), Vec3(0, 30, 0))}});
  run(grains, 88);
  EXPECT_EQ(diagnostic(grains, "recirculated_grains"), 2.0);
  EXPECT_EQ(diagnostic(grains, "returning_grains"), 0.0);
  const GrainStore& store = grains.store();
  for (std::size_t s = 0; s < store.owned; ++s) {
    if (store.clump[s] >= 0) continue;
    EXPECT_LT(store.position[s].x(), 0.0125);
    EXPECT_EQ(store.position[s].z(), 0.02);
    EXPECT_EQ(store.velocity[s], Vec3(0.5, 0.0, 0.0));
    EXPECT_EQ(store.angular_velocity[s], Vec3(1.0, 2.0, 3.0));
  }
  for (std::size_t c = 0; c < grains.clumps().size(); ++c) {
    EXPECT_LT(grains.clumps()[c].centre.x(), 0.0125);
    EXPECT_EQ(grains.clumps()[c].centre.z(), 0.012);
    EXPECT_EQ(grains.clumps()[c].velocity, Vec3(0.4, 0.0, 0.0));
    EXPECT_GT(grains.clumps()[c].angular_velocity.norm(), 20.0);
  }
}

// A smooth sphere slides on a floor, a plane or a solid, with its weight on it. It comes to lie m g/k deep in 1 ms,
// leaves after 8 ms, and is as deep wherever it comes in, so that it keeps its motion and neither rises nor sinks: but
// for half a step of 25 us without a force, g dt/2 over the frequency of the contact, 5 % of the depth.
TEST(Turnover, AGrainThatSlidesOnAFloorGoesOnSliding) {
  constexpr double g = 15.0, top = 0.01;
  for (const bool on_solid : {false, true}) {
    GrainParameters p = box_that_recirculates();
    p.body_force = [](double mass, double) { return Vec3(0.0, 0.0, -g * mass); };
    p.contact.friction = p.contact.wall_friction = 0.0;
    p.walls = face_planes(box_on(1).box(), p.contact);
    p.sinks[0].recirculation->entrance.zone.lower.z() = 0.0;
    if (on_solid)
      p.solids = {
          {std::make_shared<SolidSurface>(thalweg::test::box_mesh(Vec3::Zero(), Vec3(0.04, 0.02, top))), 0.0, 0.0, {}}};
    GrainSeed sphere = flying_sphere(0, 0.0);
    const double depth = sphere.mass() * g / p.contact.normal_stiffness;
    const double height = (on_solid ? top : 0.0) + small - depth;
    sphere.position.z() = (1.0 + 1e-9) * (height + depth);
    GrainDynamics grains(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p, GrainSeeds{{sphere}, {}});
    for (int n = 0; n < 1000; ++n) {
      step(grains);
      const GrainStore& store = grains.store();
      for (std::size_t s = 0; s < store.owned; ++s) {
        ASSERT_NEAR(store.velocity[s].x(), 0.5, 1e-9) << on_solid << ' ' << n;
        ASSERT_NEAR(store.position[s].z(), height, (n < 32 ? 1.1 : 0.1) * depth) << on_solid << ' ' << n;
      }
    }
    EXPECT_GE(diagnostic(grains, "recirculated_grains"), 3.0);
  }
}

// One from above the entrance, and one whose height is taken: they come in where there is room, at rest.
TEST(Turnover, AGrainThatCannotKeepItsHeightComesInAtRest) {
  GrainParameters p = box_that_recirculates();
  Zone& entrance = p.sinks[0].recirculation->entrance.zone;
  entrance.lower.x() = entrance.upper.x() = 0.006;
  entrance.lower.y() = entrance.upper.y() = 0.01;
  GrainDynamics grains(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p,
                       GrainSeeds{{flying_sphere(0, 0.035), flying_sphere(1, 0.02),
                                   test::glass_sphere(2, Vec3(0.006, 0.01, 0.0205), Vec3::Zero(), small)},
                                  {}});
  run(grains, 88);
  EXPECT_EQ(diagnostic(grains, "recirculated_grains"), 2.0);
  EXPECT_EQ(diagnostic(grains, "returning_grains"), 0.0);
  EXPECT_EQ(grains.largest_overlap(), 0.0);
  const GrainStore& store = grains.store();
  for (std::size_t s = 0; s < store.owned; ++s) {
    EXPECT_EQ(store.position[s].x(), 0.006);
    EXPECT_EQ(store.velocity[s], Vec3::Zero());
    EXPECT_EQ(store.angular_velocity[s], Vec3::Zero());
  }
}

TEST(Turnover, APrescribedSpinIsKeptOnTheWayBack) {
  const PeriodicBox box = box_on(1).box();
  const Vec3 spin(1.0, 20.0, -3.0), velocity(0.1, 0.2, 0.3);
  for (const Motion motion : {Motion::free, Motion::held_rotation}) {
    GrainSeed grain = test::glass_sphere(0, Vec3(0.01, 0.01, 0.01));
    ClumpSeed clump = test::glass_clump(1, test::pebble(), Vec3(0.03, 0.01, 0.01));
    grain.motion = clump.motion = motion;
    grain.angular_velocity = clump.angular_velocity = spin;
    const Vec3 after = holds_rotation(motion) ? spin : Vec3::Zero();
    for (TravellingBody& body : bodies_of(GrainSeeds{{grain}, {clump}}, box)) {
      body.set_velocity(velocity);
      for (std::size_t r = 0; r < body.rows.size(); ++r) {
        EXPECT_EQ(Vec3(body.rows[r].value[GrainRow::angular_velocity].data()), after);
        EXPECT_LT((Vec3(body.rows[r].value[GrainRow::velocity].data()) - velocity - after.cross(body.arm(r))).norm(),
                  1e-15);
      }
      if (!body.clump) continue;
      EXPECT_EQ(Vec3(body.clump->velocity), velocity);
      EXPECT_EQ(Vec3(body.clump->angular_velocity), after);
      EXPECT_EQ(Vec3(body.clump->angular_momentum).isZero(0.0), after.isZero(0.0));
    }
  }
}

// Sixteen cells of 2.5 mm are 40 mm, but for the rounding that 0.04 has as well.
TEST(Turnover, ASinkMayReachTheEndOfTheBox) {
  GrainParameters p = busy_box();
  p.sinks[0].zone.upper.x() = std::nextafter(0.04, 1.0);
  EXPECT_NO_THROW(GrainDynamics(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p, few_at_start()));
}

TEST(Turnover, ImpossibleSuppliesAreRefused) {
  const auto refused = [](const GrainParameters& p) {
    EXPECT_THROW(GrainDynamics(box_on(size_of(MPI_COMM_WORLD)), MPI_COMM_WORLD, p, few_at_start()), InputError);
  };
  GrainParameters p = busy_box();
  p.supplies[0].rate = 0.0;
  refused(p);
  p = busy_box();
  p.supplies[1].entrance.zone.upper.x() = 0.05;
  refused(p);
  p = busy_box();
  p.sinks[0].zone.lower.z() = 0.01;
  refused(p);
  p = busy_box();
  p.supplies[0].entrance.above_bed = HeightRange{0.004, 0.003};
  refused(p);
}

}  // namespace
}  // namespace thalweg::dem::turnover_test
