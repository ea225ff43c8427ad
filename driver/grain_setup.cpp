#include "driver/grain_setup.hpp"

#include "core/error.hpp"
#include "dem/packing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::driver {

namespace {

constexpr double skin_in_diameters = 0.1;

PeriodicBox box_of(const Case& c) { return {c.domain.size, periodic_axes(c.domain)}; }

dem::Region region_of(const PlacementCase& placement, const PeriodicBox& box) {
  if (!placement.region) return dem::whole(box);
  return {placement.region->lower, placement.region->upper};
}

dem::GrainSeed prototype(const PopulationCase& population) {
  dem::GrainSeed seed;
  seed.radius = 0.5 * population.diameter;
  seed.density = population.density;
  seed.velocity = population.prescribed_velocity.value_or(population.velocity);
  seed.angular_velocity = population.prescribed_angular_velocity.value_or(population.angular_velocity);
  if (population.prescribed_velocity) seed.motion = dem::Motion::held_translation;
  if (population.prescribed_angular_velocity)
    seed.motion = population.prescribed_velocity ? dem::Motion::fixed : dem::Motion::held_rotation;
  if (population.fixed) {
    seed.motion = dem::Motion::fixed;
    seed.velocity = seed.angular_velocity = Vec3::Zero();
  }
  return seed;
}

enum class Turn { positions, uniform, random };

Turn turn_of(const PlacementCase& placement) {
  if (!placement.positions.empty()) return Turn::positions;
  return placement.pattern == PlacementPattern::uniform ? Turn::uniform : Turn::random;
}

std::vector<Vec3> place(const PopulationCase& population, const PeriodicBox& box,
                        const std::vector<dem::Sphere>& placed) {
  const PlacementCase& placement = population.placement;
  const double radius = 0.5 * population.diameter;
  const auto seed = static_cast<std::uint64_t>(placement.seed);
  switch (turn_of(placement)) {
    case Turn::positions:
      return placement.positions;
    case Turn::uniform:
      return dem::uniform_packing(box, region_of(placement, box), population.count, radius, 0.0, seed);
    case Turn::random:
      break;
  }
  const std::vector<double> radii(static_cast<std::size_t>(population.count), radius);
  return dem::random_packing(box, region_of(placement, box), radii, 0.0, seed, placed);
}

}  // namespace

dem::GrainParameters grain_parameters(const Case& c, const PeriodicBox& box) {
  dem::GrainParameters parameters;
  parameters.contact.law = c.contact.law == ContactLaw::linear ? dem::Law::linear : dem::Law::hertz_mindlin;
  parameters.contact.youngs_modulus = c.contact.youngs_modulus;
  parameters.contact.poisson_ratio = c.contact.poisson_ratio;
  parameters.contact.tangential_damping = c.contact.tangential_damping;
  parameters.contact.normal_stiffness = c.contact.normal_stiffness;
  parameters.contact.tangential_stiffness = c.contact.tangential_stiffness;
  parameters.contact.restitution = c.contact.restitution;
  parameters.contact.damping = c.contact.damping;
  parameters.contact.friction = c.contact.friction;
  parameters.contact.wall_friction = c.contact.wall_friction;
  parameters.contact.attraction = c.contact.attraction == Attraction::allowed;
  parameters.walls = dem::face_planes(box, parameters.contact);
  parameters.time_step = grain_time_step(c);
  parameters.sub_steps = static_cast<int>(c.coupling.grain_steps_per_fluid_step);
  parameters.skin = skin_in_diameters * smallest_diameter(c);
  return parameters;
}

std::vector<dem::GrainSeed> grain_seeds(const Case& c) {
  const PeriodicBox box = box_of(c);
  std::vector<std::vector<Vec3>> positions(c.grains.size());
  std::vector<dem::Sphere> placed;
  for (const Turn turn : {Turn::positions, Turn::uniform, Turn::random})
    for (std::size_t p = 0; p < c.grains.size(); ++p) {
      if (turn_of(c.grains[p].placement) != turn) continue;
      try {
        positions[p] = place(c.grains[p], box, placed);
      } catch (const InputError& error) {
        throw InputError(fmt::format("grains.{}: {}", p, error.what()));
      }
      for (const Vec3& position : positions[p]) placed.push_back({position, 0.5 * c.grains[p].diameter});
    }
  std::vector<dem::GrainSeed> seeds;
  for (std::size_t p = 0; p < c.grains.size(); ++p)
    for (const Vec3& position : positions[p]) {
      dem::GrainSeed seed = prototype(c.grains[p]);
      seed.id = static_cast<GlobalId>(seeds.size());
      seed.position = position;
      seeds.push_back(seed);
    }
  return seeds;
}

}  // namespace thalweg::driver
