// An observer of a user, on a copy of analysis/ that extend.py has extended: what the compiler checks of it, its keys
// in a case, its numbers, and its restart.
#include "analysis/observers/observer_list.hpp"

#include "tests/analysis/made_up_grains.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::analysis::new_observer_test {
namespace {

static_assert(IsObserverKeys<CentreOfMassKeys>);

// Keys that nobody makes an observer of.
struct Orphan : CentreOfMassKeys {
  int needs;  // hides the systems that have it
};
static_assert(!IsObserverKeys<Orphan>);

const MPI_Comm world = MPI_COMM_WORLD;

// Grain n of 0 ... 3 has the mass 1 + n kg and the height n m (plus an offset): z_c = (0 + 2 + 6 + 12)/10 = 2 m.
MadeUpGrains column(double offset) {
  return {world, 4, [offset](GlobalId id) {
            const auto n = static_cast<double>(id);
            return MadeUpGrain{.mass = 1.0 + n, .position = Vec3(0.0, 0.0, n + offset)};
          }};
}

RequestedObservers requested(double from) {
  RequestedObservers requested;
  requested.of<CentreOfMassKeys>() = CentreOfMassKeys{.from = from};
  return requested;
}

RunContext run_of_grains() {
  RunContext run;
  run.until = 2.0;
  run.grains.emplace();
  return run;
}

std::unique_ptr<Observer> observer(double from) {
  const Decomposition decomposition = made_up_box();
  return std::move(make_observers(requested(from), run_of_grains(), {world, decomposition, 0.01}).front());
}

TEST(CentreOfMass, IsInTheListOfObservers) {
  EXPECT_TRUE(warnings(requested(1.0), run_of_grains()).empty());
  EXPECT_NE(warnings(requested(3.0), run_of_grains()).at(0).find("analysis.centre_of_mass.from: 1."),
            std::string::npos);
  const Decomposition decomposition = made_up_box();
  EXPECT_TRUE(make_observers(requested(1.0), RunContext{}, {world, decomposition, 0.01}).empty());  // no grains
}

TEST(CentreOfMass, IsInEveryRowAndItsMeanFromATimeOn) {
  const auto made = observer(1.0);
  EXPECT_EQ(made->name(), "centre_of_mass");
  EXPECT_EQ(made->every(), 0.01);
  made->observe(column(0.5).snapshot(0.5));  // before the mean begins
  EXPECT_EQ(value_of(made->diagnostics(), "centre_of_mass"), 2.5);
  EXPECT_TRUE(std::isnan(value_of(made->results(), "centre_of_mass_mean")));
  made->observe(column(0.0).snapshot(1.0));
  made->observe(column(1.0).snapshot(1.5));
  made->observe(column(1.0).snapshot(1.5));  // the same step does not count twice
  EXPECT_EQ(value_of(made->results(), "centre_of_mass_mean"), 2.5);
  EXPECT_EQ(value_of(made->results(), "measurements"), 2.0);
}

TEST(CentreOfMass, ContinuesAfterARestartIfTheMeanBeginsAtTheSameTime) {
  const auto first = observer(1.0);
  first->observe(column(0.0).snapshot(1.0));
  const test::MemoryArchive checkpoint = test::saved(*first, world);
  for (const double from : {1.0, 1.2}) {
    const auto second = observer(from);
    EXPECT_EQ(test::load(*second, checkpoint), from == 1.0);
    second->observe(column(0.0).snapshot(1.0));  // the state of the checkpoint once more
    second->observe(column(1.0).snapshot(1.5));
    EXPECT_EQ(value_of(second->results(), "centre_of_mass_mean"), from == 1.0 ? 2.5 : 3.0);
  }
}

}  // namespace
}  // namespace thalweg::analysis::new_observer_test
