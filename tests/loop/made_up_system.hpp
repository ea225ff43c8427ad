// A system that goes nowhere, for the tests of the watchdog.
#pragma once

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "loop/watchdog.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace thalweg::loop {

// A system at step 250 of 0.01 s, in a box of 1 m with cells of 0.1 m and three grains of 0.1 m on all ranks; every
// diagnostic is found in the pore between two of them.
class MadeUp : public System {
public:
  MadeUp() : decomposition_({10, 10, 10}, 0.1, {true, true, true}, {1, 1, 1}) {
    const Vec3 places[3] = {Vec3(0.05, 0.5, 0.5), Vec3(0.75, 0.5, 0.5), Vec3(0.4, 0.5, 0.5)};
    for (GlobalId id = 0; id < 3; ++id) {
      if (id % size_of(MPI_COMM_WORLD) != rank_of(MPI_COMM_WORLD)) continue;
      id_.push_back(id + 10);
      position_.push_back(places[id]);
      radius_.push_back(0.1);
    }
  }
  void advance() override {}
  std::int64_t step() const override { return 250; }
  double time_step() const override { return 0.01; }
  Snapshot snapshot() const override {
    Snapshot s;
    s.decomposition = &decomposition_;
    s.grains.global_count = 3;
    s.grains.id = id_;
    s.grains.position = position_;
    s.grains.radius = radius_;
    return s;
  }
  std::vector<Diagnostic> diagnostics() const override { return {}; }
  std::optional<Location> location_of(const std::string& diagnostic) const override {
    if (diagnostic == "nowhere") return std::nullopt;
    return Location{Vec3(0.95, 0.5, 0.5), {}};
  }
  void save(ArchiveWriter&) const override {}
  void load(ArchiveReader&) override {}
  PhaseTimer& timer() override { return timer_; }
  std::int64_t cells() const override { return 1000; }
  std::int64_t grain_steps_per_step() const override { return 0; }

private:
  Decomposition decomposition_;
  std::vector<GlobalId> id_;
  std::vector<Vec3> position_;
  std::vector<double> radius_;
  PhaseTimer timer_;
};

// The message that a look at these diagnostics throws; empty: none.
inline std::string message_of(Watchdog& dog, const std::vector<Diagnostic>& diagnostics) {
  try {
    dog.judge(diagnostics);
  } catch (const RunError& error) {
    return error.what();
  }
  return "";
}

inline void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
}

}  // namespace thalweg::loop
