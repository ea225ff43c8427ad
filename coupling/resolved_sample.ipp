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
  context.grain_id = [this](std::int32_t slot) {
    return static_cast<std::int32_t>(bodies_.mapped()[static_cast<std::size_t>(slot)].id);
  };
  context.apply_links = [this] { bodies_.apply_links_on_copies(); };
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
  return drive_of(fluid_, parameters_.units, bodies_.reference_density());
}

template <typename Real>
void ResolvedSystem<Real>::write_momentum_book() {
  momentum_ = book_of(fluid_, parameters_.units, bodies_.reference_density(), bodies_.momentum_by_height());
  booking_ = false;
}

}  // namespace thalweg::coupling
