// Performance model: work of each rank of a case and time of a step, without running it. The work of a rank follows
// from its block; grains that gravity holds on the floor are taken as settled evenly there.
#pragma once

#include "core/parallel/decomposition.hpp"
#include "driver/case/case.hpp"
#include "driver/cost/core_speed.hpp"

namespace thalweg::driver {

// Between two ranks, as benchmarks of message passing measure it (LogP, D. Culler et al. 1993).
struct Network {
  double latency = 2e-6;     // s, until a message has arrived
  double overhead = 0.4e-6;  // s that a message keeps its sender busy
  double bandwidth = 1e9;    // bytes/s of a rank while the others of its node send as well
};

// Work of one rank in a step; messages and bytes are those it sends.
struct RankWork {
  double cells = 0.0, grains = 0.0, ghosts = 0.0;
  double memory = 0.0;  // bytes, at its largest
  double messages = 0.0, bytes = 0.0;
  double rounds = 0.0;  // of messages, each of which waits for the one before
  double share_of_cells = 0.0, share_of_grains = 0.0;
};

// s a step.
struct StepTimes {
  double computing = 0.0;  // the rank's share
  double waiting = 0.0;    // for ranks that have more than theirs
  double sending = 0.0, reducing = 0.0;

  double sum() const { return computing + waiting + sending + reducing; }
};

// Work of one rank; its times among `ranks` of them.
RankWork rank_work(const Case& c, const Decomposition& decomposition, int rank);
StepTimes step_times(const RankWork& work, int ranks, const CoreSpeed& speed, const Network& network);

// The rank for which all others wait, with the memory of the rank that takes most.
struct SlowestRank {
  RankWork work;
  StepTimes times;
};
SlowestRank slowest_rank(const Case& c, const Decomposition& decomposition, const CoreSpeed& speed,
                         const Network& network);

}  // namespace thalweg::driver
