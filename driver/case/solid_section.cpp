#include "driver/case/case_sections.hpp"

// Section of the solids in a case.
namespace thalweg::driver {

static void describe(SectionVisitor& visit, SphereCase& sphere) {
  visit.vec3("centre", sphere.centre, {.unit = "m", .meaning = "of the sphere", .required = true, .example = 0.02});
  visit.real("radius", sphere.radius,
             {.unit = "m", .meaning = "of the sphere", .required = true, .above = 0.0, .example = 5e-3});
}

void describe(SectionVisitor& visit, SolidCase& solid) {
  visit.section("sphere", solid.sphere, {.meaning = "a sphere; or give stl"});
  visit.text("stl", solid.stl, {.meaning = "file with a closed surface, relative to this file; \"\": none"});
  visit.real("scale", solid.scale, {.unit = "m", .meaning = "length of one unit of the STL file", .above = 0.0});
  visit.vec3("translate", solid.translate, {.unit = "m", .meaning = "shift of the STL surface after scaling"});
  visit.real("friction", solid.friction,
             {.meaning = "default: contact.wall_friction", .at_least = 0.0, .example = 0.3});
  visit.real("rolling_friction", solid.rolling_friction,
             {.meaning = "default: contact.wall_rolling_friction", .at_least = 0.0, .example = 0.05});
  visit.section("motion", solid.motion, {.meaning = "prescribed motion; default: at rest"});
  visit.require(solid.sphere.has_value() || !solid.stl.empty(), "sphere",
                "the solid has no shape; give sphere: {centre: [x, y, z], radius: r} in m, or stl: FILE");
  visit.require(!(solid.sphere && !solid.stl.empty()), "stl", "the solid has two shapes; remove either sphere or stl");
}

}  // namespace thalweg::driver
