#include "dem/population_seeds.hpp"

#include "core/error.hpp"
#include "dem/file_seeds.hpp"
#include "dem/packing.hpp"
#include "dem/population_clumps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace thalweg::dem {
namespace {

Region region_of(const PlacementKeys& placement, const PeriodicBox& box) {
  if (!placement.region) return whole(box);
  return {placement.region->lower, placement.region->upper};
}

// Number in the list of assemblies; -1: none.
int assembly_of(std::span<const Population> populations, std::size_t population) {
  if (!populations[population].motion) return -1;
  int number = -1;
  for (std::size_t p = 0; p <= population; ++p) number += populations[p].motion.has_value();
  return number;
}

// What all grains of a population have in common.
GrainSeed common_seed(std::span<const Population> populations, std::size_t number) {
  const Population& population = populations[number];
  GrainSeed seed;
  seed.thickness = population.thickness;
  seed.material = material_of(populations, number);
  seed.assembly = assembly_of(populations, number);
  seed.motion = motion_of(population);
  return seed;
}

bool keeps_velocities(const Population& population) {
  return population.placement.velocities.value_or(FileVelocities::kept) == FileVelocities::kept;
}

// Disks are in the middle of the box.
Vec3 in_plane(Vec3 position, const Population& population, const PeriodicBox& box) {
  if (population.thickness > 0.0) position[1] = 0.5 * box.size[1];
  return position;
}

// velocity, spin: where nothing is prescribed, m/s and rad/s.
void set_motion(GrainSeed& seed, const Population& population, const Vec3& velocity, const Vec3& spin) {
  seed.velocity = population.prescribed_velocity.value_or(velocity);
  seed.angular_velocity = population.prescribed_angular_velocity.value_or(spin);
  if (population.fixed || population.motion) seed.velocity = seed.angular_velocity = Vec3::Zero();
}

// A clump moves and is held as its population says a grain is; of a file it has what its members tell.
ClumpSeed clump_seed_of(const GrainSeed& as_grain, ClumpSeed clump) {
  clump.id = as_grain.id;
  clump.density = as_grain.density;
  clump.velocity = as_grain.velocity;
  clump.angular_velocity = as_grain.angular_velocity;
  clump.material = as_grain.material;
  clump.motion = as_grain.motion;
  return clump;
}

// Who is given a place first.
enum class PlacementOrder { given, uniform, dense, random };

PlacementOrder order_of(const PlacementKeys& placement) {
  if (placement.file || !placement.positions.empty()) return PlacementOrder::given;
  switch (placement.pattern) {
    case PlacementPattern::uniform:
      return PlacementOrder::uniform;
    case PlacementPattern::dense:
      return PlacementOrder::dense;
    case PlacementPattern::random:
      break;
  }
  return PlacementOrder::random;
}

// Where the grains of a population are put, one by one.
struct Places {
  std::size_t count = 0;                // 0 of a file, whose rows tell
  std::function<Vec3(std::size_t)> of;  // m
};

Places places_in(std::vector<Vec3> positions) {
  const std::size_t count = positions.size();
  return {count, [kept = std::move(positions)](std::size_t grain) { return kept[grain]; }};
}

Places place(const Population& population, const PeriodicBox& box, const std::vector<Sphere>& placed) {
  if (population.from_file()) return {};
  const PlacementKeys& placement = population.placement;
  const auto seed = static_cast<std::uint64_t>(placement.seed);
  const auto count = static_cast<std::size_t>(population.count);
  Region region = region_of(placement, box);
  region.plane = population.thickness > 0.0;
  if (region.plane) region.lower[1] = 0.0, region.upper[1] = box.size[1];
  switch (order_of(placement)) {
    case PlacementOrder::given:
      return places_in(placement.positions);
    case PlacementOrder::uniform: {
      const UniformSites sites(box, region, population.count, 0.5 * population.room_of_all(), 0.0, seed);
      return {count, [sites](std::size_t grain) { return sites.centre(static_cast<std::int64_t>(grain)); }};
    }
    case PlacementOrder::dense:
    case PlacementOrder::random:
      break;
  }
  std::vector<double> radii;
  for (std::size_t n = 0; n < count; ++n) radii.push_back(0.5 * population.room_of(n));
  const auto pack = placement.pattern == PlacementPattern::dense ? dense_packing : random_packing;
  return places_in(pack(box, region, radii, 0.0, seed, placed));
}

// Adds the grains of a population that are wanted, one after the other, with ids that count up through all.
class SeedAdder {
public:
  SeedAdder(const PlacingRanks& ranks, GrainSeeds& seeds) : ranks_(ranks), seeds_(seeds) {}

  void add(const Population& population, const GrainSeed& common, const Places& places) {
    if (population.from_file()) return add_from_file(population, common);
    const auto seed_of = [&](std::size_t grain) {
      GrainSeed seed = common;
      seed.id = next_;
      seed.radius = 0.5 * population.diameter_of(grain);
      seed.density = population.density;
      seed.position = in_plane(places.of(grain), population, ranks_.box());
      set_motion(seed, population, population.velocity, population.angular_velocity);
      return seed;
    };
    if (population.shape) return add_clumps(population, places.count, seed_of);
    for (std::size_t n = 0; n < places.count; ++n, ++next_) add(seed_of(n));
  }

private:
  bool knows(const Vec3& centre) const { return ranks_.knows(ranks_.box().wrapped(centre)); }

  void add(const GrainSeed& grain) {
    if (grain.assembly >= 0 || knows(grain.position)) seeds_.grains.push_back(grain);
  }
  void add(const ClumpSeed& clump) {
    if (knows(clump.position)) seeds_.clumps.push_back(clump);
  }

  void add_clumps(const Population& population, std::size_t count, const auto& seed_of) {
    ClumpSeed clump;
    clump.shape = clump_shape_of(population);
    for (std::size_t n = 0; n < count; ++n) {
      const GrainSeed as_grain = seed_of(n);
      clump.position = as_grain.position;
      clump.orientation = orientation_of(population, n);
      add(clump_seed_of(as_grain, clump));
      next_ += static_cast<GlobalId>(clump.shape->members.size());
    }
  }

  void add_from_file(const Population& population, const GrainSeed& common) {
    if (ranks_.alone()) {
      for (const std::span<const BedGrain> body : bodies_of(population.file)) add_body(population, common, body);
    } else {
      const std::vector<BedGrain> rows =
          rows_known(population, ranks_, [&](std::span<const BedGrain> body) { return centre_of(population, body); });
      for (const std::span<const BedGrain> body : bodies_of(rows)) add_body(population, common, body);
    }
    next_ += population.row_count();
  }

  Vec3 centre_of(const Population& population, std::span<const BedGrain> body) const {
    if (body.front().clump < 0) return in_plane(body.front().position, population, ranks_.box());
    return clump_from(body, ranks_.box(), population.thickness).position;
  }

  // The grain or clump that some rows of a file make.
  void add_body(const Population& population, const GrainSeed& common, std::span<const BedGrain> body) {
    const BedGrain& first = body.front();
    const bool kept = keeps_velocities(population);
    GrainSeed seed = common;
    seed.id = next_ + first.id;
    seed.radius = first.radius;
    seed.density = first.density;
    seed.position = in_plane(first.position, population, ranks_.box());
    set_motion(seed, population, kept ? first.velocity : Vec3::Zero(), kept ? first.angular_velocity : Vec3::Zero());
    if (first.clump < 0) return add(seed);
    const ClumpSeed clump = clump_from(body, ranks_.box(), population.thickness);
    if (kept && !holds_translation(seed.motion)) seed.velocity = clump.velocity;  // of the centre
    add(clump_seed_of(seed, clump));
  }

  const PlacingRanks& ranks_;
  GrainSeeds& seeds_;
  GlobalId next_ = 0;
};

// Whether another population is to keep clear of those that are placed before it.
bool anyone_keeps_clear(std::span<const Population> populations) {
  return std::any_of(populations.begin(), populations.end(), [](const Population& population) {
    return order_of(population.placement) >= PlacementOrder::dense;
  });
}

}  // namespace

GrainSeeds grain_seeds(std::span<const Population> populations, const PlacingRanks& ranks) {
  const PeriodicBox& box = ranks.box();
  std::vector<Places> places(populations.size());
  std::vector<Sphere> placed;
  const bool kept_clear_of = populations.size() > 1 && anyone_keeps_clear(populations);
  for (const PlacementOrder order :
       {PlacementOrder::given, PlacementOrder::uniform, PlacementOrder::dense, PlacementOrder::random})
    for (std::size_t p = 0; p < populations.size(); ++p) {
      if (order_of(populations[p].placement) != order) continue;
      try {
        places[p] = place(populations[p], box, placed);
      } catch (const InputError& error) {
        throw InputError(fmt::format("grains.{}: {}", p, error.what()));
      }
      if (!kept_clear_of) continue;
      for (std::size_t n = 0; n < places[p].count; ++n)
        placed.push_back({in_plane(places[p].of(n), populations[p], box), 0.5 * populations[p].room_of(n)});
      if (!populations[p].from_file()) continue;
      for (const Sphere& sphere : spheres_of_file(populations[p], ranks))
        placed.push_back({in_plane(sphere.position, populations[p], box), sphere.radius});
    }
  GrainSeeds seeds;
  seeds.whole = ranks.alone();
  SeedAdder adder(ranks, seeds);
  for (std::size_t p = 0; p < populations.size(); ++p)
    adder.add(populations[p], common_seed(populations, p), places[p]);
  return seeds;
}

Motion motion_of(const Population& population) {
  if (population.fixed || population.motion) return Motion::fixed;
  if (population.prescribed_velocity && population.prescribed_angular_velocity) return Motion::fixed;
  if (population.prescribed_velocity) return Motion::held_translation;
  return population.prescribed_angular_velocity ? Motion::held_rotation : Motion::free;
}

std::vector<PrescribedMotion> assemblies_of(std::span<const Population> populations) {
  std::vector<PrescribedMotion> motions;
  for (const Population& population : populations)
    if (population.motion) motions.push_back(prescribed_motion(*population.motion));
  return motions;
}

std::vector<ContactParameters> materials_of(const ContactParameters& contact, std::span<const Population> populations) {
  std::vector<ContactParameters> materials{contact};
  for (const Population& population : populations)
    if (population.contact) materials.push_back(changed(contact, *population.contact));
  return materials;
}

int material_of(std::span<const Population> populations, std::size_t population) {
  if (!populations[population].contact) return 0;
  int number = 0;
  for (std::size_t p = 0; p <= population; ++p) number += populations[p].contact.has_value();
  return number;
}

double allowed_overlap(std::span<const Population> populations) {
  double allowed = 0.0;
  for (const Population& population : populations)
    if (population.placement.file)
      allowed = std::max(allowed, population.placement.largest_overlap.value_or(PlacementKeys::bed_overlap));
  return allowed;
}

}  // namespace thalweg::dem
