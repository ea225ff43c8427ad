#include "driver/grain_setup.hpp"

#include "core/error.hpp"
#include "dem/packing.hpp"
#include "driver/clump_setup.hpp"
#include "driver/grain_materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace thalweg::driver {

namespace {

// A wide skin costs nothing where grains are alone, and falling grains wear out a narrow one; with every new list the
// links of a fluid have to be looked at again, and its grains are slower.
constexpr double skin_in_diameters = 0.1, dry_skin_in_diameters = 0.5;

PeriodicBox box_of(const Case& c) { return {c.domain.size, periodic_axes(c.domain)}; }

dem::Region region_of(const PlacementCase& placement, const PeriodicBox& box) {
  if (!placement.region) return dem::whole(box);
  return {placement.region->lower, placement.region->upper};
}

dem::Oscillation oscillation_of(const std::optional<OscillationCase>& oscillation) {
  if (!oscillation) return {};
  return {oscillation->amplitude, oscillation->frequency, oscillation->phase};
}

// Number in the list of assemblies; -1: none.
int assembly_of(const Case& c, std::size_t population) {
  if (!c.grains[population].motion) return -1;
  int number = -1;
  for (std::size_t p = 0; p <= population; ++p) number += c.grains[p].motion.has_value();
  return number;
}

std::vector<dem::PrescribedMotion> assemblies_of(const Case& c) {
  std::vector<dem::PrescribedMotion> motions;
  for (const PopulationCase& population : c.grains)
    if (population.motion) motions.push_back(prescribed_motion(*population.motion));
  return motions;
}

// Faces the fluid sticks to; the other walls of the case are not the fluid's.
dem::LubricationParameters lubrication_parameters(const Case& c, std::size_t walls) {
  const LubricationCase& asked_for = *c.coupling.lubrication;
  dem::LubricationParameters parameters;
  parameters.viscosity = c.fluid.density * c.fluid.kinematic_viscosity;
  parameters.normal_cut_off = asked_for.normal_cut_off * c.domain.spacing;
  parameters.tangential_cut_off = asked_for.tangential_cut_off * c.domain.spacing;
  parameters.minimum_gap = asked_for.minimum_gap;
  for (const Face& face : c.domain.faces)  // in the order of planes_of()
    if (face.type != FaceType::periodic)
      parameters.walls.push_back(face.type == FaceType::no_slip || face.type == FaceType::moving);
  parameters.walls.resize(walls, false);
  return parameters;
}

// The faces that are no periodic ones, then the walls of the case.
std::vector<dem::Plane> planes_of(const Case& c, const PeriodicBox& box, const dem::ContactParameters& contact) {
  std::vector<dem::Plane> planes = dem::face_planes(box, contact);
  std::size_t number = 0;
  for (const Face& face : c.domain.faces) {  // face_planes() has the same order and leaves out the periodic ones
    if (face.type == FaceType::periodic) continue;
    dem::Plane& plane = planes[number++];
    if (face.type != FaceType::moving) continue;
    plane.velocity = face.velocity;
    plane.oscillation = oscillation_of(face.oscillation);
  }
  for (const WallCase& wall : c.walls) {
    dem::Plane plane;
    plane.point = wall.point;
    plane.normal = wall.normal.normalized();
    plane.friction = wall.friction.value_or(contact.wall_friction);
    plane.rolling_friction = wall.rolling_friction.value_or(contact.wall_rolling_friction);
    plane.velocity = wall.velocity;
    plane.oscillation = oscillation_of(wall.oscillation);
    if (wall.plate) {
      const Vec3& along = wall.plate->along;
      const Vec3 in_plane = (along - along.dot(plane.normal) * plane.normal).normalized();
      plane.plate = {in_plane, 0.5 * wall.plate->length, 0.5 * wall.plate->width};
    }
    planes.push_back(plane);
  }
  return planes;
}

dem::GrainSeed seed_of(const Case& c, std::size_t number, std::size_t grain, const Vec3& position) {
  const PopulationCase& population = c.grains[number];
  dem::GrainSeed seed;
  seed.radius = 0.5 * population.diameter_of(grain);
  seed.density = population.density_of(grain);
  seed.position = position;
  seed.thickness = population.thickness;
  if (c.disks) seed.position[1] = 0.5 * c.domain.size[1];
  seed.material = material_of(c, number);
  Vec3 velocity = population.velocity, spin = population.angular_velocity;
  if (!population.file.empty()) {
    const bool kept = population.placement.velocities.value_or(FileVelocities::kept) == FileVelocities::kept;
    velocity = kept ? population.file[grain].velocity : Vec3::Zero();
    spin = kept ? population.file[grain].angular_velocity : Vec3::Zero();
  }
  seed.velocity = population.prescribed_velocity.value_or(velocity);
  seed.angular_velocity = population.prescribed_angular_velocity.value_or(spin);
  if (population.prescribed_velocity) seed.motion = dem::Motion::held_translation;
  if (population.prescribed_angular_velocity)
    seed.motion = population.prescribed_velocity ? dem::Motion::fixed : dem::Motion::held_rotation;
  seed.assembly = assembly_of(c, number);
  if (population.fixed || population.motion) {
    seed.motion = dem::Motion::fixed;
    seed.velocity = seed.angular_velocity = Vec3::Zero();
  }
  return seed;
}

// A clump moves and is held as its population says a grain is; of a file it has what its members tell.
dem::ClumpSeed clump_seed_of(const dem::GrainSeed& as_grain, dem::ClumpSeed clump) {
  clump.id = as_grain.id;
  clump.density = as_grain.density;
  clump.velocity = as_grain.velocity;
  clump.angular_velocity = as_grain.angular_velocity;
  clump.material = as_grain.material;
  clump.motion = as_grain.motion;
  return clump;
}

// Who is given a place first.
enum class Turn { given, uniform, random };

Turn turn_of(const PlacementCase& placement) {
  if (placement.file || !placement.positions.empty()) return Turn::given;
  return placement.pattern == PlacementPattern::uniform ? Turn::uniform : Turn::random;
}

std::vector<Vec3> place(const PopulationCase& population, const PeriodicBox& box,
                        const std::vector<dem::Sphere>& placed) {
  const PlacementCase& placement = population.placement;
  const auto seed = static_cast<std::uint64_t>(placement.seed);
  std::vector<Vec3> positions;
  std::vector<double> radii;
  dem::Region region = region_of(placement, box);
  region.plane = population.thickness > 0.0;
  if (region.plane) region.lower[1] = 0.0, region.upper[1] = box.size[1];
  switch (turn_of(placement)) {
    case Turn::given:
      for (const io::BedGrain& grain : population.file) positions.push_back(grain.position);
      return placement.file ? positions : placement.positions;
    case Turn::uniform:
      return dem::uniform_packing(box, region, population.count, 0.5 * population.room_of_all(), 0.0, seed);
    case Turn::random:
      break;
  }
  for (std::size_t n = 0; n < static_cast<std::size_t>(population.count); ++n)
    radii.push_back(0.5 * population.room_of(n));
  return dem::random_packing(box, region, radii, 0.0, seed, placed);
}

// The grains of a population at their positions, or from the rows of its file; returns the id that comes next.
GlobalId add_seeds(const Case& c, std::size_t number, const std::vector<Vec3>& positions, GlobalId next,
                   GrainSeeds& seeds) {
  const PopulationCase& population = c.grains[number];
  const auto with_id = [&](std::size_t grain, const Vec3& position) {
    dem::GrainSeed seed = seed_of(c, number, grain, position);
    seed.id = next;
    return seed;
  };
  if (population.shape) {
    dem::ClumpSeed clump;
    clump.shape = clump_shape_of(population);
    for (std::size_t n = 0; n < positions.size(); ++n) {
      const dem::GrainSeed as_grain = with_id(n, positions[n]);
      clump.position = as_grain.position;
      clump.orientation = orientation_of(population, n);
      seeds.clumps.push_back(clump_seed_of(as_grain, clump));
      next += static_cast<GlobalId>(clump.shape->members.size());
    }
    return next;
  }
  if (population.file.empty()) {
    for (std::size_t n = 0; n < positions.size(); ++n, ++next) seeds.grains.push_back(with_id(n, positions[n]));
    return next;
  }
  std::size_t row = 0;
  for (const std::span<const io::BedGrain> body : bodies_of(population.file)) {
    dem::GrainSeed seed = with_id(row, body.front().position);
    if (body.front().clump < 0) {
      seeds.grains.push_back(seed);
    } else {
      dem::ClumpSeed clump = clump_from(body, box_of(c), population.thickness);
      const bool kept = population.placement.velocities.value_or(FileVelocities::kept) == FileVelocities::kept;
      if (kept && !dem::holds_translation(seed.motion)) seed.velocity = clump.velocity;  // of the centre
      seeds.clumps.push_back(clump_seed_of(seed, clump));
    }
    next += static_cast<GlobalId>(body.size());
    row += body.size();
  }
  return next;
}

}  // namespace

dem::PrescribedMotion prescribed_motion(const MotionCase& c) {
  dem::PrescribedMotion motion;
  motion.velocity = c.velocity;
  motion.oscillation = oscillation_of(c.oscillation);
  if (!c.rotation) return motion;
  motion.centre = c.rotation->point;
  motion.axis = c.rotation->axis.normalized();
  motion.angular_velocity = c.rotation->angular_velocity;
  return motion;
}

dem::GrainParameters grain_parameters(const Case& c, const PeriodicBox& box) {
  dem::GrainParameters parameters;
  const std::vector<dem::ContactParameters> materials = materials_of(c);
  parameters.contact = materials.front();
  parameters.other_materials.assign(materials.begin() + 1, materials.end());
  parameters.wall_contact = wall_material_of(c.contact);
  parameters.walls = planes_of(c, box, parameters.contact);
  parameters.assemblies = assemblies_of(c);
  if (c.coupling.lubrication) parameters.lubrication = lubrication_parameters(c, parameters.walls.size());
  parameters.time_step = grain_time_step(c);
  parameters.disks = c.disks.has_value();
  parameters.integrator = c.run.grain_integrator;
  parameters.sub_steps = static_cast<int>(c.coupling.grain_steps_per_fluid_step);
  parameters.skin = (has_fluid(c) ? skin_in_diameters : dry_skin_in_diameters) * smallest_diameter(c);
  for (const PopulationCase& population : c.grains)
    if (population.placement.file)
      parameters.initial_overlap = std::max(parameters.initial_overlap,
                                            population.placement.largest_overlap.value_or(PlacementCase::bed_overlap));
  return parameters;
}

GrainSeeds grain_seeds(const Case& c) {
  const PeriodicBox box = box_of(c);
  std::vector<std::vector<Vec3>> positions(c.grains.size());
  std::vector<dem::Sphere> placed;
  for (const Turn turn : {Turn::given, Turn::uniform, Turn::random})
    for (std::size_t p = 0; p < c.grains.size(); ++p) {
      if (turn_of(c.grains[p].placement) != turn) continue;
      try {
        positions[p] = place(c.grains[p], box, placed);
      } catch (const InputError& error) {
        throw InputError(fmt::format("grains.{}: {}", p, error.what()));
      }
      for (std::size_t n = 0; n < positions[p].size(); ++n)
        placed.push_back(
            {c.disks ? Vec3(positions[p][n].x(), 0.5 * c.domain.size[1], positions[p][n].z()) : positions[p][n],
             0.5 * c.grains[p].room_of(n)});
    }
  GrainSeeds seeds;
  GlobalId next = 0;
  for (std::size_t p = 0; p < c.grains.size(); ++p) next = add_seeds(c, p, positions[p], next, seeds);
  return seeds;
}

}  // namespace thalweg::driver
