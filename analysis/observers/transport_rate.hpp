// Sediment transport rate.
//
//   q_s = sum over grains of V v_x / (L W)              volume flux per unit width, m^2/s
//   q*  = q_s / sqrt((s - 1) g d^3),  s = rho_s/rho_f   the same without dimension
//   activity = sum over moving grains of V / (L W)      m (Furbish et al., J. Geophys. Res. 117 (2012) F03031)
//
// V volume of a grain, v_x its streamwise velocity, L and W length and width of the domain (Zhang et al. 2022: all
// grains of the whole domain count). Grains whose velocity is held, at rest or moving, are no sediment and count
// nowhere. Without a fluid s has no meaning and q* is left out. A clump is one grain.
//
// The mean of q_s comes with its error (correlated_mean.hpp) and a test of whether it drifts (stationarity.hpp); moving
// grains with the distribution of their velocities (histogram.hpp) and their hops (hops.hpp).
#pragma once

#include "analysis/observer/mean_observer.hpp"
#include "analysis/observer/observer_keys.hpp"
#include "analysis/observer/transport_scales.hpp"
#include "analysis/statistics/correlated_mean.hpp"
#include "analysis/statistics/histogram.hpp"
#include "analysis/statistics/stationarity.hpp"
#include "analysis/tools/hops.hpp"

#include <mpi.h>

#include <array>
#include <cstdint>

namespace thalweg::analysis {

struct TransportRateKeys {
  static constexpr const char* section = "transport_rate";
  static constexpr const char* meaning =
      "transport rate q and q* along x with its error; number, speed and hop length of the moving grains";
  static constexpr Needs needs = Needs::grains;
  double from = 0.0;                        // s: means, hops and distributions begin here
  double every = 0.0;                       // s: between measurements; 0: with the rows of the series
  std::optional<double> moving_speed = {};  // m/s, above which a grain moves; default: that of TransportScales
  bool operator==(const TransportRateKeys&) const = default;
};
void describe(SectionVisitor& visit, TransportRateKeys& keys);
void check(const TransportRateKeys& keys, const RunContext& run);
std::optional<std::string> warning(const TransportRateKeys& keys, const RunContext& run);
std::unique_ptr<Observer> make_observer(const TransportRateKeys& keys, const RunContext& run,
                                        const RunningSystem& system);
ObserverMemory memory_of(const TransportRateKeys& keys, const RunContext& run, const RunSize& size);

class TransportRate : public MeanObserver {
public:
  TransportRate(MPI_Comm communicator, const TransportScales& scales, const TransportRateKeys& keys,
                bool recirculation = false);

  // q_s (m^2/s), q_star (1; only in a fluid), moving_grains (1: faster than moving_speed), moving_share (1: of all
  // free grains), activity (m).
  std::vector<Diagnostic> diagnostics() const override;

  // q_s_mean, q_s_deviation (standard deviation of the measurements), q_s_error (standard error of the mean),
  // q_s_independent (values that the measurements are worth), q_s_error_holds (1; 0: an underestimate, the run is too
  // short), q_s_correlation_time (s, integrated), q_s_drift and q_s_drift_error (m^2/s, over the whole time), steady
  // (1; 0: drifts; -1: too few values to tell; -2: half of the mean may be hidden); in a fluid q_star_mean, _deviation,
  // _error, _drift, _drift_error; moving_grains_mean and _error, moving_share_mean, activity_mean; the results of Hops;
  // measured_from and measured_until (s: first and last measurement that counts), reference_diameter,
  // reference_density, moving_speed, mean_from (s), measurements; then the latest diagnostics and largest_grain_speed
  // (m/s). Means are not a number as long as nothing was measured.
  std::vector<Diagnostic> results() const override;
  std::vector<std::string> remarks() const override;  // the mean, its error and whether it is steady

  // velocity_edges (m/s), velocity_density (s/m: of x, y, z of moving grains, times the width of a bin the share of all
  // velocities that were in it); those of Hops.
  std::vector<Profile> profiles() const override;

private:
  struct Latest {
    double q_s = 0.0;       // m^2/s
    double activity = 0.0;  // m
    std::int64_t moving = 0, grains = 0;
    double largest_speed = 0.0;  // m/s
    double share() const { return grains > 0 ? static_cast<double>(moving) / static_cast<double>(grains) : 0.0; }
  };
  bool measure(const Snapshot& snapshot, bool counts) override;
  void add(const Snapshot& snapshot) override;
  void save_sums(ArchiveWriter& archive, const std::string& group) const override;
  bool load_sums(ArchiveReader& archive, const std::string& group) override;
  SavedSettings settings() const override;
  void measure_bodies(const Snapshot& snapshot, const std::vector<Body>& bodies);
  void count_velocities(const std::vector<Body>& bodies);
  std::vector<double> sums() const;  // saved sums and the latest measurement
  double interval() const;           // s, between measurements that count

  TransportScales scales_;
  double moving_speed_;  // m/s
  Latest latest_;
  double first_time_ = 0.0, last_time_ = 0.0;  // s, of the first and the latest of those
  double sum_of_shares_ = 0.0, sum_of_activity_ = 0.0;
  CorrelatedMean q_s_, moving_;
  std::array<Histogram, 3> velocities_;  // of moving grains, over all ranks, on every rank
  Hops hops_;
};

}  // namespace thalweg::analysis
