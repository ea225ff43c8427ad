// An observer as a contributor would add it: what the compiler checks of it, its numbers, and its restart.
#include "tests/analysis/observers/centre_of_mass.hpp"

#include "core/parallel/decomposition.hpp"
#include "tests/analysis/made_up_grains.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::analysis::centre_of_mass_test {
namespace {

static_assert(IsObserverKeys<CentreOfMassKeys>);

// Keys that nobody makes an observer of.
struct Orphan : CentreOfMassKeys {
  int needs;  // hides the systems that have it
};
static_assert(!IsObserverKeys<Orphan>);

const MPI_Comm world = MPI_COMM_WORLD;

// Grain n of 0 ... 3 has the mass 1 + n kg and the height n m (plus an offset): z_c = (0 + 2 + 6 + 12)/10 = 2 m.
struct Column {
  std::vector<double> masses;
  std::vector<Vec3> positions;
  std::vector<GlobalId> ids;
  explicit Column(double offset) {
    for (GlobalId id = rank_of(world); id < 4; id += size_of(world)) {
      ids.push_back(id);
      masses.push_back(1.0 + static_cast<double>(id));
      positions.emplace_back(0.0, 0.0, static_cast<double>(id) + offset);
    }
  }
  Snapshot at(double time) const {
    Snapshot snapshot;
    snapshot.time = time;
    snapshot.step = std::llround(100.0 * time);
    snapshot.grains.global_count = 4;
    snapshot.grains.id = ids;
    snapshot.grains.mass = masses;
    snapshot.grains.position = positions;
    return snapshot;
  }
};

std::unique_ptr<Observer> observer(double from) {
  const Decomposition decomposition({4, 4, 4}, 1.0, {true, true, false}, {1, 1, 1});
  return make_observer(CentreOfMassKeys{.from = from}, RunContext{}, {world, decomposition, 0.01});
}

TEST(CentreOfMass, IsInEveryRowAndItsMeanFromATimeOn) {
  const auto made = observer(1.0);
  EXPECT_EQ(made->name(), "centre_of_mass");
  EXPECT_EQ(made->every(), 0.01);
  made->observe(Column(0.5).at(0.5));  // before the mean begins
  EXPECT_EQ(value_of(made->diagnostics(), "centre_of_mass"), 2.5);
  EXPECT_TRUE(std::isnan(value_of(made->results(), "centre_of_mass_mean")));
  made->observe(Column(0.0).at(1.0));
  made->observe(Column(1.0).at(1.5));
  made->observe(Column(1.0).at(1.5));  // the same step does not count twice
  EXPECT_EQ(value_of(made->results(), "centre_of_mass_mean"), 2.5);
  EXPECT_EQ(value_of(made->results(), "measurements"), 2.0);
}

TEST(CentreOfMass, ContinuesAfterARestartIfTheMeanBeginsAtTheSameTime) {
  const auto first = observer(1.0);
  first->observe(Column(0.0).at(1.0));
  test::MemoryArchive checkpoint;
  test::MemoryWriter writer(checkpoint, world);
  first->save(writer);
  for (const double from : {1.0, 1.2}) {
    const auto second = observer(from);
    test::MemoryReader reader(checkpoint);
    EXPECT_EQ(second->load(reader), from == 1.0);
    second->observe(Column(0.0).at(1.0));  // the state of the checkpoint once more
    second->observe(Column(1.0).at(1.5));
    EXPECT_EQ(value_of(second->results(), "centre_of_mass_mean"), from == 1.0 ? 2.5 : 3.0);
  }
}

}  // namespace
}  // namespace thalweg::analysis::centre_of_mass_test
