#include "dem/population_rows.hpp"

#include "dem/grain_volume.hpp"
#include "dem/population_clumps.hpp"
#include "dem/population_seeds.hpp"

namespace thalweg::dem {
namespace {

// A clump's members, one clump after the other.
void add_clumps(const Population& population, PopulationRow row, std::vector<PopulationRow>& rows) {
  const auto shape = clump_shape_of(population);
  row.mass = population.density * shape->volume;
  row.contact_mass = population.clumps.least_contact_mass;
  for (std::int64_t clump = 0; clump < population.count; ++clump)
    for (const Sphere& member : shape->members) {
      row.radius = member.radius;
      rows.push_back(row);
    }
}

}  // namespace

std::vector<PopulationRow> rows_of(std::span<const Population> populations, std::size_t number) {
  const Population& population = populations[number];
  PopulationRow row;
  row.motion = motion_of(population);
  row.material = material_of(populations, number);
  std::vector<PopulationRow> rows;
  if (population.shape) {
    add_clumps(population, row, rows);
    return rows;
  }
  for (std::size_t n = 0; n < static_cast<std::size_t>(population.row_count()); ++n) {
    row.radius = 0.5 * population.diameter_of(n);
    const bool member = !population.file.empty() && population.file[n].clump >= 0;
    row.mass = member ? 0.0 : population.density_of(n) * grain_volume(row.radius, population.thickness);
    row.contact_mass = member ? population.clumps.least_contact_mass : row.mass;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace thalweg::dem
