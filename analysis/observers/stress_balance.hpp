// The balance of momentum along x by layers of a bed under a flow: all stresses that carry it, who takes it from whom,
// and the line that the driving force prescribes in steady state (docs/theory.md, section 5, "Momentum balance by
// layers"). Stresses are per area of the whole layer, fluid and grains together, so that they add up; positive in
// tension, the force's component first.
//
// Grains by volume shares, V_il the part of grain i within layer l, A b the layer's volume (grain_profiles.hpp); a
// clump is one grain, with arms from its centre, and its members share what it has as their own volumes are to each
// other:
//   contact stress         (1/Ab) sum_i (V_il/V_i) sum_c F_a r_b              (Christoffersen et al. 1981)
//   fluid part on grains   (1/Ab) sum_i (V_il/V_i) sum_links F_a x_b          (Zhang et al. 2022, eq. 13)
//   lubrication stress     as the contacts', of the forces between near surfaces (dem/contact/lubrication.hpp)
//   rotation stress        xz - zx of the last                                (Zhang et al. 2022, section 2.4)
//   drag density           (1/Ab) sum_i (V_il/V_i) F_i                        N/m^3, given by the fluid
//   drag function          F = f_x d^2/(18 phi (1 - phi) eta (U_f - U_s)),  Re_d = (1 - phi) rho_f |U_f - U_s| d/eta
//                                                                             (eq. 25, without turbulent drift)
// Of the fluid cells, in the collision of the step: viscous and subgrid stress from the non-equilibrium moments
// (lbm/fluid/flow_fields.hpp), rho u_a u_b, which is parted into Reynolds stress -(<rho u_a u_b> - <rho u_a><rho
// u_b>/<rho>) and what the mean flow carries.
//
// Totals of xz, all means over the layer:
//   sum of stresses   all of the above added up: grains count with their mean stress wherever they are cut
//   total stress      the same with grains cut where the layer is: what acts on the parts above a plane
//   side wall stress  what side walls and solids take of fluid and grains above the plane
//   driving stress    top, on fluid and on grains + integral from z to the top of rho_f g_x (1 - phi) + rho_s g_x phi,
//                     and of what holds held grains
// In steady state total stress and side wall stress together are the driving stress.
//
// The stress on a bed is the driving stress at its surface, the top of a layer, less that of side walls, and without
// what holds the grains that reach from the bed through the surface: what the flow above gives to those is given to the
// bed. What it gives to obstacles above the surface is not, and counts by height as that of solids does.
#pragma once

#include "analysis/observer/mean_observer.hpp"
#include "analysis/observer/observer_keys.hpp"
#include "analysis/tools/cell_layers.hpp"
#include "core/sums/reproducible_sum.hpp"

#include <mpi.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::analysis {

struct StressBalanceKeys {
  static constexpr const char* section = "stress_balance";
  static constexpr const char* meaning =
      "all stresses of grains and fluid over z, in profiles.h5, and the difference of their total from the driving "
      "stress of the steady state";
  static constexpr Needs needs = Needs::both;
  static constexpr const char* without_fluid = "use grain_profiles";
  double from = 0.0;                 // s: the means begin here
  double every = 0.01;               // s: between measurements
  std::optional<double> layer = {};  // m, wanted; a quarter of the smallest diameter where not given
  bool operator==(const StressBalanceKeys&) const = default;
};
void describe(SectionVisitor& visit, StressBalanceKeys& keys);
void check(const StressBalanceKeys& keys, const RunContext& run);
std::unique_ptr<Observer> make_observer(const StressBalanceKeys& keys, const RunContext& run,
                                        const RunningSystem& system);
// It keeps sums by layer, nothing of a grain.
inline ObserverMemory memory_of(const StressBalanceKeys&, const RunContext&, const RunSize&) { return {}; }

struct BalanceScales {
  double fluid_density = 0.0;           // kg/m^3
  double viscosity = 0.0;               // Pa s
  double diameter = 0.0;                // m, that stands for all grains
  GrainContext::Force body_force = {};  // on grains that are free
  double sound_speed = 0.0;             // m/s, of the lattice: gives the pressure
};

class BalancedBodies;

class StressBalance : public MeanObserver {
public:
  // layer: m, where the keys have none; layers are of whole planes of cells. z must not be periodic. obstacles: ids of
  // held grains that are none of the bed, ascending.
  StressBalance(MPI_Comm communicator, const Decomposition& decomposition, double layer, const StressBalanceKeys& keys,
                const BalanceScales& scales, std::vector<HeldGrains> held, std::vector<GlobalId> obstacles = {});

  bool needs_momentum() const override { return true; }
  bool needs_grain_stress() const override { return true; }

  // mean_from (s), measurements (1), bed_height (m): where, from above, the solid fraction first exceeds half of its
  // maximum, 0 where there is no bed (no grains, or less than a diameter between them and the top); bed_stress (Pa):
  // the driving stress there less that of side walls, solids and other obstacles, with what holds grains of the bed
  // that reach above (the largest of driving less side walls' stress where there is no bed); largest_difference (1): of
  // the total stress from the driving stress less the side walls', over the bed stress; largest_difference_at (m); and
  // of the sum of stresses, largest_difference_of_sum, largest_difference_of_sum_at.
  std::vector<Diagnostic> results() const override;
  std::vector<std::string> remarks() const override;

  // Over z (m, middle of the layer): thickness (m), solid_fraction (1), grain_velocity, fluid_velocity (m/s: x, y, z),
  // fluid_pressure (Pa, relative to its mean over the box), granular_temperature (m^2/s^2),
  // drag_density (N/m^3: x, y, z), drag_function, drag_reynolds_number (1; zero without grains), and in Pa:
  // contact_stress, grain_fluid_stress, lubrication_stress (xx, xy, xz, yx, ... zz), kinetic_stress, viscous_stress,
  // subgrid_stress, reynolds_stress, mean_flow_stress (xx, yy, zz, xy, xz, yz); xz alone: rotation_stress,
  // contact_rotation_stress, sum_of_stresses, total_stress, side_wall_stress, driving_stress.
  std::vector<Profile> profiles() const override;

private:
  // Columns of a plane of cells: PlaneMomentum.
  enum FluidColumn { cells, density = 1, flow = 2, flow_flux = 5, viscous = 11, subgrid = 17, fluid_columns = 23 };
  // Columns of a layer of grains (SI): sums over the parts inside the box; of forces and levers the top layer has what
  // lies above it, too. Levers are parts times their height over the layer's bottom.
  enum GrainColumn {
    volume,
    mass = 1,
    momentum = 2,
    momentum_flux = 5,
    contact_moment = 11,
    fluid_moment = 20,
    lubrication_moment = 29,
    fluid_force = 38,
    contact_force_x = 41,
    outer_force_x = 42,
    fluid_lever = 43,
    contact_lever = 44,
    outer_lever = 45,
    grain_columns = 46
  };
  using Tensor = std::array<double, 6>;  // xx, yy, zz, xy, xz, yz
  struct LayerMeans;
  struct Difference {
    double share = 0.0;  // share of the bed stress
    int layer = 0;
  };

  bool measure(const Snapshot& snapshot, bool counts) override;
  void add(const Snapshot& snapshot) override;
  void save_sums(ArchiveWriter& archive, const std::string& group) const override;
  bool load_sums(ArchiveReader& archive, const std::string& group) override;
  void add_fluid(const MomentumBudget& budget);
  void add_grains(const Snapshot& snapshot);
  void give_parts(const Snapshot& snapshot, const BalancedBodies& bodies, const TermTaker& take) const;
  void add_grains_at_walls(const Snapshot& snapshot);
  void add_holding(const Snapshot& snapshot, const BalancedBodies& bodies);
  std::array<double, fluid_columns> fluid_of(int layer) const;
  LayerMeans means_of(int layer) const;
  void set_fluid_means(int layer, LayerMeans& means) const;
  void set_grain_means(int layer, LayerMeans& means) const;
  void set_drag_law(LayerMeans& means) const;
  void set_totals(int layer, LayerMeans& means) const;
  double mean_density() const;
  double by_height_above(const std::vector<double>& half_planes, int layer) const;
  double driven_above(int layer) const;
  double above(int layer, const std::vector<double>& sums, int columns, int force, int lever) const;
  double above(int layer, GrainColumn force, GrainColumn lever) const;
  int bed_layer(const std::vector<LayerMeans>& layers) const;
  double stress_on_bed(int layer) const;
  static Difference largest_difference(const std::vector<LayerMeans>& layers, double LayerMeans::*total,
                                       double bed_stress);
  std::vector<LayerMeans> all_means() const;
  std::size_t stored_size() const;

  Index3 n_;        // cells of the domain
  double spacing_;  // m
  CellLayers layers_;
  BalanceScales scales_;
  std::vector<HeldGrains> held_;
  std::vector<GlobalId> obstacles_;
  // Over measurements and all ranks, on every rank.
  std::vector<double> fluid_;    // fluid_columns of each plane
  std::vector<double> grains_;   // grain_columns of each layer
  std::vector<double> given_;    // N, along x, on grains by half planes
  std::vector<double> sides_;    // N, along x, of the fluid on side walls by half planes
  std::vector<double> held_up_;  // of each layer: N, along x, of walls but the top on grains, and times the height at
                                 // which they act over the layer's bottom; last the same of the top
  std::vector<double> holding_;  // of each layer: N, along x, that holds grains of the bed, by those parts of them that
                                 // lie above it while others do not; and obstacles, less what the fluid gives to these
                                 // above it
  std::vector<double> driving_;  // N/m^3 times fluid cells, along x, of each plane; last: N on the top

  // Sums in the order of a checkpoint.
  static constexpr std::array stored{&StressBalance::fluid_,  &StressBalance::grains_,  &StressBalance::given_,
                                     &StressBalance::sides_,  &StressBalance::held_up_, &StressBalance::holding_,
                                     &StressBalance::driving_};
};

}  // namespace thalweg::analysis
