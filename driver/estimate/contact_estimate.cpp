#include "driver/estimate/contact_estimate.hpp"

#include "beds/population_seeds.hpp"
#include "dem/laws/contact_laws.hpp"
#include "dem/laws/material.hpp"
#include "dem/motion/prescribed_motion.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/bed/reference_grain.hpp"
#include "driver/bed/supplied_grains.hpp"
#include "driver/case/solid_setup.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "driver/estimate/settling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

namespace thalweg::driver {

namespace {

// kg/m^3, of grains less that of the fluid around them.
double submerged_density(const Case& c, double density) { return density - (has_fluid(c) ? c.fluid.density : 0.0); }

// m, by the law of the material.
double overlap_under(const dem::ContactParameters& material, double force, double diameter) {
  return dem::with_spring_law(
      material.law, [&](auto spring) { return decltype(spring)::type::overlap_under(material, force, diameter); });
}

double overlap_in_impact(const dem::ContactParameters& material, double mass, double speed, double diameter) {
  return dem::with_spring_law(material.law, [&](auto spring) {
    return decltype(spring)::type::overlap_in_impact(material, mass, speed, diameter);
  });
}

// m/s, at the start; zero of grains that move together as a body.
Vec3 initial_velocity(const beds::Population& grains) {
  return grains.held() ? grains.prescribed_velocity.value_or(Vec3(Vec3::Zero())) : grains.velocity;
}

bool any_wall(const Case& c) {
  const std::array<bool, 3> periodic = periodic_axes(c.domain);
  return !c.walls.empty() || !c.solids.empty() || std::find(periodic.begin(), periodic.end(), false) != periodic.end();
}

// m/s, of free grains that start towards or past those of another population, or a wall, or come in, or that a wall or
// a solid meets on its way.
double starting_speed(const Case& c) {
  double fastest = std::max(fastest_supply(c), speed_off_walls(c));
  for (const SolidCase& solid : c.solids) fastest = std::max(fastest, largest_speed(solid));
  for (const beds::Population& one : c.grains) {
    if (one.held()) continue;
    if (any_wall(c)) fastest = std::max(fastest, one.velocity.norm());
    for (const beds::Population& other : c.grains)
      fastest = std::max(fastest, (one.velocity - initial_velocity(other)).norm());
  }
  return fastest;
}

bool has_clumps(const beds::Population& grains) { return grains.clumps.count > 0; }

// Of clumps by their nominal diameters.
double largest_over_smallest(const beds::Population& grains) {
  return has_clumps(grains) ? grains.coarsest() / grains.finest()
                            : grains.largest_diameter() / grains.smallest_diameter();
}

// Ratio of masses of spheres, disks or clumps of one shape and density whose sizes have this ratio.
double ratio_of_masses(const beds::Population& grains, double ratio) {
  return std::pow(ratio, grains.thickness > 0.0 ? 2 : 3);
}

double speed_of_a_fall(const Case& c) {
  if (has_fluid(c)) return falling_speed(c);
  const double height = std::max(0.0, c.domain.size.z() - settled_height(c));
  return periodic_axes(c.domain)[2] ? 0.0 : std::sqrt(2.0 * std::abs(gravity_vector(c.gravity).z()) * height);
}

double impact_speed(const Case& c) { return std::max(speed_of_a_fall(c), starting_speed(c)); }

// Effective mass of a contact over the mass of a grain: of two equal grains, and of a grain and a wall.
constexpr double of_two = 0.5, with_wall = 1.0;

// Adds those of a population with contacts of this material: of its smallest grains and of its largest, whose contacts
// are softer for their size by the linear law. height: m, of the settled bed. share: of_two or with_wall.
void add_overlaps(const Case& c, const beds::Population& grains, const dem::ContactParameters& material, double height,
                  double share, Overlaps& found) {
  const double pressure = settled_fraction(c) * std::abs(submerged_density(c, grains.density)) *
                          std::abs(gravity_vector(c.gravity).z()) * height;
  for (const double ratio : {1.0, largest_over_smallest(grains)}) {
    const double d = ratio * grains.smallest_diameter();
    const double mass = share * grains.lightest_mass() * ratio_of_masses(grains, ratio);
    const double size = ratio * (has_clumps(grains) ? grains.finest() : grains.smallest_diameter());
    const double width = c.disks ? c.disks->thickness : size;
    if (!periodic_axes(c.domain)[2])
      found.under_weight = std::max(found.under_weight, overlap_under(material, pressure * size * width, d) / d);
    if (!grains.held())
      found.in_impact = std::max(found.in_impact, overlap_in_impact(material, mass, found.speed, d) / d);
  }
}

}  // namespace

double speed_off_walls(const Case& c) {
  double fastest = 0.0;
  const auto consider = [&](const Vec3& velocity, const std::optional<dem::Oscillation>& oscillation,
                            const Vec3& normal) {
    const dem::PrescribedMotion motion{velocity, oscillation.value_or(dem::Oscillation{})};
    fastest = std::max(fastest, 2.0 * motion.largest_speed_along(normal));
  };
  for (const beds::Population& body : c.grains)
    for (const int axis : {0, 1, 2})
      if (body.motion && !periodic_axes(c.domain)[static_cast<std::size_t>(axis)])
        consider(body.motion->velocity, body.motion->oscillation, Vec3::Unit(axis));
  for (std::size_t face = 0; face < c.domain.faces.size(); ++face)
    if (const coupling::FaceKeys& keys = c.domain.faces[face]; keys.type == lbm::FaceType::moving)
      consider(keys.velocity, keys.oscillation, Vec3::Unit(static_cast<Eigen::Index>(face / 2)));
  for (const beds::WallKeys& wall : c.walls) consider(wall.velocity, wall.oscillation, wall.normal.normalized());
  return fastest;
}

Overlaps expected_overlaps(const Case& c) {
  Overlaps found{0.0, 0.0, impact_speed(c)};
  if (c.grains.empty()) return found;
  const std::vector<dem::ContactParameters> materials = beds::materials_of(c.contact, c.grains);
  const double height = settled_height(c);
  for (std::size_t p = 0; p < c.grains.size(); ++p)
    add_overlaps(c, c.grains[p], materials[static_cast<std::size_t>(beds::material_of(c.grains, p))], height, of_two,
                 found);
  // Of walls softer than the grains, where a case gives their stiffness: by the law of elastic spheres grain and wall
  // share the overlap.
  const std::optional<dem::ContactParameters> walls = beds::wall_material_of(c.contact);
  if (walls && c.contact.walls->normal_stiffness && c.contact.law == dem::Law::linear)
    for (const beds::Population& grains : c.grains) add_overlaps(c, grains, *walls, height, with_wall, found);
  return found;
}

// Scales overlaps at 1 N/m: those under weight fall with the stiffness, those in an impact with its square root.
double least_stiffness(const Case& c) {
  dem::ContactParameters unit = c.contact;
  unit.normal_stiffness = 1.0;
  Overlaps found{0.0, 0.0, impact_speed(c)};
  const double height = settled_height(c);
  for (const beds::Population& grains : c.grains)
    if (!grains.contact || !grains.contact->normal_stiffness) add_overlaps(c, grains, unit, height, of_two, found);
  return stiffness_margin *
         std::max(found.under_weight / deep_under_weight, std::pow(found.in_impact / deep_in_impact, 2));
}

namespace {

// St = (rho_s/rho_f) v d/(9 nu) of the largest grain at the fastest speed there may be.
double largest_stokes_number(const Case& c) {
  const double speed = std::max(expected_overlaps(c).speed, flow_estimate(c).speed);
  double ratio = 0.0;
  for (const std::size_t p : free_populations(c)) ratio = std::max(ratio, c.grains[p].density / c.fluid.density);
  return ratio * speed * largest_size(c) / (9.0 * c.fluid.kinematic_viscosity);
}

}  // namespace

std::optional<ReboundTimes> rebound_times(const Case& c) {
  if (!has_fluid(c) || c.grains.empty() || largest_stokes_number(c) < least_stokes_number_of_a_rebound)
    return std::nullopt;
  double narrowest = std::numeric_limits<double>::infinity();
  for (const std::size_t p : free_populations(c)) narrowest = std::min(narrowest, c.grains[p].narrowest());
  return ReboundTimes{shortest_contact(c) / fluid_time_step(c),
                      0.5 * std::numbers::pi * std::sqrt(3.0) * narrowest / c.domain.spacing};
}

std::optional<DryRestitution> dry_restitution(const Case& c) {
  if (c.grains.empty() || !c.contact.damping) return std::nullopt;
  const std::vector<dem::ContactParameters> materials = beds::materials_of(c.contact, c.grains);
  const std::optional<dem::ContactParameters> walls = beds::wall_material_of(c.contact);
  const auto of = [](const dem::ContactParameters& material, double mass) {
    const double ratio = *material.damping / (2.0 * std::sqrt(material.normal_stiffness * mass));
    return dem::restitution_of_damping_ratio(ratio, material.attraction);
  };
  DryRestitution found{1.0, 0.0, 1.0, 0.0};
  for (std::size_t p = 0; p < c.grains.size(); ++p) {
    const beds::Population& grains = c.grains[p];
    if (grains.held()) continue;
    const dem::ContactParameters& own = materials[static_cast<std::size_t>(beds::material_of(c.grains, p))];
    const double lightest = grains.lightest_mass();
    for (const double mass : {lightest, lightest * ratio_of_masses(grains, largest_over_smallest(grains))}) {
      const double between = of(own, 0.5 * mass), at_wall = of(walls.value_or(own), mass);
      found.least = std::min(found.least, between);
      found.most = std::max(found.most, between);
      found.least_at_wall = std::min(found.least_at_wall, at_wall);
      found.most_at_wall = std::max(found.most_at_wall, at_wall);
    }
  }
  if (found.least > found.most) return std::nullopt;
  return found;
}

double stress_ratio_at_base(const Case& c) {
  const Vec3 gravity = gravity_vector(c.gravity);
  const std::array<bool, 3> periodic = periodic_axes(c.domain);
  if (!has_free_grains(c) || side_walls(c) > 0 || !periodic[0] || periodic[2] || gravity.x() == 0.0 ||
      gravity.z() >= 0.0)
    return 0.0;
  if (c.system == SystemKind::model_fluid || (has_fluid(c) && c.fluid.mean_velocity)) return 0.0;
  const ReferenceGrain grain = reference_grain(c);
  const double height = settled_height(c), depth = c.domain.size.z() - height;
  if (height < grain.diameter || depth < 0.0 || c.disks) return 0.0;
  const double water = has_fluid(c) ? c.fluid.density : 0.0;
  const double excess = settled_fraction(c) * (grain.density - water);
  if (excess <= neutral_density * water) return 0.0;
  return (water * held_by_the_bed(c, depth) + (water + excess) * height) * std::abs(gravity.x()) /
         (excess * height * -gravity.z());
}

bool only_friction_holds_the_bed(const Case& c) {
  if (c.contact.liquid_bridge) return false;
  const auto free = free_populations(c);
  return std::none_of(free.begin(), free.end(), [&](std::size_t p) {
    const beds::Population& grains = c.grains[p];
    const double rolling = grains.contact ? grains.contact->rolling_friction.value_or(c.contact.rolling_friction)
                                          : c.contact.rolling_friction;
    return has_clumps(grains) || rolling > 0.0;
  });
}

double bulk_friction(const Case& c) {
  double volume = 0.0, friction = 0.0;  // m^3
  for (const std::size_t p : free_populations(c)) {
    const std::optional<beds::MaterialKeys>& own = c.grains[p].contact;
    volume += c.grains[p].volume();
    friction += c.grains[p].volume() * (own ? own->friction.value_or(c.contact.friction) : c.contact.friction);
  }
  return bulk_friction(friction / volume);
}

double bulk_friction(double friction) {
  struct Row {
    double particle, bulk;
  };
  constexpr Row table[] = {{0.0, 0.105}, {0.1, 0.268}, {0.3, 0.357}, {0.5, 0.382}, {1.0, 0.405}};
  for (std::size_t n = 1; n < std::size(table); ++n) {
    const Row &a = table[n - 1], &b = table[n];
    if (friction <= b.particle) return a.bulk + (b.bulk - a.bulk) * (friction - a.particle) / (b.particle - a.particle);
  }
  return std::end(table)[-1].bulk;
}

}  // namespace thalweg::driver
