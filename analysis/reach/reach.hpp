// Transport along a reach: how sediment moves along x.
//
//   q_s(x)    = sum over the grains that cross the section at x, of V / (W dt)     m^2/s, downstream less upstream
//   q*(x)     = q_s / sqrt((s - 1) g d^3)                                           as transport_rate has it
//   h(x, t)   = sum over the free grains of a bin, of V / (W dx)                    m, sediment stored
//   z_b(x, t) = mean surface of the static pixels of a bin (static_pixels.hpp)      m above the floor of the box
//   E, D      = sum over the grains of a bin that began to move, or came to rest, of V / (W dx dt)     m/s
//
// V volume of a grain, W width, dx between sections, dt of a record. Crossings of centres are counted (grain_book.hpp),
// so that for each bin, with A and L of the grains that arrive and leave there (supplies, sinks),
//
//   dh/dt = -dq_s/dx + A - L
//
// holds to the grain; of a bed with the porosity p, and no more in motion above it than before, it is Exner's equation
// (1 - p) dz_b/dt = -dq_s/dx. Grains whose velocity is held are no sediment, but are a part of the bed that z_b shows.
//
// A record is a picture of the static pixels: of what stood still from its begin to its end. The means are over the
// records that begin at `from` or later, with errors from the records (correlated_mean.hpp); balance and residence
// times (residence.hpp) count from the first look on.
#pragma once

#include "analysis/bed/obstacle_grains.hpp"
#include "analysis/bed/static_pixels.hpp"
#include "analysis/observer/saved_settings.hpp"
#include "analysis/observer/transport_scales.hpp"
#include "analysis/reach/grain_book.hpp"
#include "analysis/reach/reach_keys.hpp"
#include "analysis/reach/residence.hpp"
#include "analysis/reach/sections.hpp"
#include "analysis/statistics/correlated_mean.hpp"

#include <mpi.h>

#include <cstdint>
#include <string>
#include <vector>

namespace thalweg::analysis {

// Grains and their volume (m^3) by passage and place: a section or a bin.
struct PassageSums {
  explicit PassageSums(std::size_t places) : places_(places), grains(passage_kinds * places), volume(grains.size()) {}
  std::size_t slot(Passage passage, std::size_t place) const {
    return static_cast<std::size_t>(passage) * places_ + place;
  }
  void add(const PassageSums& more);

  std::int64_t grains_of(Passage passage, std::size_t place) const { return grains[slot(passage, place)]; }
  double volume_of(Passage passage, std::size_t place) const { return volume[slot(passage, place)]; }
  std::int64_t all_grains_of(Passage passage) const;
  double all_volume_of(Passage passage) const;

  std::size_t places_;
  std::vector<std::int64_t> grains;
  std::vector<double> volume;
};

class Reach : public Observer {
public:
  // disk_thickness: m, 0: spheres. recirculation: as GrainBook has it. obstacles: ids, ascending, of grains that the
  // level leaves out. The box must end in walls along z.
  Reach(MPI_Comm communicator, const PeriodicBox& box, const TransportScales& scales, const ReachKeys& keys,
        double disk_thickness = 0.0, bool recirculation = false, std::vector<GlobalId> obstacles = {});

  std::string name() const override { return ReachKeys::section; }
  double every() const override { return every_; }
  bool is_lightweight() const override { return true; }
  void observe(const Snapshot& snapshot) override;  // a step seen before does not count again

  std::vector<Diagnostic> diagnostics() const override { return {}; }

  // Means over the sections and bins: q_s_mean, q_s_error, q_s_variation (m^2/s, the standard deviation of the means of
  // the sections), in a fluid the same of q_star; bed_level_mean (m), bed_level_trend and bed_level_trend_error (m/s);
  // entrainment_rate, deposition_rate (m/s). Not a number as long as there is no record that counts. From the first
  // look on: arrived_grains, left_grains (1) and until the last record arrived_volume, left_volume, stored_change
  // (m^3); balance_residual (1: grains in the bins that the counts of crossings, arrivals and departures do not account
  // for). The results of Residence. sections (1), section_spacing (m), moving_speed (m/s), mean_from, measured_from,
  // measured_until (s), records (1).
  std::vector<Diagnostic> results() const override;
  std::vector<std::string> remarks() const override;

  // By section: section (m), q_s, q_s_error, upstream_q_s (m^2/s: the part that goes upstream, positive), in a fluid
  // q_star, q_star_error, downstream_grains, upstream_grains (1). By bin: x (m, of the middle), bed_level,
  // bed_level_error (m), bed_level_trend (m/s), stored (m, at the last record), storage_rate, entrainment_rate,
  // deposition_rate, arrival_rate, departure_rate (m/s). Those of Residence.
  std::vector<Profile> profiles() const override;

  // The same for all records: section, x (m). Rows: time (s, of its end), interval (s); by section q_s, upstream_q_s
  // (m^2/s), in a fluid q_star; by bin bed_level (m; not a number where no pixel is static), stored (m), entrained,
  // deposited, arrived, left (m/s, volume by area and time).
  bool has_records() const override { return true; }
  Records take_records() override;

  void save(ArchiveWriter& archive) const override;
  // Takes the state over only if it has the same settings. Throws DamagedFile.
  bool load(ArchiveReader& archive) override;

private:
  struct Row {
    double time, interval;  // s
    std::vector<double> q_s, upstream_q_s, bed_level, stored, entrained, deposited, arrived, left;
  };
  void count(const GrainBook::Page& page);
  std::vector<std::int64_t> grains_in_bins(const std::vector<Body>& bodies) const;
  std::vector<double> stored_in_bins(const std::vector<Body>& bodies) const;  // m
  void end_record(double time, const std::vector<double>& stored_before);
  std::vector<double> levels() const;                                  // m, of the bins in the latest picture
  double plan_of_bin() const { return width_ * sections_.spacing(); }  // m^2
  // Volume of a passage by bin, per plan area and duration (s): m/s.
  std::vector<double> rates(const PassageSums& sums, Passage passage, double duration) const;
  std::int64_t balance_residual() const;
  void add_means(std::vector<Diagnostic>& results) const;
  void add_by_section(std::vector<Profile>& profiles) const;
  double duration_of(const CorrelatedMean& level) const;  // s, of the records that have a level
  double bed_trend(const CorrelatedMean& level) const;    // m/s
  SavedSettings settings() const;

  // Pointers to what is saved and sized when the observer is made.
  static auto sums_of(auto& self) { return std::vector{&self.interval_, &self.window_, &self.total_}; }
  static auto means_of(auto& self) {
    std::vector all{&self.mean_q_s_, &self.mean_level_};
    for (auto* by_place : {&self.q_s_, &self.level_})
      for (auto& mean : *by_place) all.push_back(&mean);
    return all;
  }

  MPI_Comm communicator_;
  TransportScales scales_;
  Sections sections_;
  double width_;                                       // m
  double from_, every_, record_every_, moving_speed_;  // s, m/s
  ObstacleGrains obstacles_;
  StaticPixels pixels_;
  GrainBook book_;
  Residence residence_;
  std::int64_t seen_step_ = -1;

  PassageSums interval_, window_, total_;           // of the record under way, of those that count, of all
  std::vector<std::int64_t> first_grains_, here_;   // in the bins, at the first and the latest look
  std::vector<double> first_stored_, stored_;       // m, at the first look and the latest record
  std::vector<double> window_stored_;               // m, where the means begin
  double window_begun_ = 0.0, window_ended_ = 0.0;  // s
  std::vector<CorrelatedMean> q_s_, level_;         // m^2/s by section, m by bin
  CorrelatedMean mean_q_s_, mean_level_;            // over all of them
  std::vector<Row> rows_;                           // since take_records()
};

}  // namespace thalweg::analysis
