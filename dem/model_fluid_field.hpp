// The force of model_fluid.hpp on every grain, as a force field, with a floor that no grain slides on.
#pragma once

#include "dem/force_field.hpp"
#include "dem/local_solid_fraction.hpp"
#include "dem/model_fluid.hpp"

#include <vector>

namespace thalweg::dem {

struct ModelFluidParameters {
  ModelFluidCoefficients coefficients;
  VelocityProfile profile;
  double mean_diameter;  // m
  SolidFractionParameters solid_fraction;
  bool rough_floor = true;  // grains that touch the floor at z = 0 do not move along it
};

class ModelFluidField final : public ForceField {
public:
  ModelFluidField(const PeriodicBox& box, const ModelFluidParameters& parameters);

  int attached_columns() const override { return LocalSolidFraction::columns; }
  double reach() const override { return fraction_.reach(); }
  void find_neighbours(const GrainStore& store, double skin) override;
  void act(MovingGrains& grains, GrainStore& store, std::span<const Vec3> body_force) override;

private:
  void update_flow(std::size_t slot);

  ModelFluidParameters parameters_;
  LocalSolidFraction fraction_;
  std::vector<double> velocity_;  // m/s, of the fluid around each owned grain
  std::vector<double> lift_;      // (phi_below - phi_above)/0.3
};

}  // namespace thalweg::dem
