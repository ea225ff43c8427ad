// History stored beside the state in a checkpoint: the start of each maximum and each mean.
#pragma once

#include "analysis/observer/observer.hpp"
#include "core/base/archive.hpp"
#include "core/state/system.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace thalweg::driver {

using Observers = std::vector<std::unique_ptr<analysis::Observer>>;

struct RunHistory {
  std::vector<Diagnostic> largest;  // of the system, since largest_from
  double largest_from = 0.0;        // s, simulated
  // s, by the name of an observer: from when its sums count, where that is later than the start of the run.
  std::map<std::string, double> since;

  // Saves the observers as well, and attributes largest/<diagnostic>, largest/from, run/since_<observer> and
  // run/interval_<observer>. series_every: s, the interval of observers that have none of their own. Collective.
  void save(ArchiveWriter& archive, const Observers& observers, double series_every) const;

  // Loads the observers as well. What the archive lacks begins at its time. `system` must be loaded already.
  // Means of measurements at another interval are not taken over either. Collective.
  static RunHistory load(ArchiveReader& archive, const System& system, Observers& observers, double series_every);

  // The results of an observer with the time from which they really count: mean_from, or since where it has none.
  std::vector<Diagnostic> results_of(const analysis::Observer& observer) const;
};

}  // namespace thalweg::driver
