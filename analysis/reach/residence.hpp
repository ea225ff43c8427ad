// Residence times: how long grains that came in during the run stayed until they left, and how long those have been
// here that have not.
#pragma once

#include "analysis/observer/observer.hpp"
#include "analysis/statistics/histogram.hpp"

#include <mpi.h>

#include <cstdint>
#include <string>
#include <vector>

namespace thalweg::analysis {

class Residence {
public:
  // time: s, the unit of the histogram's edges, e.g. that to go through the reach.
  Residence(MPI_Comm communicator, double time);

  // Takes a look at a time (s): so many have arrived, and these are the stays (s) of those that have left, of which
  // each rank gives its own. Collective.
  void take(double time, std::int64_t arrived, const std::vector<double>& stays);

  // residence_times (1: grains that came in during the run and have left), residence_time_mean, _10, _50, _90 (s:
  // quantiles in per cent, from the histogram), not a number as long as there is none; newcomers (1: those that came in
  // and are here), newcomer_age_mean (s).
  std::vector<Diagnostic> results() const;
  // residence_time_edges (s), residence_time_count (1: one more than there are edges, the first and the last for what
  // lies outside).
  std::vector<Profile> profiles() const;

  void save(ArchiveWriter& archive, const std::string& group) const;  // collective
  void load(ArchiveReader& archive, const std::string& group);        // throws InputError as the archive does

private:
  MPI_Comm communicator_;
  Histogram stays_;
  double sum_of_stays_ = 0.0;     // s
  std::int64_t newcomers_ = 0;    // that are here
  double sum_of_arrivals_ = 0.0;  // s, the times at which they came
  double last_time_ = 0.0;        // s
};

}  // namespace thalweg::analysis
