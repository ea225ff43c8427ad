#include "analysis/observers/population_loads.hpp"

#include "core/sums/reproducible_sum.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <utility>

namespace thalweg::analysis {

PopulationLoads::PopulationLoads(MPI_Comm communicator, const PeriodicBox& box,
                                 std::vector<PopulationContext> populations, bool with_fluid,
                                 std::vector<std::int64_t> supplied)
    : communicator_(communicator),
      box_(box),
      populations_(std::move(populations)),
      ids_{{}, std::move(supplied)},
      with_fluid_(with_fluid) {
  for (const PopulationContext& population : populations_) {
    ids_.ends.push_back(population.end);
    for (const char* source : {"contact", "fluid"}) {
      if (!with_fluid_ && source[0] == 'f') continue;
      for (const auto& [what, unit] : {std::pair("force", "N"), std::pair("torque", "N m")})
        for (const char axis : {'x', 'y', 'z'})
          diagnostics_.push_back({fmt::format("{}_{}_{}_{}", population.name, source, what, axis), unit, 0.0});
    }
  }
}

void PopulationLoads::observe(const Snapshot& snapshot) {
  const GrainView& grains = snapshot.grains;
  const std::size_t columns = with_fluid_ ? 12 : 6;
  auto diagnostic = diagnostics_.begin();
  std::vector<double> terms;
  const auto add = [&terms](const Vec3& v) { terms.insert(terms.end(), v.data(), v.data() + 3); };
  std::vector<std::int64_t> population;  // of each grain
  for (const GlobalId id : grains.id) population.push_back(population_of(id, ids_));
  for (std::size_t p = 0; p < populations_.size(); ++p) {
    const Vec3 pivot =
        box_.wrapped_from_afar(populations_[p].pivot(snapshot.time));  // it goes on where grains come back
    terms.clear();
    for (std::size_t i = 0; i < grains.id.size(); ++i) {
      if (population[i] != static_cast<std::int64_t>(p)) continue;
      const Vec3 arm = box_.difference(grains.position[i], pivot);
      add(grains.contact_force[i]);
      add(arm.cross(grains.contact_force[i]) + grains.contact_torque[i]);
      if (!with_fluid_) continue;
      add(grains.fluid_force[i]);
      add(arm.cross(grains.fluid_force[i]) + grains.fluid_torque[i]);
    }
    for (const double sum : reproducible_sums(communicator_, terms, columns)) (diagnostic++)->value = sum;
  }
}

void describe(SectionVisitor&, PopulationLoadsKeys&) {}

std::unique_ptr<Observer> make_observer(const PopulationLoadsKeys&, const RunContext& run,
                                        const RunningSystem& system) {
  return std::make_unique<PopulationLoads>(system.communicator, run.box, run.grains->populations,
                                           run.fluid || run.model_fluid, run.grains->supplied);
}

}  // namespace thalweg::analysis
