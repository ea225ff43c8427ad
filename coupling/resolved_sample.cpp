// What a resolved system shows of its fluid: fields, velocities, and the momentum it carries and hands over.
#include "coupling/fluid_sample.hpp"
#include "coupling/momentum_sample.hpp"
#include "coupling/resolved_system.hpp"

namespace thalweg::coupling {

template <typename Real>
FluidFields ResolvedSystem<Real>::sample(const std::vector<FluidField>& wanted) const {
  SampleContext context;
  context.units = parameters_.units;
  context.grain_id = [this](std::int32_t slot) { return static_cast<std::int32_t>(map_.grains()[slot].id); };
  context.apply_links = [this] {
    std::vector<lbm::LinkBody> bodies = bodies_;  // takes up the momentum, which belongs to the next step
    lbm::LinkPass<Real> links(fluid_, links_, lattice_box_, parameters_.links, bodies);
    for (int tile = 0; tile < fluid_.tiles().count(); ++tile) links.apply_tile(tile);
  };
  return sample_fields(fluid_, context, wanted);
}

template <typename Real>
void ResolvedSystem<Real>::for_each_velocity(const VelocityVisitor& visit) const {
  visit_velocities(fluid_, parameters_.units, visit);
}

// Grains are where the coming step will find them; their cells are those of the step just done.
template <typename Real>
MomentumBudget ResolvedSystem<Real>::for_each_momentum(const MomentumVisitor& visit) const {
  return sample_momentum(
      fluid_, parameters_.units, parameters_.links.reference_density,
      [this](std::vector<FixedVec3>& by_height) {
        std::vector<lbm::LinkBody> bodies = bodies_;
        for (std::size_t g = 0; g < grains_->store().total(); ++g) place_body(g, bodies[map_slot_[g]]);
        lbm::LinkPass<Real> links(fluid_, links_, lattice_box_, parameters_.links, bodies, nullptr, nullptr,
                                  &by_height);
        for (int tile = 0; tile < fluid_.tiles().count(); ++tile) links.apply_tile(tile);
      },
      visit);
}

template class ResolvedSystem<float>;
template class ResolvedSystem<double>;

}  // namespace thalweg::coupling
