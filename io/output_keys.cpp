#include "io/output_keys.hpp"

#include "core/key_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

// Static rather than in an unnamed namespace, where argument-dependent lookup would not find them.
namespace thalweg::io {

static void describe(SectionVisitor& visit, SeriesOutputKeys& series) {
  visit.real("every", series.every, {.unit = "s", .meaning = "between rows of series.csv; 0: none", .at_least = 0.0});
}

static void describe(SectionVisitor& visit, FluidOutputKeys& fluid) {
  visit.real("every", fluid.every, {.unit = "s", .meaning = "between frames of the fluid; 0: none", .at_least = 0.0});
  describe_region(visit, fluid);
  visit.choice_list<FluidField>("fields", fluid.fields,
                                {{FluidField::velocity, "velocity", "m/s"},
                                 {FluidField::pressure, "pressure", "Pa above the reference"},
                                 {FluidField::grain_id, "grain_id", "-1 in the fluid"},
                                 {FluidField::density, "density", "kg/m^3"},
                                 {FluidField::shear_rate, "shear_rate", "1/s, of the subgrid model"},
                                 {FluidField::eddy_viscosity, "eddy_viscosity", "m^2/s, of the subgrid model"},
                                 {FluidField::vorticity, "vorticity", "1/s"},
                                 {FluidField::q_criterion, "q_criterion", "1/s^2, vortices where positive"}},
                                {.meaning = "what the frames contain"});
}

static bool is_word(const std::string& name) {
  return !name.empty() &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return c == '_' || std::isalnum(c) != 0; });
}

static void describe(SectionVisitor& visit, NamedFluidOutputKeys& part) {
  visit.text("name", part.name,
             {.meaning = "of its files: fluid_parts/NAME.pvd", .required = true, .example = "near_bed"});
  visit.require(is_word(part.name), "name", "give a word of letters, digits and underscores");
  describe(visit, static_cast<FluidOutputKeys&>(part));
  visit.require(part.every > 0.0, "every", "give the time in s between its frames, above 0");
}

static void describe(SectionVisitor& visit, GrainOutputKeys& grains) {
  visit.real("every", grains.every, {.unit = "s", .meaning = "between frames of the grains; 0: none", .at_least = 0.0});
}

static void describe(SectionVisitor& visit, CheckpointOutputKeys& checkpoint) {
  visit.real("every", checkpoint.every,
             {.unit = "s", .meaning = "between checkpoints; 0: only by wall time", .at_least = 0.0});
  visit.real("every_wall", checkpoint.every_wall,
             {.unit = "s of wall time",
              .meaning = "since the last checkpoint, after which another one is written; 0: only by simulated time",
              .at_least = 0.0});
  visit.integer("keep", checkpoint.keep, {.meaning = "number of newest checkpoints that are kept", .at_least = 1});
}

void describe(SectionVisitor& visit, OutputKeys& output, const OnlyIf& of_fluid, const OnlyIf& of_grains) {
  visit.section("series", output.series, {.meaning = "the table series.csv"});
  visit.section("fluid", output.fluid, {.meaning = "VTK output of the fluid, fluid.pvd", .only_if = of_fluid});
  visit.list("fluid_parts", output.fluid_parts,
             {.meaning = "more series of frames of the fluid, each with its own files", .only_if = of_fluid});
  const auto twin = [&](const NamedFluidOutputKeys& part) {
    return std::count_if(output.fluid_parts.begin(), output.fluid_parts.end(),
                         [&](const NamedFluidOutputKeys& other) { return other.name == part.name; }) > 1;
  };
  if (of_fluid.holds)
    visit.require(std::none_of(output.fluid_parts.begin(), output.fluid_parts.end(), twin), "fluid_parts",
                  "two of them have the same name; give each its own");
  visit.section("grains", output.grains, {.meaning = "VTK output of the grains, grains.pvd", .only_if = of_grains});
  visit.section("checkpoint", output.checkpoint, {.meaning = "states from which the run can be continued"});
}

void check_fluid_output(const OutputKeys& output, const Vec3& box_size, double spacing) {
  const auto check_at = [&](const std::string& section, const FluidRegionKeys& region) {
    try {
      check(region, box_size, spacing);
    } catch (const KeyError& error) {
      throw KeyError(section + "." + error.key, error.what());
    }
  };
  check_at("fluid", output.fluid);
  for (std::size_t n = 0; n < output.fluid_parts.size(); ++n)
    check_at(fmt::format("fluid_parts.{}", n), output.fluid_parts[n]);
}

}  // namespace thalweg::io
