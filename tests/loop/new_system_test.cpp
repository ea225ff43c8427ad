// A new system, as CONTRIBUTING.md describes it: all that the time loop asks of one, in the fewest lines. A small
// sphere that falls in a viscous fluid, dv/dt = g - v/tau, from rest: v = g tau (1 - exp(-t/tau)).
#include "core/state/system.hpp"
#include "loop/time_loop.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::loop::new_system_test {
namespace {

constexpr double gravity = 9.8, relaxation_time = 0.02, step_length = 0.001;  // m/s^2, s, s

class FallingSphere final : public System {
public:
  // One step of the exact solution.
  void advance() override {
    const auto scope = timer_.measure(timer_.phase("fall"));
    constexpr double terminal = gravity * relaxation_time;
    speed_ = terminal + (speed_ - terminal) * std::exp(-step_length / relaxation_time);
    ++step_;
  }
  std::int64_t step() const override { return step_; }
  double time_step() const override { return step_length; }

  Snapshot snapshot() const override {
    Snapshot snapshot;
    snapshot.time = time();
    snapshot.step = step_;
    return snapshot;
  }
  std::vector<Diagnostic> diagnostics() const override { return {{"speed", "m/s", speed_}}; }

  // Everything the next step depends on. All ranks hold the same sphere.
  void save(ArchiveWriter& archive) const override {
    archive.attribute("sphere/step", step_);
    archive.attribute("sphere/speed", speed_);
  }
  void load(ArchiveReader& archive) override {
    step_ = archive.integer_attribute("sphere/step");
    speed_ = archive.real_attribute("sphere/speed");
  }

  PhaseTimer& timer() override { return timer_; }
  std::int64_t cells() const override { return 0; }
  std::int64_t grain_steps_per_step() const override { return 1; }

private:
  std::int64_t step_ = 0;
  double speed_ = 0.0;  // m/s
  PhaseTimer timer_;
};

// Runs the system to a time (s) in the time loop, with a row every 10 steps. Returns the last speed in the series.
double run(FallingSphere& system, double until) {
  LoopPlan plan;
  plan.until = until;
  plan.series = Schedule(10 * step_length, step_length);
  double speed = 0.0;
  plan.write_row = [&](double, std::int64_t, const std::vector<Diagnostic>& row) {
    speed = find_diagnostic(row, "speed").value();
  };
  std::vector<std::unique_ptr<analysis::Observer>> observers;
  Log log(false);
  TimeLoop loop(MPI_COMM_WORLD, system, observers, plan, log);
  loop.run();
  EXPECT_TRUE(loop.record().finished);
  return speed;
}

TEST(NewSystem, FollowsItsEquationInTheTimeLoop) {
  FallingSphere system;
  EXPECT_NEAR(run(system, 0.05), gravity * relaxation_time * (1.0 - std::exp(-2.5)), 1e-14);
  EXPECT_EQ(system.step(), 50);
}

TEST(NewSystem, ContinuesFromACheckpointWithTheSameBits) {
  FallingSphere whole, first, second;
  run(whole, 0.05);
  run(first, 0.02);
  const auto saved = [](const FallingSphere& system) { return thalweg::test::saved(system, MPI_COMM_WORLD); };
  const thalweg::test::MemoryArchive checkpoint = saved(first);
  thalweg::test::load(second, checkpoint);
  run(second, 0.05);
  EXPECT_EQ(thalweg::test::first_difference(saved(second), saved(whole)), "");
  EXPECT_NE(thalweg::test::first_difference(saved(second), checkpoint), "");
}

}  // namespace
}  // namespace thalweg::loop::new_system_test
