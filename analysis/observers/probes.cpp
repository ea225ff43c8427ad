#include "analysis/observers/probes.hpp"

#include "core/geometry/layer_at.hpp"
#include "core/parallel/mpi_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::analysis {

namespace {

struct Reading {
  std::size_t point;
  double velocity[3], pressure;
};

}  // namespace

Probes::Probes(MPI_Comm communicator, const Decomposition& decomposition, const std::vector<Vec3>& points, double every)
    : communicator_(communicator), every_(every) {
  const Block block = decomposition.block_of(rank_of(communicator));
  for (const Vec3& point : points) {
    Index3 cell;
    bool here = true;
    for (int a = 0; a < 3; ++a) {
      cell[a] = std::clamp(layer_at(point[a], decomposition.spacing()), 0, decomposition.cells()[a] - 1);
      here = here && cell[a] >= block.lower[a] && cell[a] < block.upper[a];
    }
    if (here) mine_.push_back(cells_.size());
    cells_.push_back(cell);
  }
}

void Probes::observe(const Snapshot& snapshot) {
  if (snapshot.step <= seen_step_) return;
  seen_step_ = snapshot.step;
  ++measurements_;
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  std::vector<Reading> readings;
  for (const std::size_t point : mine_) {
    const std::optional<FluidSource::State> state = snapshot.fluid->state_in(cells_[point]);
    readings.push_back(
        state ? Reading{point, {state->velocity.x(), state->velocity.y(), state->velocity.z()}, state->pressure}
              : Reading{point, {nothing, nothing, nothing}, nothing});
  }
  readings = exchange_rows(communicator_, readings, std::vector<int>(readings.size(), 0));
  if (rank_of(communicator_) != 0) return;
  std::sort(readings.begin(), readings.end(), [](const Reading& a, const Reading& b) { return a.point < b.point; });
  times_.push_back(snapshot.time);
  for (const Reading& reading : readings) {
    velocities_.insert(velocities_.end(), reading.velocity, reading.velocity + 3);
    pressures_.push_back(reading.pressure);
  }
}

std::vector<Diagnostic> Probes::results() const {
  return {{"probes", "1", static_cast<double>(cells_.size())},
          {"probe_measurements", "1", static_cast<double>(measurements_)}};
}

Records Probes::take_records() {
  Records records;
  if (rank_of(communicator_) != 0) return records;
  for (int a = 0; a < 3; ++a) {
    std::vector<std::int64_t> along;
    for (const Index3& cell : cells_) along.push_back(cell[a]);
    records.fixed.push_back({std::string("cell_") + "xyz"[a], "point", std::move(along)});
  }
  const std::uint64_t times = times_.size(), points = cells_.size();
  records.rows.push_back({"time", "s", {"time"}, {}, {times}, std::move(times_)});
  records.rows.push_back(
      {"velocity", "m/s", {"time", "point"}, {"x", "y", "z"}, {times, points, 3}, std::move(velocities_)});
  records.rows.push_back({"pressure", "Pa", {"time", "point"}, {}, {times, points}, std::move(pressures_)});
  times_.clear();
  velocities_.clear();
  pressures_.clear();
  return records;
}

void Probes::save(ArchiveWriter& archive) const {
  archive.attribute("probes/seen_step", seen_step_);
  archive.attribute("probes/measurements", measurements_);
}

bool Probes::load(ArchiveReader& archive) {
  if (!archive.has("probes/seen_step")) return false;
  seen_step_ = archive.integer_attribute("probes/seen_step");
  measurements_ = archive.integer_attribute("probes/measurements");
  return true;
}

static void describe(SectionVisitor& visit, ProbeLine& line) {
  visit.vec3("from", line.from, {.unit = "m", .meaning = "first point"});
  visit.vec3("to", line.to, {.unit = "m", .meaning = "last point"});
  visit.integer("points", line.points, {.meaning = "at equal distances, both ends included", .at_least = 2});
}

void describe(SectionVisitor& visit, ProbesKeys& keys) {
  visit.vec3_list("points", keys.points, {.unit = "m", .meaning = "each is measured in the cell that contains it"});
  visit.list("lines", keys.lines, {.meaning = "rows of points"});
  describe_every(visit, keys.every);
}

namespace {

void require_inside(const Vec3& point, const PeriodicBox& box, const std::string& key) {
  if (lies_in_box(point, box.size)) return;
  throw KeyError(key, fmt::format("the box goes from 0 to ({:g}, {:g}, {:g}) m; give a point in it", box.size.x(),
                                  box.size.y(), box.size.z()));
}

}  // namespace

void check(const ProbesKeys& keys, const RunContext& run) {
  if (keys.points.empty() && keys.lines.empty()) throw KeyError("", "there is no point; give points, lines or both");
  for (std::size_t n = 0; n < keys.points.size(); ++n)
    require_inside(keys.points[n], run.box, fmt::format("points.{}", n));
  for (std::size_t n = 0; n < keys.lines.size(); ++n) {
    require_inside(keys.lines[n].from, run.box, fmt::format("lines.{}.from", n));
    require_inside(keys.lines[n].to, run.box, fmt::format("lines.{}.to", n));
  }
}

std::unique_ptr<Observer> make_observer(const ProbesKeys& keys, const RunContext&, const RunningSystem& system) {
  std::vector<Vec3> points = keys.points;
  for (const ProbeLine& line : keys.lines)
    for (std::int64_t n = 0; n < line.points; ++n)
      points.push_back(line.from +
                       (line.to - line.from) * (static_cast<double>(n) / static_cast<double>(line.points - 1)));
  return std::make_unique<Probes>(system.communicator, system.decomposition, points, keys.every);
}

ObserverMemory memory_of(const ProbesKeys& keys, const RunContext&, const RunSize& size) {
  auto points = static_cast<double>(keys.points.size());
  for (const ProbeLine& line : keys.lines) points += static_cast<double>(line.points);
  constexpr double numbers = 4.0;  // velocity and pressure
  return {.on_first_rank = points * (sizeof(Index3) +
                                     grown_list * kept_measurements(keys.every, size.step) * numbers * sizeof(double))};
}

}  // namespace thalweg::analysis
