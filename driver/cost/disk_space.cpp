#include "driver/cost/disk_space.hpp"

#include "analysis/observers/population_loads.hpp"
#include "analysis/observers/probes.hpp"
#include "analysis/observers/tracks.hpp"
#include "analysis/reach/reach_keys.hpp"
#include "dem/motion/grain_volume.hpp"
#include "driver/bed/reference_grain.hpp"
#include "driver/bed/supplied_grains.hpp"
#include "driver/case/solid_setup.hpp"
#include "driver/cost/run_cost.hpp"
#include "driver/input/run_context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::driver {

namespace {

// Times 0, every, 2 every, ... of a run that starts at 0, no more than it has steps; 0 for never.
double times_in(const Case& c, double every) {
  return every > 0.0 ? std::floor(c.run.until / std::max(every, step_time(c)) * (1.0 + 1e-9)) + 1.0 : 0.0;
}

// Bytes of the XML of a frame with so many arrays, with the head of each (io/vtk/vtk_xml_file.cpp) and the line of the
// frame in its .pvd: 15 of one grain are 2.9 kB.
double bytes_of_xml(std::size_t arrays) { return 1000.0 + 150.0 * static_cast<double>(arrays); }

double fluid_frames(const Case& c, const io::FluidOutputKeys& keys) {
  const double real = keys.precision == io::FieldPrecision::double_ ? 8.0 : 4.0;
  double bytes = 0.0;
  for (const FluidField field : keys.fields)
    bytes += components_of(field) * (field == FluidField::grain_id ? 4.0 : real);
  const io::ShownCells cells = shown_cells(keys, cells_of(c.domain), c.domain.spacing);
  return times_in(c, keys.every) *
         (bytes_of_xml(keys.fields.size()) + static_cast<double>(cells.coarse.volume()) * bytes);
}

double fluid_frames(const Case& c) {
  if (!has_fluid(c)) return 0.0;
  double bytes = fluid_frames(c, c.output.fluid);
  for (const io::NamedFluidOutputKeys& part : c.output.fluid_parts) bytes += fluid_frames(c, part);
  return bytes;
}

// Bytes of one frame of so many grains (io/vtk/grain_series.cpp): eight for each number of the position, radius,
// connectivity, offset and fields of each.
double grain_frame(const Case& c, const std::vector<io::GrainField>& fields, double grains) {
  const io::GrainOutputFacts facts = grain_output_facts(c);
  int numbers = 3 + 1 + 2;
  std::size_t arrays = 4;
  for (const NamedChoice<io::GrainField>& field : io::grain_fields()) {
    const bool wanted = fields.empty() ? there_is(field.value, facts)
                                       : std::find(fields.begin(), fields.end(), field.value) != fields.end();
    if (!wanted || field.value == io::GrainField::radius) continue;
    numbers += components_of(field.value);
    ++arrays;
  }
  return bytes_of_xml(arrays) + 8.0 * numbers * grains;
}

// Upper bound of the number of grains in a part: in a box, as many of the smallest spheres as can have their centres
// there.
double shown_grains(const Case& c, const io::GrainSelectionKeys& keys) {
  double count = static_cast<double>(
      keys.population ? c.grains.at(static_cast<std::size_t>(*keys.population)).row_count() : most_rows(c));
  if (!keys.ids.empty()) count = std::min(count, static_cast<double>(keys.ids.size()));
  if (!keys.box || c.disks || grain_output_facts(c).clumps) return count;
  const double d = smallest_diameter(c), densest = std::numbers::pi / std::sqrt(18.0);
  const double room = (keys.box->upper - keys.box->lower + Vec3::Constant(d)).prod();
  return std::min(count, std::ceil(densest * room / dem::grain_volume(0.5 * d, 0.0)));
}

double grain_frames(const Case& c) {
  const io::GrainOutputKeys& all = c.output.grains;
  double bytes = times_in(c, all.every) * grain_frame(c, all.fields, shown_grains(c, {}));
  for (const io::NamedGrainOutputKeys& part : c.output.grain_parts)
    bytes += times_in(c, part.every) * grain_frame(c, part.fields, shown_grains(c, part));
  return bytes;
}

// Solids that all stand still have one frame (io/vtk/solid_series.cpp).
double solid_frames(const Case& c) {
  const std::set<double> intervals = solid_frames_every(c);
  if (c.solids.empty() || intervals.empty()) return 0.0;
  double frames = 1.0;
  if (any_solid_moves(c)) {
    frames = 0.0;
    for (const double every : intervals) frames += times_in(c, every);
  }
  constexpr std::size_t arrays = 5;
  double bytes = bytes_of_xml(arrays);
  for (const TriangleMesh& mesh : solid_surfaces(c, 0.0))
    bytes += 24.0 * static_cast<double>(mesh.points.size()) + 40.0 * static_cast<double>(mesh.triangles.size());
  return bytes * frames;
}

// By wall time there may be as many as are kept, however rare those by simulated time are.
double checkpoints(const Case& c) {
  const io::CheckpointOutputKeys& keys = c.output.checkpoint;
  const double most = static_cast<double>(keys.keep) + 1.0;
  const double written = keys.every_wall > 0.0 ? most : keys.every > 0.0 ? std::ceil(c.run.until / keys.every) : 1.0;
  return bytes_of_checkpoint(c) * std::min(written, most);
}

// Rows of series.csv: at most about 40 columns of the state and of what comes and goes, some of each analysis, and the
// components of loads. A number takes up to 18 bytes.
double series_rows(const Case& c) {
  constexpr double number_bytes = 18.0, of_state = 40.0, of_analysis = 4.0, of_body = 12.0, of_wall = 6.0;
  double columns = of_state + of_body * static_cast<double>(c.solids.size());
  c.analysis.observers.for_each([&](const auto& keys) { columns += keys ? of_analysis : 0.0; });
  if (c.analysis.observers.of<analysis::PopulationLoadsKeys>())
    columns += of_body * static_cast<double>(c.grains.size());
  if (c.analysis.wall_forces) columns += of_wall * static_cast<double>(c.domain.faces.size() + c.walls.size());
  return times_in(c, c.output.series.every) * columns * number_bytes;
}

// Tracks, probes and the reach (docs/input.md).
double records(const Case& c) {
  double bytes = 0.0;
  if (const auto& tracks = c.analysis.observers.of<analysis::TracksKeys>()) {
    const double grains = tracks->grains.empty()
                              ? std::ceil(static_cast<double>(grain_rows(c)) / static_cast<double>(tracks->one_in))
                              : static_cast<double>(tracks->grains.size());
    bytes += times_in(c, tracks->every) * grains * (grain_output_facts(c).clumps ? 176.0 : 144.0);
  }
  if (const auto& probes = c.analysis.observers.of<analysis::ProbesKeys>()) {
    double points = static_cast<double>(probes->points.size());
    for (const analysis::ProbeLine& line : probes->lines) points += static_cast<double>(line.points);
    bytes += times_in(c, probes->every) * points * 4.0 * 8.0;
  }
  if (const auto& reach = c.analysis.observers.of<analysis::ReachKeys>(); reach && !c.grains.empty()) {
    const auto sections = static_cast<double>(
        reach->sections.value_or(analysis::default_sections(c.domain.size.x(), reference_grain(c).diameter)));
    bytes += times_in(c, reach->record_every) * (2.0 + 9.0 * sections) * 8.0;
  }
  return bytes;
}

}  // namespace

double bytes_of_checkpoint(const Case& c) {
  // State and loads of a grain, and three contacts with their springs; groups and attributes of the file.
  constexpr double grain_bytes = 900.0, file_bytes = 40e3;
  return file_bytes + bytes_of_lattice(c) + static_cast<double>(most_rows(c)) * grain_bytes;
}

std::string bytes_text(double bytes) {
  if (bytes >= 1e12) return fmt::format("{:.3g} TB", bytes * 1e-12);
  return bytes < 1e9 ? fmt::format("{:.3g} MB", bytes * 1e-6) : fmt::format("{:.3g} GB", bytes * 1e-9);
}

DiskSpace disk_space(const Case& c) {
  return {fluid_frames(c), grain_frames(c), solid_frames(c), checkpoints(c), series_rows(c), records(c)};
}

std::string disk_line(const DiskSpace& space, double free) {
  std::string line = "disk       at most about " + bytes_text(space.total());
  if (space.total() > free) line += fmt::format(", more than the {} that are free in this folder", bytes_text(free));
  line += ":";
  const std::pair<const char*, double> parts[] = {{"fluid", space.fluid},   {"grains", space.grains},
                                                  {"solids", space.solids}, {"checkpoints", space.checkpoints},
                                                  {"series", space.series}, {"records", space.records}};
  const char* separator = " ";
  for (const auto& [name, bytes] : parts) {
    if (bytes <= 0.0) continue;
    line += fmt::format("{}{} {}", separator, name, bytes_text(bytes));
    separator = ", ";
  }
  return line;
}

}  // namespace thalweg::driver
