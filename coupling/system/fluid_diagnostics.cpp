#include "coupling/system/fluid_diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::coupling {

std::vector<Diagnostic> speed_diagnostics(const lbm::FluidSurvey& survey, const Units& units) {
  return {{"largest_lattice_velocity", "1", survey.fastest.value},
          {"largest_fluid_speed", "m/s", survey.fastest.value * units.velocity()}};
}

void add_extremes(const lbm::FluidSurvey& survey, std::vector<Diagnostic>& diagnostics) {
  const auto cells = static_cast<double>(std::max<std::int64_t>(1, survey.totals.cells));
  diagnostics.push_back({"smallest_density_deviation", "1", survey.lowest.value});
  diagnostics.push_back({"largest_density_deviation", "1", survey.highest.value});
  diagnostics.push_back({"fast_cell_fraction", "1", static_cast<double>(survey.fast_cells) / cells});
}

void add_momentum(const lbm::FluidSurvey& survey, const Vec3& force, const Units& units,
                  std::vector<Diagnostic>& diagnostics) {
  const Vec3 lattice = survey.totals.momentum - 0.5 * static_cast<double>(survey.totals.cells) * force;
  const Vec3 momentum = lattice * units.force() * units.time_step;
  for (int axis = 0; axis < 3; ++axis)
    diagnostics.push_back({fmt::format("fluid_momentum_{}", "xyz"[axis]), "kg m/s", momentum[axis]});
}

std::optional<Location> location_in_fluid(const lbm::FluidSurvey& survey, const Units& units,
                                          const std::string& diagnostic) {
  std::optional<lbm::CellExtreme> found;
  if (diagnostic == "smallest_density_deviation")
    found = survey.lowest;
  else if (diagnostic == "largest_density_deviation")
    found = survey.highest;
  else if (survey.broken_cells > 0 || diagnostic == "largest_lattice_velocity" || diagnostic == "fast_cell_fraction")
    found = survey.fastest;
  if (!found || found->cell[0] < 0) return std::nullopt;
  const Index3& cell = found->cell;
  return Location{Vec3(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5) * units.spacing, {}};
}

}  // namespace thalweg::coupling
