#include "driver/input/run_context.hpp"

#include "beds/sizes/size_classes.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/bed/grain_weight.hpp"
#include "driver/bed/obstacles.hpp"
#include "driver/bed/reference_grain.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::driver {

namespace {

// The ids of grains count population by population (grain_seeds()).
std::vector<analysis::PopulationContext> populations_of(const Case& c) {
  std::vector<analysis::PopulationContext> populations;
  GlobalId first = 0;
  for (std::size_t p = 0; p < c.grains.size(); ++p) {
    const beds::Population& grains = c.grains[p];
    std::function<Vec3(double)> pivot = [centre = Vec3(0.5 * c.domain.size)](double) { return centre; };
    if (grains.motion && grains.motion->rotation)
      pivot = [motion = prescribed_motion(*grains.motion)](double time) -> Vec3 {
        return motion.centre + motion.displacement(time);
      };
    const GlobalId end = first + grains.row_count();
    const std::int64_t members = grains.shape ? static_cast<std::int64_t>(grains.shape->clump.size()) : 1;
    populations.push_back(
        {fmt::format("grains_{}", p), first, end, pivot, grains.held(), grains.clumps.count > 0, members});
    first = end;
  }
  return populations;
}

analysis::FluidContext fluid_context(const Case& c) {
  return {c.fluid.density,
          c.fluid.kinematic_viscosity,
          units_of(c).velocity(),
          c.fluid.mean_velocity.has_value(),
          side_walls(c),
          c.domain.faces[top].drags(),
          moves_along_x(c.domain.faces[top]),
          !c.solids.empty(),
          side_walls_move(c)};
}

// Sizes of free grains, and the classes that suit them: the sieves of their populations, where they have some.
void add_sizes(const Case& c, analysis::GrainContext& context) {
  if (!c.analysis.observers.of<analysis::FractionalTransportKeys>()) return;
  const std::vector<beds::SizeCount> sizes = represented_sizes(c);
  context.smallest_free = sizes.front().diameter;
  context.largest_free = sizes.back().diameter;
  std::vector<double> sieves;
  for (const beds::Population& grains : c.grains)
    if (!grains.held() && grains.sizes.sieve)
      sieves.insert(sieves.end(), grains.sizes.sieve->sizes.begin(), grains.sizes.sieve->sizes.end());
  context.size_class_edges = beds::size_class_edges(sizes, std::move(sieves));
}

analysis::GrainContext grain_context(const Case& c) {
  const ReferenceGrain reference = reference_grain(c);
  analysis::GrainContext context{populations_of(c),    reference.diameter,  reference.density,
                                 smallest_diameter(c), largest_diameter(c), c.disks ? c.disks->thickness : 0.0};
  add_sizes(c, context);
  context.supplied = population_ids(c).supplied;
  context.recirculation =
      std::any_of(c.sinks.begin(), c.sinks.end(), [](const auto& sink) { return sink.recirculation.has_value(); });
  for (const analysis::SphereInBed& sphere : obstacles_of(c).spheres) context.obstacles.spheres.push_back(sphere.id);
  context.obstacles.solids_below = solids_below(c);
  if (!has_fluid(c)) return context;
  // Only where some may float: telling them apart takes two reductions in every look at the bed.
  const auto may_float = [&c](const beds::Population& grains) { return !grains.held() && floats(c, grains); };
  if (gravity_vector(c.gravity).z() < 0.0 && std::any_of(c.grains.begin(), c.grains.end(), may_float))
    context.obstacles.floating_density = (1.0 + neutral_density) * c.fluid.density;
  context.body_force = body_force(c);
  context.submerged_weight = submerged_weight(c);
  context.buoyancy = buoyancy_in_load(c);
  return context;
}

}  // namespace

analysis::RunContext run_context(const Case& c) {
  analysis::RunContext context;
  context.box = {c.domain.size, periodic_axes(c.domain)};
  context.until = c.run.until;
  context.has_rows = c.output.series.every > 0.0 && c.output.series.every <= c.run.until;
  context.ramp = c.run.ramp;
  context.gravity = gravity_vector(c.gravity);
  if (has_fluid(c)) context.fluid = fluid_context(c);
  if (c.system == SystemKind::model_fluid) {
    const model_fluid::ModelFluidParameters fluid = model_fluid_of(c);
    context.model_fluid = {coefficients_of(fluid.numbers, fluid.scales).velocity, fluid.scales.gravity};
  }
  if (!c.grains.empty()) context.grains = grain_context(c);
  return context;
}

PopulationIds population_ids(const Case& c) {
  PopulationIds ids;
  for (const beds::Population& grains : c.grains)
    ids.ends.push_back((ids.ends.empty() ? 0 : ids.ends.back()) + grains.row_count());
  for (const beds::SupplyKeys& supply : c.supplies) {
    const beds::Population& grains = c.grains[static_cast<std::size_t>(supply.population)];
    ids.supplied.insert(ids.supplied.end(), grains.shape ? grains.shape->clump.size() : 1, supply.population);
  }
  return ids;
}

io::GrainOutputFacts grain_output_facts(const Case& c) {
  io::GrainOutputFacts facts;
  facts.population_ids = population_ids(c);
  facts.box_size = c.domain.size;
  facts.clumps = std::any_of(c.grains.begin(), c.grains.end(),
                             [](const beds::Population& grains) { return grains.clumps.count > 0; });
  facts.fluid_force = has_fluid(c) || c.system == SystemKind::model_fluid;
  facts.fluid_stress = has_fluid(c);
  return facts;
}

}  // namespace thalweg::driver
