// Observer: turns snapshots of a run into numbers. It never changes the state, so that switching it off does not
// change one bit of the run.
#pragma once

#include "core/base/archive.hpp"
#include "core/state/profile.hpp"
#include "core/state/records.hpp"
#include "core/state/snapshot.hpp"
#include "core/state/system.hpp"

#include <string>
#include <vector>

namespace thalweg::analysis {

class Observer {
public:
  virtual ~Observer() = default;

  // Name of the group its results form in summary.json and in a checkpoint, e.g. "transport_rate".
  virtual std::string name() const = 0;

  // Seconds of simulated time between its measurements; 0: with the rows of the series.
  virtual double every() const { return 0.0; }

  // True if it may measure in every step: its measurements alone do not trigger a check of the system's health.
  virtual bool is_lightweight() const { return false; }

  // True if it needs Snapshot::momentum, which a system records when asked before the step.
  virtual bool needs_momentum() const { return false; }

  // True if it needs GrainView::fluid_stress, likewise.
  virtual bool needs_grain_stress() const { return false; }

  // Takes one measurement. Collective: every rank calls it at the same steps.
  virtual void observe(const Snapshot& snapshot) = 0;

  // Latest measurement, the same on every rank: columns of the series. Names and order must not change; SeriesTable
  // refuses a row that differs.
  virtual std::vector<Diagnostic> diagnostics() const = 0;

  // Results so far, the same on every rank: means for the summary.
  virtual std::vector<Diagnostic> results() const { return diagnostics(); }

  // Results as arrays, for profiles.h5.
  virtual std::vector<Profile> profiles() const { return {}; }

  // Results in words for the log at the end of the run, one sentence each.
  virtual std::vector<std::string> remarks() const { return {}; }

  // True if it has a folder of its own in the run folder, NAME, to which take_records() is added.
  virtual bool has_records() const { return false; }
  // Records since the last call, on rank 0; empty elsewhere. Called before every save().
  virtual Records take_records() { return {}; }

  // Running sums, so that a restarted run reports the same means as one that was never interrupted. Collective.
  virtual void save(ArchiveWriter& archive) const = 0;
  // Called once, on an observer that has seen nothing. False: the archive holds none, or those of other settings, and
  // they begin here. Throws DamagedFile if the archive holds some that nothing can be made of.
  virtual bool load(ArchiveReader& archive) = 0;
};

}  // namespace thalweg::analysis
