#include "driver/cost/run_cost.hpp"

#include "driver/bed/supplied_grains.hpp"
#include "driver/cost/machine.hpp"
#include "driver/input/run_context.hpp"

#include <algorithm>
#include <cmath>
#include <experimental/simd>

namespace thalweg::driver {

namespace {

// Costs on one core. Where memory is slow, a cell takes cell_cost times the traffic of the sweep alone, with halo,
// walls and output; where it is fast, arithmetic bounds the cell, as it bounds every link. Vectors of 16 floats have
// twice the registers of those of 8. Measured: a link 8e-9 s on AMD Zen 5, 13e-9 on Zen 4, 19e-9 on Intel Sapphire
// Rapids, all with 16, and 20e-9 on Zen 3 with 8; in double precision half as much again. Grain-steps: 20e6 to 39e6 per
// second. The flume, the wide bed and the quickstart run within a third of the estimate on the three of AMD.
constexpr bool wide_vectors = std::experimental::native_simd<float>::size() >= 16;
constexpr double cell_cost = 1.8;
constexpr double cell_seconds = wide_vectors ? 6e-9 : 17e-9, link_seconds = wide_vectors ? 12e-9 : 20e-9;
constexpr double cost_of_doubles = 1.5;
constexpr double grain_steps_per_second = 22e6;
constexpr double model_fluid_steps_per_second = 4e6;  // all grains moving; three times that where few do

// Bytes: of a process with the libraries it has loaded, MPI's above all; per cell 19 populations, streamed in place,
// and flags; per link a record; per grain its columns, neighbours, history and its row of a frame. Several ranks have
// rows twice while they sort them, those of a checkpoint or those of a frame, which have more columns.
constexpr double program_bytes = 49e6;
constexpr double flag_bytes = 16.0, link_bytes = 32.0, grain_bytes = 1150.0;
constexpr double checkpoint_row_bytes = 100.0, frame_row_bytes = 350.0;

}  // namespace

double links_of_sphere(double cells_across) { return 15.8 * cells_across * cells_across; }
double link_count(const Case& c) {
  double links = 0.0;
  for (const beds::Population& population : c.grains)
    for (const beds::SizeCount& size : population.sizes_of_grains())
      links += static_cast<double>(size.count) * links_of_sphere(size.diameter / c.domain.spacing);
  return has_fluid(c) ? links : 0.0;
}

double bytes_per_value(const Case& c) { return c.fluid.precision == coupling::Precision::single ? 4.0 : 8.0; }
double bytes_of_cell(const Case& c) { return 19.0 * bytes_per_value(c) + flag_bytes; }
double bytes_of_lattice(const Case& c) {
  if (!has_fluid(c)) return 0.0;
  const Index3 n = cells_of(c.domain);
  return static_cast<double>(n[0]) * n[1] * n[2] * 19.0 * bytes_per_value(c);
}
double bytes_of_program() { return program_bytes; }
double bytes_of_grain(const Case& c, int ranks) {
  if (ranks == 1) return grain_bytes;
  return grain_bytes + (c.output.grains.every > 0.0 ? frame_row_bytes : checkpoint_row_bytes);
}
double bytes_of_placing(const Case& c, int ranks) {
  // Bytes in the case, on every rank: a position, and a diameter while the median of all is found; around a rank's
  // block.
  constexpr double position = 24.0, diameter = 50.0, random_sphere = 130.0;
  double bytes = 0.0;
  for (const beds::Population& population : c.grains) {
    if (population.from_file()) continue;
    const auto rows = static_cast<double>(population.row_count());
    bytes += diameter * static_cast<double>(population.diameters.size());
    if (!population.placement.positions.empty())
      bytes += position * rows;
    else if (population.placement.pattern != beds::PlacementPattern::uniform)
      bytes += random_sphere * rows / ranks;
  }
  return bytes;
}
double bytes_of_bed_rows(const Case& c, int ranks) {
  double rows = 0.0;
  for (const beds::Population& population : c.grains) rows += static_cast<double>(population.figures.rows);
  return rows / ranks * sizeof(BedGrain);
}
double bytes_of_sizes(const Case& c) {
  double bytes = 0.0;
  for (const beds::Population& population : c.grains)
    bytes += static_cast<double>(population.diameters.size()) * sizeof(double) +
             static_cast<double>(population.figures.sizes.size()) * sizeof(beds::SizeCount);
  return bytes;
}
analysis::ObserverMemory memory_of_observers(const Case& c) {
  analysis::ObserverMemory memory = memory_of(c.analysis.observers, run_context(c), {ids_of_run(c), step_time(c)});
  // Where ids are added, what is kept of them grows now and then, to twice the size.
  if (!c.supplies.empty()) memory.of_ids *= analysis::grown_list;
  // Not at the same time as a frame is written.
  memory.while_saved = std::max(0.0, memory.while_saved - frame_row_bytes * static_cast<double>(most_rows(c)));
  return memory;
}
double bytes_of_links(const Case& c) { return link_count(c) * link_bytes; }

Cost cost_of(const Case& c, double bandwidth) {
  const Index3 n = cells_of(c.domain);
  Cost cost{};
  cost.cells = has_fluid(c) ? static_cast<double>(n[0]) * n[1] * n[2] : 0.0;
  cost.steps = std::ceil(c.run.until / step_time(c) * (1.0 - 1e-12));
  cost.cell_updates = cost.cells * cost.steps;
  const double growth = mean_growth(c);
  cost.grain_steps = growth * static_cast<double>(grain_rows(c)) * static_cast<double>(grain_steps(c)) * cost.steps;
  const double of_memory = bandwidth > 0.0 ? cell_cost * bytes_per_cell_update(bytes_per_value(c)) / bandwidth : 0.0;
  const double precision = c.fluid.precision == coupling::Precision::single ? 1.0 : cost_of_doubles;
  cost.core_seconds =
      cost.cell_updates * std::max(of_memory, precision * cell_seconds) +
      cost.steps * growth * link_count(c) * precision * link_seconds +
      cost.grain_steps / (c.system == SystemKind::model_fluid ? model_fluid_steps_per_second : grain_steps_per_second);
  return cost;
}

}  // namespace thalweg::driver
