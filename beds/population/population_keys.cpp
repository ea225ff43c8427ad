// The keys of a population, and whether they fit its box.
#include "beds/packing/packing.hpp"
#include "beds/population/population.hpp"
#include "core/geometry/periodic_box.hpp"
#include "core/keys/key_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

// Functions named describe are static rather than in an unnamed namespace, where argument-dependent lookup from the
// visitor's templates would not find them.
namespace thalweg::beds {

static void describe(SectionVisitor& visit, MemberKeys& member) {
  visit.vec3("position", member.position, {.unit = "m", .meaning = "relative to any origin", .required = true});
  visit.real("diameter", member.diameter,
             {.unit = "m", .meaning = "of the sphere", .required = true, .above = 0.0, .example = 4e-3});
}

static void describe(SectionVisitor& visit, BodyKeys& body) {
  visit.real("volume", body.volume, {.unit = "m^3", .meaning = "of the body", .required = true, .above = 0.0});
  visit.vec3("centre", body.centre, {.unit = "m", .meaning = "in the frame of the spheres", .required = true});
  visit.real_list("inertia", body.inertia,
                  {.unit = "m^5",
                   .meaning = "xx, yy, zz, xy, xz, yz about the centre, at 1 kg/m^3",
                   .required = true,
                   .examples = {0.1, 0.1, 0.1, 0.0, 0.0, 0.0}});
  visit.require(!visit.reading() || body.inertia.size() == 6, "inertia",
                "a symmetric tensor has six components; give xx, yy, zz, xy, xz, yz in m^5");
}

static void describe(SectionVisitor& visit, ShapeKeys& shape) {
  visit.text("stl", shape.stl,
             {.meaning = "file with the closed surface of one grain, relative to this file; a clump is fitted to it",
              .example = "pebble.stl"});
  const bool of_surface = shape.stl.has_value();
  const OnlyIf has_surface{of_surface || !visit.reading(), "only a shape from an STL file has it; remove it"};
  visit.integer("spheres", shape.spheres,
                {.meaning = "largest number in each clump", .at_least = 1, .example = 20, .only_if = has_surface});
  visit.real("tolerance", shape.tolerance,
             {.unit = "equivalent diameters",
              .meaning = "spheres are added until the mean distance of the surface from them is no larger than this",
              .above = 0.0,
              .example = 0.02,
              .only_if = has_surface});
  visit.real("scale", shape.scale,
             {.unit = "m",
              .meaning = "length of one unit of the STL file; default: 1",
              .above = 0.0,
              .example = 0.001,
              .only_if = has_surface});
  const OnlyIf has_spheres{!of_surface, "the spheres follow from the surface; remove this key or stl"};
  visit.list("clump", shape.clump,
             {.meaning = "spheres that may overlap and move as one rigid grain",
              .required = !of_surface,
              .only_if = has_spheres});
  visit.section("body", shape.body,
                {.meaning = "body that the spheres represent; default: their union", .only_if = has_spheres});
  visit.require(of_surface || !shape.clump.empty(), "clump",
                "a clump needs at least one sphere; give its position and diameter in m");
  visit.require(!of_surface || shape.spheres || shape.tolerance, "spheres",
                "the number of spheres is missing; give it, a tolerance, or both");
}

static void describe(SectionVisitor& visit, OrientationKeys& orientation) {
  visit.vec3("axis", orientation.axis, {.meaning = "direction of the axis; need not be a unit vector"});
  visit.real("angle", orientation.angle,
             {.unit = "rad", .meaning = "of rotation about the axis, right-handed, from the shape as given"});
  visit.require(!orientation.axis.isZero(0.0), "axis", "a direction cannot be zero; give for example [0, 1, 0]");
}

struct DiameterKeys {
  SizesKeys sizes;
  double diameter = 0.0;  // m
};

static void describe(SectionVisitor& visit, DiameterKeys& keys) { describe(visit, keys.sizes, keys.diameter); }

// Shape, and diameter.
static void describe_size(SectionVisitor& visit, PopulationKeys& grains, const OnlyIf& no_file) {
  visit.section("shape", grains.shape, {.meaning = "shape of grains that are not spheres", .only_if = no_file});
  const OnlyIf of_shape{grains.shape || !visit.reading(),
                        "spheres have no orientation; give a shape or remove the key"};
  visit.section(
      "orientation", grains.orientation,
      {.meaning = "the same for all clumps; default: random for each", .only_if = no_file.holds ? of_shape : no_file});
  SectionKey about{.meaning =
                       "the same for all grains, or a distribution; with a shape that of the sphere of equal volume, "
                       "by default of the shape as given",
                   .required = !grains.shape,
                   .shorthand = "value",
                   .expected = "a number in m above 0, for example 0.005",
                   .only_if = no_file};
  if (!grains.shape) {
    visit.section("diameter", about, [&](SectionVisitor& inside) { describe(inside, grains.sizes, grains.diameter); });
    return;
  }
  std::optional<DiameterKeys> given;
  if (grains.has_size()) given = {grains.sizes, grains.diameter};
  visit.section("diameter", given, about);
  if (given) grains.sizes = given->sizes, grains.diameter = given->diameter;
  visit.require(!given || !grains.shape->scale, "shape.scale",
                "the diameter already says how large the grains are; remove one of the two");
}

static void describe(SectionVisitor& visit, FillKeys& fill) {
  visit.real("depth", fill.depth,
             {.unit = "m",
              .meaning = "of the settled bed, above the floor of the placement's region or of the box",
              .above = 0.0,
              .example = 0.02});
  visit.real("layers", fill.layers,
             {.meaning = "the depth in diameters: analysis.reference_diameter, else the population's median by mass",
              .above = 0.0,
              .example = 4.0});
  visit.real("porosity", fill.porosity,
             {.meaning = "of the settled bed; default: 0.4, and more between side walls; for disks 0.2",
              .above = 0.0,
              .below = 1.0,
              .example = 1.0 - settled_bed});
  visit.require(fill.depth.has_value() != fill.layers.has_value(), "depth",
                "give either the depth in m or the number of layers");
}

static void describe_count(SectionVisitor& visit, PopulationKeys& grains, const OnlyIf& no_file) {
  const auto given = static_cast<std::int64_t>(grains.placement.positions.size());
  if (visit.reading() && given > 0) grains.count = given;
  visit.integer(
      "count", grains.count,
      {.meaning = "number of grains; not needed with positions", .at_least = 1, .example = 100, .only_if = no_file});
  const OnlyIf no_count{grains.count == 0 || !visit.reading(), "the number of grains is given; remove one of the two"};
  visit.real("solid_fraction", grains.solid_fraction,
             {.meaning = "of the placement's region, or of the box; in place of count",
              .above = 0.0,
              .at_most = densest_disks,
              .example = 0.3,
              .only_if = no_file.holds ? no_count : no_file});
  const OnlyIf no_number{(grains.count == 0 && !grains.solid_fraction) || !visit.reading(),
                         "count or solid_fraction gives the number of grains; remove one of the two"};
  visit.section(
      "fill", grains.fill,
      {.meaning = "depth of the settled bed, in place of count; each population gives the depth that it contributes",
       .only_if = no_file.holds ? no_number : no_file});
  if (!no_file.holds) return;
  visit.require(grains.count > 0 || grains.solid_fraction || grains.fill, "count",
                "the number of grains is missing; give a whole number, for example 100, solid_fraction, fill or "
                "placement.positions");
  visit.require(given == 0 || grains.count == given, "count",
                fmt::format("there are {} positions; give this number or leave the key out", given));
}

// Position, number, size and density, which a bed file gives all at once.
static void describe_grains_themselves(SectionVisitor& visit, PopulationKeys& grains) {
  visit.section("placement", grains.placement, {.meaning = "where the grains are at the start"});
  const std::string remedy = "the bed file gives it; remove this key or placement.file";
  const OnlyIf no_file{!grains.placement.file, remedy};
  const OnlyIf no_kept_velocity{no_file.holds, remedy + " (placement.velocities: zero leaves them out)"};
  describe_size(visit, grains, no_file);
  visit.real("density", grains.density,
             {.unit = "kg/m^3",
              .meaning = "of every grain",
              .required = true,
              .above = 0.0,
              .example = 2550.0,
              .only_if = no_file});
  describe_count(visit, grains, no_file);
  visit.vec3("velocity", grains.velocity, {.unit = "m/s", .meaning = "at the start", .only_if = no_kept_velocity});
  visit.vec3("angular_velocity", grains.angular_velocity,
             {.unit = "rad/s", .meaning = "at the start", .only_if = no_kept_velocity});
}

void describe(SectionVisitor& visit, PopulationKeys& grains) {
  describe_grains_themselves(visit, grains);
  visit.section("contact", grains.contact,
                {.meaning = "material of these grains where it differs from the section contact"});
  visit.flag("fixed", grains.fixed, {.meaning = "the grains never move"});
  visit.vec3("prescribed_velocity", grains.prescribed_velocity,
             {.unit = "m/s", .meaning = "held regardless of the forces", .example = 0.0});
  visit.vec3("prescribed_angular_velocity", grains.prescribed_angular_velocity,
             {.unit = "rad/s", .meaning = "held regardless of the torques", .example = 0.0});
  visit.section(
      "motion", grains.motion,
      {.meaning = "all grains move as one rigid body with prescribed motion (a bumpy wall, a plate, a drum)"});
  visit.require(
      !grains.motion || (!grains.fixed && !grains.prescribed_velocity && !grains.prescribed_angular_velocity &&
                         grains.velocity.isZero(0.0) && grains.angular_velocity.isZero(0.0)),
      "motion", "motion already says how the grains move; remove fixed and all velocities beside it");
  visit.require(
      !grains.shape || !grains.motion, "motion",
      "grains that move together as one body need no clumps; give the spheres as grains, or remove the shape");
  visit.require(!grains.fixed || (!grains.prescribed_velocity && !grains.prescribed_angular_velocity), "fixed",
                "a fixed grain cannot have a prescribed velocity; give one or the other");
  visit.require(!grains.fixed || (grains.velocity.isZero(0.0) && grains.angular_velocity.isZero(0.0)), "fixed",
                "a fixed grain cannot start with a velocity; remove fixed or the velocity, or in place of both give "
                "prescribed_velocity or prescribed_angular_velocity, which hold it");
  visit.require(!grains.prescribed_velocity || grains.velocity.isZero(0.0), "velocity",
                "prescribed_velocity already says how the grains move; remove one of the two");
  visit.require(!grains.prescribed_angular_velocity || grains.angular_velocity.isZero(0.0), "angular_velocity",
                "prescribed_angular_velocity already says how the grains turn; remove one of the two");
}

namespace {

bool stays_in_plane(const dem::MotionKeys& motion) {
  const bool turns_in_it = !motion.rotation || (motion.rotation->axis.x() == 0.0 && motion.rotation->axis.z() == 0.0);
  return turns_in_it && motion.velocity.y() == 0.0 && (!motion.oscillation || motion.oscillation->amplitude.y() == 0.0);
}

}  // namespace

void check_placement(const Population& population, const Vec3& box_size, bool disks) {
  const PlacementKeys& placement = population.placement;
  for (std::size_t p = 0; p < placement.positions.size(); ++p)
    if (!lies_in_box(placement.positions[p], box_size))
      throw KeyError(fmt::format("placement.positions.{}", p),
                     fmt::format("the grain is outside the box; give a point in m between [0, 0, 0] and [{}, {}, {}]",
                                 box_size[0], box_size[1], box_size[2]));
  if (!placement.region) return;
  check(*placement.region, box_size, "placement.region", false);
  if (placement.file || disks) return;
  const double fraction = population.volume() / (placement.region->upper - placement.region->lower).prod();
  if (fraction > densest_bed)
    throw KeyError("count",
                   fmt::format("{} grains do not fit in their region: they would fill {:.0f} % of it, and at "
                               "most {:.0f} % is possible; give a larger placement.region in m or fewer grains",
                               population.count, 100.0 * fraction, 100.0 * densest_bed));
}

void check_for_disks(const Population& population) {
  for (const Vec3& v : {population.velocity, population.prescribed_velocity.value_or(Vec3::Zero())})
    if (v.y() != 0.0)
      throw KeyError(population.velocity.y() != 0.0 ? "velocity" : "prescribed_velocity",
                     "disks move in the plane x-z; give a vector in m/s with 0 along y");
  if (population.orientation && (population.orientation->axis.x() != 0.0 || population.orientation->axis.z() != 0.0))
    throw KeyError("orientation.axis", "disks turn about y; give a vector with 0 along x and z");
  if (population.motion && !stays_in_plane(*population.motion))
    throw KeyError("motion",
                   "disks move in the plane x-z and turn about y; give vectors with 0 along y and a "
                   "rotation.axis along y");
  for (const Vec3& w : {population.angular_velocity, population.prescribed_angular_velocity.value_or(Vec3::Zero())})
    if (w.x() != 0.0 || w.z() != 0.0)
      throw KeyError(population.prescribed_angular_velocity ? "prescribed_angular_velocity" : "angular_velocity",
                     "disks turn about y; give a vector in rad/s with 0 along x and z");
}

}  // namespace thalweg::beds
