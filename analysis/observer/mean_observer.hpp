// Observer of means: sums over the measurements from a given time on, which a restarted run continues.
#pragma once

#include "analysis/observer/observer.hpp"
#include "analysis/observer/saved_settings.hpp"

#include <mpi.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::analysis {

// True from the time on at which means begin (s), also for a step that is due at that very time and misses it by
// rounding.
constexpr bool counts_from(double from, double time) { return time >= from * (1.0 - 1e-12); }

class MeanObserver : public Observer {
public:
  // from: s, the means begin here. every: as Observer::every().
  MeanObserver(MPI_Comm communicator, std::string name, double from, double every)
      : communicator_(communicator), name_(std::move(name)), from_(from), every_(every) {}

  std::string name() const final { return name_; }
  double every() const final { return every_; }
  std::vector<Diagnostic> diagnostics() const override { return {}; }

  // Measures, and adds the measurement to the sums if it counts. A step seen before, as at a restart, does not count
  // again.
  void observe(const Snapshot& snapshot) final;

  // Loading accepts only sums of the same `from` and the same settings.
  void save(ArchiveWriter& archive) const final;
  bool load(ArchiveReader& archive) final;

protected:
  // Takes the latest measurement, whether it counts or not; false: the snapshot has nothing to measure.
  virtual bool measure(const Snapshot& /*snapshot*/, bool /*counts*/) { return true; }
  // Adds the measurement to the sums.
  virtual void add(const Snapshot& snapshot) = 0;

  // The sums in a group of the archive, in a dataset "sums" and perhaps others. load_sums() leaves them as they are and
  // returns false if those saved were measured with other settings, and throws DamagedFile if they are damaged.
  virtual void save_sums(ArchiveWriter& archive, const std::string& group) const = 0;
  virtual bool load_sums(ArchiveReader& archive, const std::string& group) = 0;
  virtual SavedSettings settings() const { return {}; }

  // The number of measurements that count, which load_sums() must restore.
  std::int64_t measurements() const { return measurements_; }
  void restore_count(std::int64_t measurements) { measurements_ = measurements; }
  void save_count(ArchiveWriter& archive, const std::string& group) const;
  void load_count(ArchiveReader& archive, const std::string& group);
  // Appends mean_from (s) and measurements (1).
  void add_count(std::vector<Diagnostic>& results) const;

  MPI_Comm communicator() const { return communicator_; }

private:
  MPI_Comm communicator_;
  std::string name_;
  double from_, every_;  // s
  std::int64_t measurements_ = 0, counted_step_ = -1;
};

}  // namespace thalweg::analysis
