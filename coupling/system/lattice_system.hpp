// A lattice fluid alone, or with solids (at rest or with prescribed motion), grains, or both. One step is one lattice
// step and, with grains, its DEM sub-steps.
#pragma once

#include "bodies/bodies.hpp"
#include "core/parallel/decomposition.hpp"
#include "core/state/system.hpp"
#include "coupling/keys/fluid_parameters.hpp"
#include "coupling/loads/mass_budget.hpp"
#include "coupling/system/grain_bodies.hpp"
#include "coupling/system/solid_bodies.hpp"
#include "dem/grain_dynamics.hpp"
#include "lbm/fluid/fluid_survey.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace thalweg::coupling {

struct LatticeParameters : FluidParameters {
  LoadAveraging load = LoadAveraging::extrapolated;  // of grains
  int sub_steps = 50;                                // DEM steps per lattice step
  bool wall_forces = false;                          // the diagnostics include the forces on walls
  std::vector<dem::PrescribedMotion> solid_motions;  // SI, of the first solids; the others stand still
};

template <typename Real>
class LatticeSystem final : public System, private FluidSource, private ContactSource {
public:
  // solids: lattice units, at the start. grains: null for none; they hold their seeds, carry attached_width attached
  // columns and reach ghost_reach() beyond their block. Takes both over. Throws InputError where a solid covers no cell
  // or a rank has more cells or bodies than links can tell apart. Collective.
  LatticeSystem(std::unique_ptr<Decomposition> decomposition, MPI_Comm communicator,
                const LatticeParameters& parameters, std::unique_ptr<dem::GrainDynamics> grains = nullptr,
                const std::vector<bodies::SolidShape>& solids = {});

  // Columns that dem carries for the exchange (grain_exchange.hpp).
  static constexpr int attached_width = GrainExchange<double>::width;

  // Distance (m) beyond a block within which the centres of grains must be known for the map.
  static double ghost_reach(double largest_radius, double spacing) { return largest_radius + 2.5 * spacing; }

  void advance() override;
  void record_momentum() override { next_.momentum_by_height = grains_ != nullptr; }
  void measure_grain_stress() override { next_.moments = grains_ != nullptr; }
  std::int64_t step() const override { return step_; }
  double time_step() const override { return parameters_.units.time_step; }
  Snapshot snapshot() const override;
  // largest_lattice_velocity (1), largest_fluid_speed (m/s), mean_density_deviation (1), fluid_cells (1), those of
  // add_extremes() (fluid_diagnostics.hpp); those of SolidBodies, of the last step: what the fluid exerts on the
  // surface of each solid, without the reference pressure. With grains largest_overlap (diameters), largest_grain_speed
  // (m/s), those of MassBudget, of add_momentum() and of GrainDynamics::turnover_diagnostics(), if asked for
  // wall_force_bottom_x ... and fluid_wall_force_bottom_x ... (N); without grains or with a held mean velocity
  // mean_velocity_x (m/s) and body_force_x (N/m^3). Collective.
  std::vector<Diagnostic> diagnostics() const override;
  std::optional<Location> location_of(const std::string& diagnostic) const override;
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;
  void import_fluid(ArchiveReader& archive, double spacing) override;
  void import_grains(ArchiveReader& archive, double spacing) override;
  PhaseTimer& timer() override { return timer_; }
  std::int64_t cells() const override;
  std::int64_t grain_steps_per_step() const override;

  const lbm::Fluid<Real>& fluid() const { return fluid_; }
  const bodies::Bodies<Real>& bodies() const { return bodies_; }
  const dem::GrainDynamics& grains() const { return *grains_; }  // only where there are any
  double mass_owed() const;  // to the fluid by grains and moving solids, lattice units; collective
  typename SolidBodies<Real>::Loads solid_loads() const { return solid_bodies_.loads(); }  // collective

private:
  FluidFields sample(const std::vector<FluidField>& wanted, const Block& region) const override;
  void for_each_velocity(const VelocityVisitor& visit) const override;
  std::optional<State> state_in(const Index3& cell) const override;
  Drive drive() const override;
  void for_each_contact(const ContactVisitor& visit) const override { grains_->for_each_contact(visit); }
  void for_each_lubrication(const ContactVisitor& visit) const override { grains_->for_each_lubrication(visit); }
  void for_each_contact_of(std::span<const char> chosen, const ContactEndVisitor& visit) const override {
    grains_->for_each_contact_of(chosen, visit);
  }
  void for_each_wall_force(const ContactEndVisitor& visit) const override { grains_->for_each_wall_force(visit); }

  bool has_bodies() const { return grains_ || bodies_.solids() > 0; }
  bool any_moves() const { return grains_ || solid_bodies_.any_moves(); }
  void place_solids_again();
  void name_phases();
  Vec3 velocity_at(const Vec3& point) const;
  void move_bodies();
  void exchange_behind_links();
  void record_momentum_budget();
  void take_loads();
  void advance_grains();
  void set_gravity_of(std::int64_t step);
  Vec3 held_force_on_grains() const;
  void open_mass_budget();
  void keep_mass();
  void show_grains(Snapshot& s) const;
  void add_grain_diagnostics(const lbm::FluidSurvey& survey, std::vector<Diagnostic>& diagnostics) const;
  void add_flow_diagnostics(const lbm::FluidSurvey& survey, std::vector<Diagnostic>& diagnostics) const;
  void add_wall_forces(std::vector<Diagnostic>& diagnostics) const;
  void add_solid_diagnostics(std::vector<Diagnostic>& diagnostics) const;

  std::unique_ptr<Decomposition> decomposition_;
  MPI_Comm communicator_;
  LatticeParameters parameters_;
  mutable lbm::Fluid<Real> fluid_;  // a sample fills slots that every step fills anew; see sample_fields()
  bodies::Hydrostatic rest_;
  bodies::Bodies<Real> bodies_;
  SolidBodies<Real> solid_bodies_;
  std::unique_ptr<dem::GrainDynamics> grains_;     // null: none
  std::optional<GrainBodies<Real>> grain_bodies_;  // with grains
  bodies::StepMeasurements next_;                  // of the next step
  std::optional<MomentumBudget> momentum_;         // of the last step
  MassBudget mass_;                                // with grains
  double start_excess_ = 0.0;                      // without: the excess mass at the start; lattice units
  std::int64_t step_ = 0;
  PhaseTimer timer_;
  struct Phases {
    int lattice, map, refill, halo, walls, links, sweep, loads, grains;
  } phases_{};
};

}  // namespace thalweg::coupling
