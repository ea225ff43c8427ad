#include "driver/bed_placement.hpp"

#include "core/error.hpp"
#include "core/periodic_box.hpp"
#include "dem/grain_seed.hpp"
#include "driver/clump_setup.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <span>

namespace thalweg {
namespace {

// Box sizes that differ by less are the same: decimal numbers read from two case files.
constexpr double same_size = 1e-9;

std::string without_period(std::string text) {
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::string shape_text(double thickness) {
  return thickness > 0.0 ? fmt::format("disks {:g} m thick", thickness) : std::string("spheres");
}

class BedPlacement {
public:
  BedPlacement(const Case& c, const io::YamlDocument& document, const std::string& key, const io::Bed& bed)
      : case_(c), document_(document), key_(key), bed_(bed) {}

  void check_box() const {
    const std::array<bool, 3> periodic = periodic_axes(case_.domain);
    for (int axis = 0; axis < 3; ++axis) {
      if (!bed_.periodic[static_cast<std::size_t>(axis)] || (bed_.disk_thickness > 0.0 && axis == 1)) continue;
      const double made = bed_.box[axis], here = case_.domain.size[axis];
      if (!periodic[static_cast<std::size_t>(axis)] || std::abs(made - here) > same_size * made)
        throw document_.error(
            key_, fmt::format("the bed was made in a box periodic along {} over {:g} m, and this case's is {} over "
                              "{:g} m; give the same domain there, or make a bed for this one",
                              "xyz"[axis], made, periodic[static_cast<std::size_t>(axis)] ? "periodic" : "not periodic",
                              here));
    }
  }

  void check_grains(const std::vector<io::BedGrain>& grains, double largest_overlap) const {
    const PeriodicBox box{case_.domain.size, periodic_axes(case_.domain)};
    std::vector<dem::GrainSeed> seeds;
    for (const io::BedGrain& grain : grains) {
      dem::GrainSeed seed;
      seed.id = static_cast<GlobalId>(seeds.size());
      seed.radius = grain.radius;
      seed.density = grain.density;
      seed.position = grain.position;
      seed.thickness = bed_.disk_thickness;
      seed.clump = grain.clump;
      seeds.push_back(seed);
      if ((grain.position.array() < 0.0).any() || (grain.position.array() > case_.domain.size.array()).any())
        throw document_.error(
            key_, fmt::format("grain {} of the file, at [{:g}, {:g}, {:g}] m, is outside this case's box; give a "
                              "domain.size in m that holds the bed, or a placement.region to leave it out",
                              grain.id, grain.position[0], grain.position[1], grain.position[2]));
    }
    try {
      dem::check(seeds, box, {}, largest_overlap);
    } catch (const InputError& error) {
      throw document_.error(key_, fmt::format("{}; up to placement.largest_overlap: {:g} diameters are allowed",
                                              without_period(error.what()), largest_overlap));
    }
  }

private:
  const Case& case_;
  const io::YamlDocument& document_;
  std::string key_;
  const io::Bed& bed_;
};

bool inside(const Vec3& point, const RegionCase& region) {
  return (point.array() >= region.lower.array()).all() && (point.array() <= region.upper.array()).all();
}

// Of the grains of a bed file, a clump being one.
struct BedSizes {
  std::vector<double> diameters;  // m, of a clump that of the sphere of its volume
  double mass = 0.0, volume = 0.0;
};

// Takes over the grains with their centre in the region.
BedSizes take_bodies(PopulationCase& population, const io::Bed& bed) {
  const PeriodicBox box{bed.box, bed.periodic};
  const std::optional<RegionCase>& region = population.placement.region;
  BedSizes sizes;
  for (const std::span<const io::BedGrain> body : bodies_of(bed.grains)) {
    const io::BedGrain& first = body.front();
    double volume = 0.0, radius = first.radius;
    if (first.clump < 0) {
      if (region && !inside(first.position, *region)) continue;
      volume = bed.disk_thickness > 0.0 ? std::numbers::pi * radius * radius * bed.disk_thickness
                                        : 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    } else {
      const dem::ClumpSeed clump = clump_from(body, box, bed.disk_thickness);
      if (region && !inside(clump.position, *region)) continue;
      add_clumps(population.clumps, *clump.shape, clump.density, 1);
      volume = clump.shape->volume;
      radius = clump.shape->equivalent_radius();
    }
    sizes.diameters.push_back(2.0 * radius);
    sizes.volume += volume;
    sizes.mass += first.density * volume;
    for (const io::BedGrain& grain : body) {
      population.file.push_back(grain);
      population.diameters.push_back(2.0 * grain.radius);
    }
  }
  return sizes;
}

void take_from_file(Case& c, std::size_t number, const io::YamlDocument& document) {
  PopulationCase& population = c.grains[number];
  PlacementCase& placement = population.placement;
  const std::string key = fmt::format("grains.{}.placement.file", number);
  const std::filesystem::path path =
      std::filesystem::absolute(document.path().parent_path() / *placement.file).lexically_normal();
  if (!std::filesystem::is_regular_file(path))
    throw document.error(key, fmt::format("there is no file {}; give the path of a bed file relative to the case file, "
                                          "for example run/bed.h5 as thalweg run leaves it",
                                          path.string()));
  placement.file = path.string();
  io::Bed bed;
  try {
    bed = io::read_bed_file(path);
  } catch (const InputError& error) {
    throw document.error(key, without_period(error.what()));
  }
  const BedSizes sizes = take_bodies(population, bed);
  if (population.file.empty())
    throw document.error(key, "the file has no grain in the region; give a placement.region in m that holds some");
  const BedPlacement checks(c, document, key, bed);
  if (bed.disk_thickness != population.thickness)
    throw document.error(key, fmt::format("the bed is of {} and this case of {}; give the same disks.thickness in m",
                                          shape_text(bed.disk_thickness), shape_text(population.thickness)));
  checks.check_box();
  checks.check_grains(population.file, placement.largest_overlap.value_or(PlacementCase::bed_overlap));

  population.count = static_cast<std::int64_t>(sizes.diameters.size());
  population.diameter = median_by_volume(sizes.diameters);
  population.density = sizes.mass / sizes.volume;
  population.body_diameters = sizes.diameters;
}

// Grains that are clumps, where the case gives their shape.
void take_shape(Case& c, std::size_t number, const io::YamlDocument& document) {
  PopulationCase& population = c.grains[number];
  try {
    const auto shape = clump_shape_of(population);
    add_clumps(population.clumps, *shape, population.density, population.count);
    population.diameter = 2.0 * shape->equivalent_radius();
  } catch (const InputError& error) {
    throw document.error(fmt::format("grains.{}.shape.clump", number), without_period(error.what()));
  }
}

}  // namespace

void fill_in_grains(Case& c, const io::YamlDocument& document) {
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    PopulationCase& population = c.grains[n];
    if (c.disks) population.thickness = c.disks->thickness;
    if (population.placement.file) take_from_file(c, n, document);
    if (population.shape) take_shape(c, n, document);
    if (!population.sizes.given()) continue;
    population.diameters = sampled_diameters(population.sizes, population.count, population.placement.seed);
    population.diameter = median_by_volume(population.diameters);
  }
}

}  // namespace thalweg
