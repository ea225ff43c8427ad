#include "beds/files/population_bed.hpp"

#include "beds/files/bed_import.hpp"
#include "beds/files/bed_overlap_check.hpp"
#include "beds/packing/packing.hpp"
#include "beds/population/population_clumps.hpp"
#include "core/base/error.hpp"
#include "core/base/error_message.hpp"
#include "core/keys/key_error.hpp"
#include "dem/motion/grain_seed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::beds {
namespace {

// Box sizes that differ by less are the same: decimal numbers read from two case files.
constexpr double same_size = 1e-9;

const char* const file_key = "placement.file";

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

// Calls work(), and turns its InputError about the rows of the file into a KeyError of the file's key.
template <typename Work>
void about_file(Work&& work) {
  try {
    work();
  } catch (const InputError& error) {
    throw KeyError(file_key, without_full_stop(error.what()));
  }
}

// first: of the rows of all ranks. Throws InputError for a row that cannot be a grain of the box.
void check_row(const BedGrain& row, const dem::GrainSeed& first, const PeriodicBox& box) {
  const bool below_zero = (row.position.array() < 0.0).any();
  if (below_zero || (row.position.array() > box.size.array()).any())
    throw InputError(fmt::format("grain {} of the file, at [{:g}, {:g}, {:g}] m, is outside this case's box; give a {}",
                                 row.id, row.position[0], row.position[1], row.position[2],
                                 below_zero ? "placement.region to leave it out: a box begins at 0"
                                            : "domain.size in m that holds the bed, or a placement.region to leave it "
                                              "out"));
  dem::GrainSeed seed;
  seed.id = row.id;
  seed.radius = row.radius;
  seed.density = row.density;
  seed.position = row.position;
  seed.velocity = row.velocity;
  seed.angular_velocity = row.angular_velocity;
  seed.thickness = first.thickness;
  check_alone(seed, box, {}, 0.0);
  check_disk(seed, first);
}

// The first row of all, as far as disks have to be like it.
dem::GrainSeed first_row(const Population& population, const Ranks& ranks) {
  std::vector<double> heights;
  if (!population.file.empty()) heights.push_back(population.file.front().position.y());
  dem::GrainSeed first;
  first.thickness = population.thickness;
  first.position.y() = ranks.gathered(std::move(heights)).front();
  return first;
}

// Numbers the rows, and puts disks into the plane of this box.
void check_rows(Population& population, const PeriodicBox& box, const Ranks& ranks) {
  const dem::GrainSeed first = first_row(population, ranks);
  ranks.on_all([&] {
    for (const BedGrain& row : population.file) check_row(row, first, box);
  });
  GlobalId number = ranks.range_of(static_cast<std::int64_t>(population.file.size())).first;
  for (BedGrain& row : population.file) {
    row.id = number++;
    if (population.thickness > 0.0) row.position.y() = 0.5 * box.size.y();
  }
  const double largest_radius = 0.5 * population.figures.largest_diameter;
  const double allowed = population.placement.largest_overlap.value_or(PlacementKeys::bed_overlap);
  dem::check_periodic_axes(box, largest_radius, population.thickness > 0.0);
  try {
    refuse_overlaps(population.file, box, allowed, largest_radius, ranks);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}; up to placement.largest_overlap: {:g} diameters are allowed",
                                 without_full_stop(error.what()), allowed));
  }
}

void take_bed(Population& population, Bed bed, const PeriodicBox& box, const Ranks& ranks) {
  about_file([&] { take_rows(population, std::move(bed.grains), {bed.box, bed.periodic}, ranks); });
  if (!population.from_file())
    throw KeyError(file_key, "the file has no grain in the region; give a placement.region in m that holds some");
  population.figures.fastest = std::max(population.figures.fastest, bed.fastest);
  check_thickness(bed, population.thickness);
  check_box(bed, box);
  about_file([&] { check_rows(population, box, ranks); });
}

// The shape of the grains as the case gives it, and their size where it gives none.
std::shared_ptr<const dem::ClumpShape> take_shape(Population& population) {
  try {
    std::shared_ptr<const dem::ClumpShape> shape = clump_shape_of(population);
    population.shape_diameter = 2.0 * shape->equivalent_radius();
    population.shape_extent = 2.0 * shape->bounding_radius;
    if (!population.has_size()) population.diameter = population.shape_diameter;
    return shape;
  } catch (const InputError& error) {
    throw KeyError("shape.clump", without_full_stop(error.what()));
  }
}

// The key that the number of grains follows from.
const char* wanted_by(const Population& population) {
  if (population.solid_fraction) return "solid_fraction";
  if (!population.fill) return "count";
  return population.fill->depth ? "fill.depth" : "fill.layers";
}

// Every rank draws the sizes of all grains: 58 bytes each while it does.
constexpr std::int64_t most_drawn = 100000000;

void draw_sizes(Population& population) {
  if (population.count > most_drawn)
    throw KeyError(wanted_by(population),
                   fmt::format("sizes can be drawn for at most {} grains, as every rank stores all of them, and there "
                               "are {}; give fewer grains, or one diameter",
                               most_drawn, population.count));
  const bool disks = population.thickness > 0.0;
  population.diameters = sampled_diameters(population.sizes, population.count, population.placement.seed, disks);
  population.diameter = median_by_mass(counted(population.diameters), disks);
}

// Shape and sizes, once the number of grains is known.
void take_sizes(Population& population) {
  const std::shared_ptr<const dem::ClumpShape> shape = population.shape ? take_shape(population) : nullptr;
  if (population.sizes.given()) draw_sizes(population);
  if (shape) population.clumps = figures_of(population, *shape);
}

// Size (m) of the placement's region, or of the box; disks are as wide as they are thick.
Vec3 room_for(const Population& population, const PeriodicBox& box) {
  const std::optional<RegionKeys>& region = population.placement.region;
  Vec3 extent = region ? Vec3(region->upper - region->lower) : box.size;
  if (population.thickness > 0.0) extent[1] = population.thickness;
  return extent;
}

// Volume (m^3) of the grains of a solid fraction or a fill. layer: m.
double wanted_volume(const Population& population, const PeriodicBox& box, double layer) {
  const Vec3 room = room_for(population, box);
  if (population.solid_fraction) return *population.solid_fraction * room.prod();
  const FillKeys& fill = *population.fill;
  const double depth = fill.depth ? *fill.depth : *fill.layers * layer;
  if (depth > room.z() && room.z() > 0.0)
    throw KeyError(wanted_by(population),
                   fmt::format("a bed of {:.4g} m is deeper than its region of {:g} m; give {}, or a higher region",
                               depth, room.z(),
                               fill.depth ? fmt::format("at most {:g} m", room.z())
                                          : fmt::format("at most {:.3g} layers of {:.4g} m", room.z() / layer, layer)));
  const double settled = settled_fraction(box, layer, population.thickness > 0.0);
  return (1.0 - fill.porosity.value_or(1.0 - settled)) * depth * room.x() * room.y();
}

// The number of grains that comes as near as possible to the solid fraction or the fill; of mixed sizes to the accuracy
// of their mean.
void take_wanted_volume(Population& population, const PeriodicBox& box, std::optional<double> reference_diameter) {
  constexpr double most = 1e9;
  population.count = 1000;  // a sample, and then nearly all
  for (int pass = 0; pass < 2; ++pass) {
    take_sizes(population);
    const double wanted = wanted_volume(population, box, reference_diameter.value_or(population.diameter));
    const double needed = wanted / (population.volume() / static_cast<double>(population.count));
    if (!(needed < most))
      throw KeyError(wanted_by(population),
                     fmt::format("it takes {:.3g} grains of this size; give a larger diameter in m", needed));
    population.count = std::max<std::int64_t>(1, std::llround(needed));
  }
  population.solid_fraction.reset();
  if (population.fill) population.settled_porosity = population.fill->porosity;
  population.fill.reset();
}

}  // namespace

void complete(Population& population, double disk_thickness, std::optional<Bed> bed, const PeriodicBox& box,
              std::optional<double> reference_diameter, const Ranks& ranks) {
  population.thickness = disk_thickness;
  if (bed) take_bed(population, std::move(*bed), box, ranks);
  if (population.solid_fraction || population.fill) take_wanted_volume(population, box, reference_diameter);
  take_sizes(population);
}

}  // namespace thalweg::beds
