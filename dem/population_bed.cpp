#include "dem/population_bed.hpp"

#include "core/error.hpp"
#include "core/key_error.hpp"
#include "dem/grain_seed.hpp"
#include "dem/grain_volume.hpp"
#include "dem/packing.hpp"
#include "dem/population_clumps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace thalweg::dem {
namespace {

// Box sizes that differ by less are the same: decimal numbers read from two case files.
constexpr double same_size = 1e-9;

const char* const file_key = "placement.file";

std::string without_period(std::string text) {
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::string shape_text(double thickness) {
  return thickness > 0.0 ? fmt::format("disks {:g} m thick", thickness) : std::string("spheres");
}

void check_thickness(const Bed& bed, double thickness) {
  if (bed.disk_thickness == thickness) return;
  throw KeyError(file_key, fmt::format("the bed is of {} and this case of {}; give the same disks.thickness in m",
                                       shape_text(bed.disk_thickness), shape_text(thickness)));
}

void check_box(const Bed& bed, const PeriodicBox& box) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!bed.periodic[static_cast<std::size_t>(axis)] || (bed.disk_thickness > 0.0 && axis == 1)) continue;
    const bool periodic = box.periodic[static_cast<std::size_t>(axis)];
    const double made = bed.box[axis], here = box.size[axis];
    if (!periodic || std::abs(made - here) > same_size * made)
      throw KeyError(file_key,
                     fmt::format("the bed was made in a box periodic along {} over {:g} m, and this case's is {} over "
                                 "{:g} m; give the same domain there, or make a bed for this one",
                                 "xyz"[axis], made, periodic ? "periodic" : "not periodic", here));
  }
}

void check_grains(const std::vector<BedGrain>& grains, const Bed& bed, const PeriodicBox& box, double largest_overlap) {
  std::vector<GrainSeed> seeds;
  for (const BedGrain& grain : grains) {
    GrainSeed seed;
    seed.id = static_cast<GlobalId>(seeds.size());
    seed.radius = grain.radius;
    seed.density = grain.density;
    seed.position = grain.position;
    seed.thickness = bed.disk_thickness;
    seed.clump = grain.clump;
    seeds.push_back(seed);
    if ((grain.position.array() < 0.0).any() || (grain.position.array() > box.size.array()).any())
      throw KeyError(file_key,
                     fmt::format("grain {} of the file, at [{:g}, {:g}, {:g}] m, is outside this case's box; give a "
                                 "domain.size in m that holds the bed, or a placement.region to leave it out",
                                 grain.id, grain.position[0], grain.position[1], grain.position[2]));
  }
  try {
    check(seeds, box, {}, largest_overlap);
  } catch (const InputError& error) {
    throw KeyError(file_key, fmt::format("{}; up to placement.largest_overlap: {:g} diameters are allowed",
                                         without_period(error.what()), largest_overlap));
  }
}

bool inside(const Vec3& point, const RegionKeys& region) {
  return (point.array() >= region.lower.array()).all() && (point.array() <= region.upper.array()).all();
}

// Of the grains of a bed file, a clump being one.
struct BedSizes {
  std::vector<double> diameters;  // m, of a clump that of the sphere (disk) of its volume
  double mass = 0.0, volume = 0.0;
};

// Takes over the grains with their centre in the region.
BedSizes take_bodies(Population& population, const Bed& bed) {
  const PeriodicBox box{bed.box, bed.periodic};
  const std::optional<RegionKeys>& region = population.placement.region;
  BedSizes sizes;
  for (const std::span<const BedGrain> body : bodies_of(bed.grains)) {
    const BedGrain& first = body.front();
    double volume = 0.0, radius = first.radius;
    if (first.clump < 0) {
      if (region && !inside(first.position, *region)) continue;
      volume = grain_volume(radius, bed.disk_thickness);
    } else {
      const ClumpSeed clump = clump_from(body, box, bed.disk_thickness);
      if (region && !inside(clump.position, *region)) continue;
      add_clumps(population.clumps, *clump.shape, clump.density, 1);
      volume = clump.shape->volume;
      radius = clump.shape->equivalent_radius();
    }
    sizes.diameters.push_back(2.0 * radius);
    sizes.volume += volume;
    sizes.mass += first.density * volume;
    for (const BedGrain& grain : body) {
      population.file.push_back(grain);
      population.diameters.push_back(2.0 * grain.radius);
    }
  }
  return sizes;
}

void take_bed(Population& population, const Bed& bed, const PeriodicBox& box) {
  const BedSizes sizes = take_bodies(population, bed);
  if (population.file.empty())
    throw KeyError(file_key, "the file has no grain in the region; give a placement.region in m that holds some");
  check_thickness(bed, population.thickness);
  check_box(bed, box);
  check_grains(population.file, bed, box, population.placement.largest_overlap.value_or(PlacementKeys::bed_overlap));
  population.count = static_cast<std::int64_t>(sizes.diameters.size());
  population.diameter = median_by_volume(sizes.diameters);
  population.density = sizes.mass / sizes.volume;
  population.body_diameters = sizes.diameters;
}

// Grains that are clumps, where the case gives their shape.
void take_shape(Population& population) {
  try {
    const auto shape = clump_shape_of(population);
    population.clumps = {};
    add_clumps(population.clumps, *shape, population.density, population.count);
    population.diameter = 2.0 * shape->equivalent_radius();
  } catch (const InputError& error) {
    throw KeyError("shape.clump", without_period(error.what()));
  }
}

// Shape and sizes, once the number of grains is known.
void take_sizes(Population& population) {
  if (population.shape) take_shape(population);
  if (!population.sizes.given()) return;
  population.diameters =
      sampled_diameters(population.sizes, population.count, population.placement.seed, population.thickness > 0.0);
  population.diameter = median_by_volume(population.diameters);
}

// Of the placement's region, or of the box; of disks as wide as they are thick. m
Vec3 room_for(const Population& population, const PeriodicBox& box) {
  const std::optional<RegionKeys>& region = population.placement.region;
  Vec3 extent = region ? Vec3(region->upper - region->lower) : box.size;
  if (population.thickness > 0.0) extent[1] = population.thickness;
  return extent;
}

const char* wanted_by(const Population& population) {
  if (population.solid_fraction) return "solid_fraction";
  return population.fill->depth ? "fill.depth" : "fill.layers";
}

// What the grains of a solid fraction or a fill occupy; m^3. layer: m.
double wanted_volume(const Population& population, const Vec3& room, double layer) {
  if (population.solid_fraction) return *population.solid_fraction * room.prod();
  const FillKeys& fill = *population.fill;
  const double depth = fill.depth ? *fill.depth : *fill.layers * layer;
  if (depth > room.z() && room.z() > 0.0)
    throw KeyError(
        wanted_by(population),
        fmt::format("a bed of {:.4g} m is deeper than the {:g} m of its room; give {}, or more room", depth, room.z(),
                    fill.depth ? fmt::format("at most {:g} m", room.z())
                               : fmt::format("at most {:.3g} layers of {:.4g} m", room.z() / layer, layer)));
  const double settled = population.thickness > 0.0 ? settled_disks : settled_bed;
  return (1.0 - fill.porosity.value_or(1.0 - settled)) * depth * room.x() * room.y();
}

// The number of grains that comes as near as possible to the solid fraction or the fill; of mixed sizes to the accuracy
// of their mean.
void take_wanted_volume(Population& population, const PeriodicBox& box, std::optional<double> reference_diameter) {
  const Vec3 room = room_for(population, box);
  constexpr double most = 1e9;  // every rank places them all
  population.count = 1000;      // a sample, and then nearly all
  for (int pass = 0; pass < 2; ++pass) {
    take_sizes(population);
    const double wanted = wanted_volume(population, room, reference_diameter.value_or(population.diameter));
    const double needed = wanted / (population.volume() / static_cast<double>(population.count));
    if (!(needed < most))
      throw KeyError(wanted_by(population),
                     fmt::format("it takes {:.3g} grains of this size; give a larger diameter in m", needed));
    population.count = std::max<std::int64_t>(1, std::llround(needed));
  }
  population.solid_fraction.reset();
  population.fill.reset();
}

}  // namespace

void complete(Population& population, double disk_thickness, const std::optional<Bed>& bed, const PeriodicBox& box,
              std::optional<double> reference_diameter) {
  population.thickness = disk_thickness;
  if (bed) take_bed(population, *bed, box);
  if (population.solid_fraction || population.fill) take_wanted_volume(population, box, reference_diameter);
  take_sizes(population);
}

}  // namespace thalweg::dem
