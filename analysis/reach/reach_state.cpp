// State of Reach in a checkpoint.
#include "analysis/reach/reach.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/state/whole_dataset.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

namespace thalweg::analysis {

namespace {

const std::string group = ReachKeys::section;

template <typename Number>
void append(std::vector<Number>& all, const std::vector<Number>& some) {
  all.insert(all.end(), some.begin(), some.end());
}

template <typename Number>
void take(std::span<const Number>& rest, std::vector<Number>& some) {
  std::copy_n(rest.begin(), some.size(), some.begin());
  rest = rest.subspan(some.size());
}

}  // namespace

SavedSettings Reach::settings() const {
  return {{"sections", static_cast<double>(sections_.bins)},   {"record_every", record_every_},
          {"columns", static_cast<double>(pixels_.columns())}, {"moving_speed", moving_speed_},
          {"grain_diameter", scales_.grain_diameter},          {"mean_from", from_}};
}

void Reach::save(ArchiveWriter& archive) const {
  save_settings(archive, group, settings());
  archive.attribute(group + "/seen_step", seen_step_);
  archive.attribute(group + "/window_begun", window_begun_);
  archive.attribute(group + "/window_ended", window_ended_);
  std::vector<std::int64_t> grains, lengths;
  std::vector<double> volumes, batches;
  for (const PassageSums* sums : sums_of(*this)) append(grains, sums->grains), append(volumes, sums->volume);
  for (const auto* some : {&first_grains_, &here_}) append(grains, *some);
  for (const auto* some : {&first_stored_, &stored_, &window_stored_}) append(volumes, *some);
  for (const CorrelatedMean* mean : means_of(*this)) {
    const std::vector<double> state = mean->state();
    lengths.push_back(static_cast<std::int64_t>(state.size()));
    append(batches, state);
  }
  write_whole(archive, communicator_, group + "/grain_sums", grains);
  write_whole(archive, communicator_, group + "/volume_sums", volumes);
  write_whole(archive, communicator_, group + "/batch_lengths", lengths);
  write_whole(archive, communicator_, group + "/batches", batches);
  residence_.save(archive, group);
  book_.save(archive, group);
  pixels_.save(archive, group);
}

bool Reach::load(ArchiveReader& archive) {
  if (!has_all_or_none(archive, {group + "/seen_step", group + "/grain_sums"}) ||
      !were_saved_with(archive, group, settings()))
    return false;
  const std::size_t bins = sections_.size(), passages = 3 * passage_kinds * bins;
  const auto grains = read_whole<std::int64_t>(archive, group + "/grain_sums", {passages + 2 * bins});
  const auto volumes = read_whole<double>(archive, group + "/volume_sums", {passages + 3 * bins});
  const auto lengths = read_whole<std::int64_t>(archive, group + "/batch_lengths", {2 + 2 * bins});
  const auto batches = read_whole<double>(archive, group + "/batches");
  const auto whole = static_cast<std::int64_t>(batches.size());
  const bool fit = std::all_of(lengths.begin(), lengths.end(), [](std::int64_t n) { return n >= 6; });
  if (!fit || std::accumulate(lengths.begin(), lengths.end(), std::int64_t{0}) != whole)
    throw damaged_dataset(group + "/batches", "the lengths of the means do not fit");

  seen_step_ = archive.integer_attribute(group + "/seen_step");
  window_begun_ = archive.real_attribute(group + "/window_begun");
  window_ended_ = archive.real_attribute(group + "/window_ended");
  std::span<const std::int64_t> grains_left(grains);
  std::span<const double> volumes_left(volumes), batches_left(batches);
  for (PassageSums* sums : sums_of(*this)) take(grains_left, sums->grains), take(volumes_left, sums->volume);
  for (auto* some : {&first_grains_, &here_}) take(grains_left, *some);
  for (auto* some : {&first_stored_, &stored_, &window_stored_}) take(volumes_left, *some);
  auto length = lengths.begin();
  for (CorrelatedMean* mean : means_of(*this)) {
    const auto size = static_cast<std::size_t>(*length++);
    if (!mean->restore(batches_left.first(size)))
      throw damaged_dataset(group + "/batches", "the batches of a mean are not those of its values");
    batches_left = batches_left.subspan(size);
  }
  if (seen_step_ >= 0 && !(archive.has(group + "/grains") && archive.has(group + "/pixels_of_grains")))
    throw damaged_dataset(group + "/grains", "the file has no memory of the grains");
  residence_.load(archive, group);
  book_.load(archive, group, std::accumulate(here_.begin(), here_.end(), std::int64_t{0}));
  if (pixels_.load(archive, group) && mean_level_.count() > 0 && pixels_.surface().empty())
    throw damaged_dataset(group + "/surface", "the file has no such data, but records");
  return true;
}

}  // namespace thalweg::analysis
