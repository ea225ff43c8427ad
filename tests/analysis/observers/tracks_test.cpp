#include "analysis/observers/tracks.hpp"

#include "core/parallel/decomposition.hpp"
#include "core/parallel/mpi_session.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::analysis::tracks_test {
namespace {

// Three grains in a box of 20 m x 10 m x 5 m, periodic along x and y; each belongs to another rank at every step. Grain
// 2 goes round: x = 19 + 7 t against 20, y = 1 - 3 t; its spin and forces follow from the time.
class Carousel {
public:
  Vec3 place(GlobalId id, double time) const {
    return id == 2 ? Vec3(19.0 + 7.0 * time, 1.0 - 3.0 * time, 2.0) : Vec3(5.0, 5.0, 1.0 + static_cast<double>(id));
  }

  void show(Tracks& tracks, std::int64_t step) const {
    const double time = 0.5 * static_cast<double>(step);
    std::vector<GlobalId> id;
    std::vector<Vec3> position, velocity, spin, force, couple, contact;
    for (GlobalId grain = 2; grain >= 0; --grain) {
      if ((grain + step) % size_of(MPI_COMM_WORLD) != rank_of(MPI_COMM_WORLD)) continue;
      Vec3 x = place(grain, time);
      for (int axis = 0; axis < 2; ++axis) x[axis] -= size_[axis] * std::floor(x[axis] / size_[axis]);
      id.push_back(grain);
      position.push_back(x);
      velocity.push_back(grain == 2 ? Vec3(7.0, -3.0, 0.0) : Vec3(Vec3::Zero()));
      spin.push_back(Vec3(time, 0.0, 0.0));
      force.push_back(Vec3(0.0, time, 0.0));
      couple.push_back(Vec3(0.0, 0.0, static_cast<double>(grain)));
      contact.push_back(Vec3(-1.0, 0.0, 0.0));
    }
    Snapshot snapshot;
    snapshot.time = time;
    snapshot.step = step;
    snapshot.decomposition = &decomposition_;
    snapshot.grains.global_count = 3;
    snapshot.grains.id = id;
    snapshot.grains.position = position;
    snapshot.grains.velocity = velocity;
    snapshot.grains.angular_velocity = spin;
    snapshot.grains.fluid_force = force;
    snapshot.grains.fluid_torque = couple;
    snapshot.grains.contact_force = contact;
    tracks.observe(snapshot);
  }

private:
  Decomposition decomposition_{{40, 20, 10}, 0.5, {true, true, false}, {1, 1, 1}};
  Vec3 size_{20.0, 10.0, 5.0};
};

const Profile& array_of(const Records& records, const std::string& name) {
  for (const Profile& array : records.rows)
    if (array.name == name) return array;
  throw std::out_of_range(name);
}

TEST(Tracks, GoOnWhereAGrainLeavesTheBox) {
  const Carousel carousel;
  Tracks tracks(MPI_COMM_WORLD, {0, 2}, 0.5);
  for (std::int64_t step = 0; step < 30; ++step) carousel.show(tracks, step);
  carousel.show(tracks, 29);  // seen before
  const Records records = tracks.take_records();
  if (rank_of(MPI_COMM_WORLD) != 0) {
    EXPECT_TRUE(records.rows.empty() && records.fixed.empty());
    return;
  }
  EXPECT_EQ(records.fixed.at(0).values, (std::vector<std::int64_t>{0, 2}));
  EXPECT_EQ(array_of(records, "time").values.size(), 30u);
  const Profile& position = array_of(records, "position");
  ASSERT_EQ(position.shape, (std::vector<std::uint64_t>{30, 2, 3}));
  for (std::size_t row = 0; row < 30; ++row) {
    const double time = 0.5 * static_cast<double>(row);
    const Vec3 expected = carousel.place(2, time);
    for (std::size_t axis = 0; axis < 3; ++axis)  // exact but for the rounding of places in the box
      EXPECT_NEAR(position.values[6 * row + 3 + axis], expected[static_cast<Eigen::Index>(axis)], 1e-12);
    EXPECT_EQ(array_of(records, "angular_velocity").values[6 * row], time);
    EXPECT_EQ(array_of(records, "fluid_force").values[6 * row + 1], time);
    EXPECT_EQ(array_of(records, "fluid_couple").values[6 * row + 5], 2.0);
    EXPECT_EQ(array_of(records, "contact_force").values[6 * row + 3], -1.0);
  }
}

// Grains 1 and 2 are members of a clump, which the last rank owns; a sphere has no orientation but 1, 0, 0, 0.
TEST(Tracks, OfMembersHaveTheOrientationOfTheirClump) {
  const Decomposition decomposition{{40, 20, 10}, 0.5, {true, true, false}, {1, 1, 1}};
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
  const Profile& orientation = array_of(records, "orientation");
  EXPECT_EQ(orientation.shape, (std::vector<std::uint64_t>{1, 2, 4}));
  EXPECT_EQ(orientation.values, (std::vector<double>{1.0, 0.0, 0.0, 0.0, 0.6, 0.0, 0.8, 0.0}));
}

TEST(Tracks, GoOnAfterARestartOnAnyRanks) {
  const Carousel carousel;
  Tracks straight(MPI_COMM_WORLD, {0, 2}, 0.5), before(MPI_COMM_WORLD, {0, 2}, 0.5), after(MPI_COMM_WORLD, {0, 2}, 0.5);
  for (std::int64_t step = 0; step < 30; ++step) carousel.show(straight, step);
  for (std::int64_t step = 0; step < 13; ++step) carousel.show(before, step);
  before.take_records();
  test::MemoryArchive archive;
  test::MemoryWriter writer(archive, MPI_COMM_WORLD);
  before.save(writer);
  test::MemoryReader reader(archive);
  after.load(reader);
  for (std::int64_t step = 12; step < 30; ++step) carousel.show(after, step);
  EXPECT_EQ(after.results().at(1).value, 30.0);
  if (rank_of(MPI_COMM_WORLD) != 0) return;
  const Records whole = straight.take_records(), rest = after.take_records();
  ASSERT_EQ(array_of(rest, "time").values.size(), 17u);
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
