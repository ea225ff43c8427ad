#include "driver/setup/build_system.hpp"

#include "core/base/error.hpp"
#include "lbm/walls/wall_stress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace thalweg::driver {

namespace {

using Builder = std::unique_ptr<System> (*)(const Case&, MPI_Comm, const Decomposition&, Start);

struct Entry {
  SystemKind kind;
  Builder build;
};

constexpr Entry builders[] = {
    {SystemKind::resolved, build_lattice_system},    {SystemKind::fluid, build_lattice_system},
    {SystemKind::grains, build_grains_system},       {SystemKind::model_fluid, build_grains_system},
    {SystemKind::continuum, build_continuum_system},
};

// Cells that a rank needs along each axis. The law of the wall looks at those of the rank at the wall alone.
Index3 least_cells(const Case& c) {
  Index3 least = Decomposition::fewest;
  if (!has_fluid(c)) return least;
  for (std::size_t face = 0; face < 6; ++face)
    if (c.domain.faces[face].type == lbm::FaceType::law_of_the_wall)
      least[face / 2] = std::max(least[face / 2], lbm::WallStress<float>::layers);
  return least;
}

}  // namespace

Index3 choose_layout(const Case& c, int ranks, const std::optional<Index3>& requested) {
  if (c.system == SystemKind::continuum) {
    if (requested)
      throw InputError("--layout divides a box among ranks, and every rank has the whole column; remove it.");
    return {1, 1, 1};
  }
  const Index3 layout = requested ? *requested : Decomposition::best_layout(cells_of(c.domain), ranks, least_cells(c));
  const double needed = 1.0 * layout[0] * layout[1] * layout[2];
  if (needed != ranks)
    throw InputError(fmt::format("--layout {},{},{} needs {:.15g} rank(s), but the program runs on {}.", layout[0],
                                 layout[1], layout[2], needed, ranks));
  return layout;
}

Decomposition decomposition_of(const Case& c, const Index3& layout) {
  return {cells_of(c.domain), c.domain.spacing, periodic_axes(c.domain), layout, least_cells(c)};
}

std::unique_ptr<System> build_system(const Case& c, MPI_Comm communicator, const Decomposition& cuts, Start start) {
  const auto entry = std::find_if(std::begin(builders), std::end(builders),
                                  [&](const Entry& candidate) { return candidate.kind == c.system; });
  if (entry == std::end(builders))
    throw InputError(fmt::format("system: {} cannot be run by this build of the program.", name_of(c.system)));
  return entry->build(c, communicator, cuts, start);
}

}  // namespace thalweg::driver
