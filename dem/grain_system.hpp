// Grains alone, under gravity, between the walls of the box: the system `grains`. With a force field in place of a
// fluid it is the system `model_fluid`.
//
// One step is as many sub-steps as its parameters say, as in a fluid.
#pragma once

#include "core/state/system.hpp"
#include "dem/clumps/clump_seed.hpp"
#include "dem/grain_dynamics.hpp"

#include <mpi.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::dem {

// A grain that is slower than this, and accelerated by less, is at rest.
struct RestBounds {
  double speed = 0.0;         // m/s
  double acceleration = 0.0;  // m/s^2, by all forces
};

struct GrainSystemParameters {
  GrainParameters grains;                   // without body force
  Vec3 gravity = Vec3::Zero();              // m/s^2
  std::vector<std::string> measured_walls;  // names of all walls, in their order, or none
  std::optional<RestBounds> rest = {};      // counts the grains that are not at rest
  // Stands in for a fluid: sets the loads of the grains and has all attached columns (model_fluid.hpp); null: none.
  std::shared_ptr<ForceField> field = {};
  double fluid_density = 0.0;  // kg/m^3, of the buoyancy
};

class GrainSystem final : public System, private ContactSource {
public:
  // Throws InputError where the grains do not fit or the time step is too long. Collective.
  GrainSystem(const Decomposition& decomposition, MPI_Comm communicator, const GrainSystemParameters& parameters,
              GrainSeeds seeds);

  void advance() override;
  std::int64_t step() const override { return step_; }
  double time_step() const override { return time_step_; }
  Snapshot snapshot() const override;
  // Those of GrainDynamics::turnover_diagnostics(), and contacts (1), largest_overlap (diameters), of the free grains
  // largest_grain_speed (m/s), largest_grain_acceleration (m/s^2), with RestBounds restless_grains (1) and
  // restless_share (1: of the free grains), those of the field, and three for each measured wall and each solid (N):
  // wall_force_bottom_x ..., wall_force_wall_0_x ..., solid_0_grain_force_x ...
  std::vector<Diagnostic> diagnostics() const override;
  std::optional<Location> location_of(const std::string& diagnostic) const override;
  static constexpr const char* largest_speed_diagnostic = "largest_grain_speed";
  static constexpr const char* largest_acceleration_diagnostic = "largest_grain_acceleration";
  static constexpr const char* restless_diagnostic = "restless_grains";
  static constexpr const char* restless_share_diagnostic = "restless_share";
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;
  void import_grains(ArchiveReader& archive, double spacing) override;
  PhaseTimer& timer() override { return timer_; }
  std::int64_t cells() const override { return 0; }
  std::int64_t grain_steps_per_step() const override { return grains_.global_count() * sub_steps_; }

private:
  void for_each_contact(const ContactVisitor& visit) const override { grains_.for_each_contact(visit); }
  void for_each_contact_of(std::span<const char> chosen, const ContactEndVisitor& visit) const override {
    grains_.for_each_contact_of(chosen, visit);
  }
  void for_each_wall_force(const ContactEndVisitor& visit) const override { grains_.for_each_wall_force(visit); }

  std::shared_ptr<ForceField> field_;  // if there is one
  int sub_steps_;
  double time_step_;                     // s, of sub_steps_ sub-steps
  std::vector<std::string> wall_names_;  // whose forces are measured
  std::optional<RestBounds> rest_;
  GrainDynamics grains_;
  std::int64_t step_ = 0;
  PhaseTimer timer_;
  int lists_, motion_;  // phases
};

}  // namespace thalweg::dem
