// How much sediment moves.
//
//   q_s = sum over grains of V v_x / (L W)              volume flux per unit width, m^2/s
//   q*  = q_s / sqrt((s - 1) g d^3),  s = rho_s/rho_f   the same without dimension
//
// V volume of a grain, v_x its streamwise velocity, L and W length and width of the domain (Zhang et al. 2022: all
// grains of the whole domain count). With several populations d and rho_s are those of the first one in the case.
// Without a fluid s has no meaning and q* is left out.
#pragma once

#include "analysis/observer.hpp"

#include <mpi.h>

#include <cstdint>

namespace thalweg::analysis {

struct TransportScales {
  double grain_diameter;       // m, first population
  double grain_density;        // kg/m^3, first population
  double fluid_density = 0.0;  // kg/m^3; 0: dry grains
  double gravity = 0.0;        // m/s^2, magnitude

  double flux() const;          // sqrt(|s - 1| g d^3), m^2/s; without a fluid sqrt(g d^3)
  double moving_speed() const;  // m/s: 1 % of sqrt(|s - 1| g d), without a fluid of sqrt(g d)
  bool have_q_star() const { return fluid_density > 0.0 && flux() > 0.0; }
};

class TransportRate : public Observer {
public:
  // Means are taken over the measurements from time `from` (s) on.
  TransportRate(MPI_Comm communicator, const TransportScales& scales, double from);

  std::string name() const override { return "transport_rate"; }
  void observe(const Snapshot& snapshot) override;  // a step seen before does not count again in the means

  // q_s (m^2/s), q_star (1; only in a fluid), moving_grains (1: faster than moving_speed()), largest_grain_speed (m/s).
  std::vector<Figure> figures() const override;

  // q_s_mean, and in a fluid q_star_mean and q_star_deviation (standard deviation of the measurements), mean_from (s),
  // measurements; then the latest figures. Means are 0 as long as nothing was measured.
  std::vector<Figure> results() const override;

  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;  // takes the sums over only if they were begun at the same `from`

private:
  MPI_Comm communicator_;
  TransportScales scales_;
  double from_;
  double q_s_ = 0.0;
  std::int64_t moving_ = 0;
  double largest_speed_ = 0.0;
  std::int64_t measurements_ = 0;   // from from_ on
  std::int64_t counted_step_ = -1;  // of the latest of them
  double sum_ = 0.0;                // of q_s, m^2/s
  double sum_of_squares_ = 0.0;     // of q_s, m^4/s^2
};

}  // namespace thalweg::analysis
