#include "driver/input/grain_checks.hpp"

#include "beds/packing/packing.hpp"
#include "beds/supplies.hpp"
#include "dem/laws/material.hpp"
#include "driver/bed/obstacles.hpp"
#include "driver/bed/reference_grain.hpp"
#include "driver/bed/supplied_grains.hpp"
#include "driver/case/grain_setup.hpp"
#include "driver/case/limit_text.hpp"
#include "driver/input/case_checks.hpp"

#include <fmt/format.h>

#include <cmath>

namespace thalweg::driver {
namespace {

constexpr const char* sub_steps_key = "coupling.grain_steps_per_fluid_step";

// What to do about grains wider than any in SI units; "" for others.
std::string in_millimetres(const Case& c, double diameter) {
  if (c.system != SystemKind::resolved || diameter <= largest_boulder) return "";
  return fmt::format(", or, as diameters are in m and {0:g} looks like {0:g} mm, grains of {1:g} m", diameter,
                     1e-3 * diameter);
}

void check_room(const Case& c, const io::YamlDocument& document) {
  const std::array<bool, 3> periodic = periodic_axes(c.domain);
  const double diameter = largest_diameter(c);
  for (int axis = 0; axis < 3; ++axis) {
    if (c.disks && axis == 1) continue;
    const double least = (periodic[static_cast<std::size_t>(axis)] ? 2.0 : 1.0) * diameter;
    if (c.domain.size[axis] < least)
      throw document.error(
          "domain.size",
          fmt::format("the {} m along {} are too narrow for grains of {} m; give at least {:.6g} m ({}){}",
                      c.domain.size[axis], axis_name[axis], diameter, least,
                      least > diameter ? "two diameters of a periodic axis" : "one diameter",
                      in_millimetres(c, diameter)));
    const double extent = 1.005 * largest_extent(c);
    if (periodic[static_cast<std::size_t>(axis)] && c.domain.size[axis] < extent)
      throw document.error("domain.size",
                           fmt::format("the {} m along {}, which is periodic, are so short that a clump would touch "
                                       "itself; give at least {:.6g} m",
                                       c.domain.size[axis], axis_name[axis], extent));
  }
  const double box = c.disks ? c.domain.size[0] * c.disks->thickness * c.domain.size[2] : c.domain.size.prod();
  const double densest = c.disks ? beds::densest_disks : beds::densest_bed;
  double fraction = grain_volume(c) / box;
  if (fraction > densest) fraction = solid_volume(c) / box;
  if (fraction > densest) {
    const double share = densest / fraction;
    const std::string at_most =
        c.grains.size() == 1 ? fmt::format("{:.0f} grains", std::floor(share * static_cast<double>(grain_count(c))))
                             : fmt::format("{:.2g} % of them", 100.0 * share);
    throw document.error(
        c.grains.size() == 1 ? "grains.0.count" : "grains",
        fmt::format("{} grains do not fit: they would fill {:.0f} % of the box, and at most {:.0f} % is "
                    "possible; give at most {} or a larger domain.size in m",
                    grain_count(c), 100.0 * fraction, 100.0 * densest, at_most));
  }
}

void check_contact_steps(const Case& c, const io::YamlDocument& document) {
  const double longest = longest_contact_step(c), step = grain_time_step(c);
  if (step <= longest * (1.0 + dem::rounding_of_a_step)) return;
  const bool by_collisions = longest == shortest_contact(c) / dem::fewest_steps_per_contact;
  const std::string reason =
      by_collisions
          ? fmt::format("a step of the grains of {:.4g} s is longer than 1/20 of their shortest contact ({:.4g} s)",
                        step, shortest_contact(c))
          : fmt::format(
                "a step of the grains of {:.4g} s is too long for contact.tangential_stiffness, "
                "tangential_damping, rolling_friction or rolling_damping",
                step);
  if (!has_fluid(c))
    throw document.error("run.time_step", fmt::format("{}; give at most {} s", reason, at_most_text(longest, 3)));
  throw document.error(sub_steps_key,
                       fmt::format("{}; give {}: {} or more, or a longer contact.duration in s in place of stiffnesses",
                                   reason, sub_steps_key, sub_steps_needed(c)));
}

void check_lubrication_steps(const Case& c, const io::YamlDocument& document) {
  const double longest = longest_lubrication_step(c), step = grain_time_step(c);
  if (step <= longest * (1.0 + dem::rounding_of_a_step)) return;
  constexpr double widest_gap = 0.1;  // that the key may have, radii
  const double gap = c.coupling.lubrication->minimum_gap * step / longest;
  throw document.error(
      sub_steps_key,
      fmt::format(
          "a step of the grains of {:.4g} s is too long for the lubrication force on the smallest that are free, "
          "which needs one of at most {} s; give {}: {} or more{}",
          step, at_most_text(longest, 3), sub_steps_key, sub_steps_needed(c),
          gap <= widest_gap ? fmt::format(", or coupling.lubrication.minimum_gap: {} or more", at_least_text(gap, 3))
                            : ""));
}

// Volume of all grains, with bounding spheres for clumps, as random placement sees them, m^3.
double volume_to_place(const Case& c) {
  double volume = 0.0;
  for (const beds::Population& grains : c.grains)
    volume += grains.volume() *
              (grains.shape ? grains.volume_of(grains.room_of_all()) / grains.volume_of(grains.coarsest()) : 1.0);
  return volume;
}

// A pattern that has room for a population where all grains fill so much of its region; none is sure to have it beyond.
const char* pattern_for(double fraction, bool only_population) {
  constexpr double most_at_random = 0.3, most_dense = 0.58;
  if (fraction <= most_at_random) return "random";
  return only_population && fraction <= most_dense ? "dense" : nullptr;
}

void check_pattern(const Case& c, std::size_t n, const io::YamlDocument& document) {
  const beds::Population& grains = c.grains[n];
  const beds::PlacementKeys& placement = grains.placement;
  if (placement.file || !placement.positions.empty() || placement.pattern != beds::PlacementPattern::uniform) return;
  const PeriodicBox box = grain_box(c);
  beds::Region region =
      placement.region ? beds::Region{placement.region->lower, placement.region->upper} : beds::whole(box);
  region.plane = c.disks.has_value();
  if (region.plane) region.lower[1] = 0.0, region.upper[1] = c.disks->thickness;
  const double room = grains.room_of_all();
  const std::array<std::int64_t, 3> sites = beds::UniformSites::most(box, region, 0.5 * room, 0.0);
  const std::int64_t most = sites[0] * sites[1] * sites[2];
  if (grains.count <= most) return;
  const std::string key = fmt::format("grains.{}.placement.pattern", n);
  const char* pattern = pattern_for(volume_to_place(c) / (region.upper - region.lower).prod(), c.grains.size() == 1);
  throw document.error(
      key, fmt::format("{} grains do not fit on a lattice of places for the largest, {:.4g} m wide: {} would; give {}",
                       grains.count, room, most,
                       pattern ? fmt::format("{}: {}", key, pattern)
                               : std::string("fewer or smaller grains or a larger placement.region in m")));
}

void check_walls(const Case& c, const io::YamlDocument& document) {
  for (std::size_t n = 0; n < c.walls.size(); ++n)
    at_place(document, fmt::format("walls.{}", n), [&] {
      check(c.walls[n]);
      if (c.disks) check_for_disks(c.walls[n], 0.5 * c.domain.size.y());
    });
}

void check_disks(const Case& c, const io::YamlDocument& document) {
  if (!c.disks) return;
  if (c.domain.faces[y_low].type != lbm::FaceType::periodic)
    throw document.error("domain.boundaries", "disks move in the plane x-z; give y: periodic");
  if (gravity_vector(c.gravity).y() != 0.0)
    throw document.error("gravity.vector", "disks move in the plane x-z; give a vector in m/s^2 with 0 along y");
}

void check_clumps(const Case& c, const io::YamlDocument& document) {
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    if (c.grains[n].clumps.count == 0) continue;
    if (c.grains[n].motion)
      throw document.error(fmt::format("grains.{}.motion", n),
                           "grains that move together as one body must be spheres, and this bed has clumps; use "
                           "prescribed_velocity or another bed");
  }
}

void check_populations(const Case& c, const io::YamlDocument& document) {
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    at_place(document, fmt::format("grains.{}", n), [&] {
      if (c.disks) check_for_disks(c.grains[n]);
    });
}

// Throws where there is no bed for a supply to be above.
void check_for_bed(const Case& c, const std::string& key, const io::YamlDocument& document) {
  if (grain_box(c).periodic[2])
    throw document.error(key,
                         "a box that is periodic along z has no bed; give walls at bottom and top, or leave "
                         "above_bed out");
  if (!(c.system == SystemKind::model_fluid || gravity_vector(c.gravity).z() < 0.0))
    throw document.error(key, "there is no bed without gravity downwards; give gravity, or leave above_bed out");
}

// Throws where every point of an entrance is nearer to a face than the grain is large.
void check_entrance(const Case& c, const beds::RegionKeys& region, double radius, const std::string& key,
                    const io::YamlDocument& document) {
  const PeriodicBox box = grain_box(c);
  for (int axis = 0; axis < 3; ++axis) {
    if (box.periodic[static_cast<std::size_t>(axis)] || (c.disks && axis == 1)) continue;
    const double lowest = radius, highest = box.size[axis] - radius;
    if (region.upper[axis] >= lowest && region.lower[axis] <= highest) continue;
    throw document.error(
        key,
        fmt::format("no grain of {:.4g} m can come in there without touching the wall across {}; give a region in m "
                    "that has points between {:.4g} and {:.4g} m along {}",
                    2.0 * radius, axis_name[axis], lowest, highest, axis_name[axis]));
  }
}

void check_supplies(const Case& c, const io::YamlDocument& document) {
  const Vec3 box = grain_box(c).size;
  for (std::size_t n = 0; n < c.supplies.size(); ++n) {
    const std::string key = fmt::format("supplies.{}", n);
    at_place(document, key, [&] { check(c.supplies[n], c.grains, box); });
    const beds::Population& population = c.grains[static_cast<std::size_t>(c.supplies[n].population)];
    const double radius = 0.5 * (population.shape ? population.smallest_diameter() : population.largest_diameter());
    check_entrance(c, c.supplies[n].region, radius, key + ".region", document);
    if (c.supplies[n].above_bed) check_for_bed(c, key + ".above_bed", document);
    if (c.supplies[n].transport_rate && !(unit_rate(c) > 0.0))
      throw document.error(
          key + ".transport_rate",
          "q* has no meaning without a fluid in which the grains are heavier; give rate in grains/s or "
          "mass_rate in kg/s");
    if (c.run.until_at_rest && !c.supplies[n].until)
      throw document.error("run.until_at_rest",
                           fmt::format("the grains are at rest when no more come in, and supply {} brings them to the "
                                       "end of the run; give {}.until in s, or remove the section",
                                       n, key));
  }
  for (std::size_t n = 0; n < c.sinks.size(); ++n)
    at_place(document, fmt::format("sinks.{}", n), [&] { check(c.sinks[n], box); });
  if (c.grains.empty() && !c.sinks.empty())
    throw document.error("sinks", "there are no grains that could leave; give the section grains, or remove this one");
  for (std::size_t n = 0; n < c.sinks.size(); ++n)
    if (const auto& back = c.sinks[n].recirculation)
      check_entrance(c, back->region, 0.5 * largest_diameter(c), fmt::format("sinks.{}.recirculation.region", n),
                     document);
}

void check_materials(const Case& c, const io::YamlDocument& document) {
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    if (c.grains[n].contact)
      at_place(document, fmt::format("grains.{}.contact", n), [&] { check(*c.grains[n].contact, c.contact); });
  if (c.contact.walls) at_place(document, "contact.walls", [&] { check(*c.contact.walls, c.contact); });
}

}  // namespace

void check_that_grains_fit(const Case& c, const io::YamlDocument& document) {
  check_room(c, document);
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    at_place(document, fmt::format("grains.{}", n),
             [&] { check_placement(c.grains[n], c.domain.size, c.disks.has_value()); });
  if (c.initial.takes(InitialField::grains)) return;
  for (std::size_t n = 0; n < c.grains.size(); ++n) check_pattern(c, n, document);
}

void check_grains(const Case& c, const io::YamlDocument& document) {
  constexpr std::int64_t most_sub_steps = 1000000;
  if (c.coupling.grain_steps_per_fluid_step > most_sub_steps)
    throw document.error(sub_steps_key,
                         fmt::format("at most {} steps of the grains fit in one of the fluid; give fewer, "
                                     "or auto",
                                     most_sub_steps));
  check_disks(c, document);
  check_walls(c, document);
  check_populations(c, document);
  check_clumps(c, document);
  check_materials(c, document);
  check_supplies(c, document);
  if (c.grains.empty()) return;
  check_contact_steps(c, document);
  check_lubrication_steps(c, document);
}

}  // namespace thalweg::driver
