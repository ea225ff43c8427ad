// The force of model_fluid.hpp on every grain, as a force field. On a clump it acts at the centre, as on a sphere
// (disk) of its volume.
#pragma once

#include "dem/force_field.hpp"
#include "model_fluid/local_solid_fraction.hpp"
#include "model_fluid/model_fluid.hpp"
#include "model_fluid/shields_ramp.hpp"

#include <optional>
#include <vector>

namespace thalweg::model_fluid {

struct ModelFluidParameters {
  ModelFluidNumbers numbers;
  GrainScales scales;
  VelocityProfile profile;
  SolidFractionParameters solid_fraction;
  std::optional<ShieldsRampParameters> ramp;  // else the Shields number is constant
};

class ModelFluidField final : public dem::ForceField {
public:
  ModelFluidField(const PeriodicBox& box, const ModelFluidParameters& parameters);

  int attached_columns() const override { return fraction_.columns(); }
  double reach() const override { return fraction_.reach(); }
  void fill_columns(dem::GrainStore& store, const dem::Clumps& clumps) override { fraction_.weigh(store, clumps); }
  void find_neighbours(const dem::GrainStore& store, double skin, const dem::Clumps& clumps) override;
  void act(dem::PackedGrainState& grains, dem::GrainStore& store, dem::Clumps& clumps,
           std::span<const Vec3> body_force) override;
  void step_ended(const dem::GrainDynamics& grains, double time) override;
  // Diagnostics of a ramp: shields_number; reynolds_number, Re_* as printed, which grows with its root; and hold_left
  // (s), the time left until motion since the last step up counts as permanent.
  std::vector<Diagnostic> diagnostics(double time) const override;
  static constexpr const char* hold_left_diagnostic = "hold_left";
  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

private:
  double shields_number() const { return parameters_.numbers.shields * (ramp_ ? ramp_->factor() : 1.0); }
  void update_coefficients();
  void update_flow(std::size_t slot);
  ModelForce force_on(std::size_t slot, double radius, const Vec3& velocity) const;
  void act_on_clump(std::size_t n, dem::GrainStore& store, dem::Clumps& clumps) const;

  ModelFluidParameters parameters_;
  ModelFluidCoefficients coefficients_;
  std::optional<ShieldsRamp> ramp_;
  LocalSolidFraction fraction_;
  std::vector<double> velocity_;  // m/s, of the fluid around each owned grain, of a clump by its first member
  std::vector<double> lift_;      // (phi_below - phi_above)/0.3
};

}  // namespace thalweg::model_fluid
