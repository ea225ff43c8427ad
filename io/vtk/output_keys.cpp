#include "io/vtk/output_keys.hpp"

#include "core/keys/key_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

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
  visit.choice<FieldPrecision>("precision", fluid.precision,
                               {{FieldPrecision::single, "single"}, {FieldPrecision::double_, "double"}},
                               {.meaning = "of the numbers in the frames; fluid.precision is that of the run"});
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
  visit.choice_list<GrainField>(
      "fields", grains.fields, grain_fields(),
      {.meaning = "what the frames contain besides positions and radii; default: all there is"});
}

static void describe(SectionVisitor& visit, NamedGrainOutputKeys& part) {
  visit.text("name", part.name,
             {.meaning = "of its files: grain_parts/NAME.pvd", .required = true, .example = "tracers"});
  visit.require(is_word(part.name), "name", "give a word of letters, digits and underscores");
  describe(visit, static_cast<GrainOutputKeys&>(part));
  visit.require(part.every > 0.0, "every", "give the time in s between its frames, above 0");
  describe_selection(visit, part);
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

template <typename Part>
static void require_different_names(SectionVisitor& visit, const std::string& key, const std::vector<Part>& parts) {
  std::set<std::string> names;
  for (const Part& part : parts) names.insert(part.name);
  visit.require(names.size() == parts.size(), key, "two of them have the same name; give each its own");
}

void describe(SectionVisitor& visit, OutputKeys& output, const OnlyIf& of_fluid, const OnlyIf& of_grains) {
  visit.section("series", output.series, {.meaning = "the table series.csv"});
  visit.section("fluid", output.fluid, {.meaning = "VTK output of the fluid, fluid.pvd", .only_if = of_fluid});
  visit.list("fluid_parts", output.fluid_parts,
             {.meaning = "more series of frames of the fluid, each with its own files", .only_if = of_fluid});
  if (of_fluid.holds) require_different_names(visit, "fluid_parts", output.fluid_parts);
  visit.section("grains", output.grains, {.meaning = "VTK output of the grains, grains.pvd", .only_if = of_grains});
  visit.list("grain_parts", output.grain_parts,
             {.meaning = "more series of frames of the grains, each with its own files", .only_if = of_grains});
  if (of_grains.holds) require_different_names(visit, "grain_parts", output.grain_parts);
  visit.section("checkpoint", output.checkpoint, {.meaning = "states from which the run can be continued"});
}

// Calls a check that throws KeyError, of a section in this one.
static void check_in(const std::string& section, const auto& check_section) {
  try {
    check_section();
  } catch (const KeyError& error) {
    throw KeyError(section + "." + error.key, error.what());
  }
}

void check_fluid_output(const OutputKeys& output, const Vec3& box_size, double spacing) {
  check_in("fluid", [&] { check(output.fluid, box_size, spacing); });
  for (std::size_t n = 0; n < output.fluid_parts.size(); ++n)
    check_in(fmt::format("fluid_parts.{}", n), [&] { check(output.fluid_parts[n], box_size, spacing); });
}

// Reason why a field that exists in some cases only is refused.
static std::string refusal_of(GrainField field) {
  if (field == GrainField::fluid_force)
    return "there is no fluid around the grains; remove the word or set system: resolved";
  if (field == GrainField::fluid_stress)
    return "there is no flow around the grains whose stress could be measured; remove the word or set system: "
           "resolved";
  return "no population has clumps, and the orientation of spheres is not followed; remove the word";
}

static void check_fields(const std::vector<GrainField>& fields, const GrainFieldFacts& facts) {
  for (std::size_t n = 0; n < fields.size(); ++n)
    if (!there_is(fields[n], facts)) throw KeyError(fmt::format("fields.{}", n), refusal_of(fields[n]));
}

void check_grain_output(const OutputKeys& output, const GrainOutputFacts& facts) {
  check_in("grains", [&] { check_fields(output.grains.fields, facts); });
  for (std::size_t n = 0; n < output.grain_parts.size(); ++n)
    check_in(fmt::format("grain_parts.{}", n), [&] {
      check_fields(output.grain_parts[n].fields, facts);
      check(output.grain_parts[n], facts.population_ids, facts.box_size);
    });
}

}  // namespace thalweg::io
