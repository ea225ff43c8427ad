#include "driver/case/case.hpp"

#include "beds/population_seeds.hpp"
#include "dem/contact/lubrication.hpp"
#include "dem/laws/material.hpp"
#include "dem/motion/grain_volume.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>

namespace thalweg::driver {

bool has_fluid(SystemKind system) { return system == SystemKind::resolved || system == SystemKind::fluid; }
bool has_fluid(const Case& c) { return has_fluid(c.system); }
bool has_grains(SystemKind system) { return system != SystemKind::fluid && system != SystemKind::continuum; }

InitialSource InitialCase::source_of(InitialField field) const {
  if (from.each()) {
    const bool of_grains = field == InitialField::grains;
    return {(of_grains ? from.grains : from.fluid).value_or(""),
            of_grains ? "initial.from.grains" : "initial.from.fluid"};
  }
  const bool taken = std::find(fields.begin(), fields.end(), field) != fields.end();
  return {taken ? from.run.value_or("") : "", "initial.from"};
}

continuum::SystemParameters column_of(const Case& c) {
  const Vec3 gravity = gravity_vector(c.gravity);
  continuum::SystemParameters parameters = system_parameters(c.continuum, gravity.x(), -gravity.z());
  parameters.time_step = c.run.time_step.value_or(0.0);
  return parameters;
}

Index3 cells_of(const DomainCase& domain) {
  Index3 cells;
  for (int axis = 0; axis < 3; ++axis)
    cells[static_cast<std::size_t>(axis)] = static_cast<int>(std::lround(domain.size[axis] / domain.spacing));
  return cells;
}

double spacing_below(const Case& c, double most) {
  const std::span<const double> sides(c.domain.size.data(), c.filled_in.flow.height ? 2 : 3);
  const double longest = *std::max_element(sides.begin(), sides.end());
  const auto is_whole = [](double cells) { return std::abs(cells - std::round(cells)) <= 5e-7 * cells; };
  for (double cells = std::ceil(longest / most * (1.0 - 1e-9)); cells < 1.25 * longest / most + 1.0; cells += 1.0)
    if (std::all_of(sides.begin(), sides.end(), [&](double side) { return is_whole(side * cells / longest); }))
      return longest / cells;
  return c.domain.spacing / std::ceil(c.domain.spacing / most * (1.0 - 1e-9));
}

std::array<bool, 3> periodic_axes(const DomainCase& domain) {
  const auto periodic = [&](FaceIndex face) { return domain.faces[face].type == lbm::FaceType::periodic; };
  return {periodic(x_low), periodic(y_low), periodic(bottom)};
}

double fluid_time_step(const Case& c) { return *c.fluid.time_step; }

std::int64_t grain_steps(const Case& c) {
  constexpr std::int64_t dry_steps = 50;
  if (!has_fluid(c)) return dry_steps;
  const std::int64_t given = c.coupling.grain_steps_per_fluid_step;
  return given == coupling::CouplingKeys::as_many_as_needed ? sub_steps_needed(c) : given;
}

double grain_time_step(const Case& c) {
  if (!has_fluid(c)) return *c.run.time_step;
  return fluid_time_step(c) / static_cast<double>(grain_steps(c));
}

double step_time(const Case& c) {
  if (c.system == SystemKind::continuum) return *c.run.time_step;
  if (has_fluid(c)) return fluid_time_step(c);
  return grain_time_step(c) * static_cast<double>(grain_steps(c));
}

Vec3 gravity_vector(const GravityCase& gravity) {
  if (gravity.vector) return *gravity.vector;
  const double angle = std::atan(gravity.slope.value_or(0.0));
  return {*gravity.magnitude * std::sin(angle), 0.0, -*gravity.magnitude * std::cos(angle)};
}

Units units_of(const Case& c) { return {c.domain.spacing, fluid_time_step(c), c.fluid.density}; }

double relaxation_time(const Case& c) { return units_of(c).relaxation_time(c.fluid.kinematic_viscosity); }

// One step takes out the sound that moving grains make and leaves their drag as it is (benchmarks/validation/sound);
// more makes a fast stream unstable (docs/stability.md). Without it a turbulent stream alone rings at 0.14 cells a step
// with the model qr (benchmarks/validation/side_wall_channel).
double bulk_relaxation_time_for(const Case& c) {
  return lbm::traits_of(c.fluid.collision).is_bgk_in_bulk && c.fluid.subgrid().on() ? 1.0 : 0.0;
}

double bulk_viscosity(const Case& c) {
  const double given = c.fluid.bulk_relaxation_time.value_or(0.0), time = given > 0.0 ? given : relaxation_time(c);
  const Units units = units_of(c);
  return 2.0 / 9.0 * (time - 0.5) * units.spacing * units.velocity();
}

std::int64_t grain_count(const Case& c) {
  std::int64_t count = 0;
  for (const beds::Population& population : c.grains) count += population.count;
  return count;
}

std::int64_t grain_rows(const Case& c) {
  std::int64_t rows = 0;
  for (const beds::Population& population : c.grains) rows += population.row_count();
  return rows;
}

double largest_diameter(const Case& c) {
  double diameter = 0.0;
  for (const beds::Population& population : c.grains) diameter = std::max(diameter, population.largest_diameter());
  return diameter;
}

double largest_size(const beds::Population& grains) {
  return grains.shape ? grains.coarsest() : grains.largest_diameter();
}

double largest_size(const Case& c) {
  double size = 0.0;
  for (const beds::Population& population : c.grains) size = std::max(size, largest_size(population));
  return size;
}

double largest_extent(const Case& c) {
  double extent = 0.0;
  for (const beds::Population& population : c.grains) extent = std::max(extent, population.largest_extent());
  return extent;
}

double smallest_diameter(const Case& c) {
  double diameter = largest_diameter(c);
  for (const beds::Population& population : c.grains) diameter = std::min(diameter, population.smallest_diameter());
  return diameter;
}

double narrowest_grain(const Case& c) {
  double width = largest_extent(c);
  for (const beds::Population& population : c.grains) width = std::min(width, population.narrowest());
  return width;
}

beds::RegionKeys region_of(const Case& c, const beds::Population& grains) {
  return grains.placement.region.value_or(beds::RegionKeys{Vec3::Zero(), c.domain.size});
}

double grain_volume(const Case& c) {
  double volume = 0.0;
  for (const beds::Population& population : c.grains) volume += population.volume();
  return volume;
}

namespace {

// Adds the grains of a population, a clump with the sphere (disk) of its volume. mean: of sums.
void add_grains(const beds::Population& population, model_fluid::MeanGrain& mean) {
  if (population.from_file()) {
    const beds::FileFigures& figures = population.figures;
    mean.diameter += figures.sums.diameter;
    mean.volume += figures.sums.volume;
    mean.mass += figures.sums.mass;
    mean.largest_diameter = std::max(mean.largest_diameter, figures.sizes.back().diameter);
    return;
  }
  const auto add = [&](std::size_t n, double times) {
    const double d = population.diameter_of(n), volume = dem::grain_volume(0.5 * d, population.thickness);
    mean.diameter += times * d;
    mean.volume += times * volume;
    mean.mass += times * population.density * volume;
    mean.largest_diameter = std::max(mean.largest_diameter, d);
  };
  constexpr std::int64_t too_many = 100000000;  // to be gone through; so many have one size
  if (population.count > too_many) return add(0, static_cast<double>(population.count));
  for (std::size_t n = 0; n < static_cast<std::size_t>(population.count); ++n) add(n, 1.0);
}

}  // namespace

model_fluid::MeanGrain mean_grain(const Case& c) {
  model_fluid::MeanGrain mean{0.0, 0.0, 0.0, 0.0};
  for (const beds::Population& population : c.grains) {
    add_grains(population, mean);
    if (population.clumps.count == 0) continue;
    mean.largest_member = std::max(mean.largest_member, population.largest_diameter());
    mean.longest = std::max(mean.longest, population.clumps.largest_extent);
  }
  const auto count = static_cast<double>(grain_count(c));
  mean.diameter /= count;
  mean.volume /= count;
  mean.mass /= count;
  return mean;
}

model_fluid::ModelFluidParameters model_fluid_of(const Case& c) {
  return model_fluid_parameters(c.model_fluid, mean_grain(c), -gravity_vector(c.gravity).z(), c.disks.has_value());
}

double fastest_model_fluid(const Case& c) {
  if (c.system != SystemKind::model_fluid) return 0.0;
  model_fluid::ModelFluidParameters fluid = model_fluid_of(c);
  if (fluid.ramp) fluid.numbers.shields = std::max(fluid.numbers.shields, 1.0);  // that no bed withstands
  // A single grain of the smallest size has the lowest solid fraction and so the fastest fluid.
  const double radius = 0.5 * smallest_diameter(c);
  const double alone = std::pow(radius / (radius + fluid.solid_fraction.margin), c.disks ? 2.0 : 3.0);
  return coefficients_of(fluid.numbers, fluid.scales).velocity * fluid.profile(alone);
}

bool has_free_grains(const Case& c) {
  return std::any_of(c.grains.begin(), c.grains.end(), [](const beds::Population& grains) { return !grains.held(); });
}

std::vector<std::size_t> free_populations(const Case& c) {
  std::vector<std::size_t> all(c.grains.size()), free;
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::copy_if(all.begin(), all.end(), std::back_inserter(free), [&c](std::size_t p) { return !c.grains[p].held(); });
  return free.empty() ? all : free;
}

namespace {

// Calls between(material, effective mass, effective radius) and against_wall(material, wall, mass, radius) for the
// lightest of each population that is free; kg, m.
template <typename Between, typename AgainstWall>
void for_each_lightest(const Case& c, Between between, AgainstWall against_wall) {
  const std::vector<dem::ContactParameters> materials = beds::materials_of(c.contact, c.grains);
  const std::optional<dem::ContactParameters> walls = beds::wall_material_of(c.contact);
  for (const std::size_t p : free_populations(c)) {
    const dem::ContactParameters& own = materials[static_cast<std::size_t>(beds::material_of(c.grains, p))];
    const double mass = c.grains[p].lightest_mass(), radius = 0.5 * c.grains[p].smallest_diameter();
    between(own, 0.5 * mass, 0.5 * radius);
    if (walls) against_wall(own, *walls, mass, radius);
  }
}

}  // namespace

double shortest_contact(const Case& c) {
  const bool linear = c.contact.law == dem::Law::linear;
  double shortest = std::numeric_limits<double>::infinity();
  // pi/omega_0, or pi/beta of a dashpot that is faster than the spring (dem/laws/material.hpp).
  const auto spring = [](const dem::ContactParameters& material, double effective) {
    return std::min(std::numbers::pi * std::sqrt(effective / material.normal_stiffness),
                    2.0 * std::numbers::pi * effective / dem::Damping(material).coefficient(effective));
  };
  for_each_lightest(
      c,
      [&](const dem::ContactParameters& own, double mass, double radius) {
        shortest = std::min(shortest, linear ? spring(own, mass) : dem::contact_time(own, mass, radius));
      },
      [&](const dem::ContactParameters& own, const dem::ContactParameters& wall, double mass, double radius) {
        shortest = std::min(shortest, linear ? spring(wall, mass) : dem::wall_contact_time(own, wall, mass, radius));
      });
  return shortest;
}

double longest_contact_step(const Case& c) {
  double longest = shortest_contact(c) / dem::fewest_steps_per_contact;
  for_each_lightest(
      c,
      [&](const dem::ContactParameters& own, double mass, double radius) {
        longest = std::min(longest, dem::longest_step(own, mass, radius));
      },
      [&](const dem::ContactParameters& own, const dem::ContactParameters& wall, double mass, double radius) {
        longest = std::min(longest, dem::longest_wall_step(own, wall, mass, radius));
      });
  return longest;
}

double longest_lubrication_step(const Case& c) {
  if (!has_fluid(c) || !c.coupling.lubrication) return std::numeric_limits<double>::infinity();
  dem::LubricationParameters parameters;
  parameters.viscosity = c.fluid.density * c.fluid.kinematic_viscosity;
  parameters.minimum_gap = c.coupling.lubrication->minimum_gap;
  double radius_per_mass = 0.0;
  for (const beds::Population& population : c.grains)
    if (!dem::holds_translation(beds::motion_of(population)))
      radius_per_mass = std::max(radius_per_mass, population.radius_per_mass());
  return dem::longest_lubrication_step(parameters, radius_per_mass);
}

double film_viscosity(const Case& c) {
  const bool without = !has_fluid(c) || !c.contact.restitution || c.coupling.lubrication;
  return without ? 0.0 : c.fluid.density * c.fluid.kinematic_viscosity;
}

std::int64_t sub_steps_needed(const Case& c) {
  const double needed = fluid_time_step(c) / std::min(longest_contact_step(c), longest_lubrication_step(c));
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(needed * (1.0 - dem::rounding_of_a_step))));
}

}  // namespace thalweg::driver
