#include "beds/supplies.hpp"

#include "beds/population/population_clumps.hpp"
#include "beds/population_seeds.hpp"
#include "core/base/counter_random.hpp"
#include "core/keys/key_error.hpp"

#include <fmt/format.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::beds {

namespace {

// Disks stay in the middle of the box.
dem::Zone zone_of(const RegionKeys& region, bool disks, const Vec3& box_size) {
  dem::Zone zone{region.lower, region.upper.cwiseMin(box_size)};
  if (disks) zone.lower[1] = zone.upper[1] = 0.5 * box_size[1];
  return zone;
}

// All of the height and width of the plane of disks.
dem::Zone zone_across(const RegionKeys& region, bool disks, const Vec3& box_size) {
  dem::Zone zone{region.lower, region.upper};
  if (disks) zone.lower[1] = 0.0, zone.upper[1] = box_size[1];
  return zone;
}

// Diameters (m) of the grains of a population, in rounds: each once a round, in an order of its own.
class Diameters {
public:
  Diameters(const Population& population, std::int64_t seed) : seed_(static_cast<std::uint64_t>(seed)) {
    for (const SizeCount& size : population.sizes_of_grains())
      diameters_.insert(diameters_.end(), static_cast<std::size_t>(size.count), size.diameter);
  }

  double of(std::int64_t number) const {
    if (diameters_.front() == diameters_.back()) return diameters_.front();
    const auto count = static_cast<std::int64_t>(diameters_.size());
    if (number / count != round_) {
      round_ = number / count;
      order_ = shuffled_places(
          count, static_cast<std::int64_t>(mixed_bits(seed_ ^ mixed_bits(static_cast<std::uint64_t>(round_))) >> 1));
    }
    return diameters_[order_[static_cast<std::size_t>(number % count)]];
  }

private:
  std::uint64_t seed_;
  std::vector<double> diameters_;  // rising
  mutable std::int64_t round_ = -1;
  mutable std::vector<std::size_t> order_;
};

// Above the floor, the lowest bed there is.
void check_heights(const AboveBedKeys& above_bed, const RegionKeys& region, double diameter) {
  if (above_bed.upper < 0.5 * diameter)
    throw KeyError(
        "above_bed.upper",
        fmt::format("with its centre so low a grain of {:.4g} m touches the bed; give at least its radius, {:.4g} m",
                    diameter, 0.5 * diameter));
  if (above_bed.lower > region.upper.z())
    throw KeyError("above_bed.lower", fmt::format("however low the bed, this is above the region, which ends at {:g} "
                                                  "m; give a smaller height, or a higher region.upper",
                                                  region.upper.z()));
}

}  // namespace

void check(const SupplyKeys& supply, std::span<const Population> populations, const Vec3& box_size) {
  const auto count = static_cast<std::int64_t>(populations.size());
  if (supply.population >= count)
    throw KeyError("population", count == 0
                                     ? std::string("supplied grains are like those of a population, and there is none; "
                                                   "give the section grains at least one")
                                     : fmt::format("there is no such population; give one of 0 to {}", count - 1));
  const Population& population = populations[static_cast<std::size_t>(supply.population)];
  if (population.held() || population.prescribed_angular_velocity)  // a supply's grains are free in all ways
    throw KeyError("population",
                   "its grains are held or move as prescribed; give the number of a population whose grains are free");
  if (population.from_file() && population.clumps.count > 0)
    throw KeyError("population",
                   "its clumps are from a file and have no common shape; give the number of a population "
                   "with a shape, or of spheres");
  if (const FileFigures& of = population.figures; of.least_density < of.largest_density)
    throw KeyError("population",
                   fmt::format("its grains are from a file and have densities from {:g} to {:g} kg/m^3, of which a "
                               "supply has one; give the number of a population of one density",
                               of.least_density, of.largest_density));
  check(supply.region, box_size, "region", true);
  if (supply.above_bed)
    check_heights(*supply.above_bed, supply.region,
                  population.shape ? population.smallest_diameter() : population.largest_diameter());
}

void check(const SinkKeys& sink, const Vec3& box_size) {
  check(sink.region, box_size, "region", true);
  if (sink.recirculation) check(sink.recirculation->region, box_size, "recirculation.region", true);
}

double mass_rate(const SupplyKeys& keys, const Population& population, double unit_rate) {
  return keys.mass_rate ? *keys.mass_rate : *keys.transport_rate * unit_rate * population.density;
}

double mean_mass(const Population& population) {
  return population.density * population.volume() / static_cast<double>(population.count);
}

dem::Supply supply_of(const SupplyKeys& keys, std::span<const Population> populations, const Vec3& box_size,
                      double unit_rate) {
  const auto number = static_cast<std::size_t>(keys.population);
  const Population& population = populations[number];
  dem::Supply supply;
  supply.entrance = {zone_of(keys.region, population.thickness > 0.0, box_size), keys.velocity, keys.seed};
  if (keys.above_bed) supply.entrance.above_bed = {keys.above_bed->lower, keys.above_bed->upper};
  supply.by_mass = !keys.rate;
  supply.rate = keys.rate ? *keys.rate : mass_rate(keys, population, unit_rate);
  supply.from = keys.from;
  supply.until = keys.until.value_or(std::numeric_limits<double>::infinity());
  const int material = material_of(populations, number);
  if (population.shape) {
    const auto shapes = std::make_shared<ClumpShapes>(population);
    supply.members = static_cast<int>(shapes->member_count());
    supply.make = [population, shapes, diameters = Diameters(population, keys.seed), material](std::int64_t n) {
      dem::ClumpSeed clump;
      clump.shape = shapes->of(diameters.of(n));
      clump.density = population.density;
      clump.orientation = orientation_of(population, static_cast<std::size_t>(population.count + n));
      clump.material = material;
      return dem::GrainSeeds{{}, {clump}};
    };
    return supply;
  }
  supply.make = [diameters = Diameters(population, keys.seed), density = population.density,
                 thickness = population.thickness, material](std::int64_t n) {
    dem::GrainSeed grain;
    grain.radius = 0.5 * diameters.of(n);
    grain.density = density;
    grain.thickness = thickness;
    grain.material = material;
    return dem::GrainSeeds{{grain}, {}};
  };
  return supply;
}

dem::Sink sink_of(const SinkKeys& keys, bool disks, const Vec3& box_size) {
  dem::Sink sink;
  sink.zone = zone_across(keys.region, disks, box_size);
  if (const std::optional<RecirculationKeys>& back = keys.recirculation)
    sink.recirculation = {{zone_of(back->region, disks, box_size), back->velocity, back->seed}, back->delay};
  return sink;
}

}  // namespace thalweg::beds
