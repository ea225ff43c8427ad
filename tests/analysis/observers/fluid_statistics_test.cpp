// Mean flow and Reynolds stresses of a made-up flow against plain sums, on any ranks, with an interruption.
#include "analysis/observers/fluid_statistics.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/sums/sum_range.hpp"
#include "tests/support/memory_archive.hpp"
#include "tests/support/named_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::analysis::fluid_statistics_test {
namespace {

const Index3 cells{13, 9, 8};
constexpr double spacing = 0.5e-3, time_step = 1e-4, unit = spacing / time_step;  // m, s, m/s

bool is_fluid(const Index3& g) { return g[2] > 0 && (g[0] + 2 * g[1] + g[2]) % 5 != 0; }

Vec3 velocity_at(const Index3& g, std::int64_t step) {
  const double s = 0.37 * g[0] + 1.1 * g[1] + 0.6 * g[2] + 0.9 * static_cast<double>(step);
  return 0.1 * unit * Vec3(1.0 + 0.3 * std::sin(s), 0.2 * std::cos(s), 0.2 * std::sin(1.7 * s));
}

class MadeUpFlow final : public FluidSource {
public:
  MadeUpFlow(MPI_Comm communicator, const Decomposition& decomposition)
      : decomposition_(decomposition), block_(decomposition.block_of(rank_of(communicator))) {}
  FluidFields sample(const std::vector<FluidField>&, const Block&) const override { return {}; }
  void for_each_velocity(const VelocityVisitor& visit) const override {
    for (int z = block_.lower[2]; z < block_.upper[2]; ++z)
      for (int y = block_.lower[1]; y < block_.upper[1]; ++y)
        for (int x = block_.lower[0]; x < block_.upper[0]; ++x)
          if (is_fluid({x, y, z})) visit({x, y, z}, velocity_at({x, y, z}, step));
  }
  std::optional<State> state_in(const Index3&) const override { return std::nullopt; }
  Snapshot snapshot(std::int64_t at_step) {
    step = at_step;
    Snapshot snapshot;
    snapshot.step = at_step;
    snapshot.time = time_step * static_cast<double>(at_step);
    snapshot.decomposition = &decomposition_;
    snapshot.fluid = this;
    return snapshot;
  }
  std::int64_t step = 0;

private:
  const Decomposition& decomposition_;
  Block block_;
};

struct Bench {
  Bench(MPI_Comm communicator, bool with_sections)
      : decomposition(cells, spacing, {true, false, false}, Decomposition::best_layout(cells, size_of(communicator))),
        flow(communicator, decomposition),
        statistics(communicator, decomposition, unit, {10 * time_step, 2 * time_step}, with_sections) {}
  void watch(std::int64_t first, std::int64_t last) {
    for (std::int64_t step = first; step <= last; ++step) statistics.observe(flow.snapshot(step));
  }
  Decomposition decomposition;
  MadeUpFlow flow;
  FluidStatistics statistics;
};

using test::named;

// Means over steps 10 to 30 and the cells that `in` accepts, in extended precision.
struct Plain {
  long double fraction = 0.0, u[3] = {}, uu[3][3] = {};
  template <typename In>
  explicit Plain(In in) {
    long double n = 0.0, all = 0.0;
    for (std::int64_t step = 10; step <= 30; ++step)
      for (int z = 0; z < cells[2]; ++z)
        for (int y = 0; y < cells[1]; ++y)
          for (int x = 0; x < cells[0]; ++x) {
            if (!in(y, z)) continue;
            all += 1.0;
            if (!is_fluid({x, y, z})) continue;
            n += 1.0;
            const Vec3 v = velocity_at({x, y, z}, step);
            for (int a = 0; a < 3; ++a) u[a] += v[a];
            for (int a = 0; a < 3; ++a)
              for (int b = 0; b < 3; ++b) uu[a][b] += static_cast<long double>(v[a]) * v[b];
          }
    fraction = n / all;
    for (int a = 0; a < 3 && n > 0; ++a) u[a] /= n;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3 && n > 0; ++b) uu[a][b] = uu[a][b] / n - u[a] * u[b];
  }
};

void expect_means(const Profile& velocity, const Profile& stress, const Profile& fraction, std::size_t place,
                  const Plain& plain) {
  // A term is rounded by at most 2^-41 of the velocity unit (5 m/s), a product by that of the unit squared; the
  // stress takes the mean's rounding twice.
  const double bound = std::ldexp(1.0, -41) * unit;
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(velocity.values[3 * place + a], static_cast<double>(plain.u[a]), 1.1 * bound);
  constexpr int pairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  for (int p = 0; p < 6; ++p)
    EXPECT_NEAR(stress.values[6 * place + p], static_cast<double>(plain.uu[pairs[p][0]][pairs[p][1]]),
                1.5 * bound * unit);
  EXPECT_NEAR(fraction.values[place], static_cast<double>(plain.fraction), 1e-15);
}

TEST(FluidStatistics, AreThoseOfPlainSums) {
  Bench bench(MPI_COMM_WORLD, true);
  EXPECT_TRUE(std::isnan(bench.statistics.results()[0].value)) << "a mean of nothing";
  bench.watch(0, 30);
  const std::vector<Profile> profiles = bench.statistics.profiles();
  EXPECT_EQ(named(profiles, "reynolds_stress").unit, "m^2/s^2");
  EXPECT_EQ(named(profiles, "section_velocity").shape, (std::vector<std::uint64_t>{8, 9, 3}));
  EXPECT_DOUBLE_EQ(named(profiles, "z").values[3], 3.5 * spacing);
  for (int z = 0; z < cells[2]; ++z) {
    expect_means(named(profiles, "velocity"), named(profiles, "reynolds_stress"), named(profiles, "fluid_fraction"), z,
                 Plain([&](int, int at_z) { return at_z == z; }));
    for (int y = 0; y < cells[1]; ++y)
      expect_means(named(profiles, "section_velocity"), named(profiles, "section_reynolds_stress"),
                   named(profiles, "section_fluid_fraction"), static_cast<std::size_t>(z * cells[1] + y),
                   Plain([&](int at_y, int at_z) { return at_y == y && at_z == z; }));
  }
  const std::vector<Diagnostic> results = bench.statistics.results();
  EXPECT_NEAR(results[0].value, static_cast<double>(Plain([](int, int) { return true; }).u[0]), 1e-11);
  EXPECT_EQ(results[2].value, 21.0);
}

// The same velocity again and again, as of a layer of so many cells.
class LargeFlow final : public FluidSource {
public:
  LargeFlow(const Vec3& velocity, int cells_here) : velocity_(velocity), cells_here_(cells_here) {}
  FluidFields sample(const std::vector<FluidField>&, const Block&) const override { return {}; }
  void for_each_velocity(const VelocityVisitor& visit) const override {
    for (int cell = 0; cell < cells_here_; ++cell) visit({0, 0, 1}, velocity_);
  }
  std::optional<State> state_in(const Index3&) const override { return std::nullopt; }

private:
  Vec3 velocity_;
  int cells_here_;
};

// 64 bits in multiples of 2^-40 end at 2^23 cells of velocity 1.
TEST(FluidStatistics, HoldLayersOfMoreThanEightMillionCells) {
  constexpr int cells_here = 8'500'000;
  const Vec3 velocity(0.995 * unit, 0.0, -0.995 * unit);
  ASSERT_GT(0.995 * cells_here, 0x1p23);
  const Decomposition decomposition(cells, spacing, {true, true, true}, {1, 1, 1});
  FluidStatistics statistics(MPI_COMM_SELF, decomposition, unit, {0.0, time_step}, false);
  const LargeFlow flow(velocity, cells_here);
  Snapshot snapshot;
  snapshot.decomposition = &decomposition;
  snapshot.fluid = &flow;
  SumRange::reset();
  statistics.observe(snapshot);
  EXPECT_FALSE(SumRange::was_left());
  SumRange::reset();
  const std::vector<Profile> profiles = statistics.profiles();
  const double bound = 2.0 * std::ldexp(unit, -41);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(named(profiles, "velocity").values[3 + a], velocity[a], bound);
  for (int p = 0; p < 6; ++p) EXPECT_NEAR(named(profiles, "reynolds_stress").values[6 + p], 0.0, 2.0 * bound * unit);
}

TEST(FluidStatistics, HaveTheSameBitsOnAnyRanksAndAfterARestart) {
  for (const bool sections : {false, true}) {
    Bench alone(MPI_COMM_SELF, sections), shared(MPI_COMM_WORLD, sections), before(MPI_COMM_WORLD, sections),
        after(MPI_COMM_WORLD, sections);
    alone.watch(0, 30);
    shared.watch(0, 30);
    before.watch(0, 17);
    test::load(after.statistics, test::saved(before.statistics, MPI_COMM_WORLD));
    after.watch(17, 30);  // the step of the checkpoint is seen again
    const auto a = alone.statistics.profiles(), b = shared.statistics.profiles(), c = after.statistics.profiles();
    ASSERT_EQ(a.size(), sections ? 8u : 4u);
    for (std::size_t p = 0; p < a.size(); ++p) {
      EXPECT_EQ(a[p].values, b[p].values) << a[p].name;
      EXPECT_EQ(a[p].values, c[p].values) << a[p].name;
    }
  }
}

}  // namespace
}  // namespace thalweg::analysis::fluid_statistics_test
