#include "driver/bed_placement.hpp"

#include "core/error.hpp"
#include "dem/population_bed.hpp"
#include "driver/case_checks.hpp"
#include "io/bed_file.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace thalweg::driver {
namespace {

Bed read_bed(dem::Population& population, const io::YamlDocument& document, const std::string& key) {
  std::optional<std::string>& file = population.placement.file;
  const std::filesystem::path path =
      std::filesystem::absolute(document.path().parent_path() / *file).lexically_normal();
  if (!std::filesystem::is_regular_file(path))
    throw document.error(key, fmt::format("there is no file {}; give the path of a bed file relative to the case file, "
                                          "for example run/bed.h5 as thalweg run leaves it",
                                          path.string()));
  file = path.string();
  try {
    return io::read_bed_file(path);
  } catch (const InputError& error) {
    std::string reason = error.what();
    if (reason.ends_with('.')) reason.pop_back();
    throw document.error(key, reason);
  }
}

}  // namespace

void fill_in_grains(Case& c, const io::YamlDocument& document) {
  const PeriodicBox box{c.domain.size, periodic_axes(c.domain)};
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    const std::string key = fmt::format("grains.{}", n);
    std::optional<Bed> bed;
    if (c.grains[n].placement.file) bed = read_bed(c.grains[n], document, key + ".placement.file");
    at_place(document, key, [&] { complete(c.grains[n], c.disks ? c.disks->thickness : 0.0, bed, box); });
  }
}

}  // namespace thalweg::driver
