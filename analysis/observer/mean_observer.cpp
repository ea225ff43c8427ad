#include "analysis/observer/mean_observer.hpp"

#include "core/state/whole_dataset.hpp"

namespace thalweg::analysis {

void MeanObserver::observe(const Snapshot& snapshot) {
  const bool counts = counts_from(from_, snapshot.time);
  if (!measure(snapshot, counts) || !counts || snapshot.step <= counted_step_) return;
  counted_step_ = snapshot.step;
  ++measurements_;
  add(snapshot);
}

void MeanObserver::save(ArchiveWriter& archive) const {
  archive.attribute(name_ + "/mean_from", from_);
  archive.attribute(name_ + "/counted_step", counted_step_);
  save_settings(archive, name_, settings());
  save_sums(archive, name_);
}

bool MeanObserver::load(ArchiveReader& archive) {
  if (!has_all_or_none(archive, {name_ + "/mean_from", name_ + "/sums"}) ||
      archive.real_attribute(name_ + "/mean_from") != from_ || !were_saved_with(archive, name_, settings()) ||
      !load_sums(archive, name_))
    return false;
  counted_step_ = archive.integer_attribute(name_ + "/counted_step");
  return true;
}

void MeanObserver::save_count(ArchiveWriter& archive, const std::string& group) const {
  archive.attribute(group + "/measurements", measurements_);
}

void MeanObserver::load_count(ArchiveReader& archive, const std::string& group) {
  restore_count(archive.integer_attribute(group + "/measurements"));
}

void MeanObserver::add_count(std::vector<Diagnostic>& results) const {
  results.push_back({"mean_from", "s", from_});
  results.push_back({"measurements", "1", static_cast<double>(measurements_)});
}

}  // namespace thalweg::analysis
