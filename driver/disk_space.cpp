#include "driver/disk_space.hpp"

#include "analysis/probes.hpp"
#include "analysis/tracks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::driver {

namespace {

// Times 0, every, 2 every, ... of a run that starts at 0; 0 for never.
double times_in(double until, double every) {
  return every > 0.0 ? std::floor(until / every * (1.0 + 1e-9)) + 1.0 : 0.0;
}

double fluid_frames(const Case& c, const io::FluidOutputKeys& keys) {
  double values = 0.0;
  for (const FluidField field : keys.fields) values += components_of(field);
  const io::ShownCells cells = shown_cells(keys, cells_of(c.domain), c.domain.spacing);
  return times_in(c.run.until, keys.every) * static_cast<double>(cells.coarse.volume()) * values * 4.0;
}

double fluid_frames(const Case& c) {
  if (!has_fluid(c)) return 0.0;
  double bytes = fluid_frames(c, c.output.fluid);
  for (const io::NamedFluidOutputKeys& part : c.output.fluid_parts) bytes += fluid_frames(c, part);
  return bytes;
}

// Doubles of a grain in a frame (io/grain_series.cpp): place, id, radius, speed, connectivity, two velocities, contact
// force and stress; force of the fluid, its stress.
double grain_frames(const Case& c) {
  double doubles = 3.0 + 3.0 + 2.0 + 6.0 + 3.0 + 9.0;
  if (has_fluid(c)) doubles += 3.0;
  if (c.coupling.grain_stress) doubles += 9.0;
  return times_in(c.run.until, c.output.grains.every) * static_cast<double>(grain_count(c)) * doubles * 8.0;
}

double checkpoints(const Case& c) {
  const Index3 n = cells_of(c.domain);
  const double bytes = c.fluid.precision == coupling::Precision::single ? 4.0 : 8.0;
  const double lattice = has_fluid(c) ? static_cast<double>(n[0]) * n[1] * n[2] * 19.0 * bytes : 0.0;
  // State and loads of a grain, and three contacts with their springs.
  constexpr double grain_bytes = 900.0;
  const double one = lattice + static_cast<double>(grain_count(c)) * grain_bytes;
  const io::CheckpointOutputKeys& keys = c.output.checkpoint;
  const double most = static_cast<double>(keys.keep) + 1.0;
  const double written = keys.every > 0.0 ? std::ceil(c.run.until / keys.every) : keys.every_wall > 0.0 ? most : 1.0;
  return one * std::min(written, most);
}

// tracks.h5 and probes.h5 (docs/input.md).
double records(const Case& c) {
  double bytes = 0.0;
  if (const auto& tracks = c.analysis.observers.of<analysis::TracksKeys>()) {
    const double grains = tracks->grains.empty()
                              ? std::ceil(static_cast<double>(grain_count(c)) / static_cast<double>(tracks->one_in))
                              : static_cast<double>(tracks->grains.size());
    bytes += times_in(c.run.until, tracks->every) * grains * 144.0;
  }
  if (const auto& probes = c.analysis.observers.of<analysis::ProbesKeys>()) {
    double points = static_cast<double>(probes->points.size());
    for (const analysis::ProbeLine& line : probes->lines) points += static_cast<double>(line.points);
    bytes += times_in(c.run.until, probes->every) * points * 4.0 * 8.0;
  }
  return bytes;
}

}  // namespace

std::string bytes_text(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.3g} MB", bytes * 1e-6) : fmt::format("{:.3g} GB", bytes * 1e-9);
}

DiskSpace disk_space(const Case& c) { return {fluid_frames(c), grain_frames(c), checkpoints(c), records(c)}; }

std::string disk_line(const DiskSpace& space) {
  std::string line = "disk       at most about " + bytes_text(space.total()) + ":";
  const std::pair<const char*, double> parts[] = {{"fluid", space.fluid},
                                                  {"grains", space.grains},
                                                  {"checkpoints", space.checkpoints},
                                                  {"probes and tracks", space.records}};
  const char* separator = " ";
  for (const auto& [name, bytes] : parts) {
    if (bytes <= 0.0) continue;
    line += fmt::format("{}{} {}", separator, name, bytes_text(bytes));
    separator = ", ";
  }
  return line;
}

}  // namespace thalweg::driver
