#include "coupling/system/fluid_figures.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::coupling {

std::vector<Figure> speed_figures(const lbm::FluidSurvey& survey, const Units& units) {
  return {{"largest_lattice_velocity", "1", survey.fastest.value},
          {"largest_fluid_speed", "m/s", survey.fastest.value * units.velocity()}};
}

void add_extremes(const lbm::FluidSurvey& survey, std::vector<Figure>& figures) {
  const auto cells = static_cast<double>(std::max<std::int64_t>(1, survey.totals.cells));
  figures.push_back({"smallest_density_deviation", "1", survey.lowest.value});
  figures.push_back({"largest_density_deviation", "1", survey.highest.value});
  figures.push_back({"fast_cell_fraction", "1", static_cast<double>(survey.fast_cells) / cells});
}

void add_momentum(const lbm::FluidSurvey& survey, const Vec3& force, const Units& units, std::vector<Figure>& figures) {
  const Vec3 lattice = survey.totals.momentum - 0.5 * static_cast<double>(survey.totals.cells) * force;
  const Vec3 momentum = lattice * units.force() * units.time_step;
  for (int axis = 0; axis < 3; ++axis)
    figures.push_back({fmt::format("fluid_momentum_{}", "xyz"[axis]), "kg m/s", momentum[axis]});
}

std::optional<Location> place_in_fluid(const lbm::FluidSurvey& survey, const Units& units, const std::string& figure) {
  std::optional<lbm::CellExtreme> found;
  if (figure == "smallest_density_deviation")
    found = survey.lowest;
  else if (figure == "largest_density_deviation")
    found = survey.highest;
  else if (survey.broken_cells > 0 || figure == "largest_lattice_velocity" || figure == "fast_cell_fraction")
    found = survey.fastest;
  if (!found || found->cell[0] < 0) return std::nullopt;
  const Index3& cell = found->cell;
  return Location{Vec3(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5) * units.spacing, {}};
}

}  // namespace thalweg::coupling
