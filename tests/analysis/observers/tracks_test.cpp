#include "analysis/observers/tracks.hpp"

#include "tests/analysis/made_up_grains.hpp"
#include "tests/support/memory_archive.hpp"
#include "tests/support/named_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::analysis::tracks_test {
namespace {

// Where three grains are, beyond periodic faces, too: grain 2 goes round, x = 19 + 7 t against 20, y = 1 - 3 t.
Vec3 place(GlobalId id, double time) {
  return id == 2 ? Vec3(19.0 + 7.0 * time, 1.0 - 3.0 * time, 2.0) : Vec3(5.0, 5.0, 1.0 + static_cast<double>(id));
}

// Each belongs to another rank at every step; their spin and forces follow from the time.
void show(Tracks& tracks, std::int64_t step) {
  const double time = 0.5 * static_cast<double>(step);
  const auto grain = [time](GlobalId id) {
    return MadeUpGrain{.velocity = id == 2 ? Vec3(7.0, -3.0, 0.0) : Vec3(Vec3::Zero()),
                       .angular_velocity = Vec3(time, 0.0, 0.0),
                       .position = place(id, time),
                       .fluid_force = Vec3(0.0, time, 0.0),
                       .fluid_torque = Vec3(0.0, 0.0, static_cast<double>(id)),
                       .contact_force = Vec3(-1.0, 0.0, 0.0)};
  };
  tracks.observe(MadeUpGrains(MPI_COMM_WORLD, 3, grain, step).snapshot(time, 0.5));
}

using test::named;

TEST(Tracks, GoOnWhereAGrainLeavesTheBox) {
  Tracks tracks(MPI_COMM_WORLD, {0, 2}, 0.5);
  for (std::int64_t step = 0; step < 30; ++step) show(tracks, step);
  show(tracks, 29);  // seen before
  const Records records = tracks.take_records();
  if (rank_of(MPI_COMM_WORLD) != 0) {
    EXPECT_TRUE(records.rows.empty() && records.fixed.empty());
    return;
  }
  EXPECT_EQ(records.fixed.at(0).values, (std::vector<std::int64_t>{0, 2}));
  EXPECT_EQ(named(records.rows, "time").values.size(), 30u);
  const Profile& position = named(records.rows, "position");
  ASSERT_EQ(position.shape, (std::vector<std::uint64_t>{30, 2, 3}));
  for (std::size_t row = 0; row < 30; ++row) {
    const double time = 0.5 * static_cast<double>(row);
    const Vec3 expected = place(2, time);
    for (std::size_t axis = 0; axis < 3; ++axis)  // exact but for the rounding of places in the box
      EXPECT_NEAR(position.values[6 * row + 3 + axis], expected[static_cast<Eigen::Index>(axis)], 1e-12);
    EXPECT_EQ(named(records.rows, "angular_velocity").values[6 * row], time);
    EXPECT_EQ(named(records.rows, "fluid_force").values[6 * row + 1], time);
    EXPECT_EQ(named(records.rows, "fluid_couple").values[6 * row + 5], 2.0);
    EXPECT_EQ(named(records.rows, "contact_force").values[6 * row + 3], -1.0);
  }
}

// Grain 1 is away at times 2 to 4 s, and comes in again elsewhere; grain 0 is put elsewhere between two measurements.
// Neither goes on from where it was, and grain 2 goes round as before.
TEST(Tracks, OfGrainsThatLeaveAndComeIn) {
  const auto show = [](Tracks& tracks, std::int64_t step) {
    const double time = 0.5 * static_cast<double>(step);
    const auto grain = [time](GlobalId id) -> std::optional<MadeUpGrain> {
      if (id == 1 && time >= 2.0 && time <= 4.0) return {};
      const Vec3 elsewhere = id < 2 && time > 4.0 ? Vec3(17.0, 8.0, 4.0) : place(id, time);
      return MadeUpGrain{.velocity = id == 2 ? Vec3(7.0, -3.0, 0.0) : Vec3(Vec3::Zero()), .position = elsewhere};
    };
    tracks.observe(MadeUpGrains(MPI_COMM_WORLD, 3, grain, step).snapshot(time, 0.5));
  };
  const std::vector<GlobalId> all{0, 1, 2};
  Tracks straight(MPI_COMM_WORLD, all, 0.5, true, 1.0), before(MPI_COMM_WORLD, all, 0.5, true, 1.0),
      tracks(MPI_COMM_WORLD, all, 0.5, true, 1.0);
  for (std::int64_t step = 0; step < 20; ++step) show(straight, step);
  for (std::int64_t step = 0; step < 6; ++step) show(before, step);  // a restart while grain 1 is away
  test::load(tracks, test::saved(before, MPI_COMM_WORLD));
  for (std::int64_t step = 5; step < 20; ++step) show(tracks, step);
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  const Records records = straight.take_records(), rest = tracks.take_records();
  const Profile& position = named(records.rows, "position");
  ASSERT_EQ(position.shape, (std::vector<std::uint64_t>{20, 3, 3}));
  for (std::size_t row = 0; row < 20; ++row) {
    const double time = 0.5 * static_cast<double>(row);
    for (const std::size_t id : {0, 1, 2})
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double value = position.values[9 * row + 3 * id + axis];
        const Vec3 expected = id < 2 && time > 4.0 ? Vec3(17.0, 8.0, 4.0) : place(static_cast<GlobalId>(id), time);
        if (id == 1 && time >= 2.0 && time <= 4.0)
          EXPECT_TRUE(std::isnan(value));
        else
          EXPECT_NEAR(value, expected[static_cast<Eigen::Index>(axis)], 1e-12);
      }
  }
  const std::vector<double>& orientation = named(records.rows, "orientation").values;
  ASSERT_EQ(orientation.size(), 240u);
  EXPECT_EQ(orientation[0], 1.0);
  EXPECT_TRUE(std::isnan(orientation[12 * 5 + 4]));
  const std::vector<double>& part = named(rest.rows, "position").values;
  ASSERT_EQ(part.size(), 14u * 9);
  for (std::size_t n = 0; n < part.size(); ++n) {
    const double whole = position.values[position.values.size() - part.size() + n];
    EXPECT_TRUE(part[n] == whole || (std::isnan(part[n]) && std::isnan(whole)));
  }
}

// Grains 1 and 2 are members of a clump, which the last rank owns; a sphere has no orientation but 1, 0, 0, 0.
TEST(Tracks, OfMembersHaveTheOrientationOfTheirClump) {
  const Decomposition decomposition = made_up_box();
  const bool here = rank_of(MPI_COMM_WORLD) == size_of(MPI_COMM_WORLD) - 1, first = rank_of(MPI_COMM_WORLD) == 0;
  std::vector<GlobalId> id, clump;
  if (here) id = {2, 1}, clump = {1, 1};
  if (first) id.push_back(0), clump.push_back(-1);
  const std::vector<Vec3> some(id.size(), Vec3(1.0, 2.0, 3.0));
  Snapshot snapshot;
  snapshot.decomposition = &decomposition;
  snapshot.grains.global_count = 3;
  snapshot.grains.id = id;
  snapshot.grains.clump = clump;
  snapshot.grains.clump_count = 1;
  snapshot.grains.member_count = 2;
  for (auto* vectors : {&snapshot.grains.position, &snapshot.grains.velocity, &snapshot.grains.angular_velocity})
    *vectors = some;
  if (here) {
    snapshot.grains.clumps = {{1, 1.0, 1.0, Vec3::Zero(), Vec3::Zero(), 0.0}};
    snapshot.grains.clumps[0].orientation = {0.6, 0.0, 0.8, 0.0};
  }
  Tracks tracks(MPI_COMM_WORLD, {0, 2}, 0.5, true);
  tracks.observe(snapshot);
  const Records records = tracks.take_records();
  if (!first) return;
  const Profile& orientation = named(records.rows, "orientation");
  EXPECT_EQ(orientation.shape, (std::vector<std::uint64_t>{1, 2, 4}));
  EXPECT_EQ(orientation.values, (std::vector<double>{1.0, 0.0, 0.0, 0.0, 0.6, 0.0, 0.8, 0.0}));
}

TEST(Tracks, GoOnAfterARestartOnAnyRanks) {
  Tracks straight(MPI_COMM_WORLD, {0, 2}, 0.5), before(MPI_COMM_WORLD, {0, 2}, 0.5), after(MPI_COMM_WORLD, {0, 2}, 0.5);
  for (std::int64_t step = 0; step < 30; ++step) show(straight, step);
  for (std::int64_t step = 0; step < 13; ++step) show(before, step);
  before.take_records();
  test::load(after, test::saved(before, MPI_COMM_WORLD));
  for (std::int64_t step = 12; step < 30; ++step) show(after, step);
  EXPECT_EQ(after.results().at(1).value, 30.0);
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  const Records whole = straight.take_records(), rest = after.take_records();
  ASSERT_EQ(named(rest.rows, "time").values.size(), 17u);
  for (std::size_t a = 0; a < rest.rows.size(); ++a) {
    const std::vector<double>&part = rest.rows[a].values, &all = whole.rows[a].values;
    EXPECT_TRUE(std::equal(part.rbegin(), part.rend(), all.rbegin())) << rest.rows[a].name;
  }
}

TEST(Tracks, AreRefusedOfMoreGrainsThanOneRankGathers) {
  constexpr std::int64_t most = TracksKeys::most_grains;
  const auto facts_of = [](GlobalId count) {
    RunContext run;
    run.grains.emplace();
    run.grains->populations.push_back({.name = "all", .first = 0, .end = count, .pivot = {}});
    return run;
  };
  EXPECT_NO_THROW(check(TracksKeys{}, facts_of(most)));
  EXPECT_NO_THROW(check(TracksKeys{{}, 3}, facts_of(3 * most)));
  EXPECT_NO_THROW(check(TracksKeys{{5, 7 * most}}, facts_of(100 * most)));
  EXPECT_THROW(check(TracksKeys{{}, 3}, facts_of(3 * most + 1)), KeyError);
  std::string message;
  try {
    check(TracksKeys{}, facts_of(738'304));
  } catch (const KeyError& error) {
    message = error.what();
  }
  EXPECT_NE(message.find("738304 grains"), std::string::npos) << message;
  EXPECT_NE(message.find("one_in: 37"), std::string::npos) << message;
  EXPECT_NO_THROW(check(TracksKeys{{}, 37}, facts_of(738'304)));  // the remedy
}

}  // namespace
}  // namespace thalweg::analysis::tracks_test
