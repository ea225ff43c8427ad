#include "driver/input/case_checks.hpp"

#include "core/base/schedule.hpp"
#include "core/geometry/layer_at.hpp"
#include "core/geometry/periodic_box.hpp"
#include "dem/motion/walls.hpp"
#include "driver/bed/grain_weight.hpp"
#include "driver/bed/obstacles.hpp"
#include "driver/bed/solid_cells.hpp"
#include "driver/case/limit_text.hpp"
#include "driver/case/solid_setup.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "driver/input/grain_checks.hpp"
#include "driver/input/run_context.hpp"
#include "lbm/walls/law_of_the_wall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::driver {
namespace {

// True Mach number 0.3, beyond which the lattice fluid is compressible: 0.3 / sqrt(3) cells a step.
constexpr double largest_lattice_velocity = 0.173;
// A sphere must cover cells wherever it is, or the fluid would not see it at all: half the diagonal of a cell,
// sqrt(3)/2.
constexpr double fewest_cells_per_radius = 0.87;
// A component of the random eddies at the start stays below this many times its root mean square nearly everywhere.
constexpr double strongest_gust = 4.0;
constexpr double most_cells_along_axis = 1e6;

void check_resolution(const Case& c, const io::YamlDocument& document) {
  if (c.grains.empty() || c.system != SystemKind::resolved) return;
  const double largest = 0.5 * smallest_diameter(c) / fewest_cells_per_radius;
  if (c.domain.spacing > largest * (1.0 + whole_number_tolerance))
    throw document.error(
        "domain.spacing",
        fmt::format("the spacing is too coarse for grains of {:.6g} m, which would lie between the "
                    "centres of cells and not be seen; give at most {} m, better domain.spacing: {:.9g}",
                    smallest_diameter(c), at_most_text(largest, 4),
                    spacing_below(c, std::min(largest, narrowest_grain(c) / c.coupling.fewest_cells_per_diameter))));
}

void check_lattice_velocity(const Case& c, const io::YamlDocument& document, const std::string& key, double velocity) {
  const double lattice_velocity = velocity / units_of(c).velocity();
  if (lattice_velocity <= largest_lattice_velocity * (1.0 + whole_number_tolerance)) return;
  throw document.error(
      key,
      fmt::format("{:.4g} m/s would be {:.3g} cells per step, more than {}; give a fluid.time_step of at most {} s",
                  velocity, lattice_velocity, largest_lattice_velocity,
                  at_most_text(largest_lattice_velocity * c.domain.spacing / velocity, 3)));
}

// A rotation is taken about the nearest image of the axis, so that a solid must not reach across half a periodic box.
void check_motion_in_fluid(const Case& c, const io::YamlDocument& document, std::size_t n) {
  const SolidCase& solid = c.solids[n];
  const std::string key = fmt::format("solids.{}.motion", n);
  check_lattice_velocity(c, document, key, largest_speed(solid));
  const dem::PrescribedMotion motion = motion_of(solid);
  if (!motion.turns()) return;
  const double reach = reach_from_axis(solid);
  for (int axis = 0; axis < 3; ++axis) {
    if (!periodic_axes(c.domain)[axis] || std::abs(motion.axis[axis]) == 1.0) continue;
    if (reach > 0.5 * c.domain.size[axis] - c.domain.spacing)
      throw document.error(key + ".rotation",
                           fmt::format("the solid reaches {:.4g} m from its axis and would meet its own image along "
                                       "{}, where the box is periodic and {:g} m long; give a longer box",
                                       reach, axis_name[axis], c.domain.size[axis]));
  }
}

// m, the longest side.
double length_of(const SolidCase& solid) {
  const bodies::Extent extent = extent_of(solid);
  return (extent.upper - extent.lower).maxCoeff();
}

void check_solids(const Case& c, const io::YamlDocument& document) {
  for (std::size_t n = 0; n < c.solids.size(); ++n) {
    const SolidCase& solid = c.solids[n];
    if (has_fluid(c) && solid.sphere && solid.sphere->radius < fewest_cells_per_radius * c.domain.spacing)
      throw document.error(fmt::format("solids.{}.sphere.radius", n),
                           fmt::format("the sphere is smaller than the cells can show; give at least {:.4g} m",
                                       fewest_cells_per_radius * c.domain.spacing));
    if (solid.motion && has_fluid(c)) check_motion_in_fluid(c, document, n);
    if (c.grains.empty() && (solid.friction || solid.rolling_friction))
      throw document.error(fmt::format("solids.{}.{}", n, solid.friction ? "friction" : "rolling_friction"),
                           "there are no grains on which it acts; remove it");
  }
  check_solid_extents(c, document);
}

void check_initial_fluid(const Case& c, const io::YamlDocument& document) {
  if (c.initial.fluid.uniform)
    check_lattice_velocity(c, document, "initial.fluid.uniform", c.initial.fluid.uniform->norm());
  if (c.initial.fluid.linear_profile)
    check_lattice_velocity(c, document, "initial.fluid.linear_profile.velocity",
                           c.initial.fluid.linear_profile->velocity.norm());
  if (!c.initial.fluid.log_profile) return;
  const coupling::LogProfileKeys& profile = *c.initial.fluid.log_profile;
  if (c.filled_in.profile.shear_velocity && *profile.shear_velocity == 0.0)
    throw document.error("initial.fluid.log_profile",
                         "nothing drives the water along the bed in x, so its shear velocity does not follow from the "
                         "case; give shear_velocity in m/s, a gravity.slope that drives it, or initial.fluid: rest");
  const double depth = c.domain.size[2] - *profile.bed_height;
  if (depth > 0.0 && depth <= *profile.roughness)
    throw document.error(
        "initial.fluid.log_profile.roughness",
        fmt::format("the profile begins above the water, which is {:.6g} m deep; give a thirtieth of the "
                    "height of what makes the bed rough, in m",
                    depth));
  if (depth <= 0.0)
    throw document.error(
        "initial.fluid.log_profile.bed_height",
        fmt::format("no fluid is left above the bed; give a height in m below {:.6g}", c.domain.size[2]));
  check_lattice_velocity(c, document, "initial.fluid.log_profile.shear_velocity",
                         std::abs(*profile.shear_velocity) *
                             (std::log(depth / *profile.roughness) / lbm::karman_constant +
                              (profile.perturbation ? strongest_gust * profile.perturbation->amplitude : 0.0)));
}

void check_held_flow(const Case& c, const io::YamlDocument& document) {
  if (!c.fluid.mean_velocity) return;
  if (!periodic_axes(c.domain)[0])
    throw document.error("fluid.mean_velocity",
                         "faces across x that are not periodic decide how much flows, and a force that works against "
                         "them grows without limit; remove the key, or make domain.boundaries.x periodic");
  check_lattice_velocity(c, document, "fluid.mean_velocity.velocity", std::abs(c.fluid.mean_velocity->velocity));
  if (c.fluid.mean_velocity->response_time < 100.0 * fluid_time_step(c))
    throw document.error(
        "fluid.mean_velocity.response_time",
        fmt::format("the force is steered every 10 steps and needs ten times as long to answer; give at "
                    "least {} s",
                    at_least_text(100.0 * fluid_time_step(c), 3)));
}

// Velocities of faces and grains that the case gives, which the lattice must be able to represent.
void check_given_velocities(const Case& c, const io::YamlDocument& document) {
  for (const coupling::FaceKeys& face : c.domain.faces)
    if (face.has_velocity()) check_lattice_velocity(c, document, "domain.boundaries", face.velocity.norm());
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    const beds::Population& grains = c.grains[n];
    const std::string key = fmt::format("grains.{}.", n);
    const double radius = 0.5 * grains.largest_extent();
    check_lattice_velocity(c, document, key + "velocity", grains.velocity.norm());
    check_lattice_velocity(c, document, key + "angular_velocity", grains.angular_velocity.norm() * radius);
    if (grains.prescribed_velocity)
      check_lattice_velocity(c, document, key + "prescribed_velocity", grains.prescribed_velocity->norm());
    if (grains.prescribed_angular_velocity)
      check_lattice_velocity(c, document, key + "prescribed_angular_velocity",
                             grains.prescribed_angular_velocity->norm() * radius);
    if (grains.motion) check_lattice_velocity(c, document, key + "motion", given_speed(c, grains));
  }
  for (std::size_t n = 0; n < c.supplies.size(); ++n)
    if (const std::optional<Vec3>& velocity = c.supplies[n].velocity)
      check_lattice_velocity(c, document, fmt::format("supplies.{}.velocity", n), velocity->norm());
  for (std::size_t n = 0; n < c.sinks.size(); ++n)
    if (const auto& back = c.sinks[n].recirculation; back && back->velocity)
      check_lattice_velocity(c, document, fmt::format("sinks.{}.recirculation.velocity", n), back->velocity->norm());
}

void check_fluid(const Case& c, const io::YamlDocument& document) {
  if (!has_fluid(c)) return;
  if (!(relaxation_time(c) > 0.5))
    throw document.error("fluid.kinematic_viscosity",
                         "the relaxation time of the lattice is 1/2, which means no "
                         "viscosity at all; give a larger viscosity in m^2/s or a longer step");
  if (fluid_time_step(c) > c.run.until)
    throw document.error("fluid.time_step",
                         fmt::format("the step of {:.4g} s is longer than the run; give a shorter step in s or a "
                                     "later run.until",
                                     fluid_time_step(c)));
  check_held_flow(c, document);
  check_given_velocities(c, document);
  check_initial_fluid(c, document);
}

void check_balanced_gravity(const Case& c, const io::YamlDocument& document) {
  const Vec3 gravity = gravity_vector(c.gravity);
  const std::array<bool, 3> periodic = periodic_axes(c.domain);
  for (int axis = 0; axis < 3; ++axis)
    if (gravity[axis] != 0.0 && !periodic[static_cast<std::size_t>(axis)])
      throw document.error(
          "gravity.mode",
          fmt::format("walls across {} would carry the weight that balanced gravity leaves to the fluid; "
                      "make domain.boundaries.{} periodic, or set mode: reduced",
                      axis_name[axis], axis_name[axis]));
  if (c.grains.empty() || balancing_acceleration(c).isZero(0.0))
    throw document.error("gravity.mode", "there is no weight of free grains to balance; set mode: reduced");
  if (!c.supplies.empty() || !c.sinks.empty())
    throw document.error("gravity.mode",
                         "balanced gravity carries the weight of the initial grains, which supplies and sinks change; "
                         "remove them, or set mode: reduced");
}

void check_gravity(const Case& c, const io::YamlDocument& document) {
  const auto any = [&c](lbm::FaceType type) {
    return std::any_of(c.domain.faces.begin(), c.domain.faces.end(),
                       [type](const coupling::FaceKeys& f) { return f.type == type; });
  };
  if (has_fluid(c) && c.gravity.mode == GravityMode::balanced) check_balanced_gravity(c, document);
  if (!has_fluid(c) || c.gravity.mode != GravityMode::full) return;
  if (c.run.ramp > 0.0)
    throw document.error("run.ramp",
                         "in full gravity the fluid begins at rest under its whole weight, which leaves nothing to "
                         "raise; remove the key or set gravity.mode: reduced");
  if (c.domain.faces[bottom].type == lbm::FaceType::periodic)
    throw document.error("gravity.mode",
                         "a box that is periodic along z has no hydrostatic pressure; give domain.boundaries a bottom "
                         "and a top, or set mode: reduced");
  if (any(lbm::FaceType::pressure_outlet))
    throw document.error("gravity.mode",
                         "an outlet of one pressure contradicts the hydrostatic pressure; set mode: reduced or remove "
                         "the outlet");
  if (!c.initial.from.none())
    throw document.error("gravity.mode",
                         "full gravity begins with its own hydrostatic pressure; remove initial.from or set mode: "
                         "reduced");
}

// The region before an open face, so deep (m).
beds::RegionKeys region_before(const Case& c, std::size_t face, double depth) {
  beds::RegionKeys region{Vec3::Zero(), c.domain.size};
  const auto axis = static_cast<Eigen::Index>(face / 2);
  if (face % 2 == 0)
    region.upper[axis] = std::min(depth, c.domain.size[axis]);
  else
    region.lower[axis] = std::max(0.0, c.domain.size[axis] - depth);
  return region;
}

// The first sink that takes all grains that come so near (m) an open face.
std::optional<std::size_t> sink_before(const Case& c, std::size_t face, double depth) {
  const beds::RegionKeys needed = region_before(c, face, depth);
  for (std::size_t n = 0; n < c.sinks.size(); ++n) {
    const beds::RegionKeys& region = c.sinks[n].region;
    if ((region.lower.array() <= needed.lower.array()).all() && (region.upper.array() >= needed.upper.array()).all())
      return n;
  }
  return std::nullopt;
}

// The key that a case gives a face by: its own, or that of its axis.
std::string key_of_face(std::size_t face, const io::YamlDocument& document) {
  const std::string own = fmt::format("domain.boundaries.{}", dem::face_names[face]);
  return document.find(own) ? own : fmt::format("domain.boundaries.{}", axis_name[face / 2]);
}

void check_recycling(const Case& c, const io::YamlDocument& document) {
  for (std::size_t face = 0; face < c.domain.faces.size(); ++face) {
    const coupling::FaceKeys& inlet = c.domain.faces[face];
    if (inlet.type != lbm::FaceType::velocity_inlet || !inlet.recycling_plane) continue;
    const auto axis = static_cast<Eigen::Index>(face / 2);
    Vec3 along = inlet.velocity;
    along[axis] = 0.0;
    if (along != Vec3::Zero())
      throw document.error(key_of_face(face, document) + ".velocity",
                           fmt::format("an inlet that recycles takes the flow along the face from its plane; give zero "
                                       "for all but {}",
                                       axis_name[axis]));
    const int plane = layer_at(*inlet.recycling_plane, c.domain.spacing);
    const int cells = cells_of(c.domain)[static_cast<std::size_t>(axis)];
    if (plane >= cells)
      throw document.error(key_of_face(face, document) + ".recycling_plane",
                           fmt::format("the plane must lie in the box; give a position along {} below {:g} m",
                                       axis_name[axis], c.domain.size[axis]));
    if (plane == (face % 2 == 0 ? 0 : cells - 1))
      throw document.error(key_of_face(face, document) + ".recycling_plane",
                           fmt::format("the plane lies in the cells of the inlet itself; give a position along {} more "
                                       "than {:g} m from the face, where the flow has developed",
                                       axis_name[axis], c.domain.spacing));
    // Faces of one axis do not meet; of two axes, both would write the populations out of the edge.
    for (std::size_t other = 0; other < face / 2 * 2; ++other)
      if (c.domain.faces[other].recycling_plane)
        throw document.error(
            key_of_face(face, document) + ".recycling_plane",
            fmt::format("the inlet meets {}, which recycles as well, at an edge; leave the key out for "
                        "one of them",
                        key_of_face(other, document)));
  }
}

// Grains bounce off a face through which the water flows: they jam at an outlet, unless a sink takes them. An inlet
// pushes them away.
void check_open_faces(const Case& c, const io::YamlDocument& document) {
  if (!has_fluid(c) || !has_free_grains(c)) return;
  for (std::size_t face = x_low; face <= y_high; ++face) {
    const coupling::FaceKeys& open = c.domain.faces[face];
    const double inwards = (face % 2 == 0 ? 1.0 : -1.0) * open.velocity[static_cast<Eigen::Index>(face / 2)];
    const bool pushes_away = open.type == lbm::FaceType::velocity_inlet && inwards > 0.0;
    const double longest = longest_free_grain(c), least = longest * (1.0 - whole_number_tolerance);
    if (!lbm::is_open(open.type) || pushes_away || sink_before(c, face, least)) continue;
    if (const std::optional<std::size_t> thin = sink_before(c, face, 0.0))
      throw document.error(
          fmt::format("sinks.{}.region", *thin),
          fmt::format("grains would jam at {}, through which only the water leaves, as the sink before it is less deep "
                      "than the longest free grain, {:g} m; give a region of at least that depth along {}, better of "
                      "twice as much",
                      key_of_face(face, document), longest, axis_name[face / 2]));
    const beds::RegionKeys region = region_before(c, face, 2.0 * longest);
    const std::string axis = axis_name[face / 2];
    throw document.error(
        key_of_face(face, document),
        fmt::format(
            "grains would jam at this face, through which only the water leaves; give sinks: [{{region: {{lower: "
            "[{:g}, {:g}, {:g}], upper: [{:g}, {:g}, {:g}]}}}}] or one that is at least half as deep, give {}: "
            "periodic in place of {}_low and {}_high, or hold the grains with grains.{}.fixed: true",
            region.lower[0], region.lower[1], region.lower[2], region.upper[0], region.upper[1], region.upper[2], axis,
            axis, axis, free_populations(c).front()));
  }
}

// Times are multiples of the step in double precision.
void check_number_of_steps(const Case& c, const io::YamlDocument& document) {
  const double step = step_time(c);
  if (c.run.until <= most_countable_steps * step) return;
  throw document.error("run.until",
                       fmt::format("the run would take {:.3g} steps of {:.3g} s, more than can be counted; "
                                   "give a longer {}, or at most {} s",
                                   c.run.until / step, step, has_fluid(c) ? "fluid.time_step" : "run.time_step",
                                   at_most_text(most_countable_steps * step, 3)));
}

void check_model_fluid(const Case& c, const io::YamlDocument& document) {
  if (c.system != SystemKind::model_fluid) return;
  const Vec3 gravity = gravity_vector(c.gravity);
  if (gravity.x() != 0.0 || gravity.y() != 0.0 || !(gravity.z() < 0.0))
    throw document.error("gravity",
                         "the model fluid drives the grains, and gravity is downwards; give a magnitude alone");
  if (c.domain.faces[bottom].type == lbm::FaceType::periodic)
    throw document.error("domain.boundaries", "the bed needs a floor; give a bottom and a top that are not periodic");
  const std::array<bool, 3> periodic = periodic_axes(c.domain);
  if (!periodic[0] || !(c.disks || periodic[1]))
    throw document.error("domain.boundaries",
                         "the model fluid takes a side wall for missing grains; make x and y periodic");
  if (c.model_fluid.ramp && c.run.until_at_rest)
    throw document.error("run.until_at_rest",
                         "a rising Shields number starts from grains at rest, where the section would end the run at "
                         "once; remove the section, or model_fluid.ramp");
  at_place(document, "model_fluid", [&] { check(c.model_fluid, mean_grain(c), -gravity.z()); });
}

void check_observers(const Case& c, const io::YamlDocument& document) {
  at_place(document, "analysis", [&] { check(c.analysis.observers, run_context(c)); });
}

}  // namespace

void check_whole_cells(const DomainCase& domain, int axes, const io::YamlDocument& document) {
  for (int axis = 0; axis < axes; ++axis) {
    const double cells = domain.size[axis] / domain.spacing;
    const double whole = std::round(cells);
    if (cells > most_cells_along_axis)
      throw document.error("domain.spacing",
                           fmt::format("the {} m along {} would be {:.3g} cells, more than {:.0f}; give a "
                                       "larger spacing in m",
                                       domain.size[axis], axis_name[axis], cells, most_cells_along_axis));
    if (whole >= 1.0 && std::abs(cells - whole) <= whole_number_tolerance * whole) continue;
    const double shorter = std::floor(cells) * domain.spacing, longer = std::ceil(cells) * domain.spacing;
    const std::string sizes =
        shorter > 0.0 ? fmt::format("{:.9g} or {:.9g} m", shorter, longer) : fmt::format("at least {:.9g} m", longer);
    throw document.error("domain.size",
                         fmt::format("the {} m along {} are {:.6g} cells of {} m; make it a whole number of "
                                     "cells, {}",
                                     domain.size[axis], axis_name[axis], cells, domain.spacing, sizes));
  }
}

void check_solid_room(const Case& c, const io::YamlDocument& document) {
  check_solid_extents(c, document);
  if (!has_fluid(c) || c.solids.empty() || SolidCells(c).any_open()) return;
  const auto longest = std::max_element(c.solids.begin(), c.solids.end(), [](const SolidCase& a, const SolidCase& b) {
    return length_of(a) < length_of(b);
  });
  throw document.error(shape_key(c, static_cast<std::size_t>(longest - c.solids.begin())),
                       fmt::format("{} the box and leave{} no room for the fluid; {}, or a larger domain.size in m",
                                   c.solids.size() == 1 ? "the solid fills" : "the solids fill",
                                   c.solids.size() == 1 ? "s" : "", smaller_text(*longest)));
}

void check_column(const Case& c, const io::YamlDocument& document) {
  const Vec3 gravity = gravity_vector(c.gravity);
  if (gravity.y() != 0.0)
    throw document.error("gravity", "a column of two continua flows along x alone; leave out what gravity has along y");
  at_place(document, "", [&] { check(c.continuum, gravity.x(), -gravity.z()); });
}

void check_box(const Case& c, const io::YamlDocument& document) {
  check_whole_cells(c.domain, 3, document);
  check_resolution(c, document);
  check_that_grains_fit(c, document);
}

void check_case(const Case& c, const io::YamlDocument& document) {
  check_box(c, document);
  check_solids(c, document);
  check_fluid(c, document);
  check_number_of_steps(c, document);
  check_gravity(c, document);
  check_recycling(c, document);
  check_open_faces(c, document);
  check_grains(c, document);
  check_model_fluid(c, document);
  check_observers(c, document);
  if (has_fluid(c))
    at_place(document, "output", [&] { check_fluid_output(c.output, c.domain.size, c.domain.spacing); });
  if (!c.grains.empty()) at_place(document, "output", [&] { check_grain_output(c.output, grain_output_facts(c)); });
}

}  // namespace thalweg::driver
