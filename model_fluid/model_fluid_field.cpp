#include "model_fluid/model_fluid_field.hpp"

#include "dem/grain_dynamics.hpp"

#include <cmath>

namespace thalweg::model_fluid {

ModelFluidField::ModelFluidField(const PeriodicBox& box, const ModelFluidParameters& parameters)
    : parameters_(parameters), fraction_(box, parameters.solid_fraction) {
  if (parameters.ramp) ramp_.emplace(*parameters.ramp);
  update_coefficients();
}

void ModelFluidField::update_coefficients() {
  const ModelFluidNumbers& n = parameters_.numbers;
  coefficients_ = coefficients_of(n, parameters_.scales);
  if (ramp_) coefficients_ = at_shields_number(shields_number(), n.lift_ratio, coefficients_, parameters_.scales);
}

void ModelFluidField::find_neighbours(const dem::GrainStore& store, double skin, const dem::Clumps& clumps) {
  fraction_.find_neighbours(store, skin, clumps);
  velocity_.assign(store.owned, 0.0);
  lift_.assign(store.owned, 0.0);
  for (std::size_t s = 0; s < store.owned; ++s) update_flow(s);
}

void ModelFluidField::update_flow(std::size_t slot) {
  velocity_[slot] = coefficients_.velocity * parameters_.profile(fraction_.around(slot));
  if (parameters_.solid_fraction.lift) lift_[slot] = fraction_.below_less_above(slot) / lift_scale;
}

ModelForce ModelFluidField::force_on(std::size_t slot, double radius, const Vec3& v) const {
  return model_force(coefficients_, 2.0 * radius / parameters_.scales.diameter, velocity_[slot], v.x(), v.y(), v.z(),
                     lift_[slot]);
}

void ModelFluidField::act(dem::PackedGrainState& grains, dem::GrainStore& store, dem::Clumps& clumps,
                          std::span<const Vec3> body_force) {
  for (const std::uint32_t s : fraction_.update(grains, clumps, store)) update_flow(s);
  for (std::size_t s = 0; s < store.owned; ++s) {
    if (store.clump[s] >= 0) continue;
    const dem::PackedGrain& grain = grains[s];
    const double radius = grain.position[3];
    const ModelForce f = force_on(s, radius, dem::vector_of(grain.velocity));
    store.load_force[s] = Vec3(f.x, f.y, f.z);
    const Vec3 load = store.load_force[s] + body_force[s];
    grains.set_load(s, load);
  }
  for (std::size_t n = 0; n < clumps.size(); ++n) act_on_clump(n, store, clumps);
}

void ModelFluidField::act_on_clump(std::size_t n, dem::GrainStore& store, dem::Clumps& clumps) const {
  const ModelForce f = force_on(clumps.first_slot(n), clumps.radius_of(clumps[n]), clumps[n].velocity);
  clumps.set_central_force(n, Vec3(f.x, f.y, f.z), store);
}

void ModelFluidField::step_ended(const dem::GrainDynamics& grains, double time) {
  if (!ramp_) return;
  if (ramp_->watches_share()) ramp_->watch(grains.moving_share(ramp_->moving_speed()));
  if (!ramp_->advance(time, grains.largest_free_speed() / coefficients_.velocity, grains.largest_acceleration()))
    return;
  update_coefficients();
  for (std::size_t s = 0; s < velocity_.size(); ++s) update_flow(s);
}

std::vector<Diagnostic> ModelFluidField::diagnostics(double time) const {
  if (!ramp_) return {};
  return {{"shields_number", "1", shields_number()},
          {"reynolds_number", "1", parameters_.numbers.reynolds * std::sqrt(ramp_->factor())},
          {hold_left_diagnostic, "s", ramp_->hold_left(time)}};
}

void ModelFluidField::save(ArchiveWriter& archive) const {
  if (ramp_) ramp_->save(archive);
}

void ModelFluidField::load(ArchiveReader& archive) {
  if (!ramp_) return;
  ramp_->load(archive);
  update_coefficients();
}

}  // namespace thalweg::model_fluid
