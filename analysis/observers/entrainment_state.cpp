// State of Entrainment in a checkpoint: one row for every id, and the samples and touches of all rings, one after the
// other in the order of ids.
#include "analysis/observers/entrainment.hpp"
#include "core/parallel/row_range.hpp"

#include <algorithm>

namespace thalweg::analysis {

namespace {

constexpr std::ptrdiff_t of_sphere = 7;  // values of a touch: arm, force and distance; from_centre after them

std::vector<double> read_rows(ArchiveReader& archive, MPI_Comm communicator, const std::string& path, std::int64_t rows,
                              std::uint64_t columns) {
  const ArrayBox box = RowRange::of_rows(rows, communicator).box(columns);
  std::vector<double> values(static_cast<std::size_t>(rows) * columns);
  archive.read(path, std::span<double>(values), box);
  return values;
}

}  // namespace

std::vector<double> Entrainment::rows_of_memory() const {
  std::vector<double> rows;
  for (const Memory& m : memory_)
    rows.insert(rows.end(), {m.watched ? 1.0 : 0.0, static_cast<double>(m.phase), m.radius, m.mass, m.quiet_since,
                             m.rest.x(), m.rest.y(), m.rest.z(), static_cast<double>(m.ring.size())});
  return rows;
}

SavedSettings Entrainment::definitions() const {
  return {
      {"from", settings_.from},           {"interval", settings_.interval}, {"displacement", settings_.displacement},
      {"rest_time", settings_.rest_time}, {"diameter", settings_.diameter}, {"moving_speed", settings_.moving_speed}};
}

void Entrainment::save(ArchiveWriter& archive) const {
  save_settings(archive, "entrainment", definitions());
  archive.attribute("entrainment/seen_step", seen_step_);
  archive.attribute("entrainment/chosen_step", chosen_step_);
  archive.attribute("entrainment/events", events_);
  archive.attribute("entrainment/without_onset", without_onset_);
  archive.attribute("entrainment/shares", shares_);
  archive.attribute("entrainment/sum_of_shares", sum_of_shares_);
  archive.attribute("entrainment/sum_of_squares", sum_of_squares_);
  if (!homes_) return;
  homes_->write(archive, "entrainment/grains", rows_of_memory(), memory_columns);
  std::vector<SampleRow> samples;
  std::vector<TouchRow> touches;
  for (std::size_t m = 0; m < memory_.size(); ++m) add_rows(homes_->id_at(m), memory_[m].ring, samples, touches);
  samples = homes_->in_order_of_ids(std::move(samples));
  touches = homes_->in_order_of_ids(std::move(touches));
  std::vector<double> values;
  for (const SampleRow& row : samples) {
    values.push_back(row.time);
    values.insert(values.end(), row.record.values.begin(), row.record.values.end());
    values.push_back(static_cast<double>(row.touches));
  }
  archive.write("entrainment/samples", std::span<const double>(values),
                RowRange::of_rows(static_cast<std::int64_t>(samples.size()), communicator_).box(sample_columns));
  values.clear();
  for (const TouchRow& row : touches) {
    values.push_back(static_cast<double>(row.partner));
    values.insert(values.end(), row.values.begin(), row.values.begin() + of_sphere);
    if (!settings_.clumps) continue;
    values.push_back(static_cast<double>(row.member));
    values.insert(values.end(), row.values.begin() + of_sphere, row.values.end());
  }
  archive.write("entrainment/touches", std::span<const double>(values),
                RowRange::of_rows(static_cast<std::int64_t>(touches.size()), communicator_).box(touch_columns()));
}

bool Entrainment::load(ArchiveReader& archive) {
  if (!archive.has("entrainment/seen_step") && !archive.has("entrainment/grains")) return false;
  if (archive.integer_attribute("entrainment/seen_step") < 0) return true;  // before the first measurement
  if (!were_saved_with(archive, "entrainment", definitions())) return false;
  homes_ = DistributionById::of_rows(communicator_, archive, "entrainment/grains");
  memory_.assign(homes_->size(), {});
  const auto rows = homes_->read<double>(archive, "entrainment/grains", memory_columns);
  std::int64_t watched = 0;
  bool as_listed = true;
  for (std::size_t m = 0; m < memory_.size(); ++m) {
    memory_[m].watched = rows[m * memory_columns] != 0.0;
    watched += memory_[m].watched ? 1 : 0;
    as_listed &= memory_[m].watched == is_listed(homes_->id_at(m));
  }
  if (!settings_.grains.empty() && any_rank(communicator_, !as_listed)) {
    homes_.reset();
    return false;
  }
  watched_count_ = sum_over_ranks(communicator_, watched);
  watched_here_ = {};
  restore_rings(archive, rows);
  seen_step_ = archive.integer_attribute("entrainment/seen_step");
  chosen_step_ = archive.integer_attribute("entrainment/chosen_step");
  events_ = archive.integer_attribute("entrainment/events");
  const std::string without_onset = "entrainment/without_onset";  // not in older checkpoints
  without_onset_ = archive.has(without_onset) ? archive.integer_attribute(without_onset) : 0;
  shares_ = archive.integer_attribute("entrainment/shares");
  sum_of_shares_ = archive.real_attribute("entrainment/sum_of_shares");
  sum_of_squares_ = archive.real_attribute("entrainment/sum_of_squares");
  return true;
}

void Entrainment::restore_rings(ArchiveReader& archive, std::span<const double> rows) {
  std::int64_t sample_count = 0, touch_count = 0;
  for (std::size_t m = 0; m < memory_.size(); ++m)
    sample_count += static_cast<std::int64_t>(rows[m * memory_columns + 8]);
  const auto samples = read_rows(archive, communicator_, "entrainment/samples", sample_count, sample_columns);
  for (std::size_t n = 0; n < samples.size(); n += sample_columns)
    touch_count += static_cast<std::int64_t>(samples[n + sample_columns - 1]);
  const auto values = read_rows(archive, communicator_, "entrainment/touches", touch_count, touch_columns());
  std::vector<TouchRow> touches;
  for (auto row = values.begin(); row != values.end(); row += static_cast<std::ptrdiff_t>(touch_columns())) {
    TouchRow touch{0, static_cast<GlobalId>(*row), -1, {}};
    std::copy_n(row + 1, of_sphere, touch.values.begin());
    if (settings_.clumps) {
      touch.member = static_cast<GlobalId>(row[of_sphere + 1]);
      std::copy(row + of_sphere + 2, row + static_cast<std::ptrdiff_t>(touch_columns()),
                touch.values.begin() + of_sphere);
    }
    touches.push_back(touch);
  }
  auto next = touches.cbegin();
  const double* sample = samples.data();
  for (std::size_t m = 0; m < memory_.size(); ++m) {
    const double* row = rows.data() + m * memory_columns;
    Memory& memory = memory_[m];
    memory.phase = static_cast<Phase>(static_cast<int>(row[1]));
    memory.radius = row[2];
    memory.mass = row[3];
    memory.quiet_since = row[4];
    memory.rest = Vec3(row[5], row[6], row[7]);
    for (auto left = static_cast<std::int64_t>(row[8]); left > 0; --left, sample += sample_columns) {
      SampleRow one{0, sample[0], {}, static_cast<std::int64_t>(sample[sample_columns - 1])};
      one.record.id = homes_->id_at(m);
      std::copy_n(sample + 1, one.record.values.size(), one.record.values.begin());
      memory.ring.push_back(sample_of(one, next));
    }
  }
}

}  // namespace thalweg::analysis
