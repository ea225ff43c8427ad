// Entrainment of grains from the bed: what acted on them before, and the hinge about which they rolled out
// (hinge.hpp).
//
// A watched grain rests once it has been slower than the moving speed for a while; where it is then is its rest place.
// It is entrained when its centre has left that place by a share of its diameter. What is remembered of it, its states
// and contacts of the latest fraction of a second, is then an event. The share of the couple in the fluid's torque is
// that of their sums over the samples until the onset of the motion,
//
//   share = sum T_C / sum T_F
//
// for events with a hinge and a torque of the fluid that pushes the way the grain went. A motion that began before what
// is remembered has no onset, no hinge and no share. Events count as independent:
// the error of the mean share is its deviation over sqrt(events).
//
// A clump is one grain, by the id of its first member.
//
// What is remembered, and which grains are watched, lies at the home of the grain's id (distribution_by_id.hpp).
#pragma once

#include "analysis/bed/bed_layers.hpp"
#include "analysis/observer/observer_keys.hpp"
#include "analysis/observer/saved_settings.hpp"
#include "analysis/observers/entrainment_event.hpp"
#include "analysis/tools/bodies_here.hpp"
#include "analysis/tools/distribution_by_id.hpp"
#include "analysis/tools/grain_ring.hpp"
#include "analysis/tools/watched_here.hpp"

#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::analysis {

struct EntrainmentKeys {
  static constexpr const char* section = "entrainment";
  static constexpr const char* meaning =
      "forces on grains that start to move and torques about the hinge they roll over, in entrainment/";
  static constexpr Needs needs = Needs::both;
  std::vector<GlobalId> grains;  // ids; empty: free grains above the bed height less one diameter
  double from = 0.0;             // s
  double memory = 0.2;           // s
  double every = 0.0;            // s, between samples; 0: every step
  double refresh = 0.5;          // s, between two selections of the surface grains
  double displacement = 0.1;     // grain diameters from the rest place that count as a start
  double rest_time = 0.1;        // s
  bool operator==(const EntrainmentKeys&) const = default;
};
void describe(SectionVisitor& visit, EntrainmentKeys& keys);
void check(const EntrainmentKeys& keys, const RunContext& run);
std::unique_ptr<Observer> make_observer(const EntrainmentKeys& keys, const RunContext& run,
                                        const RunningSystem& system);
ObserverMemory memory_of(const EntrainmentKeys& keys, const RunContext& run, const RunSize& size);

// Settings of a run: the ids ascending, and values that follow from its step and its grains.
struct EntrainmentSettings : EntrainmentKeys {
  double interval = 0.0;           // s, between samples
  std::int64_t refresh_steps = 0;  // between two selections of the surface grains
  double window = 0.0;             // m, over which the solid fraction is averaged for the bed height
  double diameter = 0.0;           // m, the depth below the bed height that belongs to its surface
  double moving_speed = 0.0;       // m/s
  std::vector<HeldGrains> held;    // grains that cannot move
  BedObstacles obstacles;
  bool clumps = false;           // there are some, or may be
  bool recirculation = false;    // grains may be taken out of the box and put in elsewhere between two samples
  GrainContext::Force weight;    // submerged
  GrainContext::Force buoyancy;  // as in torques_about()
};

class Entrainment : public Observer {
public:
  // Bytes that it keeps of every id; of a watched grain for each sample, with so many contacts, besides.
  static double bytes_per_id();
  static double bytes_per_sample(double touches);

  Entrainment(MPI_Comm communicator, const PeriodicBox& box, EntrainmentSettings settings);

  std::string name() const override { return "entrainment"; }
  double every() const override { return settings_.interval; }
  bool is_lightweight() const override { return true; }
  void observe(const Snapshot& snapshot) override;  // a step seen before does not count again

  // watched_grains, entrainments (1: so far).
  std::vector<Diagnostic> diagnostics() const override;
  // These; entrainments_without_onset, entrainments_with_share, couple_share_mean, couple_share_deviation,
  // couple_share_error (1; not a number where there are too few events).
  std::vector<Diagnostic> results() const override;
  std::vector<std::string> remarks() const override;

  // One event for each start, event_000001 and so on. Diagnostics: onset_time (s), radius (m), couple_share and
  // largest_torque_ratio (1, as Entraining has them). Arrays: id, rest_position (m), submerged_weight (N); [sample]:
  // time and those of GrainRecord; with a hinge hinge_partners, hinge_points (m), hinge_axis, and [sample]
  // fluid_torque, couple_torque, critical_torque (N m). Of each contact of each sample: contact_sample,
  // contact_partner, contact_point, contact_partner_position (m), contact_force_each (N); of clumps also
  // contact_member, the id of the member that touches.
  bool has_records() const override { return true; }
  Records take_records() override;

  void save(ArchiveWriter& archive) const override;
  bool load(ArchiveReader& archive) override;  // begins anew where other grains were chosen, or with other definitions

private:
  // Settings that define an event, by name; counts made with other settings are not continued.
  SavedSettings definitions() const;

  enum Phase { unsettled, at_rest, moving };
  // Memory of a grain, at its home.
  struct Memory {
    bool watched = false;
    Phase phase = unsettled;
    double radius = 0.0, mass = 0.0;  // m, kg
    double quiet_since = -1.0;        // s; negative: it is faster than the moving speed
    Vec3 rest = Vec3::Zero();         // m, its rest place in the positions of the ring
    GrainRing ring;
  };
  struct Seen {  // on the way home
    GlobalId id;
    double radius, mass;
    GrainRecord record;
  };
  struct Start {  // part of an event that all ranks learn
    GlobalId id;
    double radius, mass, share;  // m, kg, 1 (not a number: none)
    bool has_onset;
    std::array<double, 3> rest;  // m
  };

  struct Shares {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double mean = unknown, deviation = unknown, error = unknown;  // the last two from two starts on
  };

  Shares shares() const;
  bool is_listed(GlobalId id) const;
  void choose(const Snapshot& snapshot, const BodiesHere& bodies);
  void watch(std::span<const GlobalId> ids, std::vector<char> chosen);
  std::vector<GlobalId> take_samples(const Snapshot& snapshot, const BodiesHere& bodies);
  void remember(Memory& memory, const Seen& seen, double time) const;
  bool has_come_in_anew(const GrainSample& last, const Seen& seen, double time) const;
  bool starts(Memory& memory) const;
  void count(const std::vector<GlobalId>& started, double time);
  std::vector<GrainRing> rings_on_first_rank(const std::vector<GlobalId>& started) const;
  EntrainedGrain grain_of(const Start& start) const;
  std::vector<double> rows_of_memory() const;
  void restore_rings(ArchiveReader& archive, std::span<const double> rows);

  MPI_Comm communicator_;
  PeriodicBox box_;
  EntrainmentSettings settings_;
  BedLayers layers_;
  std::optional<DistributionById> homes_;  // from the first measurement on
  WatchedHere watched_here_;
  std::int64_t watched_count_ = 0;  // over all ranks
  std::vector<Memory> memory_;      // of the ids whose home is here
  std::int64_t seen_step_ = -1, chosen_step_ = -1;
  std::int64_t events_ = 0, shares_ = 0, without_onset_ = 0;  // over all ranks
  double sum_of_shares_ = 0.0, sum_of_squares_ = 0.0;         // the same
  static constexpr std::uint64_t memory_columns = 9, sample_columns = 20;
  std::uint64_t touch_columns() const { return settings_.clumps ? 12 : 8; }  // with member and from_centre, or without
  std::vector<Event> pending_;                                               // since take_records(); on rank 0
};

}  // namespace thalweg::analysis
