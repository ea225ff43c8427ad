// A fluid without grains as a system: what the time loop drives, shows, saves and loads. One step is one lattice step.
// Solids that stand still may be in it.
#pragma once

#include "bodies/bodies.hpp"
#include "core/decomposition.hpp"
#include "core/system.hpp"
#include "coupling/fluid_parameters.hpp"
#include "coupling/solid_forces.hpp"

#include <memory>
#include <vector>

namespace thalweg::coupling {

template <typename Real>
class FluidSystem final : public System, private FluidSource {
public:
  // solids: lattice units. Throws InputError where one covers no cell. Collective.
  FluidSystem(std::unique_ptr<Decomposition> decomposition, MPI_Comm communicator, const FluidParameters& parameters,
              const std::vector<bodies::SolidShape>& solids = {});

  void advance() override;
  std::int64_t step() const override { return step_; }
  double time_step() const override { return parameters_.units.time_step; }
  Snapshot snapshot() const override;
  // largest_lattice_velocity (1), largest_fluid_speed (m/s), mean_velocity_x (m/s), body_force_x (N/m^3),
  // mean_density_deviation (1), fluid_cells (1), of each solid solid_<n>_force_x, _y, _z (N), of the last step: what
  // the fluid exerts on its surface, without the reference pressure, and those of add_extremes() (fluid_figures.hpp).
  std::vector<Figure> figures() const override;
  std::optional<Place> place_of(const std::string& figure) const override;
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;
  void take_fluid(ArchiveReader& archive, double spacing) override;
  PhaseTimer& timer() override { return timer_; }
  std::int64_t cells() const override;
  std::int64_t grain_steps_per_step() const override { return 0; }

  const lbm::Fluid<Real>& fluid() const { return fluid_; }
  const bodies::Bodies<Real>* solids() const { return solids_.get(); }           // null: none
  std::vector<Vec3> solid_forces() const { return solid_forces_.of(*solids_); }  // in the last step; collective

private:
  void advance_around_solids();
  void keep_mass();
  FluidFields sample(const std::vector<FluidField>& wanted, const Block& region) const override;
  void for_each_velocity(const VelocityVisitor& visit) const override;
  std::optional<State> state_in(const Index3& cell) const override;
  Drive drive() const override;

  std::unique_ptr<Decomposition> decomposition_;
  MPI_Comm communicator_;
  FluidParameters parameters_;
  mutable lbm::Fluid<Real> fluid_;  // a sample fills slots that every step fills anew; see sample_fields()
  bodies::Hydrostatic rest_;
  SolidForces solid_forces_;
  std::unique_ptr<bodies::Bodies<Real>> solids_;  // null: none
  double start_excess_ = 0.0;                     // mass beyond that of the fluid at rest, at the start; lattice units
  std::int64_t step_ = 0;
  PhaseTimer timer_;
  struct Phases {
    int lattice, halo, walls, links, sweep;
  } phases_{};
};

}  // namespace thalweg::coupling
