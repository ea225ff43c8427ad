// Fractional transport: rates, surface and load by size class, and the armouring of the bed.
//
//   bed share      f_i  = V_i / V                           by volume, all free grains
//   surface share  F_i  = pixels that show class i / those that show any free grain, from above (plan_view.hpp)
//   rate           q_si = sum over the grains of class i of V v_x / (L W)      m^2/s; their sum is q_s (transport_rate)
//   load share     p_i  = q_si / q_s                        of the means
//   q*_i           = q_si / (F_i sqrt((s_i - 1) g d_i^3))
//   armouring      = d50 of the surface / d50 of the bed
//
// as Wilcock & Crowe (J. Hydraul. Eng. 129 (2003) 120) have them, who scale with the shear velocity where q*_i has the
// weight of a grain: W*_i = (s_i - 1) g q_si / (F_i u_*^3), their eq. (2). Parker & Klingeman (Water Resour. Res. 18
// (1982) 1409) take the share f_i of the bed below in place of F_i.
//
// d_i is the mean diameter of the class's grains by volume, in the logarithm, s_i their mean density over the fluid's.
// A clump is one grain as large as the sphere (disk) of its volume; from above all its members are seen. The surface is
// what a photograph shows: grains in motion count where they are, and moving_surface_share says how much they cover.
// Grains whose velocity is held are no sediment and belong to no class; what they hide is not seen.
#pragma once

#include "analysis/observer/mean_observer.hpp"
#include "analysis/observer/observer_keys.hpp"
#include "analysis/observer/transport_scales.hpp"
#include "analysis/sizes/grading.hpp"
#include "analysis/sizes/plan_view.hpp"
#include "analysis/statistics/correlated_mean.hpp"

#include <mpi.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::analysis {

struct FractionalTransportKeys {
  static constexpr const char* section = "fractional_transport";
  static constexpr const char* meaning =
      "transport, surface and bed by size class, and the armouring ratio, of grains of several sizes";
  static constexpr Needs needs = Needs::grains;
  double from = 0.0;                        // s: the means begin here
  double every = 0.0;                       // s: between measurements; 0: with the rows of the series
  std::vector<double> edges = {};           // m, of the classes, rising; empty: GrainContext::size_class_edges
  std::optional<double> moving_speed = {};  // m/s, above which a grain moves; default: that of TransportScales
  bool operator==(const FractionalTransportKeys&) const = default;
};
void describe(SectionVisitor& visit, FractionalTransportKeys& keys);
void check(const FractionalTransportKeys& keys, const RunContext& run);
std::optional<std::string> warning(const FractionalTransportKeys& keys, const RunContext& run);
std::unique_ptr<Observer> make_observer(const FractionalTransportKeys& keys, const RunContext& run,
                                        const RunningSystem& system);
// It keeps sums by class, nothing of a grain.
inline ObserverMemory memory_of(const FractionalTransportKeys&, const RunContext&, const RunSize&) { return {}; }

class FractionalTransport : public MeanObserver {
public:
  // pixel: of the plan view, m.
  FractionalTransport(MPI_Comm communicator, const PeriodicBox& box, const TransportScales& scales,
                      const SizeClasses& classes, const FractionalTransportKeys& keys, double pixel,
                      double disk_thickness = 0.0);

  // surface_d50 (m), armouring_ratio (1), moving_surface_share (1: of the plan area of free grains, by moving ones),
  // and for each class, 0 the finest, class_0_q_s (m^2/s), class_0_surface_share (1), class_0_moving_grains (1).
  std::vector<Diagnostic> diagnostics() const override;

  // bed_d50, surface_d50_mean and _error, load_d50 (m), armouring_ratio_mean and _error, errors_hold (1; 0: too few
  // measurements of the surface, errors are underestimates), moving_surface_share_mean; for
  // each class class_0_diameter (m), _bed_share, _surface_share_mean and _error, _load_share, _q_s_mean and _error
  // (m^2/s), in a fluid _q_star_mean and _error (that of q_s), _moving_grains_mean; mean_from (s), measurements; the
  // latest diagnostics. Not a number as long as nothing was measured, for q* of a class that is not at the surface, and
  // for shares and d50 of a load that is nothing on the whole. Bed and load are those of all measurements.
  std::vector<Diagnostic> results() const override;
  std::vector<std::string> remarks() const override;  // the three median sizes and the armouring ratio

  // edges (m), one more than classes; d50 (m: of bed, surface, load); by class: diameter (m, of one that had no grains
  // the geometric mean of its edges) and density (kg/m^3) over the measurements, bed_share, surface_share
  // and _error, load_share, q_s and q_s_error (m^2/s), in a fluid q_star and q_star_error, moving_grains and _error.
  std::vector<Profile> profiles() const override;

private:
  struct ClassMeans {
    CorrelatedMean q_s, surface_share, moving_grains;
  };
  struct Grain {  // as one body
    int bin;
    double volume, mass, v_x;  // m^3, kg, m/s
    bool moves;
  };
  // What follows from the means, for all classes.
  struct Findings;
  Findings findings() const;

  bool measure(const Snapshot& snapshot, bool counts) override;
  void add(const Snapshot& snapshot) override;
  void save_sums(ArchiveWriter& archive, const std::string& group) const override;
  bool load_sums(ArchiveReader& archive, const std::string& group) override;
  SavedSettings settings() const override;
  std::vector<Grain> sort_grains(const GrainView& grains, std::vector<SeenSphere>& seen) const;
  void measure_transport(const std::vector<Grain>& grains);
  void measure_surface(const std::vector<SeenSphere>& seen);
  double latest_bed_d50() const;  // m
  std::vector<double> mean_diameters() const;
  double bed_d50() const;   // m, of the bed of all measurements
  double load_d50() const;  // m
  // Pointers to what is saved; the latest measurement too, as a row of the series may come before the next.
  static auto sums_of(auto& self) {
    return std::array{&self.bed_volume_,        &self.bed_mass_,      &self.bed_diameter_,
                      &self.volume_sums_,       &self.mass_sums_,     &self.size_sums_,
                      &self.load_sums_,         &self.load_,          &self.q_s_,
                      &self.surface_share_,     &self.moving_grains_, &self.latest_,
                      &self.moving_surface_sum_};
  }
  static auto means_of(auto& self) {
    std::vector all{&self.surface_d50_};
    for (auto& means : self.means_) all.insert(all.end(), {&means.q_s, &means.surface_share, &means.moving_grains});
    all.push_back(&self.armouring_);
    return all;
  }

  TransportScales scales_;
  SizeClasses classes_;
  double moving_speed_;    // m/s
  double area_;            // m^2, of the plan
  double disk_thickness_;  // m; 0: spheres
  PlanView view_;
  // Of bins: the grains of the bed (m^3, kg, m) at the latest measurement.
  std::vector<double> bed_volume_, bed_mass_, bed_diameter_;
  // Of bins, over the measurements that count: volume (m^3), mass (kg) and volume times ln(diameter/m) of the grains,
  // by which a class that has left keeps its size and density, and the load (m^2/s).
  std::vector<double> volume_sums_, mass_sums_, size_sums_, load_sums_;
  // The latest measurement, by class and, of the load, by bin.
  std::vector<double> q_s_, surface_share_, moving_grains_, load_;
  std::vector<double> latest_{0.0, 0.0};  // surface d50 (m), moving share of the surface
  std::vector<double> moving_surface_sum_{0.0};
  std::vector<ClassMeans> means_;
  CorrelatedMean surface_d50_, armouring_;
};

}  // namespace thalweg::analysis
