#include "beds/population_rows.hpp"

#include "beds/population/population_clumps.hpp"
#include "beds/population_seeds.hpp"
#include "dem/motion/grain_volume.hpp"

namespace thalweg::beds {
namespace {

// A clump's members, one clump after the other.
void add_clumps(const Population& population, PopulationRow row, const RowRange& share,
                std::vector<PopulationRow>& rows) {
  ClumpShapes shapes(population);
  row.contact_mass = population.clumps.least_contact_mass;
  row.motion = member_of(row.motion);
  for (std::int64_t n = share.first; n < share.last; ++n) {
    const auto number = static_cast<std::size_t>(n), members = shapes.member_count();
    const auto shape = shapes.of(population.diameter_of(number / members));
    row.mass = population.density * shape->volume;
    row.radius = shape->members[number % members].radius;
    rows.push_back(row);
  }
}

void add_from_file(const Population& population, PopulationRow row, std::vector<PopulationRow>& rows) {
  const dem::Motion of_grains = row.motion, of_members = member_of(row.motion);
  for (const BedGrain& grain : population.file) {
    const bool member = grain.clump >= 0;
    row.radius = grain.radius;
    row.mass = member ? 0.0 : grain.density * dem::grain_volume(row.radius, population.thickness);
    row.contact_mass = member ? population.clumps.least_contact_mass : row.mass;
    row.motion = member ? of_members : of_grains;
    rows.push_back(row);
  }
}

void add_spheres(const Population& population, PopulationRow row, const RowRange& share,
                 std::vector<PopulationRow>& rows) {
  for (std::int64_t n = share.first; n < share.last; ++n) {
    row.radius = 0.5 * population.diameter_of(static_cast<std::size_t>(n));
    row.mass = row.contact_mass = population.density * dem::grain_volume(row.radius, population.thickness);
    rows.push_back(row);
  }
}

}  // namespace

RowRange share_of_rows(const Population& population, const Ranks& ranks) {
  if (!population.from_file()) return ranks.share_of(population.row_count());
  RowRange share(population.row_count(), 1, 0);
  share.first = population.file.empty() ? 0 : population.file.front().id;
  share.last = share.first + static_cast<std::int64_t>(population.file.size());
  return share;
}

std::vector<PopulationRow> rows_of(std::span<const Population> populations, std::size_t number, const RowRange& share) {
  const Population& population = populations[number];
  PopulationRow row;
  row.motion = motion_of(population);
  row.material = material_of(populations, number);
  std::vector<PopulationRow> rows;
  if (population.shape)
    add_clumps(population, row, share, rows);
  else if (population.from_file())
    add_from_file(population, row, rows);
  else
    add_spheres(population, row, share, rows);
  return rows;
}

}  // namespace thalweg::beds
