// Grains that start from their places, as made up: when a start counts, what is remembered of it, on any ranks and
// after a restart.
#include "analysis/observers/entrainment.hpp"

#include "tests/analysis/made_up_grains.hpp"
#include "tests/support/memory_archive.hpp"
#include "tests/support/named_profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::analysis::entrainment_test {
namespace {

constexpr double dt = 0.01, radius = 0.5, lever = 0.4;
constexpr GlobalId count = 60;

// Sixty grains in a box of 20 m x 10 m x 5 m, periodic along x and y, in two layers: a bed of 50 below (z = 0.5 m), ten
// on top (ids 50 to 59, z = 1.4 m). Grain 50 + n leaves its place at 0.305 s + 0.1 n s with 2 m/s along x, for 0.15 s,
// if n is even; it moves 0.3 m. Each has two loaded contacts at 0.4 m below its centre, one on either side, and the
// fluid pushes it with 1 N along x and turns it with C_n = 0.1 (1 + n) N m about y: its share is C_n / (0.4 + C_n).
// Whoever owns a grain changes from step to step. With twins each grain on top is a clump of two spheres, 50 + 2n and
// 51 + 2n, on either side of its centre, each with one of the contacts: the first has a quarter of the load, and the
// other one a couple about z that makes up for it.
class Bed : public ContactSource {
public:
  static constexpr double aside = 0.2;  // m, of a twin from the centre
  explicit Bed(bool twins = false) : twins_(twins) {}

  static double couple(GlobalId n) { return 0.1 * static_cast<double>(1 + n); }
  static double share(GlobalId n) { return couple(n) / (lever + couple(n)); }

  void show(Entrainment& observer, std::int64_t step) {
    const double time = dt * static_cast<double>(step);
    const auto clear = [](auto&... lists) { (lists.clear(), ...); };
    clear(id_, clump_, radii_, masses_, position_, velocity_, spin_, force_, couple_, contact_);
    std::vector<ClumpState> clumps;
    for (GlobalId id = count - 1; id >= 0; --id) {
      if ((id * 7 + step) % size_of(MPI_COMM_WORLD) != rank_of(MPI_COMM_WORLD)) continue;
      const GlobalId n = id - 50;
      const double begin = 0.305 + 0.1 * static_cast<double>(n), way = std::clamp(time - begin, 0.0, 0.15) * 2.0;
      const bool starts = n >= 0 && n % 2 == 0, moves = starts && way > 0.0 && way < 0.3;
      Vec3 place(n < 0 ? static_cast<double>(id % 10) * 2.0 : 19.8,
                 n < 0 ? 0.5 + static_cast<double>(id / 10) : static_cast<double>(n) + 0.5, n < 0 ? 0.5 : 1.4);
      if (starts) place.x() += way;
      if (place.x() >= 20.0) place.x() -= 20.0;
      const Vec3 velocity = moves ? Vec3(2.0, 0.0, 0.0) : Vec3(Vec3::Zero());
      if (!twins_ || n < 0) {
        add(id, -1, place, velocity, 1.0, Vec3(0.0, couple(n), 0.0));
        continue;
      }
      const GlobalId first = 50 + 2 * n;
      for (const int twin : {0, 1}) {
        const double load = twin == 0 ? 0.25 : 0.75;
        add(first + twin, first, place + Vec3(0.0, twin == 0 ? -aside : aside, 0.0), velocity, load,
            Vec3(0.0, load * couple(n), twin == 0 ? 0.0 : 0.5 * aside));
      }
      clumps.push_back({first, 1.0, 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3), place, velocity, 0.0});
    }
    Snapshot snapshot;
    snapshot.time = time;
    snapshot.step = step;
    snapshot.decomposition = &decomposition_;
    snapshot.contacts = this;
    snapshot.grains.global_count = twins_ ? count + 10 : count;
    if (twins_) {
      std::reverse(clumps.begin(), clumps.end());
      snapshot.grains.clump_count = 10;
      snapshot.grains.member_count = 20;
      snapshot.grains.clump = clump_;
      snapshot.grains.clumps = clumps;
    }
    snapshot.grains.force_density = force_density;
    snapshot.grains.id = id_;
    snapshot.grains.radius = radii_;
    snapshot.grains.mass = masses_;
    snapshot.grains.position = position_;
    snapshot.grains.velocity = velocity_;
    snapshot.grains.angular_velocity = spin_;
    snapshot.grains.fluid_force = force_;
    snapshot.grains.fluid_torque = couple_;
    snapshot.grains.contact_force = contact_;
    observer.observe(snapshot);
  }

  void for_each_contact(const ContactVisitor&) const override { FAIL() << "only watched grains are asked for"; }
  void for_each_contact_of(std::span<const char> chosen, const ContactEndVisitor& visit) const override {
    for (std::size_t i = 0; i < chosen.size(); ++i)
      for (const double side : {-0.3, 0.3}) {
        const bool member = clump_[i] >= 0, left = id_[i] == clump_[i];
        if (chosen[i] == 0 || (member && left != (side < 0.0))) continue;
        const double own = side - (member ? (left ? -aside : aside) : 0.0);
        visit(i, {{0.0, own, -lever}, {0.0, 0.0, 1.0}, side < 0.0 ? 1 : 2, {0.0, 2 * own, -0.8}});
      }
  }

  const Decomposition& decomposition() const { return decomposition_; }

  Vec3 force_density = Vec3::Zero();

private:
  void add(GlobalId id, GlobalId clump, const Vec3& place, const Vec3& velocity, double load, const Vec3& couple) {
    id_.push_back(id);
    clump_.push_back(clump);
    radii_.push_back(clump < 0 ? radius : 0.4);
    masses_.push_back(1.0);
    position_.push_back(place);
    velocity_.push_back(velocity);
    spin_.push_back(Vec3::Zero());
    force_.push_back(Vec3(load, 0.0, 0.0));
    couple_.push_back(couple);
    contact_.push_back(Vec3(0.0, 0.0, 2.0 * load));
  }

  bool twins_;
  Decomposition decomposition_ = made_up_box();
  std::vector<GlobalId> id_, clump_;
  std::vector<double> radii_, masses_;
  std::vector<Vec3> position_, velocity_, spin_, force_, couple_, contact_;
};

EntrainmentSettings settings(std::vector<GlobalId> grains) {
  EntrainmentSettings s;
  s.grains = std::move(grains);
  s.interval = dt;
  s.memory = 0.1;
  s.refresh_steps = 25;
  s.window = 2.0 * radius;
  s.diameter = 0.3;  // the bed is one layer, which reaches up to 1 m at most
  s.rest_time = 0.1;
  s.moving_speed = 0.01;
  s.held = {{52, 53}};
  s.weight = [](double mass, double) { return Vec3(0.0, 0.0, -mass); };
  s.buoyancy = [](double, double) { return Vec3(Vec3::Zero()); };
  return s;
}

using test::named;

// Five grains of the top layer move, one of which is held.
TEST(Entrainment, CountsTheStartsOfTheSurfaceAndMeansTheirShares) {
  Bed bed;
  Entrainment observer(MPI_COMM_WORLD, bed.decomposition().box(), settings({}));
  for (std::int64_t step = 0; step <= 150; ++step) bed.show(observer, step);
  bed.show(observer, 150);  // seen before
  EXPECT_EQ(value_of(observer.diagnostics(), "watched_grains"),
            9.0);  // of 60, not the bed's and not the one that is held
  EXPECT_EQ(value_of(observer.diagnostics(), "entrainments"), 4.0);
  double mean = 0.0, squares = 0.0;
  for (const GlobalId n : {0, 4, 6, 8}) mean += Bed::share(n) / 4.0;
  for (const GlobalId n : {0, 4, 6, 8}) squares += std::pow(Bed::share(n) - mean, 2);
  EXPECT_EQ(value_of(observer.results(), "entrainments_without_onset"), 0.0);
  EXPECT_EQ(value_of(observer.results(), "entrainments_with_share"), 4.0);
  EXPECT_NEAR(value_of(observer.results(), "couple_share_mean"), mean, 1e-14);
  EXPECT_NEAR(value_of(observer.results(), "couple_share_error"), std::sqrt(squares / 3.0 / 4.0), 1e-7);
  const Records records = observer.take_records();
  if (rank_of(MPI_COMM_WORLD) != 0) {
    EXPECT_TRUE(records.events.empty());
    return;
  }
  ASSERT_EQ(records.events.size(), 4u);
  const Event& second = records.events[1];
  EXPECT_EQ(second.name, "event_000002");
  EXPECT_EQ(second.numbers.at(0).values.at(0), 54);
  // It starts at 0.705 s and has gone more than 0.1 diameters (0.1 m) after 0.05 s and a sample.
  EXPECT_NEAR(second.time, 0.76, 1e-12);
  EXPECT_NEAR(value_of(second.diagnostics, "onset_time"), 0.70, 1e-12);
  EXPECT_NEAR(value_of(second.diagnostics, "couple_share"), Bed::share(4), 1e-14);
  EXPECT_TRUE(std::isnan(value_of(second.diagnostics, "largest_torque_ratio")));  // the hinge is below the centre
  const Profile& time = named(second.arrays, "time");
  ASSERT_EQ(time.values.size(), 11u);  // 0.1 s
  EXPECT_NEAR(time.values.front(), 0.66, 1e-12);
  EXPECT_NEAR(named(second.arrays, "position").values[30], 19.8 + 0.11, 1e-12);
  EXPECT_NEAR(named(records.events[3].arrays, "position").values[30], 19.91, 1e-12);
  EXPECT_EQ(named(second.arrays, "contact_point").shape[0], 22u);
}

// It takes 0.05 s and a sample to leave the rest place, and 0.04 s are remembered.
TEST(Entrainment, AMotionOlderThanTheMemoryHasNoOnset) {
  Bed bed;
  EntrainmentSettings forgetful = settings({});
  forgetful.memory = 0.04;
  Entrainment observer(MPI_COMM_WORLD, bed.decomposition().box(), forgetful);
  for (std::int64_t step = 0; step <= 150; ++step) bed.show(observer, step);
  EXPECT_EQ(value_of(observer.diagnostics(), "entrainments"), 4.0);
  EXPECT_EQ(value_of(observer.results(), "entrainments_without_onset"), 4.0);
  EXPECT_EQ(value_of(observer.results(), "entrainments_with_share"), 0.0);
  EXPECT_NE(observer.remarks().at(0).find("4 began before the recorded 0.04 s"), std::string::npos);
  const Records records = observer.take_records();
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  ASSERT_EQ(records.events.size(), 4u);
  EXPECT_TRUE(std::isnan(value_of(records.events[1].diagnostics, "onset_time")));
  EXPECT_TRUE(std::isnan(value_of(records.events[1].diagnostics, "couple_share")));
  EXPECT_EQ(named(records.events[1].arrays, "time").values.size(), 5u);
}

EntrainmentSettings settings_of_twins() {
  EntrainmentSettings s = settings({});
  s.clumps = true;
  s.held = {{54, 56}};
  return s;
}

// Clumps with the place, load and contacts of the spheres above start as these do, about the same hinge.
TEST(Entrainment, OfClumpsTakesTheWholeAndAllItsContacts) {
  Bed bed, twins(true);
  const PeriodicBox box = bed.decomposition().box();
  Entrainment of_spheres(MPI_COMM_WORLD, box, settings({})), of_twins(MPI_COMM_WORLD, box, settings_of_twins());
  for (std::int64_t step = 0; step <= 150; ++step) bed.show(of_spheres, step), twins.show(of_twins, step);
  EXPECT_EQ(value_of(of_twins.diagnostics(), "watched_grains"), 9.0);
  EXPECT_EQ(value_of(of_twins.diagnostics(), "entrainments"), 4.0);
  EXPECT_NEAR(value_of(of_twins.results(), "couple_share_mean"), value_of(of_spheres.results(), "couple_share_mean"),
              1e-14);
  const Records spheres = of_spheres.take_records(), clumps = of_twins.take_records();
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  ASSERT_EQ(clumps.events.size(), 4u);
  const Event &sphere = spheres.events[1], &clump = clumps.events[1];
  EXPECT_EQ(clump.numbers.at(0).values.at(0), 58);
  for (const char* name : {"position", "fluid_force", "fluid_couple", "contact_force", "hinge_points", "hinge_axis",
                           "fluid_torque", "couple_torque", "critical_torque"}) {
    const std::vector<double>&expected = named(sphere.arrays, name).values, &found = named(clump.arrays, name).values;
    ASSERT_EQ(found.size(), expected.size()) << name;
    for (std::size_t v = 0; v < found.size(); ++v) EXPECT_NEAR(found[v], expected[v], 1e-12) << name;
  }
  EXPECT_EQ(named(clump.arrays, "contact_point").shape[0], 22u);
  EXPECT_EQ(clump.numbers.back().name, "contact_member");
}

// The pressure gradient that holds a flow pushes a grain as well: its force on the volume is the fluid's.
TEST(Entrainment, CountsTheForceOfTheGradientThatHoldsAFlow) {
  Bed bed, held;
  held.force_density = Vec3(6.0, 0.0, 0.0);
  const PeriodicBox box = bed.decomposition().box();
  Entrainment without(MPI_COMM_WORLD, box, settings({})), with(MPI_COMM_WORLD, box, settings({}));
  for (std::int64_t step = 0; step <= 150; ++step) bed.show(without, step), held.show(with, step);
  const Records before = without.take_records(), after = with.take_records();
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  const auto values = [](const Records& records, const char* name) {
    return named(records.events.at(1).arrays, name).values;
  };
  const double force = 6.0 * 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
  for (std::size_t n = 0; n < values(before, "time").size(); ++n) {
    EXPECT_NEAR(values(after, "fluid_force")[3 * n] - values(before, "fluid_force")[3 * n], force, 1e-12);
    // About a hinge along y, a lever below the centre.
    EXPECT_NEAR(std::abs(values(after, "fluid_torque")[n] - values(before, "fluid_torque")[n]), lever * force, 1e-12);
    EXPECT_EQ(values(after, "couple_torque")[n], values(before, "couple_torque")[n]);
  }
}

// Grain 58 starts at 1.105 s and goes on beyond the face of the box at 1.205 s; listed grains alone are watched.
TEST(Entrainment, FollowsListedGrainsBeyondTheBoxAndRestsAnew) {
  Bed bed;
  EntrainmentSettings s = settings({3, 58});
  s.displacement = 0.2;
  Entrainment observer(MPI_COMM_WORLD, bed.decomposition().box(), s);
  for (std::int64_t step = 0; step <= 150; ++step) bed.show(observer, step);
  EXPECT_EQ(value_of(observer.diagnostics(), "watched_grains"), 2.0);
  EXPECT_EQ(value_of(observer.diagnostics(), "entrainments"), 1.0);
  const Records records = observer.take_records();
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  const std::vector<double>& position = named(records.events.at(0).arrays, "position").values;
  EXPECT_NEAR(position[position.size() - 3], 20.01, 1e-12);  // 0.21 m from 19.8 m
}

// A grain at rest is put elsewhere by a sink, at once or after it was away. Where grains do not recirculate, it has
// started.
TEST(Entrainment, IsNotThatOfAGrainThatASinkPutsElsewhere) {
  const auto entrainments = [](bool recirculation, int away) {
    EntrainmentSettings s = settings({0});
    s.recirculation = recirculation;
    Entrainment observer(MPI_COMM_WORLD, made_up_box().box(), s);
    for (int step = 0; step <= 200; ++step) {
      const auto grain = [&](GlobalId) -> std::optional<MadeUpGrain> {
        if (step >= 100 && step < 100 + away) return std::nullopt;
        return MadeUpGrain{.position = Vec3(step < 100 ? 15.0 : 7.0, 5.0, 1.0)};
      };
      observer.observe(MadeUpGrains(MPI_COMM_WORLD, 1, grain, step).snapshot(0.01 * step));
    }
    return value_of(observer.diagnostics(), "entrainments");
  };
  EXPECT_EQ(entrainments(true, 0), 0.0);
  EXPECT_EQ(entrainments(true, 50), 0.0);
  EXPECT_EQ(entrainments(false, 0), 1.0);
}

// It comes back from a sink at 0.5 s, rests, and is 1 m further on at 1.5 s; a restart while it is away changes
// nothing.
TEST(Entrainment, IsThatOfAListedGrainThatIsAwayAtFirst) {
  EntrainmentSettings s = settings({0});
  s.recirculation = true;
  const auto look = [](Entrainment& observer, int from, int to) {
    for (int step = from; step <= to; ++step) {
      const auto grain = [&](GlobalId) -> std::optional<MadeUpGrain> {
        if (step < 50) return std::nullopt;
        return MadeUpGrain{.position = Vec3(step < 150 ? 15.0 : 16.0, 5.0, 1.0)};
      };
      observer.observe(MadeUpGrains(MPI_COMM_WORLD, 1, grain, step).snapshot(0.01 * step));
    }
  };
  s.diameter = 2.0;  // it may go as far from one look to the next
  Entrainment straight(MPI_COMM_WORLD, made_up_box().box(), s), after(MPI_COMM_WORLD, made_up_box().box(), s);
  look(straight, 0, 20);
  EXPECT_TRUE(test::load(after, test::saved(straight, MPI_COMM_WORLD)));
  look(straight, 21, 200);
  look(after, 20, 200);
  for (const Entrainment* observer : {&straight, &after}) {
    EXPECT_EQ(value_of(observer->diagnostics(), "watched_grains"), 1.0);
    EXPECT_EQ(value_of(observer->diagnostics(), "entrainments"), 1.0);
  }
}

void restart(Bed bed, const EntrainmentSettings& given) {
  const PeriodicBox box = bed.decomposition().box();
  Entrainment straight(MPI_COMM_WORLD, box, given), before(MPI_COMM_WORLD, box, given),
      after(MPI_COMM_WORLD, box, given);
  for (std::int64_t step = 0; step <= 150; ++step) bed.show(straight, step);
  for (std::int64_t step = 0; step <= 73; ++step) bed.show(before, step);
  test::load(after, test::saved(before, MPI_COMM_WORLD));
  for (std::int64_t step = 73; step <= 150; ++step) bed.show(after, step);
  EXPECT_EQ(test::first_difference(test::saved(after, MPI_COMM_WORLD), test::saved(straight, MPI_COMM_WORLD)), "");
  const Records rest = after.take_records(), whole = straight.take_records(), first = before.take_records();
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  EXPECT_EQ(first.events.size(), 1u);
  ASSERT_EQ(rest.events.size(), 3u);
  for (std::size_t e = 0; e < 3; ++e) {
    EXPECT_EQ(rest.events[e].name, whole.events[e + 1].name);
    for (std::size_t n = 0; n < rest.events[e].arrays.size(); ++n)
      EXPECT_EQ(rest.events[e].arrays[n].values, whole.events[e + 1].arrays[n].values);
    for (std::size_t n = 0; n < rest.events[e].numbers.size(); ++n)
      EXPECT_EQ(rest.events[e].numbers[n].values, whole.events[e + 1].numbers[n].values);
  }
}

TEST(Entrainment, GoesOnAfterARestartWithTheSameBits) {
  restart(Bed(), settings({}));
  restart(Bed(true), settings_of_twins());
}

}  // namespace
}  // namespace thalweg::analysis::entrainment_test
