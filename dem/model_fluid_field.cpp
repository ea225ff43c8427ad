#include "dem/model_fluid_field.hpp"

namespace thalweg::dem {

ModelFluidField::ModelFluidField(const PeriodicBox& box, const ModelFluidParameters& parameters)
    : parameters_(parameters), fraction_(box, parameters.solid_fraction) {}

void ModelFluidField::act(MovingGrains& grains, GrainStore& store, std::span<const Vec3> body_force) {
  fraction_.update(grains, store);
  const ModelFluidCoefficients& c = parameters_.coefficients;
  for (std::size_t s = 0; s < store.owned; ++s) {
    MovingGrain& grain = grains[s];
    const double radius = grain.position[3];
    const bool held = parameters_.rough_floor && grain.position[2] < radius;
    if (held) grain.velocity[0] = grain.velocity[1] = 0.0;
    const double fluid = c.velocity * parameters_.profile(LocalSolidFraction::around(store, s));
    const double lift = LocalSolidFraction::below_less_above(store, s) / lift_scale;
    const ModelForce f = model_force(c, 2.0 * radius / parameters_.mean_diameter, fluid, grain.velocity[0],
                                     grain.velocity[1], grain.velocity[2], lift);
    store.load_force[s] = Vec3(f.x, f.y, f.z);
    const Vec3 load = store.load_force[s] + body_force[s];
    if (held) {  // the floor takes what would move it along
      grain.force[0] = -load.x();
      grain.force[1] = -load.y();
    }
    grains.set_load(s, load);
  }
}

}  // namespace thalweg::dem
