#include "beds/population_seeds.hpp"

#include "beds/bed_redistribution.hpp"
#include "beds/packing/packing.hpp"
#include "beds/packing/random_packing.hpp"
#include "beds/population/population_clumps.hpp"
#include "core/base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

namespace thalweg::beds {
namespace {

Region region_of(const PlacementKeys& placement, const PeriodicBox& box) {
  if (!placement.region) return whole(box);
  return {placement.region->lower, placement.region->upper.cwiseMin(box.size)};
}

// Number in the list of assemblies; -1: none.
int assembly_of(std::span<const Population> populations, std::size_t population) {
  if (!populations[population].motion) return -1;
  int number = -1;
  for (std::size_t p = 0; p <= population; ++p) number += populations[p].motion.has_value();
  return number;
}

// Seed with the properties that all grains of a population have in common.
dem::GrainSeed common_seed(std::span<const Population> populations, std::size_t number) {
  const Population& population = populations[number];
  dem::GrainSeed seed;
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
void set_motion(dem::GrainSeed& seed, const Population& population, const Vec3& velocity, const Vec3& spin) {
  seed.velocity = population.prescribed_velocity.value_or(velocity);
  seed.angular_velocity = population.prescribed_angular_velocity.value_or(spin);
  if (population.fixed || population.motion) seed.velocity = seed.angular_velocity = Vec3::Zero();
}

// A clump moves and is held as its population says of a grain; from a file it has the density and motion of its rows.
dem::ClumpSeed clump_seed_of(const dem::GrainSeed& as_grain, dem::ClumpSeed clump) {
  clump.id = as_grain.id;
  clump.density = as_grain.density;
  clump.velocity = as_grain.velocity;
  clump.angular_velocity = as_grain.angular_velocity;
  clump.material = as_grain.material;
  clump.motion = as_grain.motion;
  return clump;
}

// Order in which populations are placed.
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

using PlaceVisitor = std::function<void(std::size_t grain, const Vec3& centre)>;  // m

// Calls the visitor for the grains of a population, not from a file, in their order: for all, or for those of a packing
// that this rank knows.
using Places = std::function<void(const PlaceVisitor&)>;

Places places_in(std::vector<Vec3> centres) {
  return [kept = std::move(centres)](const PlaceVisitor& visit) {
    for (std::size_t grain = 0; grain < kept.size(); ++grain) visit(grain, kept[grain]);
  };
}

Places places_on(UniformSites sites, std::int64_t count) {
  return [sites = std::move(sites), count](const PlaceVisitor& visit) {
    for (std::int64_t grain = 0; grain < count; ++grain) visit(static_cast<std::size_t>(grain), sites.centre(grain));
  };
}

// A rigid assembly is known to all ranks.
std::vector<PlacedGrain> known_to_all(const PackingDomain& ranks, std::vector<PlacedGrain> known) {
  struct Row {
    std::int64_t number;
    double position[3];
  };
  std::vector<Row> rows;
  for (const PlacedGrain& grain : known)
    rows.push_back({grain.number, {grain.centre.x(), grain.centre.y(), grain.centre.z()}});
  known.clear();
  for (const Row& row : ranks.to_all(std::move(rows))) known.push_back({row.number, Vec3(row.position)});
  std::sort(known.begin(), known.end());
  return known;
}

Places pack(const Population& population, const Region& region, const PackingDomain& ranks,
            std::span<const Obstacle> obstacles) {
  const PlacementKeys& placement = population.placement;
  const GrainsToPlace grains{
      region,
      population.count,
      [&population](std::int64_t grain) { return 0.5 * population.room_of(static_cast<std::size_t>(grain)); },
      0.5 * population.room_of_all(),
      0.0,
      static_cast<std::uint64_t>(placement.seed)};
  const bool dense = placement.pattern == PlacementPattern::dense;
  std::vector<PlacedGrain> placed =
      dense ? dense_packing(ranks, grains, obstacles) : random_packing(ranks, grains, obstacles);
  if (population.motion) placed = known_to_all(ranks, std::move(placed));
  return [kept = std::move(placed)](const PlaceVisitor& visit) {
    for (const PlacedGrain& grain : kept) visit(static_cast<std::size_t>(grain.number), grain.centre);
  };
}

Places place(const Population& population, const PackingDomain& ranks, std::span<const Obstacle> obstacles) {
  const PlacementKeys& placement = population.placement;
  Region region = region_of(placement, ranks.box());
  region.plane = population.thickness > 0.0;
  if (region.plane) region.lower[1] = 0.0, region.upper[1] = ranks.box().size[1];
  switch (order_of(placement)) {
    case PlacementOrder::given:
      return places_in(placement.positions);
    case PlacementOrder::uniform:
      return places_on(UniformSites(ranks.box(), region, population.count, 0.5 * population.room_of_all(), 0.0,
                                    static_cast<std::uint64_t>(placement.seed)),
                       population.count);
    case PlacementOrder::dense:
    case PlacementOrder::random:
      break;
  }
  return pack(population, region, ranks, obstacles);
}

// Adds the grains of a population that this rank knows, one after the other, with ids that count up through all.
class SeedAdder {
public:
  SeedAdder(const PackingDomain& ranks, dem::GrainSeeds& seeds) : ranks_(ranks), seeds_(seeds) {}

  void add(const Population& population, const dem::GrainSeed& common, const Places& places) {
    const auto seed_of = [&](std::size_t grain, const Vec3& centre) {
      dem::GrainSeed seed = common;
      seed.radius = 0.5 * population.diameter_of(grain);
      seed.density = population.density;
      seed.position = in_plane(centre, population, ranks_.box());
      set_motion(seed, population, population.velocity, population.angular_velocity);
      return seed;
    };
    if (population.from_file())
      add_from_file(population, common);
    else if (population.shape)
      add_clumps(population, places, seed_of);
    else
      places([&](std::size_t grain, const Vec3& centre) {
        if (!wants(in_plane(centre, population, ranks_.box()), common.assembly)) return;
        seeds_.grains.push_back(seed_of(grain, centre));
        seeds_.grains.back().id = first_ + static_cast<GlobalId>(grain);
      });
    first_ += population.row_count();
  }

private:
  bool wants(const Vec3& centre, int assembly) const {
    return assembly >= 0 || ranks_.knows(ranks_.box().wrapped(centre));
  }

  void add_clumps(const Population& population, const Places& places, const auto& seed_of) {
    dem::ClumpSeed clump;
    ClumpShapes shapes(population);
    const auto members = static_cast<GlobalId>(shapes.member_count());
    places([&](std::size_t grain, const Vec3& centre) {
      if (!wants(in_plane(centre, population, ranks_.box()), -1)) return;
      dem::GrainSeed as_grain = seed_of(grain, centre);
      as_grain.id = first_ + static_cast<GlobalId>(grain) * members;
      clump.shape = shapes.of(population.diameter_of(grain));
      clump.position = as_grain.position;
      clump.orientation = orientation_of(population, grain);
      seeds_.clumps.push_back(clump_seed_of(as_grain, clump));
    });
  }

  void add_from_file(const Population& population, const dem::GrainSeed& common) {
    if (ranks_.alone()) {
      for (const std::span<const BedGrain> body : bodies_of(population.file)) add_body(population, common, body);
      return;
    }
    const std::vector<BedGrain> rows =
        rows_known(population, ranks_, [&](std::span<const BedGrain> body) { return centre_of(population, body); });
    for (const std::span<const BedGrain> body : bodies_of(rows)) add_body(population, common, body);
  }

  Vec3 centre_of(const Population& population, std::span<const BedGrain> body) const {
    if (body.front().clump < 0) return in_plane(body.front().position, population, ranks_.box());
    return clump_from(body, ranks_.box(), population.thickness).position;
  }

  // The grain or clump that some rows of a file make.
  void add_body(const Population& population, const dem::GrainSeed& common, std::span<const BedGrain> body) {
    const BedGrain& first = body.front();
    const bool kept = keeps_velocities(population);
    dem::GrainSeed seed = common;
    seed.id = first_ + first.id;
    seed.radius = first.radius;
    seed.density = first.density;
    seed.position = in_plane(first.position, population, ranks_.box());
    set_motion(seed, population, kept ? first.velocity : Vec3::Zero(), kept ? first.angular_velocity : Vec3::Zero());
    if (first.clump < 0) {
      if (wants(seed.position, seed.assembly)) seeds_.grains.push_back(seed);
      return;
    }
    const dem::ClumpSeed clump = clump_from(body, ranks_.box(), population.thickness);
    if (kept && !holds_translation(seed.motion)) seed.velocity = clump.velocity;  // of the centre
    if (wants(clump.position, -1)) seeds_.clumps.push_back(clump_seed_of(seed, clump));
  }

  const PackingDomain& ranks_;
  dem::GrainSeeds& seeds_;
  GlobalId first_ = 0;  // id of the population's first grain
};

// True if a later population must keep clear of those placed before it.
bool anyone_keeps_clear(std::span<const Population> populations) {
  return std::any_of(populations.begin(), populations.end(), [](const Population& population) {
    return order_of(population.placement) >= PlacementOrder::dense;
  });
}

// The room of its grains that this rank knows, for others to keep clear of; numbered within the population.
std::vector<Obstacle> spheres_of(const Population& population, const PackingDomain& ranks, const Places& places) {
  std::vector<Obstacle> spheres;
  const auto add = [&](std::int64_t number, const Vec3& centre, double radius) {
    const Vec3 in_box = ranks.box().wrapped(in_plane(centre, population, ranks.box()));
    if (ranks.knows(in_box)) spheres.push_back({{in_box, radius}, number});
  };
  if (population.from_file()) {
    for (const Obstacle& row : spheres_of_file(population, ranks))
      add(row.number, row.sphere.position, row.sphere.radius);
  } else {
    places([&](std::size_t grain, const Vec3& centre) {
      add(static_cast<std::int64_t>(grain), centre, 0.5 * population.room_of(grain));
    });
  }
  return spheres;
}

}  // namespace

dem::GrainSeeds grain_seeds(std::span<const Population> populations, const PackingDomain& ranks) {
  std::vector<Places> places(populations.size());
  std::vector<Obstacle> obstacles;
  std::int64_t first = 0;  // number of a population's first grain among the obstacles
  const bool kept_clear_of = populations.size() > 1 && anyone_keeps_clear(populations);
  for (const PlacementOrder order :
       {PlacementOrder::given, PlacementOrder::uniform, PlacementOrder::dense, PlacementOrder::random})
    for (std::size_t p = 0; p < populations.size(); ++p) {
      const Population& population = populations[p];
      if (order_of(population.placement) != order) continue;
      try {
        if (!population.from_file()) places[p] = place(population, ranks, obstacles);
      } catch (const InputError& error) {
        throw InputError(fmt::format("grains.{}: {}", p, error.what()));
      }
      if (!kept_clear_of) continue;
      for (Obstacle obstacle : spheres_of(population, ranks, places[p])) {
        obstacle.number += first;
        obstacles.push_back(obstacle);
      }
      first += population.row_count();
    }
  dem::GrainSeeds seeds;
  seeds.whole = ranks.alone();
  SeedAdder adder(ranks, seeds);
  for (std::size_t p = 0; p < populations.size(); ++p)
    adder.add(populations[p], common_seed(populations, p), places[p]);
  return seeds;
}

dem::Motion motion_of(const Population& population) {
  if (population.fixed || population.motion) return dem::Motion::fixed;
  if (population.prescribed_velocity && population.prescribed_angular_velocity) return dem::Motion::fixed;
  if (population.prescribed_velocity) return dem::Motion::held_translation;
  return population.prescribed_angular_velocity ? dem::Motion::held_rotation : dem::Motion::free;
}

std::vector<dem::PrescribedMotion> assemblies_of(std::span<const Population> populations) {
  std::vector<dem::PrescribedMotion> motions;
  for (const Population& population : populations)
    if (population.motion) motions.push_back(prescribed_motion(*population.motion));
  return motions;
}

std::vector<dem::ContactParameters> materials_of(const dem::ContactParameters& contact,
                                                 std::span<const Population> populations) {
  std::vector<dem::ContactParameters> materials{contact};
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

}  // namespace thalweg::beds
