// The plan for many ranks, against counts by hand. tests/system and benchmarks measure the rest.
#include "driver/cost/performance_model.hpp"

#include "driver/cost/run_cost.hpp"
#include "driver/cost/sample_case.hpp"
#include "driver/setup/build_system.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace thalweg::driver::performance_model_test {
namespace {

RankWork total(const Case& c, const Index3& layout) {
  const Decomposition decomposition = decomposition_of(c, layout);
  RankWork sum;
  for (int rank = 0; rank < decomposition.ranks(); ++rank) {
    const RankWork work = rank_work(c, decomposition, rank);
    sum.cells += work.cells;
    sum.grains += work.grains;
    sum.share_of_cells += work.share_of_cells;
    sum.share_of_grains += work.share_of_grains;
  }
  return sum;
}

TEST(RankCost, SharesOutEverything) {
  const Case c = wide_bed();
  for (const Index3& layout : {Index3{1, 1, 1}, Index3{4, 2, 1}, Index3{3, 3, 2}, Index3{1, 1, 7}}) {
    const RankWork sum = total(c, layout);
    EXPECT_NEAR(sum.cells, 240.0 * 80.0 * 212.0, 1e-6);
    EXPECT_NEAR(sum.grains, 1000.0, 1e-9);
    EXPECT_NEAR(sum.share_of_cells, 1.0, 1e-12);
    EXPECT_NEAR(sum.share_of_grains, 1.0, 1e-12);
  }
}

// Not those of as many grains of the median size, which by mass is that of the largest.
TEST(RunCost, CountsTheLinksOfEachSize) {
  Case c = wide_bed();
  const double alike = bytes_of_links(c);
  beds::Population& grains = c.grains.front();
  grains.diameters.assign(static_cast<std::size_t>(grains.count), grains.diameter);
  std::fill_n(grains.diameters.begin(), grains.count / 2, 0.5 * grains.diameter);
  EXPECT_NEAR(bytes_of_links(c), (0.5 + 0.5 / 4.0) * alike, 1e-9 * alike);
}

TEST(RankCost, OfOneRankSendsNothing) {
  const Case c = wide_bed();
  const RankWork work = rank_work(c, decomposition_of(c, {1, 1, 1}), 0);
  EXPECT_EQ(work.bytes, 0.0);
  EXPECT_EQ(work.messages, 0.0);
  EXPECT_EQ(work.ghosts, 0.0);
}

// Two ranks along x are each other's neighbours on both sides; eight in four by two have each three beside them.
TEST(RankCost, CountsMessagesAndBytes) {
  const Case c = wide_bed();
  // Every sub-step and once after them, the halo, the sums of the links and what comes back.
  RankWork work = rank_work(c, decomposition_of(c, {2, 1, 1}), 0);
  EXPECT_EQ(work.rounds, 54.0);
  EXPECT_EQ(work.messages, 54.0);
  // Grains a diameter and a skin of a tenth of one beyond the block, on both sides.
  EXPECT_NEAR(work.ghosts, 1000.0 * 2.0 * 1.1 * 5e-3 / 0.120, 1e-9);
  // Two faces of five populations. Towards the edges along y lies the same rank, with one population each.
  const double halo = 4.0 * (2.0 * 5.0 * 80.0 * 212.0 + 4.0 * 212.0 + 4.0 * 80.0 - 2.0 * 80.0 * 2.0);
  const double grains = work.ghosts * 8.0 * ((0.6 * 50.0 + 1.0) * 9.0 + 18.0 + 5.0);  // six of ten in sub-steps
  EXPECT_NEAR(work.bytes, halo + grains, 0.01 * halo);
  work = rank_work(c, decomposition_of(c, {4, 2, 1}), 5);
  // Along x two ranks, along y one, and the two at the corners in plan.
  EXPECT_EQ(work.messages, 5.0 * 54.0);
}

// A rank above the bed has cells and no grains; without an excess of grains nobody waits for one.
TEST(RankCost, KnowsWhereTheBedIs) {
  const Case c = wide_bed();
  const Decomposition halves = decomposition_of(c, {1, 1, 2});
  EXPECT_EQ(rank_work(c, halves, 1).grains, 0.0);
  EXPECT_NEAR(rank_work(c, halves, 0).grains, 1000.0, 1e-9);
  CoreSpeed speed;
  speed.of_cells = 0.02;
  speed.of_grains = 0.08;
  const Network at_once{1e-30, 1e-30, 1e30};
  EXPECT_NEAR(step_times(rank_work(c, halves, 1), 2, speed, at_once).sum(), 0.01, 1e-9);
  const SlowestRank slowest = slowest_rank(c, halves, speed, at_once);
  EXPECT_NEAR(slowest.times.computing, 0.09, 1e-9);
  EXPECT_NEAR(slowest.times.waiting, 0.08 / std::sqrt(1000.0), 1e-9);
}

TEST(RankCost, AddsLatencyOverheadAndBandwidth) {
  RankWork work;
  work.rounds = 54.0;
  work.messages = 108.0;
  work.bytes = 2e6;
  const StepTimes times = step_times(work, 16, {}, {2e-6, 1e-6, 1e9});
  EXPECT_NEAR(times.sending, 54.0 * 2e-6 + 108.0 * 1e-6 + 2e-3, 1e-12);
  EXPECT_NEAR(times.reducing, 2.0 * 2.0 * 4.0 * 2e-6, 1e-12);  // up and down a tree of 16
}

// The piece that is timed has the section of the whole, and grains that touch as those of a bed do.
TEST(SampleCase, IsAShortPieceOfTheWhole) {
  Case c = wide_bed();
  const Sample sample = sample_of(c);
  EXPECT_LT(sample.share, 0.5);
  EXPECT_NEAR(sample.c.domain.size.x(), sample.share * 0.120, 1e-12);
  EXPECT_EQ(sample.c.domain.size.z(), c.domain.size.z());
  ASSERT_EQ(sample.c.grains.size(), 1u);
  EXPECT_NEAR(static_cast<double>(sample.c.grains[0].count), 1000.0 * sample.share, 1.0);
  int touching = 0;
  const std::vector<BedGrain>& bed = sample.c.grains[0].file;
  for (const BedGrain& one : bed)
    for (const BedGrain& other : bed)
      touching += one.id < other.id && (one.position - other.position).norm() < one.radius + other.radius ? 1 : 0;
  EXPECT_GT(2.0 * touching / static_cast<double>(bed.size()), 4.0);
  EXPECT_NEAR(cells_of(sample.c.domain)[0] * c.domain.spacing, sample.c.domain.size.x(), 1e-12);
}

// A hundred grains per second for 30 s come to a bed of 1000: 2500 in the mean.
TEST(SampleCase, IsOfTheGrainsThatTheWholeHasInTheMean) {
  Case c = wide_bed();
  c.run.until = 30.0;
  const Sample still = sample_of(c);
  EXPECT_NEAR(still.share_of_grains, still.share, 1e-3);
  beds::SupplyKeys& supply = c.supplies.emplace_back();
  supply.rate = 100.0;
  const Sample fed = sample_of(c);
  EXPECT_EQ(fed.share, still.share);
  EXPECT_NEAR(fed.share_of_grains, fed.share, 1e-3);
  EXPECT_NEAR(static_cast<double>(fed.c.grains[0].count), 2500.0 * fed.share, 1.0);
}

// Their regions may lie beyond its end, and their populations are not in it.
TEST(SampleCase, HasNeitherSuppliesNorSinks) {
  Case c = wide_bed();
  c.grains.push_back(c.grains.front());
  beds::SupplyKeys supply;
  supply.population = 1;
  supply.rate = 10.0;
  c.supplies = {supply};
  c.sinks.emplace_back().region = {Vec3(0.110, 0.0, 0.0), c.domain.size};
  const Sample sample = sample_of(c);
  EXPECT_TRUE(sample.c.supplies.empty());
  EXPECT_TRUE(sample.c.sinks.empty());
}

// Grains that the case holds are free in the sample, and those with a material of their own have that of all.
TEST(SampleCase, HasContactsThatItsStepCanFollow) {
  const auto expect_a_step_short_enough = [](const Case& c) {
    const Sample sample = sample_of(c);
    EXPECT_EQ(grain_time_step(sample.c), grain_time_step(c));
    EXPECT_LE(grain_time_step(sample.c), longest_contact_step(sample.c));
  };
  Case rough = wide_bed();
  beds::Population fine = rough.grains.front();
  fine.diameter = 1.5e-3;
  fine.fixed = true;
  rough.grains.push_back(fine);
  rough.coupling.grain_steps_per_fluid_step = sub_steps_needed(rough);
  expect_a_step_short_enough(rough);
  Case soft = wide_bed();
  soft.grains.front().contact.emplace().normal_stiffness = 200.0;
  soft.coupling.grain_steps_per_fluid_step = sub_steps_needed(soft);
  ASSERT_GT(grain_time_step(soft), shortest_contact(wide_bed()) / 20.0);
  expect_a_step_short_enough(soft);
}

}  // namespace
}  // namespace thalweg::driver::performance_model_test
