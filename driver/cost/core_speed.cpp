#include "driver/cost/core_speed.hpp"

#include "core/parallel/mpi_session.hpp"
#include "driver/cost/sample_case.hpp"
#include "driver/setup/build_system.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>

namespace thalweg::driver {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Phases that work only where grains are; the others cover all cells.
constexpr std::array<const char*, 7> grain_phases = {"grain map", "refill",      "links",       "loads",
                                                     "grains",    "grain lists", "grain motion"};

// An even number of steps, since the two kinds of lattice step differ. Not before the grains have begun to touch.
CoreSpeed time_steps(System& system) {
  constexpr double settling = 2.0, timing = 4.0;  // s
  Clock::time_point start = Clock::now();
  while (seconds_since(start) < settling) system.advance();
  system.timer().reset();
  start = Clock::now();
  int steps = 0;
  while (seconds_since(start) < timing) {
    system.advance();
    system.advance();
    steps += 2;
  }
  const double all = seconds_since(start) / steps;
  CoreSpeed speed;
  for (const auto& [phase, seconds] : system.timer().seconds())
    if (std::find(grain_phases.begin(), grain_phases.end(), phase) != grain_phases.end())
      speed.of_grains += seconds / steps;
  speed.of_cells = all - speed.of_grains;
  return speed;
}

}  // namespace

CoreSpeed measure_core_speed(const Case& c, MPI_Comm communicator) {
  const Sample sample = sample_of(c);
  const std::unique_ptr<System> system = build_system(sample.c, MPI_COMM_SELF, decomposition_of(sample.c, {1, 1, 1}));
  MPI_Barrier(communicator);
  const CoreSpeed own = time_steps(*system);
  const int cores = size_of(communicator);
  return {cores, sum_over_ranks(communicator, own.of_cells) / (cores * sample.share),
          sum_over_ranks(communicator, own.of_grains) / (cores * sample.share_of_grains)};
}

}  // namespace thalweg::driver
