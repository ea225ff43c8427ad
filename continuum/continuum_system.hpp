// A column of the two-phase continuum as a system: what the time loop drives, shows, saves and loads. One step is one
// interval of the stiff integrator, which begins anew with each. Every rank holds and advances the whole column.
#pragma once

#include "continuum/column_equations.hpp"
#include "continuum/granular_fluidity.hpp"
#include "continuum/stiff_integrator.hpp"
#include "core/parallel/decomposition.hpp"
#include "core/state/system.hpp"

#include <mpi.h>

#include <memory>
#include <optional>
#include <vector>

namespace thalweg::continuum {

// rest: fluid and grains. flow: the water flows as the mixing length has it over a bed at rest.
enum class ColumnStart { flow, rest };
std::vector<NamedChoice<ColumnStart>> choices_of(ColumnStart);

inline constexpr double creep_decay_depth = 7.0;  // diameters: the decay length is fitted from here up

struct CreepParameters {
  double nonlocal_amplitude = 0.43;             // A
  std::optional<double> rate_coefficient = {};  // b'; else local_rate_coefficient()
  double upper = 2.0,
         lower = 10.0;  // diameters below the surface: the ends; upper is one above creep_decay_depth or more
  double surface_fluidity = 1e-2;  // 1/s, at the upper end
  bool operator==(const CreepParameters&) const = default;
};

struct SystemParameters {
  ColumnParameters column;
  int bed_cells = 0;       // at the start, from the floor
  double depth = 0.0;      // m, of the water above them
  double time_step = 0.0;  // s, of one interval
  ColumnStart start = ColumnStart::flow;
  std::optional<CreepParameters> creep;
};

// The creep of a bed at rest under the flow; parameters.creep must be there. Throws as creep_of().
Creep creep_below(const SystemParameters& parameters);

class ContinuumSystem final : public System {
public:
  // Throws InputError where creep has no steady state. Collective.
  ContinuumSystem(MPI_Comm communicator, const SystemParameters& parameters);

  void advance() override;
  std::int64_t step() const override { return step_; }
  double time_step() const override { return parameters_.time_step; }
  Snapshot snapshot() const override;

  // q_s (m^2/s), q_star (1), shields_number (1: of the stress on the surface), bed_stress (Pa), surface_height (m:
  // where phi is half of the densest, or the top where the grains reach it), moving_depth (m: of grains below the
  // surface faster than a hundredth of the fastest grain at or below it), largest_grain_speed, largest_fluid_speed
  // (m/s), solid_volume (m), integrator_steps (1), unsteadiness (1), and with creep creep_decay_length,
  // creep_decade_length (m).
  //
  // unsteadiness: the larger of two changes over the latest step, of momentum, over the driving stress on the floor
  // times the step, and of q_s, relative (to 1e-4 sqrt((s - 1) g d^3) where it is less). 1 before the first step.
  std::vector<Diagnostic> diagnostics() const override;
  static constexpr const char* unsteadiness_diagnostic = "unsteadiness";

  // Over z (m, cell middles), named and shaped as those of analysis::StressBalance where they are the same: thickness,
  // solid_fraction, grain_velocity, fluid_velocity, drag_density (x, y, z), drag_function, drag_reynolds_number,
  // grain_pressure, grain_shear_stress, fluid_shear_stress, total_stress, driving_stress (Pa), eddy_viscosity (Pa s),
  // drift_velocity, and over a depth of its own creep_depth, creep_stress_ratio, creep_fluidity, creep_velocity.
  std::vector<Profile> profiles() const override;

  void save(ArchiveWriter& archive) const override;
  // Throws InputError where the state has another step, or cells of another number or height.
  void load(ArchiveReader& archive) override;
  PhaseTimer& timer() override { return timer_; }
  std::int64_t cells() const override { return 0; }
  std::int64_t grain_steps_per_step() const override { return 0; }

  const std::vector<double>& unknowns() const { return unknowns_; }  // in the order of ColumnEquations
  const ColumnEquations& equations() const { return equations_; }

private:
  double transport_rate() const;  // q_s, m^2/s
  double momentum() const;        // kg/(m s), along x, of both phases
  double driving_stress(std::size_t face) const;
  double surface_height() const;
  double bed_stress() const;
  double largest_grain_speed() const;  // m/s, where there are grains
  double moving_depth(double surface) const;
  void add_creep(std::vector<Profile>& profiles) const;

  MPI_Comm communicator_;
  SystemParameters parameters_;
  Decomposition decomposition_;
  ColumnEquations equations_;
  StiffIntegrator integrator_;
  std::vector<double> unknowns_;
  double transport_change_ = 1.0, momentum_change_ = 1.0;  // over the latest step
  std::int64_t integrator_steps_ = 0;                      // since the start of the run
  std::int64_t step_ = 0;
  std::optional<BedStress> creep_stress_;
  std::optional<Creep> creep_;
  PhaseTimer timer_;
  int phase_;
};

}  // namespace thalweg::continuum
