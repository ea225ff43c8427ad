#include "analysis/reach/reach.hpp"

#include "tests/analysis/made_up_grains.hpp"
#include "tests/support/memory_archive.hpp"
#include "tests/support/named_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>

namespace thalweg::analysis::reach_test {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;
constexpr double interval = 0.25;              // s, between looks
constexpr double width = 10.0, spacing = 2.0;  // m; ten sections
const TransportScales scales{1.0, 2650.0, 1000.0, 9.81};
const ReachKeys keys{
    .every = interval, .record_every = 4 * interval, .sections = 10, .pixel = 0.05, .moving_speed = 0.5};

double radius_of(GlobalId id) { return 0.3 + 0.05 * static_cast<double>(id); }
double volume_of(GlobalId id) { return 4.0 / 3.0 * std::numbers::pi * std::pow(radius_of(id), 3); }

struct Place {
  double x, v_x;  // m, m/s
  double z = 1.0;
};
// Where a grain is at a look, if it is there. x goes on through a periodic face.
using Script = std::function<std::optional<Place>(GlobalId id, int look)>;

// Grains that follow a script, each with another owner at every look.
class Play {
public:
  Play(bool periodic, GlobalId ids, Script script)
      : box_(made_up_box(periodic)), ids_(ids), script_(std::move(script)) {}

  PeriodicBox box() const { return box_.box(); }

  void show(Reach& reach, MPI_Comm communicator, int look) const {
    const auto grain = [&](GlobalId id) -> std::optional<MadeUpGrain> {
      const std::optional<Place> place = script_(id, look);
      if (!place) return std::nullopt;
      return MadeUpGrain{
          .radius = radius_of(id), .velocity = Vec3(place->v_x, 0.0, 0.0), .position = Vec3(place->x, 5.0, place->z)};
    };
    reach.observe(MadeUpGrains(communicator, ids_, grain, look, box_).snapshot(interval * look));
  }

private:
  Decomposition box_;
  GlobalId ids_;
  Script script_;
};

// Through periodic faces: grain 0 rests; 1 goes downstream, 2 upstream, 3 downstream by three quarters of the box in an
// interval; 4 hops once, from x = 3 m to 5 m, and is found moving at looks 6 to 9.
const Play carousel(true, 5, [](GlobalId id, int look) -> std::optional<Place> {
  const double t = interval * look;
  if (id == 0) return Place{5.0, 0.0};
  if (id == 1) return Place{19.0 + 6.0 * t, 6.0};
  if (id == 2) return Place{1.0 - 4.0 * t, -4.0};
  if (id == 3) return Place{1.0 + 60.0 * t, 60.0};
  return Place{3.0 + 0.5 * std::clamp(look - 5.5, 0.0, 4.0), look >= 6 && look <= 9 ? 2.0 : 0.0};
});

// Between ends: 0 leaves after look 7; 1 is put in again at 2.5 m after every 14 m; 2 comes in at look 3 and leaves
// after 14 m; 3 comes in at look 10 and stays; 4 is lifted by 4 m at look 12, as by a sink whose grains come back.
const Play open_reach(false, 5, [](GlobalId id, int look) -> std::optional<Place> {
  const double step = 4.0 * interval;  // m
  if (id == 0) return look <= 7 ? std::optional(Place{10.0 + step * look, 4.0}) : std::nullopt;
  if (id == 1) return Place{2.5 + step * ((look + 8) % 15), 4.0};
  if (id == 2) return look >= 3 && look < 18 ? std::optional(Place{2.5 + step * (look - 3), 4.0}) : std::nullopt;
  if (id == 3) return look >= 10 ? std::optional(Place{7.0, 0.0}) : std::nullopt;
  return Place{13.0, 0.0, look < 12 ? 0.6 : 4.4};
});

using test::named;

Reach observer_of(const Play& play, MPI_Comm communicator, bool recirculation, const ReachKeys& with = keys) {
  return {communicator, play.box(), scales, with, 0.0, recirculation};
}

TEST(Reach, CountsEveryGrainThatCrossesASectionOfAPeriodicReach) {
  Reach reach = observer_of(carousel, world, false);
  for (int look = 0; look <= 16; ++look) carousel.show(reach, world, look);  // 4 s
  // Grain 1 crosses 20, 22, ... 42 m, grain 2 0, -2, ... -14 m, grain 3 every section twelve times, grain 4 that at 4
  // m.
  std::map<std::size_t, double> down, up;
  double volume = 0.0;
  for (std::size_t k = 0; k < 10; ++k) {
    down[k] = 12.0 + (k <= 1 ? 2.0 : 1.0) + (k == 2 ? 1.0 : 0.0);
    up[k] = k == 1 || k == 2 ? 0.0 : 1.0;
    const double of_section = volume_of(3) * 12.0 + volume_of(1) * (k <= 1 ? 2.0 : 1.0) +
                              (k == 2 ? volume_of(4) : 0.0) - volume_of(2) * up[k];
    volume += of_section;
    const std::vector<Profile> profiles = reach.profiles();
    EXPECT_EQ(named(profiles, "downstream_grains").values.at(k), down[k]) << k;
    EXPECT_EQ(named(profiles, "upstream_grains").values.at(k), up[k]) << k;
    EXPECT_NEAR(named(profiles, "q_s").values.at(k), of_section / (width * 4.0), 1e-12) << k;
    EXPECT_NEAR(named(profiles, "upstream_q_s").values.at(k), up[k] * volume_of(2) / (width * 4.0), 1e-12) << k;
    EXPECT_EQ(named(profiles, "section").values.at(k), 2.0 * static_cast<double>(k));
  }
  const std::vector<Diagnostic> results = reach.results();
  EXPECT_NEAR(value_of(results, "q_s_mean"), volume / (10.0 * width * 4.0), 1e-12);
  EXPECT_NEAR(value_of(results, "q_star_mean") * scales.flux(), value_of(results, "q_s_mean"), 1e-12);
  EXPECT_EQ(value_of(results, "records"), 4.0);
  EXPECT_EQ(value_of(results, "arrived_grains"), 0.0);
  EXPECT_EQ(value_of(results, "left_grains"), 0.0);
  EXPECT_EQ(value_of(results, "balance_residual"), 0.0);
}

TEST(Reach, CountsWhatIsEntrainedAndDepositedWhereItLay) {
  Reach reach = observer_of(carousel, world, false);
  for (int look = 0; look <= 16; ++look) carousel.show(reach, world, look);
  const std::vector<Profile> profiles = reach.profiles();
  const double rate = volume_of(4) / (width * spacing * 4.0);  // m/s
  for (std::size_t bin = 0; bin < 10; ++bin) {
    EXPECT_NEAR(named(profiles, "entrainment_rate").values.at(bin), bin == 1 ? rate : 0.0, 1e-14) << bin;
    EXPECT_NEAR(named(profiles, "deposition_rate").values.at(bin), bin == 2 ? rate : 0.0, 1e-14) << bin;
  }
  EXPECT_NEAR(value_of(reach.results(), "entrainment_rate"), 0.1 * rate, 1e-14);
  EXPECT_NEAR(value_of(reach.results(), "deposition_rate"), 0.1 * rate, 1e-14);
  const Records records = reach.take_records();
  if (rank_of(world) != 0) return;
  // It began to move in the second second, and came to rest in the third.
  EXPECT_NEAR(named(records.rows, "entrained").values.at(10 + 1), 4.0 * rate, 1e-14);
  EXPECT_NEAR(named(records.rows, "deposited").values.at(20 + 2), 4.0 * rate, 1e-14);
  EXPECT_EQ(named(records.places, "x").values.at(2), 5.0);
}

TEST(Reach, BalancesWhatComesInAndLeavesToTheGrain) {
  Reach reach = observer_of(open_reach, world, true);
  for (int look = 0; look <= 24; ++look) open_reach.show(reach, world, look);  // 6 s
  const std::vector<Diagnostic> results = reach.results();
  EXPECT_EQ(value_of(results, "arrived_grains"), 5.0);  // 1 at looks 7 and 22, 2, 3, 4
  EXPECT_EQ(value_of(results, "left_grains"), 5.0);     // 0, 1 twice, 2, 4
  EXPECT_EQ(value_of(results, "balance_residual"), 0.0);
  EXPECT_NEAR(value_of(results, "stored_change"), volume_of(3) - volume_of(0), 1e-12);
  EXPECT_NEAR(value_of(results, "arrived_volume") - value_of(results, "left_volume"), volume_of(3) - volume_of(0),
              1e-12);
  // Of those that came in, 1 stayed from look 7 to 22 and 2 from 3 to 18. At look 24, 3 is there since look 10, 4 since
  // 12, 1 since 22.
  EXPECT_EQ(value_of(results, "residence_times"), 2.0);
  EXPECT_NEAR(value_of(results, "residence_time_mean"), 15.0 * interval, 1e-12);
  EXPECT_EQ(value_of(results, "newcomers"), 3.0);
  EXPECT_NEAR(value_of(results, "newcomer_age_mean"), (14.0 + 12.0 + 2.0) / 3.0 * interval, 1e-12);
  // No jump counts as a crossing: nothing goes upstream, and downstream go 0 from 10 m to 17 m, 1 from 10.5 m and 2.5 m
  // to 16.5 m and from 2.5 m to 4.5 m, 2 from 2.5 m to 16.5 m. The ends are no sections.
  const std::vector<Profile> profiles = reach.profiles();
  const std::vector<double> down{0, 3, 2, 2, 2, 4, 4, 4, 0};  // at 2, 4, ... 18 m
  EXPECT_EQ(named(profiles, "downstream_grains").values, down);
  EXPECT_EQ(named(profiles, "upstream_grains").values, std::vector<double>(9, 0.0));
  EXPECT_EQ(named(profiles, "section").values.front(), 2.0);
}

TEST(Reach, BalancesEveryRecordOfEveryBin) {
  Reach reach = observer_of(open_reach, world, true);
  for (int look = 0; look <= 24; ++look) open_reach.show(reach, world, look);
  const Records records = reach.take_records();
  if (rank_of(world) != 0) return;
  const auto at = [&](const char* name, std::size_t row, std::size_t place) {
    const Profile& array = named(records.rows, name);
    return array.values.at(row * array.shape.at(1) + place);
  };
  ASSERT_EQ(named(records.rows, "time").values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  ASSERT_EQ(named(records.rows, "q_s").shape, (std::vector<std::uint64_t>{6, 9}));
  for (std::size_t row = 1; row < 6; ++row)
    for (std::size_t bin = 0; bin < 10; ++bin) {
      const double in = bin == 0 ? 0.0 : at("q_s", row, bin - 1), out = bin == 9 ? 0.0 : at("q_s", row, bin);
      const double change = at("stored", row, bin) - at("stored", row - 1, bin);
      EXPECT_NEAR(change, (in - out) / spacing + at("arrived", row, bin) - at("left", row, bin), 1e-14) << row << bin;
    }
}

TEST(Reach, HasTheMeansOfTheRecordsFromATimeOn) {
  ReachKeys late = keys;
  late.from = 3.0;
  Reach reach = observer_of(carousel, world, false, late);
  for (int look = 0; look <= 16; ++look) carousel.show(reach, world, look);
  const std::vector<Diagnostic> results = reach.results();
  EXPECT_EQ(value_of(results, "records"), 1.0);
  EXPECT_EQ(value_of(results, "measured_from"), 3.0);
  EXPECT_EQ(value_of(results, "measured_until"), 4.0);
  EXPECT_EQ(value_of(results, "entrainment_rate"), 0.0);
  Reach nothing = observer_of(carousel, world, false, late);
  for (int look = 0; look <= 15; ++look) carousel.show(nothing, world, look);
  EXPECT_TRUE(std::isnan(value_of(nothing.results(), "q_s_mean")));
  EXPECT_EQ(value_of(nothing.results(), "balance_residual"), 0.0);
}

// A grain of radius r whose centre lies at the height z shows z + sqrt(r^2 - x^2), on the mean z + pi r/4. It is lifted
// by 0.125 m right after each record has begun, which shows what it has covered from the begin on.
TEST(Reach, HasTheLevelOfWhatStandsStillAndItsTrend) {
  const Play play(true, 1, [](GlobalId, int look) {
    return std::optional(Place{5.0, 0.0, 1.0 + 0.125 * ((look + 3) / 4)});
  });
  ReachKeys fine = keys;
  fine.pixel = 0.03125;
  Reach reach = observer_of(play, world, false, fine);
  for (int look = 0; look <= 16; ++look) play.show(reach, world, look);
  const double level_at_first = 1.0 + 0.25 * std::numbers::pi * radius_of(0);
  const Records records = reach.take_records();
  if (rank_of(world) == 0) {
    const Profile& level = named(records.rows, "bed_level");
    ASSERT_EQ(level.shape, (std::vector<std::uint64_t>{4, 10}));
    EXPECT_NEAR(level.values.at(2), level_at_first, 0.5 * *fine.pixel);
    EXPECT_NEAR(level.values.at(32), level.values.at(2) + 3.0 * 0.125, 1e-12);
    EXPECT_TRUE(std::isnan(level.values.at(3)));
  }
  EXPECT_NEAR(value_of(reach.results(), "bed_level_mean"), level_at_first + 1.5 * 0.125, 0.5 * *fine.pixel);
  EXPECT_NEAR(value_of(reach.results(), "bed_level_trend"), 0.125, 1e-12);
  EXPECT_NEAR(named(reach.profiles(), "bed_level_trend").values.at(2), 0.125, 1e-12);
}

// A boulder beside the grain, of the same bin, that reaches higher.
TEST(Reach, HasTheLevelWithoutObstacles) {
  const Play play(true, 2, [](GlobalId id, int) { return std::optional(Place{5.0, 0.0, id == 0 ? 1.0 : 3.0}); });
  Reach reach(world, play.box(), scales, keys, 0.0, false, {1}), all = observer_of(play, world, false);
  for (int look = 0; look <= 8; ++look) {
    play.show(reach, world, look);
    play.show(all, world, look);
  }
  EXPECT_NEAR(value_of(reach.results(), "bed_level_mean"), 1.0 + 0.25 * std::numbers::pi * radius_of(0), *keys.pixel);
  EXPECT_NEAR(value_of(all.results(), "bed_level_mean"), 3.0 + 0.25 * std::numbers::pi * radius_of(1), *keys.pixel);
}

// The same grain comes in after two records: the trend is that of the records that have a level.
TEST(Reach, HasTheTrendOfABedThatIsBuiltUpLater) {
  const Play play(true, 1, [](GlobalId, int look) {
    return look < 8 ? std::nullopt : std::optional(Place{5.0, 0.0, 1.0 + 0.125 * ((look + 3) / 4)});
  });
  ReachKeys fine = keys;
  fine.pixel = 0.03125;
  Reach reach = observer_of(play, world, false, fine);
  for (int look = 0; look <= 24; ++look) play.show(reach, world, look);
  EXPECT_NEAR(value_of(reach.results(), "bed_level_trend"), 0.125, 1e-12);
  EXPECT_NEAR(named(reach.profiles(), "bed_level_trend").values.at(2), 0.125, 1e-12);
}

using thalweg::test::saved;

using thalweg::test::load;

TEST(Reach, HasTheSameBitsOnAnyNumberOfRanksAndAfterARestart) {
  for (const auto& [play, recirculation] : {std::pair{&carousel, false}, std::pair{&open_reach, true}}) {
    Reach alone = observer_of(*play, MPI_COMM_SELF, recirculation), shared = observer_of(*play, world, recirculation);
    Reach restarted = observer_of(*play, world, recirculation);
    test::MemoryArchive half_way;
    for (int look = 0; look <= 22; ++look) {
      play->show(alone, MPI_COMM_SELF, look);
      play->show(shared, world, look);
      if (look == 10) half_way = saved(alone, MPI_COMM_SELF);
    }
    EXPECT_TRUE(load(restarted, half_way));
    for (int look = 10; look <= 22; ++look) play->show(restarted, world, look);  // 10 is seen again
    const test::MemoryArchive end = saved(alone, MPI_COMM_SELF);
    EXPECT_EQ(test::first_difference(end, saved(shared, world)), "");
    EXPECT_EQ(test::first_difference(end, saved(restarted, world)), "");
    const Records whole = shared.take_records(), rest = restarted.take_records();
    for (std::size_t a = 0; a < rest.rows.size(); ++a) {
      const std::vector<double>&part = rest.rows[a].values, &all = whole.rows[a].values;
      ASSERT_EQ(part.size() * 5, all.size() * 3);
      for (std::size_t n = 0; n < part.size(); ++n) {
        const double other = all[all.size() - part.size() + n];
        EXPECT_TRUE(part[n] == other || (std::isnan(part[n]) && std::isnan(other))) << rest.rows[a].name;
      }
    }
  }
}

TEST(Reach, GoesOnOnlyWithStateThatFits) {
  Reach reach = observer_of(open_reach, world, true);
  for (int look = 0; look <= 10; ++look) open_reach.show(reach, world, look);
  const test::MemoryArchive good = saved(reach, world);
  ReachKeys other = keys;
  other.sections = 5;
  Reach coarser = observer_of(open_reach, world, true, other);
  EXPECT_FALSE(load(coarser, good));
  const auto refuses = [&](const std::function<void(test::MemoryArchive&)>& damage) {
    test::MemoryArchive archive = good;
    damage(archive);
    Reach again = observer_of(open_reach, world, true);
    EXPECT_THROW(load(again, archive), InputError);
  };
  for (const char* name :
       {"grain_sums", "volume_sums", "batches", "batch_lengths", "grains", "pixels_of_grains", "stays"})
    refuses([&](test::MemoryArchive& archive) { archive.datasets.erase(std::string("reach/") + name); });
  refuses([](test::MemoryArchive& archive) {
    std::get<std::vector<double>>(archive.datasets.at("reach/grains").values)[0] = 7.0;  // no such state
  });
  refuses([](test::MemoryArchive& archive) {
    std::get<std::vector<double>>(archive.datasets.at("reach/grains").values)[1] = std::nan("");
  });
  refuses([](test::MemoryArchive& archive) {
    ++std::get<std::vector<std::int64_t>>(archive.datasets.at("reach/batch_lengths").values)[0];
  });
}

TEST(ReachKeys, AreForABedOfFreeGrains) {
  RunContext run;
  run.box = {Vec3(0.2, 0.1, 0.1), {true, true, false}};
  EXPECT_THROW(check(ReachKeys{}, run), KeyError);
  run.grains.emplace();
  run.grains->populations.push_back({.name = "bed", .first = 0, .end = 8, .pivot = {}, .held = true});
  EXPECT_THROW(check(ReachKeys{}, run), KeyError);
  run.grains->populations.push_back({.name = "load", .first = 8, .end = 9, .pivot = {}});
  EXPECT_NO_THROW(check(ReachKeys{}, run));
  run.box.periodic[2] = true;
  EXPECT_THROW(check(ReachKeys{}, run), KeyError);
  EXPECT_EQ(default_sections(0.2, 5e-3), 40);
  EXPECT_EQ(default_sections(0.2, 1.0), 2);
  EXPECT_EQ(default_sections(20.0, 1e-3), ReachKeys::most_sections);
}

}  // namespace
}  // namespace thalweg::analysis::reach_test
