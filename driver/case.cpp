#include "driver/case.hpp"

#include "dem/population_seeds.hpp"
#include "driver/bed_flow.hpp"
#include "driver/run_facts.hpp"
#include "driver/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace thalweg::driver {

bool has_fluid(const Case& c) { return c.system != SystemKind::grains; }

Index3 cells_of(const DomainCase& domain) {
  Index3 cells;
  for (int axis = 0; axis < 3; ++axis)
    cells[static_cast<std::size_t>(axis)] = static_cast<int>(std::lround(domain.size[axis] / domain.spacing));
  return cells;
}

std::array<bool, 3> periodic_axes(const DomainCase& domain) {
  const auto periodic = [&](FaceIndex face) { return domain.faces[face].type == lbm::FaceType::periodic; };
  return {periodic(x_low), periodic(y_low), periodic(bottom)};
}

double fluid_time_step(const Case& c) {
  if (c.fluid.time_step) return *c.fluid.time_step;
  return *c.fluid.maximum_lattice_velocity * c.domain.spacing / *c.fluid.expected_velocity;
}

double grain_time_step(const Case& c) {
  if (c.system == SystemKind::grains) return *c.run.time_step;
  return fluid_time_step(c) / static_cast<double>(c.coupling.grain_steps_per_fluid_step);
}

Vec3 gravity_vector(const GravityCase& gravity) {
  if (gravity.vector) return *gravity.vector;
  const double angle = std::atan(gravity.slope.value_or(0.0));
  return {*gravity.magnitude * std::sin(angle), 0.0, -*gravity.magnitude * std::cos(angle)};
}

Units units_of(const Case& c) { return {c.domain.spacing, fluid_time_step(c), c.fluid.density}; }

double relaxation_time(const Case& c) { return units_of(c).relaxation_time(c.fluid.kinematic_viscosity); }

// One step takes out the sound that moving grains make and leaves their drag as it is (benchmarks/validation/sound);
// more makes a fast stream unstable (docs/stability.md).
double bulk_relaxation_time_for(const Case& c) {
  const bool suits = c.fluid.collision == lbm::CollisionModel::bgk && c.fluid.smagorinsky_constant > 0.0;
  return c.system == SystemKind::resolved && suits ? 1.0 : 0.0;
}

double bulk_viscosity(const Case& c) {
  const double given = c.fluid.bulk_relaxation_time.value_or(0.0), time = given > 0.0 ? given : relaxation_time(c);
  const Units units = units_of(c);
  return 2.0 / 9.0 * (time - 0.5) * units.spacing * units.velocity();
}

std::int64_t grain_count(const Case& c) {
  std::int64_t count = 0;
  for (const dem::Population& population : c.grains) count += population.count;
  return count;
}

double largest_diameter(const Case& c) {
  double diameter = 0.0;
  for (const dem::Population& population : c.grains) diameter = std::max(diameter, population.largest_diameter());
  return diameter;
}

double largest_extent(const Case& c) {
  double extent = 0.0;
  for (const dem::Population& population : c.grains) extent = std::max(extent, population.largest_extent());
  return extent;
}

double smallest_diameter(const Case& c) {
  double diameter = largest_diameter(c);
  for (const dem::Population& population : c.grains) diameter = std::min(diameter, population.smallest_diameter());
  return diameter;
}

double grain_volume(const Case& c) {
  double volume = 0.0;
  for (const dem::Population& population : c.grains) volume += population.volume();
  return volume;
}

double shortest_contact(const Case& c) {
  const bool linear = c.contact.law == dem::Law::linear;
  const std::vector<dem::ContactParameters> materials = dem::materials_of(c.contact, c.grains);
  const std::optional<dem::ContactParameters> walls = dem::wall_material_of(c.contact);
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < c.grains.size(); ++p) {
    const dem::ContactParameters& own = materials[static_cast<std::size_t>(dem::material_of(c.grains, p))];
    const double mass = c.grains[p].lightest_mass(), radius = 0.5 * c.grains[p].smallest_diameter();
    const auto undamped = [&](double stiffness, double effective) {
      return std::numbers::pi * std::sqrt(effective / stiffness);
    };
    shortest = std::min(shortest, linear ? undamped(own.normal_stiffness, 0.5 * mass)
                                         : dem::contact_time(own, 0.5 * mass, 0.5 * radius));
    if (walls)
      shortest = std::min(shortest, linear ? undamped(walls->normal_stiffness, mass)
                                           : dem::wall_contact_time(own, *walls, mass, radius));
  }
  return shortest;
}

std::int64_t sub_steps_needed(const Case& c) {
  const double needed = fluid_time_step(c) * dem::fewest_steps_per_contact / shortest_contact(c);
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(needed * (1.0 - 1e-9))));
}

namespace {

constexpr double karman = 0.41;

// Smooth walls on either side carry their share of the weight: the stress is that of the hydraulic radius, and the law
// of the wall holds over half the width.
double velocity_between_side_walls(double along, double depth, double width, double nu) {
  const double shear_velocity = std::sqrt(along * depth * width / (width + 2.0 * depth));
  const double distance = 9.0 * shear_velocity * std::min(depth, 0.5 * width) / nu;
  return distance > std::numbers::e ? shear_velocity / karman * std::log(distance)
                                    : std::numeric_limits<double>::infinity();
}

bool holds_back(const coupling::FaceKeys& face) {
  return face.type == lbm::FaceType::no_slip || face.type == lbm::FaceType::law_of_the_wall;
}

}  // namespace

double estimated_velocity(const Case& c) {
  const Vec3 gravity = gravity_vector(c.gravity);
  const double along = std::hypot(gravity[0], gravity[1]);
  const double bed = grain_volume(c) / (settled_fraction(c) * c.domain.size[0] * c.domain.size[1]);
  const double depth = c.domain.size[2] - bed;
  if (!has_fluid(c) || along == 0.0 || depth <= 0.0) return 0.0;
  const double nu = c.fluid.kinematic_viscosity;
  const double laminar = along * depth * depth / (2.0 * nu);
  const double shear_velocity = std::sqrt(along * depth);
  // Rough over grains (equivalent roughness two diameters), smooth over a bare floor.
  const double roughness = c.grains.empty() ? nu / (9.0 * shear_velocity) : largest_diameter(c) / 15.0;
  if (depth <= std::numbers::e * roughness) return laminar;
  const double over_bed = std::min(laminar, shear_velocity / karman * std::log(depth / roughness));
  if (!holds_back(c.domain.faces[y_low]) || !holds_back(c.domain.faces[y_high])) return over_bed;
  return std::min(over_bed, velocity_between_side_walls(along, depth, c.domain.size[1], nu));
}

std::vector<std::string> warnings(const Case& c) {
  std::vector<std::string> found = warnings(c.analysis.observers, run_facts(c));
  if (!has_fluid(c)) return found;
  const double lattice_velocity = estimated_velocity(c) / units_of(c).velocity();
  if (!c.fluid.expected_velocity && lattice_velocity > 0.1)
    found.push_back(
        fmt::format("The flow may reach about {:.2g} m/s, which is {:.2g} cells a step; results are accurate below 0.1 "
                    "and the limit "
                    "is 0.173: consider a fluid.time_step of at most {:.2g} s.",
                    estimated_velocity(c), lattice_velocity, 0.1 * c.domain.spacing / estimated_velocity(c)));
  const double compression =
      3.0 * std::abs(gravity_vector(c.gravity).z()) / units_of(c).acceleration() * c.domain.size[2] / c.domain.spacing;
  if (c.gravity.mode == GravityMode::full && compression > 0.05)
    found.push_back(
        fmt::format("The weight of the fluid compresses it by {:.2g} % from top to bottom: consider a fluid.time_step "
                    "of at most {:.2g} s or gravity.mode: reduced.",
                    100.0 * compression, fluid_time_step(c) * std::sqrt(0.05 / compression)));
  const double excess = relaxation_time(c) - 0.5;
  const double fastest =
      c.fluid.expected_velocity ? *c.fluid.expected_velocity / units_of(c).velocity() : lattice_velocity;
  const double stable = stable_lattice_velocity(c.fluid.collision, excess);
  const bool eddies = c.fluid.smagorinsky_constant > 0.0,
             regularised = c.fluid.collision == lbm::CollisionModel::regularised;
  if ((!eddies || regularised) && (stable == 0.0 || fastest > stable))
    found.push_back(fmt::format(
        "The relaxation time is only {:.2g} above 1/2{}; the collision {} was stable there {}: consider {}{}.", excess,
        eddies ? "" : " and there is no subgrid model", regularised ? "'regularised'" : "chosen",
        stable == 0.0 ? std::string("at no velocity") : fmt::format("up to {:g} cells a step", stable),
        eddies ? "" : "fluid.smagorinsky_constant: 0.27",
        regularised ? (eddies ? "fluid.collision: trt" : " and fluid.collision: trt") : ""));
  const double bulk = c.fluid.bulk_relaxation_time.value_or(0.0);
  if (!eddies && c.fluid.collision == lbm::CollisionModel::trt && bulk > 0.0 && excess < 0.0299)
    found.push_back(
        fmt::format("With a bulk relaxation time of its own and no subgrid model the collision trt is unstable at a "
                    "relaxation time only {:.2g} above 1/2: consider fluid.collision: bgk or "
                    "fluid.bulk_relaxation_time: 0.",
                    excess));
  // The largest stable stream at tau - 1/2 = 0.003, where the subgrid model brings water (docs/stability.md), to 5 %.
  const double calm = 0.17 / std::sqrt(bulk);
  if (c.fluid.collision == lbm::CollisionModel::bgk && bulk > 1.0 && excess < 0.003 && fastest > calm)
    found.push_back(
        fmt::format("With a bulk relaxation time of {:g} steps a stream faster than about {:.2g} cells a step "
                    "grows stripes, and this one may reach {:.2g}: consider fluid.bulk_relaxation_time: 1.",
                    bulk, calm, fastest));
  if (excess > 1.0)
    found.push_back(
        fmt::format("The relaxation time, {:.2g}, is so large that walls and grains lose accuracy: consider a "
                    "shorter fluid.time_step.",
                    excess + 0.5));
  if (!c.grains.empty() && smallest_diameter(c) < 5.99 * c.domain.spacing)
    found.push_back(fmt::format("A grain is only {:.2g} cells across; drag is accurate to a few percent from about 8.",
                                smallest_diameter(c) / c.domain.spacing));
  // The fluid resists a sudden motion of a sphere with 3.8 dx/d of the displaced mass, and the load, extrapolated in
  // time, stands up to 1.15 times the mass of the grain (coupling/load_rule.hpp); the mean was stable down to half the
  // fluid's.
  for (const dem::Population& population : c.grains) {
    const double least = c.coupling.load == coupling::LoadRule::mean
                             ? 0.5
                             : 3.8 / 1.15 * c.domain.spacing / population.smallest_diameter();
    if (!c.coupling.virtual_mass && !population.fixed && !population.prescribed_velocity &&
        population.density < least * c.fluid.density)
      found.push_back(
          fmt::format("Grains of {} kg/m^3 are so light that the explicit coupling may become unstable: consider "
                      "coupling.virtual_mass: {{}}.",
                      population.density));
  }
  return found;
}

}  // namespace thalweg::driver
