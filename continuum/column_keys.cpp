#include "continuum/column_keys.hpp"

#include "core/keys/key_error.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::continuum {

void describe(SectionVisitor& visit, FluidPhaseKeys& fluid) {
  visit.real("density", fluid.density,
             {.unit = "kg/m^3", .meaning = "mass density", .required = true, .above = 0.0, .example = 1000.0});
  visit.real("kinematic_viscosity", fluid.kinematic_viscosity,
             {.unit = "m^2/s", .meaning = "of the clear fluid", .required = true, .above = 0.0, .example = 1e-6});
}

void describe(SectionVisitor& visit, GrainPhaseKeys& grains) {
  visit.real("diameter", grains.diameter,
             {.unit = "m", .meaning = "of all grains", .required = true, .above = 0.0, .example = 5e-3});
  visit.real("density", grains.density,
             {.unit = "kg/m^3", .meaning = "mass density", .required = true, .above = 0.0, .example = 2550.0});
}

void describe(SectionVisitor& visit, HeightKeys& height) {
  visit.real("shields_number", height.shields_number,
             {.meaning = "of the water over the bed at the start; gives the depth", .above = 0.0, .example = 0.085});
  visit.real(
      "depth", height.depth,
      {.unit = "m", .meaning = "of the water over the bed, in place of shields_number", .above = 0.0, .example = 0.04});
  visit.require(height.shields_number || height.depth, "shields_number",
                "the depth is missing; give shields_number, for example 0.085, or depth in m");
  visit.require(!height.shields_number || !height.depth, "depth",
                "the depth is given twice; remove this key or shields_number");
  visit.real("bed", height.bed,
             {.unit = "diameters", .meaning = "thickness of the bed, as dense as it can be at rest", .at_least = 2.0});
  visit.integer("cells_per_diameter", height.cells_per_diameter,
                {.meaning = "target; adjusted to fill the water with whole cells", .at_least = 2});
  visit.choice("start", height.start, {.meaning = "state at the start"});
}

static void describe_rheology(SectionVisitor& visit, ClosureKeys& keys) {
  Rheology& r = keys.closures.rheology;
  visit.real("static_friction", r.static_friction, {.meaning = "mu_1", .above = 0.0});
  visit.real("limit_friction", r.limit_friction, {.meaning = "mu_2, of fast flow", .above = 0.0});
  visit.require(r.limit_friction > r.static_friction, "limit_friction",
                "it must be larger than static_friction; give for example 0.7");
  visit.real("densest_fraction", r.densest_fraction,
             {.meaning = "phi_m: solid fraction of grains that begin to flow", .above = 0.0, .below = 0.75});
  visit.real("friction_scale", r.friction_scale, {.meaning = "b", .above = 0.0});
  visit.real("dilation", r.dilation, {.meaning = "a", .above = 0.0});
  visit.real("elastic_modulus", keys.elastic_modulus,
             {.unit = "Pa",
              .meaning = "pressure of grains at rest over phi - phi_m; default: 2633 (rho_s - rho_f) g d",
              .above = 0.0,
              .example = 2e5});
  visit.real("smallest_gap", r.smallest_gap,
             {.meaning = "lower limit of phi_m - phi in the pressure of flowing grains", .above = 0.0, .below = 0.1});
  visit.real("creeping_rate", keys.creeping_rate,
             {.unit = "1/s",
              .meaning = "shear rate below which friction falls to zero; default: 3.63e-5 v/d, v the smaller of "
                         "sqrt(g' d) and g' d^2/nu, g' = (rho_s/rho_f - 1) g",
              .above = 0.0,
              .example = 2e-3});
}

static void describe_turbulence(SectionVisitor& visit, Turbulence& t) {
  visit.real("mixing_length_factor", t.mixing_length_factor,
             {.meaning = "of l_m = factor d (phi_m - phi)^3", .above = 0.0});
  visit.real("smallest_mixing_length", t.smallest_mixing_length,
             {.unit = "diameters", .meaning = "lower limit of l_m; 0: none", .at_least = 0.0});
  visit.real("schmidt_number", t.schmidt_number, {.meaning = "Sigma_s of the drift", .above = 0.0});
  visit.choice("strain_norm", t.strain_norm, {.meaning = "norm of the rate of strain in the eddy viscosity"});
}

void describe(SectionVisitor& visit, ClosureKeys& keys) {
  Closures& closures = keys.closures;
  visit.section("rheology", {.meaning = "flow rule of the grains"},
                [&](SectionVisitor& inside) { describe_rheology(inside, keys); });
  visit.section("turbulence", {.meaning = "stress of the fluid and drift"},
                [&](SectionVisitor& inside) { describe_turbulence(inside, closures.turbulence); });
  visit.choice("drag", closures.drag.function, {.meaning = "drag function F"});
  visit.choice("drag_crowding", closures.drag.crowding, {.meaning = "term of the solid fraction in F_2"});
  visit.choice("drag_speed", closures.speed, {.meaning = "velocity difference in the Reynolds number of the drag"});
  visit.choice("drift_sign", closures.drift, {.meaning = "which way the drift velocity u_d acts"});
}

void describe(SectionVisitor& visit, CreepParameters& creep) {
  visit.real("nonlocal_amplitude", creep.nonlocal_amplitude, {.meaning = "A", .above = 0.0});
  visit.real("rate_coefficient", creep.rate_coefficient,
             {.meaning = "b of the fluidity; default: (mu_2 - mu_1)/friction_scale, with which an even flow obeys the "
                         "flow rule of the grains",
              .above = 0.0,
              .example = 0.066});
  visit.real("upper", creep.upper,
             {.unit = "diameters",
              .meaning = "depth below the surface where the fluidity is given",
              .above = 0.0,
              .at_most = creep_decay_depth - 1.0});  // the decay is fitted over a diameter at least
  visit.real("lower", creep.lower, {.unit = "diameters", .meaning = "depth where it is zero", .above = 0.0});
  visit.require(creep.lower > creep.upper, "lower", "it must be deeper than upper; give for example 10");
  visit.real("surface_fluidity", creep.surface_fluidity,
             {.unit = "1/s", .meaning = "fluidity at `upper`: shear rate over the ratio of stresses", .above = 0.0});
}

namespace {

constexpr double most_cells = 1e5, fewest_in_water = 4.0;

// 2e5 Pa and 2e-3/s of glass of 5 mm in water, over the weight of a layer and v/d.
constexpr double modulus_over_weight = 2633.0, creeping_over_shear = 3.63e-5;

Mixture mixture_of(const ContinuumKeys& keys) {
  return {keys.fluid.density, keys.fluid.density * keys.fluid.kinematic_viscosity, keys.grains.density,
          keys.grains.diameter};
}

double depth_of(const ContinuumKeys& keys, double gravity_x, double gravity_z) {
  if (keys.column.depth) return *keys.column.depth;
  const double d = keys.grains.diameter, weight = mixture_of(keys).excess_density() * std::hypot(gravity_x, gravity_z);
  return *keys.column.shields_number * weight * d / (keys.fluid.density * gravity_x);
}

// Whole numbers, but perhaps more than an int holds.
struct CellCounts {
  double water, bed;
};

CellCounts cell_counts(const ContinuumKeys& keys, double depth) {
  const double d = keys.grains.diameter, wanted = d / static_cast<double>(keys.column.cells_per_diameter);
  const double water = std::max(fewest_in_water, std::round(depth / wanted));
  return {water, std::round(keys.column.bed * d / (depth / water))};
}

// Names the key by which the column gets smaller.
void refuse_too_many_cells(const ContinuumKeys& keys, double depth) {
  const CellCounts cells = cell_counts(keys, depth);
  if (cells.water + cells.bed <= most_cells) return;
  constexpr double fewest_per_diameter = 2.0;
  const char* depth_key = keys.column.depth ? "column.depth" : "column.shields_number";
  if (fewest_per_diameter * keys.column.bed > most_cells)
    throw KeyError("column.bed", "the column would have more than 100000 cells; give a thinner bed, in diameters");
  if (fewest_per_diameter * depth > most_cells * keys.grains.diameter)
    throw KeyError(depth_key,
                   "the column would have more than 100000 cells; give a smaller value, for shallower water");
  if (cells.water == fewest_in_water)
    throw KeyError(depth_key,
                   "four cells fill the water, and the bed would have more than 100000 of that height; give a larger "
                   "value, for deeper water");
  throw KeyError("column.cells_per_diameter", "the column would have more than 100000 cells; give fewer");
}

}  // namespace

SystemParameters system_parameters(const ContinuumKeys& keys, double gravity_x, double gravity_z) {
  SystemParameters parameters;
  ColumnParameters& column = parameters.column;
  column.mixture = mixture_of(keys);
  column.closures = keys.closures.closures;
  const double gravity = std::hypot(gravity_x, gravity_z), d = column.mixture.diameter;
  column.closures.rheology.elastic_modulus =
      keys.closures.elastic_modulus.value_or(modulus_over_weight * column.mixture.excess_density() * gravity * d);
  column.closures.rheology.creeping_rate =
      keys.closures.creeping_rate.value_or(creeping_over_shear * column.mixture.shear_speed(gravity) / d);
  column.gravity_x = gravity_x;
  column.gravity_z = gravity_z;
  parameters.depth = depth_of(keys, gravity_x, gravity_z);
  const CellCounts cells = cell_counts(keys, parameters.depth);
  column.spacing = parameters.depth / cells.water;
  parameters.bed_cells = static_cast<int>(cells.bed);
  column.cells = parameters.bed_cells + static_cast<int>(cells.water);
  parameters.start = keys.column.start;
  parameters.creep = keys.creep;
  return parameters;
}

void check(const ContinuumKeys& keys, double gravity_x, double gravity_z) {
  if (!(gravity_x > 0.0 && gravity_z > 0.0))
    throw KeyError("gravity", "the column flows downhill along x; give magnitude and a slope above 0");
  if (!(keys.grains.density > keys.fluid.density))
    throw KeyError("grains.density", "the grains float; give a density above that of the fluid in kg/m^3");
  refuse_too_many_cells(keys, depth_of(keys, gravity_x, gravity_z));
}

}  // namespace thalweg::continuum
