// A time loop around a system that only counts its steps, and a record of everything the loop did.
#pragma once

#include "core/parallel/mpi_session.hpp"
#include "loop/stop_request.hpp"
#include "loop/time_loop.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace thalweg::loop::time_loop_bench {

inline const MPI_Comm world = MPI_COMM_WORLD;

using Steps = std::vector<std::int64_t>;

// System that counts its steps, with one diagnostic that is a given function of the step.
class Counter : public System {
public:
  std::function<double(std::int64_t)> lattice_velocity = [](std::int64_t) { return 0.05; };
  std::function<void(std::int64_t)> on_advance = [](std::int64_t) {};
  Steps with_momentum, with_stress;  // that were asked to measure these

  explicit Counter(std::int64_t start = 0) : step_(start) {}
  void advance() override {
    const auto scope = timer_.measure(timer_.phase("counting"));
    ++step_;
    on_advance(step_);
  }
  void record_momentum() override { with_momentum.push_back(step_ + 1); }
  void measure_grain_stress() override { with_stress.push_back(step_ + 1); }
  std::int64_t step() const override { return step_; }
  double time_step() const override { return 0.001; }
  Snapshot snapshot() const override {
    Snapshot snapshot;
    snapshot.time = time();
    snapshot.step = step_;
    return snapshot;
  }
  std::vector<Diagnostic> diagnostics() const override {
    return {{"largest_lattice_velocity", "1", lattice_velocity(step_)}};
  }
  void save(ArchiveWriter&) const override {}
  void load(ArchiveReader&) override {}
  PhaseTimer& timer() override { return timer_; }
  std::int64_t cells() const override { return 1000; }
  std::int64_t grain_steps_per_step() const override { return 20; }

private:
  std::int64_t step_;
  PhaseTimer timer_;
};

class LooksOn : public analysis::Observer {
public:
  explicit LooksOn(double every = 0.0, bool is_lightweight = false) : every_(every), is_lightweight_(is_lightweight) {}
  double every() const override { return every_; }
  bool is_lightweight() const override { return is_lightweight_; }
  std::string name() const override { return "looks_on"; }
  void observe(const Snapshot& snapshot) override { steps.push_back(snapshot.step); }
  std::vector<Diagnostic> diagnostics() const override { return {{"seen", "1", static_cast<double>(steps.size())}}; }
  void save(ArchiveWriter&) const override {}
  bool load(ArchiveReader&) override { return true; }
  std::vector<std::int64_t> steps;

private:
  double every_;
  bool is_lightweight_;
};

// The loop, and a record of what it did.
struct Bench {
  explicit Bench(double until, std::int64_t start = 0) : system(start) {
    listen_for_stop_signals();  // forget the signal of an earlier test
    plan.until = until;
    plan.watch = {{"largest_lattice_velocity", WatchRule::Side::above,
                   [](const std::vector<Diagnostic>&) {
                     return WatchLimits{0.2, 0.3};
                   },
                   "the speed", "Slow down."}};
    plan.series = Schedule(0.003, 0.001);
    plan.checkpoint = Schedule(0.004, 0.001);
    plan.write_row = [this](double, std::int64_t step, const std::vector<Diagnostic>& row) {
      rows.push_back(step);
      columns = row.size();
    };
    plan.write_checkpoint = [this](const LoopRecord&) {
      checkpoints.push_back(system.step());
      return std::uint64_t{0};
    };
    plan.outputs.push_back(
        {"pictures", Schedule(0.005, 0.001), [this](const Snapshot& s) { pictures.push_back(s.step); }});
    auto observer = std::make_unique<LooksOn>();
    looks_on = observer.get();
    observers.push_back(std::move(observer));
  }
  TimeLoop& run() {
    loop = std::make_unique<TimeLoop>(world, system, observers, plan, log);
    loop->run();
    return *loop;
  }
  Counter system;
  std::vector<std::unique_ptr<analysis::Observer>> observers;
  LooksOn* looks_on;
  LoopPlan plan;
  Log log{false};
  std::unique_ptr<TimeLoop> loop;
  std::vector<std::int64_t> rows, checkpoints, pictures;
  std::size_t columns = 0;
};

}  // namespace thalweg::loop::time_loop_bench
