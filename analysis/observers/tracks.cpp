#include "analysis/observers/tracks.hpp"

#include "core/parallel/mpi_session.hpp"
#include "core/state/whole_dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace thalweg::analysis {

namespace {

constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();

bool is_there(const GrainRecord& record) { return record.id >= 0; }

Look look_at(const GrainRecord& record) { return {record[GrainRecord::position], record[GrainRecord::velocity]}; }

double speed_of(const GrainRecord& record) { return is_there(record) ? record[GrainRecord::velocity].norm() : 0.0; }

}  // namespace

Tracks::Tracks(MPI_Comm communicator, std::vector<GlobalId> grains, double every, bool clumps,
               std::optional<double> diameter)
    : communicator_(communicator),
      grains_(std::move(grains)),
      every_(every),
      clumps_(clumps),
      diameter_(diameter),
      since_(GrainRecord::quantities) {}

std::size_t Tracks::index_of(GlobalId id) const {
  return static_cast<std::size_t>(std::lower_bound(grains_.begin(), grains_.end(), id) - grains_.begin());
}

void Tracks::observe(const Snapshot& snapshot) {
  if (snapshot.step <= seen_step_) return;
  seen_step_ = snapshot.step;
  ++measurements_;
  std::vector<GrainRecord> records;
  for (std::size_t n = 0; n < snapshot.grains.id.size(); ++n)
    if (std::binary_search(grains_.begin(), grains_.end(), snapshot.grains.id[n]))
      records.push_back(record_of(snapshot.grains, n));
  records = exchange_rows(communicator_, records, std::vector<int>(records.size(), 0));
  if (rank_of(communicator_) == 0) {
    records = in_order(records);
    if (!last_.empty()) go_on(records, snapshot.time - last_time_, snapshot.decomposition->box());
    times_.push_back(snapshot.time);
    for (const GrainRecord& record : records)
      for (std::size_t v = 0; v < record.values.size(); ++v) since_[v / 3].push_back(record.values[v]);
    last_ = std::move(records);
  }
  last_time_ = snapshot.time;
  if (clumps_) record_orientations(snapshot);
}

std::vector<GrainRecord> Tracks::in_order(const std::vector<GrainRecord>& records) const {
  GrainRecord absent;
  absent.values.fill(nowhere);
  std::vector<GrainRecord> rows(grains_.size(), absent);
  for (const GrainRecord& record : records) rows[index_of(record.id)] = record;
  return rows;
}

void Tracks::record_orientations(const Snapshot& snapshot) {
  struct Turned {
    GlobalId id;
    std::array<double, 4> orientation;
  };
  const GrainView& grains = snapshot.grains;
  std::map<GlobalId, std::array<double, 4>> of_clump;
  for (const ClumpState& clump : grains.clumps) of_clump[clump.id] = clump.orientation;
  std::vector<Turned> turned;
  for (std::size_t n = 0; n < grains.id.size(); ++n) {
    if (!std::binary_search(grains_.begin(), grains_.end(), grains.id[n])) continue;
    turned.push_back({grains.id[n], {1.0, 0.0, 0.0, 0.0}});
    if (grains.is_member(n)) turned.back().orientation = of_clump.at(grains.clump[n]);
  }
  turned = exchange_rows(communicator_, turned, std::vector<int>(turned.size(), 0));
  if (rank_of(communicator_) != 0) return;
  std::vector<std::array<double, 4>> rows(grains_.size(), {nowhere, nowhere, nowhere, nowhere});
  for (const Turned& row : turned) rows[index_of(row.id)] = row.orientation;
  for (const auto& row : rows) orientations_.insert(orientations_.end(), row.begin(), row.end());
}

// duration: s, since the latest measurement.
void Tracks::go_on(std::vector<GrainRecord>& records, double duration, const PeriodicBox& box) const {
  double fastest = 0.0;
  for (std::size_t n = 0; n < records.size(); ++n)
    fastest = std::max({fastest, speed_of(records[n]), speed_of(last_[n])});
  for (std::size_t n = 0; n < records.size(); ++n) {
    if (!is_there(records[n]) || !is_there(last_[n])) continue;
    const Look now = look_at(records[n]);
    const Way gone = way_between(look_at(last_[n]), now, duration, box);
    if (diameter_ && gone.away > farthest_away(*diameter_, fastest, duration)) continue;
    records[n].set(GrainRecord::position, now.position + gone.boxes.cwiseProduct(box.size));
  }
}

std::vector<Diagnostic> Tracks::results() const {
  return {{"tracked_grains", "1", static_cast<double>(grains_.size())},
          {"track_measurements", "1", static_cast<double>(measurements_)}};
}

Records Tracks::take_records() {
  Records records;
  if (rank_of(communicator_) != 0) return records;
  records.fixed = {{"id", "id", grains_}};
  const std::uint64_t times = times_.size();
  records.rows.push_back({"time", "s", {"time"}, {}, {times}, std::move(times_)});
  times_.clear();
  for (std::size_t q = 0; q < since_.size(); ++q) {
    const auto& [name, unit] = recorded_quantities[q];
    records.rows.push_back(
        {name, unit, {"time", "id"}, {"x", "y", "z"}, {times, grains_.size(), 3}, std::move(since_[q])});
    since_[q].clear();
  }
  if (clumps_) {
    records.rows.push_back({"orientation",
                            "1",
                            {"time", "id"},
                            {"w", "x", "y", "z"},
                            {times, grains_.size(), 4},
                            std::move(orientations_)});
    orientations_.clear();
  }
  return records;
}

void Tracks::save(ArchiveWriter& archive) const {
  archive.attribute("tracks/seen_step", seen_step_);
  archive.attribute("tracks/measurements", measurements_);
  archive.attribute("tracks/last_time", last_time_);
  const std::uint64_t columns = std::tuple_size_v<decltype(GrainRecord::values)>;
  std::vector<double> values;
  for (const GrainRecord& record : last_) values.insert(values.end(), record.values.begin(), record.values.end());
  write_whole(archive, communicator_, "tracks/id", grains_);
  write_whole(archive, communicator_, "tracks/last", std::span<const double>(values),
              {measurements_ > 0 ? grains_.size() : 0, columns});
}

bool Tracks::load(ArchiveReader& archive) {
  if (!has_all_or_none(archive, {"tracks/seen_step", "tracks/id", "tracks/last"}) ||
      read_whole_if_alike<std::int64_t>(archive, "tracks/id", {grains_.size()}) != grains_)
    return false;
  seen_step_ = archive.integer_attribute("tracks/seen_step");
  measurements_ = archive.integer_attribute("tracks/measurements");
  last_time_ = archive.real_attribute("tracks/last_time");
  constexpr std::size_t columns = std::tuple_size_v<decltype(GrainRecord::values)>;
  const std::size_t rows = measurements_ > 0 ? grains_.size() : 0;
  const auto values = read_whole<double>(archive, "tracks/last", {rows, columns});
  if (rank_of(communicator_) != 0) return true;
  last_.assign(rows, {});
  for (std::size_t n = 0; n < last_.size(); ++n) {
    if (std::isnan(values[n * columns])) continue;  // it was not there
    last_[n].id = grains_[n];
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(n * columns), columns, last_[n].values.begin());
  }
  return true;
}

void describe(SectionVisitor& visit, TracksKeys& keys) {
  visit.integer_list(
      "grains", keys.grains,
      {.meaning = "ids of the grains, numbered through the populations from 0; default: every one_in-th grain",
       .at_least = 0,
       .example = 0});
  visit.integer("one_in", keys.one_in,
                {.meaning = "grains 0, one_in, 2 one_in, ... where no ids are given", .at_least = 1});
  describe_every(visit, keys.every);
}

// Number of grains that are recorded, of so many.
static std::int64_t recorded_grains(const TracksKeys& keys, std::int64_t all) {
  return keys.grains.empty() ? (all + keys.one_in - 1) / keys.one_in : static_cast<std::int64_t>(keys.grains.size());
}

void check(const TracksKeys& keys, const RunContext& run) {
  require_ids(run, keys.grains);
  if (!keys.grains.empty() && keys.one_in != 1)
    throw KeyError("one_in", "analysis.tracks.grains already names the grains; give one of the two");
  const std::int64_t all = run.grains->count(), recorded = recorded_grains(keys, all);
  if (recorded > TracksKeys::most_grains)
    throw KeyError("", fmt::format("it would record {} grains, but one rank can gather only {}; name fewer in grains, "
                                   "give one_in: {}, or take all grains from output.grains",
                                   recorded, TracksKeys::most_grains,
                                   (all + TracksKeys::most_grains - 1) / TracksKeys::most_grains));
}

std::unique_ptr<Observer> make_observer(const TracksKeys& keys, const RunContext& run, const RunningSystem& system) {
  std::vector<GlobalId> ids = keys.grains;
  std::sort(ids.begin(), ids.end());
  if (ids.empty())
    for (GlobalId id = 0; id < run.grains->count(); id += keys.one_in) ids.push_back(id);
  return std::make_unique<Tracks>(
      system.communicator, std::move(ids), keys.every, run.grains->any_clumps(),
      run.grains->recirculation ? std::optional(run.grains->reference_diameter) : std::nullopt);
}

// Every rank knows the ids; the first has the records.
ObserverMemory memory_of(const TracksKeys& keys, const RunContext& run, const RunSize& size) {
  const double numbers = std::tuple_size_v<decltype(GrainRecord::values)> + (run.grains->any_clumps() ? 4.0 : 0.0);
  const auto grains = static_cast<double>(recorded_grains(keys, run.grains->count()));
  return {.on_first_rank = grains * (sizeof(GlobalId) + sizeof(GrainRecord) +
                                     grown_list * kept_measurements(keys.every, size.step) * numbers * sizeof(double))};
}

}  // namespace thalweg::analysis
