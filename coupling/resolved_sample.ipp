// What a resolved system shows of its fluid: fields, velocities, and the momentum of a step.
#pragma once

#include "coupling/fluid_sample.hpp"
#include "coupling/momentum_book.hpp"
#include "coupling/resolved_system.hpp"

namespace thalweg::coupling {

template <typename Real>
FluidFields ResolvedSystem<Real>::sample(const std::vector<FluidField>& wanted, const Block& region) const {
  SampleContext context;
  context.units = parameters_.units;
  context.grain_id = [this](std::int32_t slot) { return static_cast<std::int32_t>(map_.bodies()[slot].id); };
  context.apply_links = [this] {
    std::vector<bodies::LinkBody> bodies = bodies_;  // takes up the momentum, which belongs to the next step
    bodies::LinkPass<Real> links(fluid_, links_, lattice_box_, parameters_.links, bodies);
    for (int tile = 0; tile < fluid_.tiles().count(); ++tile) links.apply_tile(tile);
  };
  return sample_fields(fluid_, context, wanted, region);
}

template <typename Real>
void ResolvedSystem<Real>::for_each_velocity(const VelocityVisitor& visit) const {
  visit_velocities(fluid_, parameters_.units, visit);
}

template <typename Real>
std::optional<FluidSource::State> ResolvedSystem<Real>::state_in(const Index3& cell) const {
  return state_of(fluid_, parameters_.units, cell);
}

template <typename Real>
FluidSource::Drive ResolvedSystem<Real>::drive() const {
  return drive_of(fluid_, parameters_.units, parameters_.links.reference_density);
}

// The links of this step are applied twice: here on copies of the bodies, so that all that streams in lies ready.
template <typename Real>
void ResolvedSystem<Real>::write_momentum_book() {
  std::vector<bodies::LinkBody> bodies = bodies_;
  bodies::LinkPass<Real> links(fluid_, links_, lattice_box_, parameters_.links, bodies, nullptr, &given_by_height_);
  for (int tile = 0; tile < fluid_.tiles().count(); ++tile) links.apply_tile(tile);
  momentum_ = book_of(fluid_, parameters_.units, parameters_.links.reference_density, given_by_height_);
  booking_ = false;
}

}  // namespace thalweg::coupling
