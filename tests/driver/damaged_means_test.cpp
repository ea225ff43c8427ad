// Observers on a checkpoint that has lost rows, and where they keep records.
#include "driver/input/run_context.hpp"
#include "driver/setup/build_system.hpp"
#include "driver/setup/run_history.hpp"
#include "io/folder/run_folder.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/support/damaged_archive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace thalweg::driver::damaged_means_test {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

// Some grains that fall in water, and all that can be measured of them.
const std::string watched = R"(system: resolved
domain:
  size: [0.024, 0.012, 0.016]
  spacing: 0.8e-3
  boundaries: {x: periodic, y: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-5, time_step: 1.0e-4}
gravity: {magnitude: 9.8, slope: 0.05}
grains:
  - {count: 4, diameter: 4.0e-3, density: 2550, placement: {pattern: random, seed: 1}}
contact: {restitution: 0.9, friction: 0.3}
run: {until: 1}
output: {series: {every: 1.0e-4}}
analysis:
  fluid_statistics: {every: 1.0e-4}
  probes: {points: [[0.006, 0.006, 0.012]], every: 1.0e-4}
  transport_rate: {}
  fractional_transport: {}
  reach: {every: 1.0e-4, record_every: 2.0e-4}
  bed_surface: {every: 1.0e-4, static_time: 2.0e-4}
  grain_profiles: {every: 1.0e-4}
  stress_balance: {every: 1.0e-4}
  population_loads: {}
  tracks: {grains: [0, 2], every: 1.0e-4}
  entrainment: {grains: [0, 1]}
)";

struct Watched {
  Case c = testing::read_text(watched);
  Decomposition cuts = decomposition_of(c, choose_layout(c, size_of(world), {}));
  std::unique_ptr<System> system = build_system(c, world, cuts);
  Observers observers =
      make_observers(c.analysis.observers, run_context(c), {world, *system->snapshot().decomposition, 1e-4});

  void run(int steps) {
    for (int n = 0; n < steps; ++n) {
      system->record_momentum();
      system->measure_grain_stress();
      system->advance();
      for (auto& observer : observers) observer->observe(system->snapshot());
    }
  }
  test::MemoryArchive saved(const RunHistory& history) const {
    return test::saved(history, world, observers, c.output.series.every);
  }
};

// A run says which means begin anew (RunHistory::since).
TEST(DamagedMeans, AreRefusedOrSaidToBeginAnew) {
  Watched first;
  first.run(6);
  const test::MemoryArchive whole = first.saved({});
  Watched again;
  // The whole one goes on as it is: what is refused below is so for its loss.
  RunHistory undamaged;
  EXPECT_FALSE(test::is_refused(whole, [&](test::MemoryReader& reader) {
    undamaged = RunHistory::load(reader, *again.system, again.observers, again.c.output.series.every);
  }));
  EXPECT_TRUE(undamaged.since.empty());
  for (const test::Loss& loss : test::losses_of(whole)) {
    RunHistory history;
    again.observers = make_observers(again.c.analysis.observers, run_context(again.c),
                                     {world, *again.system->snapshot().decomposition, 1e-4});
    const bool refused = test::is_refused(loss.left, [&](test::MemoryReader& reader) {
      history = RunHistory::load(reader, *again.system, again.observers, again.c.output.series.every);
    });
    if (refused || !history.since.empty()) continue;
    EXPECT_EQ(test::first_difference(whole, again.saved({})), "") << loss.what;
  }
}

// A run folder is cleared of them, and of those that a restart leaves behind.
TEST(RecordFolders, AreKnownOfAllObserversThatHaveSome) {
  const std::vector<std::string> known = io::RunFolder::names_of_records();
  const Watched watched_run;
  for (const auto& observer : watched_run.observers)
    EXPECT_EQ(std::count(known.begin(), known.end(), observer->name()), observer->has_records() ? 1 : 0)
        << observer->name();
}

// Nothing that settings could mean is left of a dataset without rows.
TEST(DamagedMeans, AreRefusedWithoutTheirRows) {
  Watched first;
  first.run(6);
  const test::MemoryArchive whole = first.saved({});
  EXPECT_GT(whole.datasets.size(), 20u);
  const auto refuses = [&](const test::MemoryArchive& archive) {
    Observers observers = make_observers(first.c.analysis.observers, run_context(first.c),
                                         {world, *first.system->snapshot().decomposition, 1e-4});
    return test::is_refused(archive, [&](test::MemoryReader& reader) {
      RunHistory::load(reader, *first.system, observers, first.c.output.series.every);
    });
  };
  EXPECT_FALSE(refuses(whole));
  int lost = 0;
  for (const test::Loss& loss : test::losses_of(whole)) {
    if (!loss.what.starts_with("the rows")) continue;
    EXPECT_TRUE(refuses(loss.left)) << loss.what;
    ++lost;
  }
  EXPECT_GT(lost, 10);
}

}  // namespace
}  // namespace thalweg::driver::damaged_means_test
