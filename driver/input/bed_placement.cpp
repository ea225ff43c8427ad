#include "driver/input/bed_placement.hpp"

#include "beds/files/population_bed.hpp"
#include "beds/population/population_clumps.hpp"
#include "core/base/error.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "driver/case/grain_setup.hpp"
#include "driver/input/case_checks.hpp"
#include "io/hdf5/bed_file.hpp"
#include "io/text/stl_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

namespace thalweg::driver {
namespace {

Bed read_bed(const std::filesystem::path& path, const io::YamlDocument& document, const std::string& key,
             const Ranks& ranks) {
  const auto check = [&] {
    std::error_code unknown;
    if (std::filesystem::is_regular_file(path, unknown) || unknown == std::errc::permission_denied) return;
    throw document.error(key, fmt::format("there is no file {}; give the path of a bed file relative to the case file, "
                                          "for example run/bed.h5 as thalweg run leaves it",
                                          path.string()));
  };
  ranks.alone() ? check() : on_first_rank(ranks.communicator(), check);
  try {
    return io::read_bed_file(path, ranks);
  } catch (const InputError& error) {
    throw document.error(key, error);
  }
}

// What makes a surface as large as a grain, whose own size its clump takes later; 1 where it encloses nothing, which
// will be said.
double scale_to_size(const TriangleMesh& surface) {
  constexpr double as_large_as = 0.01;  // m, a sphere
  const double volume = signed_volume(surface);
  return volume > 0.0 ? as_large_as / std::cbrt(6.0 * volume / std::numbers::pi) : 1.0;
}

// Makes the clumps of populations whose shape is an STL file.
void take_shape(beds::Population& population, const io::YamlDocument& document, const std::string& grains,
                const Ranks& ranks) {
  if (!population.shape || !population.shape->stl) return;
  const std::string key = grains + ".shape.stl";
  beds::ShapeKeys& shape = *population.shape;
  shape.made_from = document.path_beside(*shape.stl, key);
  try {
    TriangleMesh surface = io::read_stl(shape.made_from, ranks);
    const double scale = population.has_size() ? scale_to_size(surface) : shape.scale.value_or(1.0);
    for (Vec3& point : surface.points) point *= scale;
    take_surface(shape, surface);
  } catch (const InputError& error) {
    throw document.error(key, error);
  }
}

}  // namespace

void fill_in_grains(Case& c, const io::YamlDocument& document, const KnownBeds& known, const Ranks& ranks) {
  const PeriodicBox box = grain_box(c);
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    const std::string key = fmt::format("grains.{}", n);
    // Each population gets its own seed, so that grain n of two of them does not get the same position.
    if (!document.find(key + ".placement.seed")) c.grains[n].placement.seed = static_cast<std::int64_t>(n) + 1;
    std::optional<Bed> bed;
    if (std::optional<std::string>& file = c.grains[n].placement.file) {
      file = document.path_beside(*file, key + ".placement.file");
      if (known) bed = known(c, n, ranks);
      if (!bed) bed = read_bed(*file, document, key + ".placement.file", ranks);
    }
    take_shape(c.grains[n], document, key, ranks);
    at_place(document, key, [&] {
      complete(c.grains[n], c.disks ? c.disks->thickness : 0.0, std::move(bed), box, c.analysis.reference_diameter,
               ranks);
    });
  }
}

}  // namespace thalweg::driver
