#include "loop/phase_shares.hpp"

#include "core/parallel/mpi_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <utility>

namespace thalweg::loop {

namespace {

using Phases = std::vector<std::pair<std::string, double>>;

Phases phases_of_this_rank(System& system, TimeLoop& loop) {
  Phases phases = system.timer().seconds();
  for (const auto& phase : loop.timer().seconds()) phases.push_back(phase);
  double rest = loop.record().wall_seconds;
  for (const auto& [name, seconds] : phases) rest -= seconds;
  phases.emplace_back("other", std::max(0.0, rest));
  return phases;
}

// All ranks' phases on rank 0 as text lines "name\tseconds".
std::string gather_phases(MPI_Comm communicator, const Phases& phases) {
  std::string mine;
  for (const auto& [name, seconds] : phases) mine += fmt::format("{}\t{}\n", name, seconds);
  const int ranks = size_of(communicator), length = static_cast<int>(mine.size());
  std::vector<int> lengths(ranks, 0), starts(ranks, 0);
  MPI_Gather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, communicator);
  for (int r = 1; r < ranks; ++r) starts[r] = starts[r - 1] + lengths[r - 1];
  std::string all(static_cast<std::size_t>(starts.back() + lengths.back()), '\0');
  MPI_Gatherv(mine.data(), length, MPI_CHAR, all.data(), lengths.data(), starts.data(), MPI_CHAR, 0, communicator);
  return all;
}

}  // namespace

std::vector<PhaseShare> collect_phases(MPI_Comm communicator, System& system, TimeLoop& loop) {
  std::istringstream lines(gather_phases(communicator, phases_of_this_rank(system, loop)));
  const double ranks = size_of(communicator);
  const double wall = std::max(1e-9, loop.record().wall_seconds);
  std::vector<PhaseShare> phases;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t tab = line.find('\t');
    const std::string name = line.substr(0, tab);
    const double seconds = std::strtod(line.c_str() + tab + 1, nullptr);
    auto phase = std::find_if(phases.begin(), phases.end(), [&](const PhaseShare& p) { return p.name == name; });
    if (phase == phases.end()) phase = phases.insert(phases.end(), {name, 0.0, 0.0, 0.0});
    phase->mean_seconds += seconds / ranks;
    phase->largest_seconds = std::max(phase->largest_seconds, seconds);
    phase->share = phase->mean_seconds / wall;
  }
  // "other" last, also where a later rank had a phase of its own.
  std::stable_partition(phases.begin(), phases.end(), [](const PhaseShare& p) { return p.name != "other"; });
  return phases;
}

std::vector<std::string> phase_table(const std::vector<PhaseShare>& phases) {
  std::size_t width = 5;
  for (const PhaseShare& phase : phases) width = std::max(width, phase.name.size());
  std::vector<std::string> lines{
      fmt::format("{:<{}}  {:>10}  {:>10}  {:>6}", "phase", width, "mean s", "slowest s", "share")};
  for (const PhaseShare& phase : phases)
    lines.push_back(fmt::format("{:<{}}  {:>10.3f}  {:>10.3f}  {:>4.1f} %", phase.name, width, phase.mean_seconds,
                                phase.largest_seconds, 100.0 * phase.share));
  return lines;
}

Speeds speeds_of(const System& system, const LoopRecord& record) {
  const auto steps = static_cast<double>(record.last_step - record.first_step);
  const double rate = record.wall_seconds > 0.0 ? steps / record.wall_seconds : 0.0;
  const double advancing = record.advance_seconds > 0.0 ? steps / record.advance_seconds : 0.0;
  const auto cells = static_cast<double>(system.cells());
  return {rate, rate * cells * 1e-6, advancing * cells * 1e-6,
          rate * static_cast<double>(system.grain_steps_per_step())};
}

}  // namespace thalweg::loop
