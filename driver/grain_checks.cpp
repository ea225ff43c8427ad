#include "driver/grain_checks.hpp"

#include "dem/material.hpp"
#include "driver/case_checks.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace thalweg {
namespace {

// Random close packing of equal spheres: no bed is denser.
constexpr double densest_bed = 0.64;
constexpr double densest_disks = 0.84;  // the same in two dimensions

void check_room(const Case& c, const io::YamlDocument& document) {
  const std::array<bool, 3> periodic = periodic_axes(c.domain);
  const double diameter = largest_diameter(c);
  for (int axis = 0; axis < 3; ++axis) {
    if (c.disks && axis == 1) continue;
    const double least = (periodic[static_cast<std::size_t>(axis)] ? 2.0 : 1.0) * diameter;
    if (c.domain.size[axis] < least)
      throw document.error(
          "domain.size", fmt::format("the {} m along {} are too narrow for grains of {} m; give at least {:.6g} m ({})",
                                     c.domain.size[axis], axis_name[axis], diameter, least,
                                     least > diameter ? "two diameters of a periodic axis" : "one diameter"));
    const double extent = 1.005 * largest_extent(c);
    if (periodic[static_cast<std::size_t>(axis)] && c.domain.size[axis] < extent)
      throw document.error("domain.size",
                           fmt::format("the {} m along {}, which is periodic, are so short that a clump would touch "
                                       "itself; give at least {:.6g} m",
                                       c.domain.size[axis], axis_name[axis], extent));
  }
  const double box = c.disks ? c.domain.size[0] * c.disks->thickness * c.domain.size[2] : c.domain.size.prod();
  const double fraction = grain_volume(c) / box, densest = c.disks ? densest_disks : densest_bed;
  if (fraction > densest)
    throw document.error(
        c.grains.size() == 1 ? "grains.0.count" : "grains",
        fmt::format("{} grains do not fit: they would fill {:.0f} % of the box, and at most {:.0f} % is "
                    "possible; give at most {:.0f}% of them or a larger domain.size in m",
                    grain_count(c), 100.0 * fraction, 100.0 * densest, std::floor(100.0 * densest / fraction)));
}

bool inside(const Vec3& point, const DomainCase& domain) {
  return (point.array() >= 0.0).all() && (point.array() <= domain.size.array()).all();
}

std::string shown(const Vec3& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

void check_placement(const Case& c, const io::YamlDocument& document) {
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    const PopulationCase& grains = c.grains[n];
    const std::string key = fmt::format("grains.{}", n);
    for (std::size_t p = 0; p < grains.placement.positions.size(); ++p)
      if (!inside(grains.placement.positions[p], c.domain))
        throw document.error(fmt::format("{}.placement.positions.{}", key, p),
                             fmt::format("the grain is outside the box; give a point in m between [0, 0, 0] and {}",
                                         shown(c.domain.size)));
    if (!grains.placement.region) continue;
    const RegionCase& region = *grains.placement.region;
    const Vec3 extent = region.upper - region.lower;
    if (!inside(region.lower, c.domain) || !inside(region.upper, c.domain) || !(extent.array() > 0.0).all())
      throw document.error(key + ".placement.region.upper",
                           fmt::format("the region must lie in the box with lower below upper along every axis; give "
                                       "corners in m between [0, 0, 0] and {}",
                                       shown(c.domain.size)));
    if (grains.placement.file || c.disks) continue;
    const double fraction = grains.volume() / extent.prod();
    if (fraction > densest_bed)
      throw document.error(
          key + ".count",
          fmt::format("{} grains do not fit in their region: they would fill {:.0f} % of it, and at most "
                      "{:.0f} % is possible; give a larger placement.region in m or fewer grains",
                      grains.count, 100.0 * fraction, 100.0 * densest_bed));
  }
}

void check_contact_steps(const Case& c, const io::YamlDocument& document) {
  if (c.grains.empty()) return;
  const double longest = shortest_contact(c) / dem::fewest_steps_per_contact;
  const double step = grain_time_step(c);
  if (step <= longest * (1.0 + whole_number_tolerance)) return;
  const std::string reason = fmt::format(
      "a step of the grains of {:.4g} s is longer than 1/20 of their shortest contact "
      "({:.4g} s)",
      step, shortest_contact(c));
  if (c.system == SystemKind::grains)
    throw document.error("run.time_step", fmt::format("{}; give at most {:.3g} s", reason, longest));
  throw document.error("coupling.grain_steps_per_fluid_step",
                       fmt::format("{}; give at least {} sub-steps, or a lower contact.normal_stiffness in N/m", reason,
                                   sub_steps_needed(c)));
}

// What a population or the walls change must fit the law and the manner of loss of the section contact.
void check_material(const Case& c, const io::YamlDocument& document, const std::string& key,
                    const MaterialCase& material) {
  const auto refuse = [&](bool given, const char* name, const std::string& remedy) {
    if (given) throw document.error(key + "." + name, remedy);
  };
  if (c.contact.law == dem::Law::linear) {
    const std::string remedy = "contact.law is linear, which has stiffnesses; remove it or set hertz_mindlin there";
    refuse(material.youngs_modulus.has_value(), "youngs_modulus", remedy);
    refuse(material.poisson_ratio.has_value(), "poisson_ratio", remedy);
  } else {
    const std::string remedy = "contact.law is hertz_mindlin, which has moduli; remove it or set linear there";
    refuse(material.normal_stiffness.has_value(), "normal_stiffness", remedy);
    refuse(material.tangential_stiffness.has_value(), "tangential_stiffness", remedy);
  }
  refuse(material.damping && !c.contact.damping, "damping",
         "the section contact gives a restitution; give restitution here, too");
  refuse(material.restitution && !c.contact.restitution, "restitution",
         "the section contact gives a damping; give damping in kg/s here, too");
}

bool stays_in_plane(const MotionCase& motion) {
  const bool turns_in_it = !motion.rotation || (motion.rotation->axis.x() == 0.0 && motion.rotation->axis.z() == 0.0);
  return turns_in_it && motion.velocity.y() == 0.0 && (!motion.oscillation || motion.oscillation->amplitude.y() == 0.0);
}

void check_plates(const Case& c, const io::YamlDocument& document) {
  for (std::size_t n = 0; n < c.walls.size(); ++n) {
    const WallCase& wall = c.walls[n];
    constexpr double rounded = 1e-3;  // numbers with a few digits are welcome
    if (wall.plate && !(std::abs(wall.plate->along.normalized().dot(wall.normal.normalized())) < rounded))
      throw document.error(fmt::format("walls.{}.plate.along", n),
                           "a plate lies in the plane of its wall; give a direction at right angles to normal");
  }
}

// An edge across y would push disks out of their plane.
void check_plates_of_disks(const Case& c, const io::YamlDocument& document) {
  for (std::size_t n = 0; n < c.walls.size(); ++n) {
    if (!c.walls[n].plate) continue;
    const PlateCase& plate = *c.walls[n].plate;
    if (plate.along.y() != 0.0)
      throw document.error(fmt::format("walls.{}.plate.along", n),
                           "disks move in the plane x-z; give a direction with 0 along y");
    if (!(std::abs(0.5 * c.domain.size.y() - c.walls[n].point.y()) < 0.5 * plate.width))
      throw document.error(fmt::format("walls.{}.plate.width", n),
                           "disks are in the middle of the box; give a width in m that reaches there");
  }
}

void check_disks(const Case& c, const io::YamlDocument& document) {
  if (!c.disks) return;
  if (c.domain.faces[y_low].type != FaceType::periodic)
    throw document.error("domain.boundaries", "disks move in the plane x-z; give y: periodic");
  if (gravity_vector(c.gravity).y() != 0.0)
    throw document.error("gravity.vector", "disks move in the plane x-z; give a vector in m/s^2 with 0 along y");
  for (std::size_t n = 0; n < c.walls.size(); ++n) {
    const WallCase& wall = c.walls[n];
    if (wall.normal.y() != 0.0)
      throw document.error(fmt::format("walls.{}.normal", n),
                           "disks move in the plane x-z; give a normal with 0 along y");
    if (wall.velocity.y() != 0.0)
      throw document.error(fmt::format("walls.{}.velocity", n),
                           "disks move in the plane x-z; give a vector in m/s with 0 along y");
    if (wall.oscillation && wall.oscillation->amplitude.y() != 0.0)
      throw document.error(fmt::format("walls.{}.oscillation.amplitude", n),
                           "disks move in the plane x-z; give a vector in m with 0 along y");
  }
  check_plates_of_disks(c, document);
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    const PopulationCase& grains = c.grains[n];
    const std::string key = fmt::format("grains.{}.", n);
    for (const Vec3& v : {grains.velocity, grains.prescribed_velocity.value_or(Vec3::Zero())})
      if (v.y() != 0.0)
        throw document.error(key + (grains.velocity.y() != 0.0 ? "velocity" : "prescribed_velocity"),
                             "disks move in the plane x-z; give a vector in m/s with 0 along y");
    if (grains.orientation && (grains.orientation->axis.x() != 0.0 || grains.orientation->axis.z() != 0.0))
      throw document.error(key + "orientation.axis", "disks turn about y; give a vector with 0 along x and z");
    if (grains.motion && !stays_in_plane(*grains.motion))
      throw document.error(key + "motion",
                           "disks move in the plane x-z and turn about y; give vectors with 0 along y and a "
                           "rotation.axis along y");
    for (const Vec3& w : {grains.angular_velocity, grains.prescribed_angular_velocity.value_or(Vec3::Zero())})
      if (w.x() != 0.0 || w.z() != 0.0)
        throw document.error(
            key + (grains.prescribed_angular_velocity ? "prescribed_angular_velocity" : "angular_velocity"),
            "disks turn about y; give a vector in rad/s with 0 along x and z");
  }
}

void check_clumps(const Case& c, const io::YamlDocument& document) {
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    if (c.grains[n].clumps.count == 0) continue;
    if (c.run.grain_integrator == dem::Integrator::gear)
      throw document.error("run.grain_integrator", "clumps are moved by velocity_verlet; give that or no clumps");
    if (c.grains[n].motion)
      throw document.error(fmt::format("grains.{}.motion", n),
                           "grains that move together as one body must be spheres, and this bed has clumps; use "
                           "prescribed_velocity or another bed");
  }
}

void check_materials(const Case& c, const io::YamlDocument& document) {
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    if (c.grains[n].contact) check_material(c, document, fmt::format("grains.{}.contact", n), *c.grains[n].contact);
  if (c.contact.walls) check_material(c, document, "contact.walls", *c.contact.walls);
}

}  // namespace

void check_that_grains_fit(const Case& c, const io::YamlDocument& document) {
  check_room(c, document);
  check_placement(c, document);
}

void check_grains(const Case& c, const io::YamlDocument& document) {
  check_plates(c, document);
  check_disks(c, document);
  check_clumps(c, document);
  check_materials(c, document);
  check_contact_steps(c, document);
}

}  // namespace thalweg
