#include "driver/input/run_facts.hpp"

#include "driver/estimate/grain_weight.hpp"
#include "driver/estimate/obstacles.hpp"
#include "driver/estimate/reference_grain.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::driver {

namespace {

// The ids of grains count population by population (grain_seeds()).
std::vector<analysis::Population> populations_of(const Case& c) {
  std::vector<analysis::Population> populations;
  GlobalId first = 0;
  for (std::size_t p = 0; p < c.grains.size(); ++p) {
    const beds::Population& grains = c.grains[p];
    std::function<Vec3(double)> pivot = [centre = Vec3(0.5 * c.domain.size)](double) { return centre; };
    if (grains.motion && grains.motion->rotation)
      pivot = [motion = prescribed_motion(*grains.motion)](double time) -> Vec3 {
        return motion.centre + motion.displacement(time);
      };
    const GlobalId end = first + grains.row_count();
    populations.push_back({fmt::format("grains_{}", p), first, end, pivot, grains.held(), grains.clumps.count > 0});
    first = end;
  }
  return populations;
}

analysis::FluidFacts fluid_facts(const Case& c) {
  return {c.fluid.density,
          c.fluid.kinematic_viscosity,
          units_of(c).velocity(),
          c.fluid.mean_velocity.has_value(),
          c.domain.faces[y_low].drags() + c.domain.faces[y_high].drags(),
          c.domain.faces[top].drags(),
          c.domain.faces[top].type == lbm::FaceType::moving && c.domain.faces[top].velocity.x() != 0.0};
}

analysis::GrainFacts grain_facts(const Case& c) {
  const ReferenceGrain reference = reference_grain(c);
  analysis::GrainFacts facts{populations_of(c),    reference.diameter,  reference.density,
                             smallest_diameter(c), largest_diameter(c), c.disks ? c.disks->thickness : 0.0};
  for (const analysis::SphereInBed& sphere : obstacles_of(c).spheres) facts.obstacles.push_back(sphere.id);
  if (!has_fluid(c)) return facts;
  facts.body_force = body_force(c);
  facts.submerged_weight = submerged_weight(c);
  facts.buoyancy = buoyancy_in_load(c);
  return facts;
}

}  // namespace

analysis::RunFacts run_facts(const Case& c) {
  analysis::RunFacts facts;
  facts.box = {c.domain.size, periodic_axes(c.domain)};
  facts.until = c.run.until;
  facts.ramp = c.run.ramp;
  facts.gravity = gravity_vector(c.gravity);
  if (has_fluid(c)) facts.fluid = fluid_facts(c);
  if (c.system == SystemKind::model_fluid) {
    const model_fluid::ModelFluidParameters fluid = model_fluid_of(c);
    facts.model_fluid = {coefficients_of(fluid.numbers, fluid.scales).velocity, fluid.scales.gravity};
  }
  if (!c.grains.empty()) facts.grains = grain_facts(c);
  return facts;
}

io::PopulationEnds population_ends(const Case& c) {
  io::PopulationEnds ends;
  for (const beds::Population& grains : c.grains) ends.push_back((ends.empty() ? 0 : ends.back()) + grains.row_count());
  return ends;
}

io::GrainOutputFacts grain_output_facts(const Case& c) {
  io::GrainOutputFacts facts;
  facts.population_ends = population_ends(c);
  facts.box_size = c.domain.size;
  facts.clumps = std::any_of(c.grains.begin(), c.grains.end(),
                             [](const beds::Population& grains) { return grains.clumps.count > 0; });
  facts.fluid_force = has_fluid(c) || c.system == SystemKind::model_fluid;
  facts.fluid_stress = measures_grain_stress(c);
  return facts;
}

}  // namespace thalweg::driver
