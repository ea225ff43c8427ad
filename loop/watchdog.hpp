// Watchdog: compares the diagnostics of the system with the limits of its rules at each health check of the time loop,
// warns, and stops a run that goes wrong.
//
// A diagnostic beyond its first limit gives a warning: once, and again whenever it has grown by half. Beyond the second
// limit it ends the run. One that is not a finite number always ends it.
#pragma once

#include "core/state/system.hpp"
#include "loop/out_of_bounds.hpp"
#include "loop/watch_rule.hpp"

#include <mpi.h>

#include <string>
#include <vector>

namespace thalweg::loop {

class Watchdog {
public:
  // The system must outlive it.
  Watchdog(MPI_Comm communicator, const System& system, std::vector<WatchRule> rules, OutOfBounds out_of_bounds);

  // Judges the diagnostics of the present state; returns new warnings, whole sentences. Throws RunError, with value,
  // limit, time, step, place, cause and remedy. Collective, the same on every rank.
  std::vector<std::string> judge(const std::vector<Diagnostic>& diagnostics);

  // Diagnostics that were beyond their first limit when last judged, e.g. "mean_density_deviation -0.0031"; empty:
  // none.
  std::string notice() const;

private:
  struct Watched {
    WatchRule rule;
    double warned = 0.0;  // badness of the latest warning; 0: none so far
    double value = 0.0;
    bool suspicious = false;
  };

  std::string moment() const;
  std::string location_of(const std::string& diagnostic) const;

  MPI_Comm communicator_;
  const System& system_;
  std::vector<Watched> watched_;
  OutOfBounds out_of_bounds_;
};

}  // namespace thalweg::loop
