#include "driver/case_sections.hpp"

#include <fmt/format.h>

#include <utility>

// Functions named describe are static rather than in an unnamed namespace, as in case_sections.cpp.
namespace thalweg {

static void describe(SectionVisitor& visit, RegionCase& region) {
  visit.vec3("lower", region.lower, {.unit = "m", .meaning = "lower corner", .required = true, .example = 0.0});
  visit.vec3("upper", region.upper, {.unit = "m", .meaning = "upper corner", .required = true, .example = 0.05});
}

static void describe(SectionVisitor& visit, PlacementCase& placement) {
  visit.text("file", placement.file,
             {.meaning = "a bed file, as a run leaves it (bed.h5); relative to this file",
              .example = "../settled_bed/run/bed.h5"});
  visit.real("largest_overlap", placement.largest_overlap,
             {.unit = "diameters",
              .meaning = "that grains of the file may have; 0.01 where not given",
              .at_least = 0.0,
              .at_most = 0.1,
              .example = PlacementCase::bed_overlap});
  visit.choice<FileVelocities>(
      "velocities", placement.velocities,
      {{FileVelocities::kept, "kept", "the default"}, {FileVelocities::zero, "zero", "grains begin at rest"}},
      {.meaning = "of the grains of the file"});
  if (placement.file) {
    for (const char* key : {"positions", "pattern", "seed"})
      visit.not_here(key, "the file says where the grains are; remove this key or the file");
    visit.section("region", placement.region, {.meaning = "only the grains of the file with their centre in it"});
    return;
  }
  for (const char* key : {"largest_overlap", "velocities"}) visit.not_here(key, "only a placement from a file has it");
  visit.vec3_list("positions", placement.positions,
                  {.unit = "m", .meaning = "centres of the grains, one by one, in place of the keys below"});
  if (!placement.positions.empty()) {
    for (const char* key : {"pattern", "seed", "region"})
      visit.not_here(key, "the positions are given one by one; remove this key or the positions");
    return;
  }
  visit.choice<PlacementPattern>("pattern", placement.pattern,
                                 {{PlacementPattern::uniform, "uniform", "evenly spread, slightly disturbed"},
                                  {PlacementPattern::random, "random", "at random without overlap"}},
                                 {.meaning = "how the grains are spread over the region"});
  visit.integer("seed", placement.seed, {.meaning = "another seed, another packing", .at_least = 0});
  visit.section("region", placement.region, {.meaning = "where the grains are put; the whole box where not given"});
}

static void require_sizes_that_fit(SectionVisitor& visit, const SizesCase& sizes) {
  if (sizes.distribution) {
    visit.require(sizes.median && sizes.geometric_deviation && sizes.minimum && sizes.maximum, "distribution",
                  "a lognormal distribution needs median, minimum and maximum in m and geometric_deviation");
    visit.require(*sizes.minimum < *sizes.maximum && *sizes.minimum <= *sizes.median && *sizes.median <= *sizes.maximum,
                  "median", "minimum, median and maximum must rise in this order");
  }
  visit.require(sizes.sizes.size() == sizes.fractions.size(), "sizes",
                "each size needs its share of the number of grains; give as many fractions as sizes");
  double sum = 0.0;
  for (const double fraction : sizes.fractions) sum += fraction;
  visit.require(sizes.fractions.empty() || (sum > 0.999 && sum < 1.001), "fractions",
                fmt::format("the fractions add up to {:g}; they are shares of the number and must add up to 1", sum));
}

static void describe_diameter(SectionVisitor& visit, PopulationCase& grains) {
  SizesCase& sizes = grains.sizes;
  std::optional<double> value;
  if (!visit.reading() && !sizes.given()) value = grains.diameter;
  visit.real("value", value, {.unit = "m", .meaning = "of every grain", .above = 0.0, .example = 5e-3});
  visit.choice<SizeDistribution>("distribution", sizes.distribution,
                                 {{SizeDistribution::lognormal, "lognormal", "of the number, with the next four keys"}},
                                 {.meaning = "in place of a value"});
  visit.real("median", sizes.median, {.unit = "m", .meaning = "of lognormal", .above = 0.0, .example = 5e-3});
  visit.real("geometric_deviation", sizes.geometric_deviation,
             {.meaning = "of lognormal: exp of the deviation of ln d", .above = 1.0, .at_most = 3.0, .example = 1.2});
  visit.real("minimum", sizes.minimum, {.unit = "m", .meaning = "nothing finer", .above = 0.0, .example = 3.5e-3});
  visit.real("maximum", sizes.maximum, {.unit = "m", .meaning = "nothing coarser", .above = 0.0, .example = 7e-3});
  visit.real_list("sizes", sizes.sizes,
                  {.unit = "m", .meaning = "a few sizes, in place of a value", .above = 0.0, .example = 5e-3});
  visit.real_list(
      "fractions", sizes.fractions,
      {.meaning = "of the number of grains, one for each size", .above = 0.0, .at_most = 1.0, .example = 0.5});
  if (!visit.reading()) return;
  const int ways = value.has_value() + sizes.distribution.has_value() + !sizes.sizes.empty();
  visit.require(ways == 1, "value", "give exactly one of value in m, distribution, and sizes with fractions");
  if (!sizes.distribution)
    for (const char* key : {"median", "geometric_deviation", "minimum", "maximum"})
      visit.not_here(key, "only a distribution has it; add distribution: lognormal or remove the key");
  require_sizes_that_fit(visit, sizes);
  if (value) grains.diameter = *value;
}

static void describe_material(SectionVisitor& visit, MaterialCase& material, bool walls) {
  visit.real("normal_stiffness", material.normal_stiffness,
             {.unit = "N/m", .meaning = "linear law", .above = 0.0, .example = 20000.0});
  visit.real("tangential_stiffness", material.tangential_stiffness,
             {.unit = "N/m", .meaning = "linear law", .at_least = 0.0, .example = 5714.0});
  visit.real("youngs_modulus", material.youngs_modulus,
             {.unit = "Pa", .meaning = "hertz_mindlin", .above = 0.0, .example = 70e9});
  visit.real("poisson_ratio", material.poisson_ratio,
             {.meaning = "hertz_mindlin", .at_least = 0.0, .at_most = 0.5, .example = 0.3});
  visit.real("restitution", material.restitution,
             {.meaning = "where the section contact has one", .above = 0.0, .at_most = 1.0, .example = 0.93});
  visit.real("damping", material.damping,
             {.unit = "kg/s", .meaning = "where the section contact has one", .at_least = 0.0, .example = 0.09});
  if (walls) {
    visit.not_here("friction", "the friction of walls is contact.wall_friction; give it there");
    visit.not_here("rolling_friction", "give contact.wall_rolling_friction instead, which is that of walls");
    return;
  }
  visit.real("friction", material.friction, {.meaning = "between grains", .at_least = 0.0, .example = 0.5});
  visit.real("rolling_friction", material.rolling_friction,
             {.meaning = "between grains", .at_least = 0.0, .example = 0.05});
}

static void describe(SectionVisitor& visit, MaterialCase& material) { describe_material(visit, material, false); }
static void describe(SectionVisitor& visit, WallMaterialCase& walls) { describe_material(visit, walls, true); }

static void describe(SectionVisitor& visit, MemberCase& member) {
  visit.vec3("position", member.position, {.unit = "m", .meaning = "from any origin", .required = true});
  visit.real("diameter", member.diameter,
             {.unit = "m", .meaning = "of the sphere", .required = true, .above = 0.0, .example = 4e-3});
}

static void describe(SectionVisitor& visit, ShapeCase& shape) {
  visit.list("clump", shape.clump,
             {.meaning = "spheres that may overlap and move as one rigid grain", .required = true});
  visit.require(!shape.clump.empty(), "clump",
                "a clump needs at least one sphere; give its position and diameter in m");
}

static void describe(SectionVisitor& visit, OrientationCase& orientation) {
  visit.vec3("axis", orientation.axis, {.meaning = "along the axis, of any length"});
  visit.real("angle", orientation.angle, {.unit = "rad", .meaning = "right-handed about it from the shape as given"});
  visit.require(!orientation.axis.isZero(0.0), "axis", "a direction cannot be zero; give for example [0, 1, 0]");
}

// Diameter, or shape.
static void describe_size(SectionVisitor& visit, PopulationCase& grains) {
  visit.section("shape", grains.shape, {.meaning = "in place of a diameter, for grains that are no spheres"});
  if (!grains.shape) visit.not_here("orientation", "spheres have none; give a shape or remove the key");
  if (grains.shape || !visit.reading())
    visit.section("orientation", grains.orientation, {.meaning = "of all clumps; each at random where not given"});
  if (grains.shape) {
    visit.not_here("diameter", "the members of the shape have diameters; remove this key or the shape");
    return;
  }
  visit.section("diameter",
                {.meaning = "the same for all grains, or a distribution",
                 .required = true,
                 .shorthand = "value",
                 .expected = "a number in m above 0, for example 0.005"},
                [&](SectionVisitor& inside) { describe_diameter(inside, grains); });
}

// Position, number, size and density, which a bed file gives all at once.
static void describe_grains_themselves(SectionVisitor& visit, PopulationCase& grains) {
  visit.section("placement", grains.placement, {.meaning = "where the grains are at the start"});
  if (grains.placement.file) {
    for (const char* key : {"diameter", "shape", "orientation", "density", "count"})
      visit.not_here(key, "the bed file gives it; remove this key or placement.file");
    for (const char* key : {"velocity", "angular_velocity"})
      visit.not_here(key,
                     "the bed file gives it; remove this key or placement.file (placement.velocities: zero leaves "
                     "them out)");
    return;
  }
  describe_size(visit, grains);
  visit.real("density", grains.density,
             {.unit = "kg/m^3", .meaning = "of every grain", .required = true, .above = 0.0, .example = 2550.0});
  const auto given = static_cast<std::int64_t>(grains.placement.positions.size());
  if (visit.reading() && given > 0) grains.count = given;
  visit.integer("count", grains.count,
                {.meaning = "number of grains; not needed with positions", .at_least = 1, .example = 100});
  visit.require(grains.count > 0, "count",
                "the number of grains is missing; give a whole number, for example 100, or placement.positions");
  visit.require(given == 0 || grains.count == given, "count",
                fmt::format("there are {} positions; give this number or leave the key out", given));
  visit.vec3("velocity", grains.velocity, {.unit = "m/s", .meaning = "at the start"});
  visit.vec3("angular_velocity", grains.angular_velocity, {.unit = "rad/s", .meaning = "at the start"});
}

void describe(SectionVisitor& visit, PopulationCase& grains) {
  describe_grains_themselves(visit, grains);
  visit.section("contact", grains.contact,
                {.meaning = "material of these grains where it differs from the section contact"});
  visit.flag("fixed", grains.fixed, {.meaning = "the grains never move"});
  visit.vec3("prescribed_velocity", grains.prescribed_velocity,
             {.unit = "m/s", .meaning = "kept whatever the forces", .example = 0.0});
  visit.vec3("prescribed_angular_velocity", grains.prescribed_angular_velocity,
             {.unit = "rad/s", .meaning = "kept whatever the torques", .example = 0.0});
  visit.section("motion", grains.motion,
                {.meaning = "all grains move as one rigid body, whatever the forces (a bumpy wall, a plate, a drum)"});
  visit.require(
      !grains.motion || (!grains.fixed && !grains.prescribed_velocity && !grains.prescribed_angular_velocity &&
                         grains.velocity.isZero(0.0) && grains.angular_velocity.isZero(0.0)),
      "motion", "it already says how the grains move; remove fixed and all velocities beside it");
  visit.require(
      !grains.shape || !grains.motion, "motion",
      "grains that move together as one body need no clumps; give the spheres as grains, or remove the shape");
  visit.require(!grains.fixed || (!grains.prescribed_velocity && !grains.prescribed_angular_velocity), "fixed",
                "a fixed grain cannot have a prescribed velocity; give one or the other");
  visit.require(!grains.fixed || (grains.velocity.isZero(0.0) && grains.angular_velocity.isZero(0.0)), "fixed",
                "a fixed grain cannot start with a velocity; remove fixed or the velocity");
  visit.require(!grains.prescribed_velocity || grains.velocity.isZero(0.0), "velocity",
                "prescribed_velocity already says how the grains move; remove one of the two");
  visit.require(!grains.prescribed_angular_velocity || grains.angular_velocity.isZero(0.0), "angular_velocity",
                "prescribed_angular_velocity already says how the grains turn; remove one of the two");
}

void describe_contact(SectionVisitor& visit, ContactCase& contact, bool with_grains) {
  dem::describe(visit, contact);
  visit.require(!with_grains || contact.restitution || contact.damping, "restitution",
                "the loss in a collision is missing; give restitution, for example 0.93, or damping in kg/s");
  visit.section("walls", contact.walls,
                {.meaning = "contact of grains with walls where it differs from that between grains"});
}

}  // namespace thalweg
