#include "analysis/bed/static_pixels.hpp"

#include "core/parallel/mpi_count.hpp"
#include "core/state/whole_dataset.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg::analysis {

StaticPixels::StaticPixels(MPI_Comm communicator, const PeriodicBox& box, double pixel, double static_time)
    : communicator_(communicator),
      box_(box),
      columns_(std::max<std::int64_t>(1, std::llround(box.size.x() / pixel))),
      width_(box.size.x() / static_cast<double>(columns_)),
      height_(pixel),
      static_time_(static_time) {}

bool StaticPixels::look(const Snapshot& snapshot, std::span<const char> left_out) {
  const GrainView& grains = snapshot.grains;
  const bool first_look = !homes_;
  if (first_look) {
    homes_.emplace(communicator_, grains.end_of_ids());
    begun_ = snapshot.time;
  }
  make_room_for(grains);
  homes_->grow(grains.end_of_ids());
  first_.resize(homes_->size());
  rows_.resize(homes_->size() * static_cast<std::size_t>(columns_a_grain_));
  std::vector<Disk> disks;
  for (std::size_t i = 0; i < grains.id.size(); ++i)
    if (left_out.empty() || left_out[i] == 0)
      disks.push_back({grains.id[i], grains.position[i].x(), grains.position[i].z(), grains.radius[i]});
  disks = homes_->bring_home(disks);
  forget_others(disks);
  if (!first_look)
    for (const Disk& disk : disks) narrow(disk);
  const bool complete = !first_look && snapshot.time - begun_ >= static_time_ * (1.0 - 1e-9);
  if (complete) {
    finish();
    picture_begun_ = begun_;
    begun_ = snapshot.time;
  }
  if (first_look || complete)
    for (const Disk& disk : disks) begin(disk);
  return complete;
}

// More columns, where grains have come in that are larger than any before; those before cover nothing in them.
void StaticPixels::make_room_for(const GrainView& grains) {
  double largest = 0.0;
  for (const double radius : grains.radius) largest = std::max(largest, radius);
  largest = max_over_ranks(communicator_, largest);
  const std::int64_t columns = columns_covered(largest);
  if (columns <= columns_a_grain_) return;
  std::vector<Rows> wider(first_.size() * static_cast<std::size_t>(columns));
  for (std::size_t grain = 0; grain < first_.size(); ++grain)
    std::copy_n(rows_.begin() + static_cast<std::ptrdiff_t>(grain) * columns_a_grain_, columns_a_grain_,
                wider.begin() + static_cast<std::ptrdiff_t>(grain) * columns);
  rows_ = std::move(wider);
  columns_a_grain_ = columns;
}

// Grains that have left cover nothing.
void StaticPixels::forget_others(const std::vector<Disk>& disks) {
  std::vector<char> here(homes_->size(), 0);
  for (const Disk& disk : disks) here[homes_->location_of(disk.id)] = 1;
  const auto columns = static_cast<std::ptrdiff_t>(columns_a_grain_);
  for (std::size_t grain = 0; grain < here.size(); ++grain)
    if (here[grain] == 0) std::fill_n(rows_.begin() + static_cast<std::ptrdiff_t>(grain) * columns, columns, Rows{});
}

// The number of columns that such a disk (m) may cover.
std::int64_t StaticPixels::columns_covered(double radius) const {
  return static_cast<std::int64_t>(std::ceil(2.0 * radius / width_)) + 1;
}

// The first column whose centre a disk may cover.
std::int64_t StaticPixels::first_column(double x, double radius) const {
  return static_cast<std::int64_t>(std::ceil((x - radius) / width_ - 0.5));
}

// The image of x nearest to the grain's columns.
double StaticPixels::near(double x, std::int64_t column) const {
  if (!box_.periodic[0]) return x;
  const double middle = (static_cast<double>(column) + 0.5 * static_cast<double>(columns_a_grain_)) * width_;
  return x - box_.size.x() * std::round((x - middle) / box_.size.x());
}

StaticPixels::Rows StaticPixels::covered(const Disk& disk, double x, std::int64_t column) const {
  const double off = (static_cast<double>(column) + 0.5) * width_ - x;
  const double square = disk.radius * disk.radius - off * off;
  if (square < 0.0) return {};
  const double half = std::sqrt(square);
  return {static_cast<std::int32_t>(std::ceil((disk.z - half) / height_ - 0.5)),
          static_cast<std::int32_t>(std::floor((disk.z + half) / height_ - 0.5))};
}

void StaticPixels::begin(const Disk& disk) {
  const std::size_t grain = homes_->location_of(disk.id);
  first_[grain] = first_column(disk.x, disk.radius);
  Rows* rows = rows_.data() + grain * static_cast<std::size_t>(columns_a_grain_);
  for (std::int64_t c = 0; c < columns_a_grain_; ++c) rows[c] = covered(disk, disk.x, first_[grain] + c);
}

void StaticPixels::narrow(const Disk& disk) {
  const std::size_t grain = homes_->location_of(disk.id);
  const double x = near(disk.x, first_[grain]);
  Rows* rows = rows_.data() + grain * static_cast<std::size_t>(columns_a_grain_);
  for (std::int64_t c = 0; c < columns_a_grain_; ++c) {
    const Rows now = covered(disk, x, first_[grain] + c);
    rows[c] = {std::max(rows[c].lowest, now.lowest), std::min(rows[c].highest, now.highest)};
  }
}

void StaticPixels::finish() {
  std::vector<std::int64_t> highest(static_cast<std::size_t>(columns_), -1);
  for (std::size_t grain = 0; grain < first_.size(); ++grain)
    for (std::int64_t c = 0; c < columns_a_grain_; ++c) {
      const Rows& rows = rows_[grain * static_cast<std::size_t>(columns_a_grain_) + static_cast<std::size_t>(c)];
      std::int64_t column = first_[grain] + c;
      if (box_.periodic[0]) column = ((column % columns_) + columns_) % columns_;
      if (rows.lowest > rows.highest || column < 0 || column >= columns_) continue;
      std::int64_t& top = highest[static_cast<std::size_t>(column)];
      top = std::max<std::int64_t>(top, rows.highest);
    }
  MPI_Allreduce(MPI_IN_PLACE, highest.data(), mpi_count(columns_), MPI_INT64_T, MPI_MAX, communicator_);
  surface_.clear();
  for (const std::int64_t row : highest) surface_.push_back(static_cast<double>(row + 1) * height_);
}

void StaticPixels::save(ArchiveWriter& archive, const std::string& group) const {
  archive.attribute(group + "/picture_begun", picture_begun_);
  archive.attribute(group + "/looks_begun", begun_);
  archive.attribute(group + "/pixel", height_);
  archive.attribute(group + "/columns_a_grain", columns_a_grain_);
  if (!surface_.empty()) write_whole(archive, communicator_, group + "/surface", surface_);
  if (!homes_) return;
  const auto columns = static_cast<std::size_t>(columns_a_grain_);
  std::vector<std::int64_t> values;
  values.reserve(first_.size() * (1 + 2 * columns));
  for (std::size_t grain = 0; grain < first_.size(); ++grain) {
    values.push_back(first_[grain]);
    for (std::size_t c = 0; c < columns; ++c) {
      const Rows& rows = rows_[grain * columns + c];
      values.insert(values.end(), {rows.lowest, rows.highest});
    }
  }
  homes_->write(archive, group + "/pixels_of_grains", std::move(values), 1 + 2 * columns);
}

bool StaticPixels::load(ArchiveReader& archive, const std::string& group) {
  const std::string rows = group + "/pixels_of_grains";
  const auto looked = [&] { return archive.integer_attribute(group + "/columns_a_grain") > 0; };
  if (!archive.has(rows) && !(archive.has(group + "/pixel") && looked())) return false;
  if (archive.real_attribute(group + "/pixel") != height_) return false;
  picture_begun_ = archive.real_attribute(group + "/picture_begun");
  begun_ = archive.real_attribute(group + "/looks_begun");
  columns_a_grain_ = archive.integer_attribute(group + "/columns_a_grain");
  if (archive.has(group + "/surface"))
    surface_ = read_whole<double>(archive, group + "/surface", {static_cast<std::uint64_t>(columns_)});
  homes_ = DistributionById::of_rows(communicator_, archive, rows);
  // A grain covers at least two columns, and only as long as there has been no grain may there be no row.
  if (homes_->count() == 0 && columns_a_grain_ > 1) throw damaged_dataset(rows, "the file holds no values");
  const auto columns = static_cast<std::size_t>(columns_a_grain_), numbers = 1 + 2 * columns;
  const auto values = homes_->read<std::int64_t>(archive, rows, numbers);
  first_.resize(homes_->size());
  rows_.resize(homes_->size() * columns);
  for (std::size_t grain = 0; grain < first_.size(); ++grain) {
    const std::int64_t* row = values.data() + grain * numbers;
    first_[grain] = row[0];
    for (std::size_t c = 0; c < columns; ++c)
      rows_[grain * columns + c] = {static_cast<std::int32_t>(row[1 + 2 * c]),
                                    static_cast<std::int32_t>(row[2 + 2 * c])};
  }
  return true;
}

}  // namespace thalweg::analysis
