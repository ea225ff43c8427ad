#include "driver/cost/scaling_table.hpp"

#include "driver/cost/disk_space.hpp"
#include "driver/cost/load_balance.hpp"
#include "driver/setup/build_system.hpp"
#include "loop/progress.hpp"

#include <fmt/format.h>

#include <cmath>

namespace thalweg::driver {

namespace {

std::string row(const Case& c, int ranks, const CoreSpeed& speed, const Network& network) {
  const Index3 layout = choose_layout(c, ranks, std::nullopt);
  const SlowestRank slowest = slowest_rank(c, planned_partition(c, layout), speed, network);
  const RankWork& work = slowest.work;
  const double step = slowest.times.sum(), seconds = step * std::ceil(c.run.until / step_time(c) * (1.0 - 1e-12));
  return fmt::format(
      "{:>7}  {:>12} {:>10.0f} {:>9.0f} {:>8.0f} {:>9} {:>9.0f} {:>9} {:>9.3g} {:>8.0f} {:>10.0f} {:>13} {:>10.3g}",
      ranks, fmt::format("{} x {} x {}", layout[0], layout[1], layout[2]), work.cells, work.grains, work.ghosts,
      bytes_text(work.memory), work.messages, bytes_text(work.bytes), 1e3 * step,
      100.0 * (1.0 - slowest.times.computing / step), 100.0 * speed.step() / (step * ranks), loop::clock_text(seconds),
      seconds * ranks / 3600.0);
}

}  // namespace

std::vector<std::string> scaling_table(const Case& c, const std::vector<int>& ranks, const CoreSpeed& speed,
                                       const Network& network) {
  std::vector<std::string> lines{
      fmt::format(
          "ranks      measured on {} core{} of this machine at once: {:.4g} ms per step on one, {:.4g} for cells and "
          "{:.4g} for grains",
          speed.cores, speed.cores == 1 ? "" : "s", 1e3 * speed.step(), 1e3 * speed.of_cells, 1e3 * speed.of_grains),
      fmt::format("           predicted for a latency of {:g} s, {:g} s to send a message and {:g} GB/s per rank; "
                  "figures of the slowest rank:",
                  network.latency, network.overhead, 1e-9 * network.bandwidth),
      fmt::format("{:>7}  {:>12} {:>10} {:>9} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8} {:>10} {:>13} {:>10}", "ranks",
                  "layout", "cells", "grains", "ghosts", "memory", "messages", "sent", "ms a step", "waits %",
                  "efficiency", "time", "core-hours")};
  for (const int number : ranks) lines.push_back(row(c, number, speed, network));
  return lines;
}

}  // namespace thalweg::driver
