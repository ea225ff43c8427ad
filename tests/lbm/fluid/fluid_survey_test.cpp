// The survey against plain loops over the cells of the whole box, which every rank runs alone.
#include "lbm/fluid/fluid_survey.hpp"

#include "core/parallel/mpi_session.hpp"
#include "core/sums/wide_sums_over_ranks.hpp"
#include "lbm/fluid/mean_momentum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace thalweg::lbm::fluid_survey_test {
namespace {

constexpr Index3 cells{37, 17, 11};  // no whole packs
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

FluidState swirl(const Vec3& p) {
  return {0.01 * std::sin(0.7 * p.x() + 0.31 * p.y() + 0.3 * p.z()),
          Vec3(0.13 * std::sin(0.5 * p.y() + 0.013 * p.x()), 0.08 * std::cos(0.6 * p.z()),
               0.1 * std::sin(0.4 * p.x() + 0.2 * p.y()))};
}

bool solid(int x, int y, int z) { return (7 * x + 5 * y + 3 * z) % 11 < 3 || (z < 3 && x > 4 && x < 30); }

// The same box on one rank and on all of them.
template <typename Real>
struct Boxes {
  explicit Boxes(const Index3& layout, bool with_solids = true)
      : whole(cells, 1.0, {true, true, true}, {1, 1, 1}),
        cut(cells, 1.0, {true, true, true}, layout),
        alone(whole, MPI_COMM_SELF, parameters(), {}),
        shared(cut, MPI_COMM_WORLD, parameters(), {}) {
    for (Fluid<Real>* fluid : {&alone, &shared}) {
      fluid->initialise(swirl);
      const Index3 n = fluid->indexing().size(), from = fluid->block().lower;
      for (int z = 0; z < n[2] && with_solids; ++z)
        for (int y = 0; y < n[1]; ++y)
          for (int x = 0; x < n[0]; ++x)
            if (solid(from[0] + x, from[1] + y, from[2] + z)) fluid->cells().assign(x, y, z, 3);
    }
  }

  static CollisionParameters parameters() {
    CollisionParameters p;
    p.relaxation_time = 0.6;
    p.force[0] = 1e-3;
    p.force[2] = -2e-3;
    return p;
  }

  // Writes a population of a global cell in both.
  void set(const Index3& cell, double value) {
    for (Fluid<Real>* fluid : {&alone, &shared}) {
      const Index3& from = fluid->block().lower;
      const int x = cell[0] - from[0], y = cell[1] - from[1], z = cell[2] - from[2];
      if (fluid->indexing().owned(x, y, z))
        fluid->populations().post_collision(5, fluid->indexing().index(x, y, z)) = static_cast<Real>(value);
    }
  }

  Decomposition whole, cut;
  Fluid<Real> alone, shared;
};

std::vector<Index3> layouts() {
  const int ranks = size_of(MPI_COMM_WORLD);
  if (ranks == 4) return {{4, 1, 1}, {2, 1, 2}, {1, 4, 1}};
  if (ranks == 2) return {{2, 1, 1}, {1, 2, 1}, {1, 1, 2}};
  return {{1, 1, 1}};
}

void expect_same(const CellExtreme& a, const CellExtreme& b) {
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.cell, b.cell);
}

void expect_same(const FluidSurvey& a, const FluidSurvey& b) {
  EXPECT_EQ(a.totals.mass_deviation, b.totals.mass_deviation);
  EXPECT_EQ(a.totals.momentum, b.totals.momentum);
  EXPECT_EQ(a.totals.cells, b.totals.cells);
  EXPECT_EQ(a.lever, b.lever);
  EXPECT_EQ(a.fast_cells, b.fast_cells);
  EXPECT_EQ(a.broken_cells, b.broken_cells);
  expect_same(a.lowest, b.lowest);
  expect_same(a.highest, b.highest);
  expect_same(a.fastest, b.fastest);
}

// Cell by cell, in plain double precision.
template <typename Real>
FluidSurvey plain(const Fluid<Real>& fluid) {
  FluidSurvey s;
  for (int z = 0; z < cells[2]; ++z)
    for (int y = 0; y < cells[1]; ++y)
      for (int x = 0; x < cells[0]; ++x) {
        const std::ptrdiff_t cell = fluid.indexing().index(x, y, z);
        if (!fluid.cells().is_fluid(cell)) continue;
        const FluidState state = fluid.state_at(cell);
        const Vec3 force(fluid.parameters().force[0], fluid.parameters().force[1], fluid.parameters().force[2]);
        const double deviation = state.density_deviation, speed = state.velocity.norm();
        s.totals.mass_deviation += deviation;
        s.totals.momentum += (1.0 + deviation) * state.velocity + 0.5 * force;
        s.lever += Vec3(x + 0.5, y + 0.5, z + 0.5) - 0.5 * Vec3(cells[0], cells[1], cells[2]);
        if (s.totals.cells == 0 || deviation < s.lowest.value) s.lowest = {deviation, {x, y, z}};
        if (s.totals.cells == 0 || deviation > s.highest.value) s.highest = {deviation, {x, y, z}};
        if (s.totals.cells == 0 || speed > s.fastest.value) s.fastest = {speed, {x, y, z}};
        if (speed > FluidSurvey::fast) ++s.fast_cells;
        ++s.totals.cells;
      }
  return s;
}

template <typename Real>
void compare_to_plain_loops(const Boxes<Real>& boxes) {
  const FluidSurvey survey = survey_of(boxes.shared), loops = plain(boxes.alone);
  expect_same(survey, survey_of(boxes.alone));
  const auto n = static_cast<double>(loops.totals.cells);
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(mean_momentum(boxes.shared, axis), survey.totals.momentum[axis] / n);
  // Every cell is rounded to a multiple of 2^-36; the loops' own round-off is smaller.
  EXPECT_NEAR(survey.totals.mass_deviation, loops.totals.mass_deviation, n * 0x1p-37 + 1e-12);
  EXPECT_LT((survey.totals.momentum - loops.totals.momentum).cwiseAbs().maxCoeff(), n * 0x1p-37 + 1e-12);
  EXPECT_EQ(survey.lever, loops.lever);
  EXPECT_EQ(survey.totals.cells, loops.totals.cells);
  EXPECT_EQ(survey.broken_cells, 0);
  EXPECT_EQ(survey.fast_cells, loops.fast_cells);
  EXPECT_GT(survey.fast_cells, 0);
  EXPECT_LT(survey.fast_cells, survey.totals.cells);
  // Sums of 19 numbers below 0.2, in another order.
  constexpr double round_off = 19 * 0.2 * 0x1p-52;
  EXPECT_NEAR(survey.lowest.value, loops.lowest.value, round_off);
  EXPECT_NEAR(survey.highest.value, loops.highest.value, round_off);
  EXPECT_NEAR(survey.fastest.value, loops.fastest.value, round_off);
  EXPECT_EQ(survey.lowest.cell, loops.lowest.cell);
  EXPECT_EQ(survey.highest.cell, loops.highest.cell);
  EXPECT_EQ(survey.fastest.cell, loops.fastest.cell);
}

template <typename Real>
void compare_in_both_arrangements() {
  for (const Index3& layout : layouts())
    for (const bool with_solids : {true, false}) {
      Boxes<Real> boxes(layout, with_solids);
      compare_to_plain_loops(boxes);
      boxes.alone.advance();
      boxes.shared.advance();
      compare_to_plain_loops(boxes);
    }
}

TEST(FluidSurvey, IsWhatPlainLoopsFind) {
  compare_in_both_arrangements<float>();
  compare_in_both_arrangements<double>();
}

TEST(FluidSurvey, ExtremesOfSeveralCellsBelongToTheFirst) {
  for (const Index3& layout : layouts()) {
    Boxes<double> boxes(layout);
    const auto still = [](const Vec3&) { return FluidState{0.125, Vec3::Zero()}; };
    boxes.alone.initialise(still);
    boxes.shared.initialise(still);
    const FluidSurvey survey = survey_of(boxes.shared);
    expect_same(survey, survey_of(boxes.alone));
    Index3 first{0, 0, 0};
    while (solid(first[0], first[1], first[2])) ++first[0];
    EXPECT_EQ(survey.lowest.cell, first);
    EXPECT_EQ(survey.highest.cell, first);
  }
}

template <typename Real>
void break_cells() {
  for (const Index3& layout : layouts()) {
    Boxes<Real> boxes(layout);
    const Index3 buried{10, 1, 1}, first{36, 2, 4}, second{3, 9, 9};
    ASSERT_TRUE(solid(10, 1, 1));
    ASSERT_FALSE(solid(36, 2, 4));
    ASSERT_FALSE(solid(3, 9, 9));
    const FluidSurvey healthy = survey_of(boxes.shared);
    boxes.set(buried, no_number);
    expect_same(survey_of(boxes.shared), healthy);  // nobody reads what is in a solid cell
    EXPECT_TRUE(std::isfinite(mean_momentum(boxes.shared, 2)));

    for (const double value : {no_number, HUGE_VAL, -HUGE_VAL, 1e9, -1e9}) {
      boxes.set(first, no_number);
      boxes.set(second, value);
      const FluidSurvey survey = survey_of(boxes.shared);
      EXPECT_EQ(survey.broken_cells, 2) << value;
      EXPECT_EQ(survey.totals.cells, healthy.totals.cells);
      EXPECT_TRUE(std::isnan(survey.totals.mass_deviation) && survey.totals.momentum.array().isNaN().all());
      EXPECT_TRUE(std::isnan(mean_momentum(boxes.shared, 2)));
      for (const CellExtreme* e : {&survey.lowest, &survey.highest, &survey.fastest}) {
        EXPECT_TRUE(std::isinf(e->value));
        EXPECT_EQ(e->cell, first);  // the lower of the two
      }
    }
  }
}

TEST(FluidSurvey, LosesNoCellThatIsNotANumber) {
  break_cells<float>();
  break_cells<double>();
}

TEST(FluidSurvey, OfNoFluidIsEmpty) {
  Boxes<float> boxes(layouts().front());
  for (int z = 0; z < boxes.shared.indexing().size()[2]; ++z)
    for (int y = 0; y < boxes.shared.indexing().size()[1]; ++y)
      for (int x = 0; x < boxes.shared.indexing().size()[0]; ++x) boxes.shared.cells().assign(x, y, z, 3);
  expect_same(survey_of(boxes.shared), FluidSurvey{});
}

// Sums of the old range, 2^27 lattice units, and beyond: 1.3e8 x 50 over all ranks would overflow 64 bits.
TEST(FluidSurvey, SumsOfRanksAreWide) {
  const int ranks = size_of(MPI_COMM_WORLD), rank = rank_of(MPI_COMM_WORLD);
  WideSum sums[2];
  for (int k = 0; k < 5; ++k) sums[0].add(std::numeric_limits<std::int64_t>::max() - rank);
  sums[1].add(rank % 2 == 0 ? -7 : 3);
  WideSum expected[2];
  for (int r = 0; r < ranks; ++r) {
    for (int k = 0; k < 5; ++k) expected[0].add(std::numeric_limits<std::int64_t>::max() - r);
    expected[1].add(r % 2 == 0 ? -7 : 3);
  }
  sum_over_ranks(MPI_COMM_WORLD, sums);
  EXPECT_EQ(sums[0], expected[0]);
  EXPECT_EQ(sums[1], expected[1]);
}

}  // namespace
}  // namespace thalweg::lbm::fluid_survey_test
