// Hops: how far and how long grains move between two rests.
//
// A grain moves where its speed exceeds a threshold. A hop begins with the first measurement that finds a grain moving
// and ends with the first that finds it at rest again. Its time is that between these two, in error by less than the
// interval between measurements, and by nothing on average; a hop shorter than the interval may be missed. Its length
// is the way along x from the last measurement before it to the one that ends it, so that all of the way counts except
// for what a grain creeps below the threshold. Hops that were under way when measuring began are not counted, nor those
// that have not ended.
//
// A grain that has gone by a sink and come in again begins anew: one that a measurement does not find, and where grains
// recirculate, one that is farther away than farthest_away() from where its velocities would have taken it
// (way_between.hpp).
#pragma once

#include "analysis/observer/observer.hpp"
#include "analysis/statistics/histogram.hpp"
#include "analysis/tools/distribution_by_id.hpp"
#include "analysis/tools/way_between.hpp"
#include "core/geometry/periodic_box.hpp"

#include <mpi.h>

#include <optional>

namespace thalweg::analysis {

// A grain or a clump as transport sees it.
struct Body {
  GlobalId id;    // of a clump: that of its first member
  double volume;  // m^3
  Vec3 position;  // m, inside the box
  Vec3 velocity;  // m/s
};

// The bodies owned by this rank that are free to move, of which a clump is one.
std::vector<Body> free_bodies_of(const GrainView& grains);

class Hops {
public:
  // length, time: the units of the histograms' edges (m, s), a diameter and e.g. the time to fall by it.
  // moving_speed: the threshold, m/s. recirculation: grains may be taken out of the box and put in elsewhere from one
  // measurement to the next.
  Hops(MPI_Comm communicator, double length, double time, double moving_speed, bool recirculation = false);

  static constexpr double bytes_per_id() { return sizeof(Memory); }  // of what it keeps

  // id_count: of all ids, also those of members of clumps. counts: hops that begin now count. Collective.
  void observe(double time, const PeriodicBox& box, GlobalId id_count, const std::vector<Body>& bodies, bool counts);

  // hops (1: that have ended), hop_length_mean (m: of the way along x, with its sign), hop_length_10, _50, _90 (m:
  // quantiles of its magnitude in per cent, from the histogram), hop_time_mean, hop_time_10, _50, _90 (s). Not a number
  // as long as there was none.
  std::vector<Diagnostic> results() const;

  // hop_length_edges (m), hop_time_edges (s), hop_length_count, hop_time_count (1: one more than there are edges, the
  // first and the last for what lies outside; lengths by their magnitude).
  std::vector<Profile> profiles() const;

  void save(ArchiveWriter& archive, const std::string& group) const;  // collective
  // Does nothing where an older version has written the archive. bodies: at the latest measurement. Throws DamagedFile
  // if fewer are remembered. Collective.
  void load(ArchiveReader& archive, const std::string& group, std::int64_t bodies);

private:
  enum Phase { unseen, at_rest, hopping, hopping_uncounted };
  // Memory of a body, at its home.
  struct Memory {
    Phase phase = unseen;
    Look latest = {};
    double begin = 0.0;   // s, of the hop
    double length = 0.0;  // m, so far
  };
  static constexpr std::size_t columns = 9;

  struct Sighting {
    GlobalId id;
    double x, y, z, v_x, v_y, v_z;
  };
  struct Interval {
    double time, duration;  // s
    double farthest;        // m, that a grain can be away from where its velocities would have taken it
    const PeriodicBox& box;
    bool counts;
  };
  void follow(Memory& memory, const Sighting& seen, const Interval& interval, std::vector<double>& ended) const;
  void take_in(const std::vector<double>& ended);

  MPI_Comm communicator_;
  double diameter_, moving_speed_;
  bool recirculation_;
  std::optional<DistributionById> homes_;             // from the first measurement on
  std::vector<Memory> memory_;                        // of the ids whose home is here
  double last_time_ = 0.0;                            // s, of the latest measurement
  double last_speed_ = 0.0;                           // m/s, the largest then
  Histogram lengths_, times_;                         // over all ranks, on every rank
  double sum_of_lengths_ = 0.0, sum_of_times_ = 0.0;  // m, s
};

}  // namespace thalweg::analysis
