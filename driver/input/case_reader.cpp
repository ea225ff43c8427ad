#include "driver/input/case_reader.hpp"

#include "core/base/error.hpp"
#include "core/base/shell_word.hpp"
#include "driver/case/case_sections.hpp"
#include "driver/case/preset.hpp"
#include "driver/case/solid_setup.hpp"
#include "driver/estimate/contact_stiffness.hpp"
#include "driver/estimate/filled_in.hpp"
#include "driver/input/case_checks.hpp"
#include "driver/input/derived_flow.hpp"
#include "io/text/section_reader.hpp"
#include "io/text/section_schema.hpp"
#include "io/text/section_writer.hpp"
#include "io/text/yaml_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <utility>

namespace thalweg::driver {
namespace {

constexpr double column_time_step =
    5.0;  // s, where the user gives none: of diagnostics, and of looks whether it is steady

// Plausible values for the keys that have no default: a small flume of glass spheres in water.
Case example_column(Case c) {
  c.gravity.slope = 0.016;
  c.run.until = 120.0;
  c.run.time_step = column_time_step;
  c.output.series.every = column_time_step;
  c.continuum.fluid = {1000.0, 1e-6};
  c.continuum.grains = {5e-3, 2550.0};
  c.continuum.column.shields_number = 0.085;
  return c;
}

Case example_case(SystemKind system) {
  Case c;
  c.system = system;
  c.domain.size = {0.060, 0.0105, 0.075};
  c.domain.spacing = 0.5e-3;
  const coupling::FaceKeys periodic{lbm::FaceType::periodic}, floor{lbm::FaceType::no_slip},
      lid{lbm::FaceType::free_slip};
  const coupling::FaceKeys side{has_fluid(c)                   ? lbm::FaceType::law_of_the_wall
                                : system == SystemKind::grains ? lbm::FaceType::moving
                                                               : lbm::FaceType::periodic};
  c.domain.faces = {periodic, periodic, side, side, floor, lid};
  c.gravity.magnitude = 9.8;
  c.gravity.slope = 0.07;
  c.run.until = 3.0;
  if (system == SystemKind::continuum) return example_column(c);
  if (system == SystemKind::fluid) c.solids.emplace_back().sphere = SphereCase{{0.02, 0.00525, 0.02}, 2.5e-3};
  if (system != SystemKind::fluid) {
    beds::Population glass;
    glass.count = 200;
    glass.diameter = 4.95e-3;
    glass.density = 2550.0;
    c.grains = {glass};
    c.contact.restitution = 0.93;
    c.analysis.observers.of<analysis::TransportRateKeys>().emplace();
  }
  if (system == SystemKind::model_fluid) {
    c.gravity.slope.reset();
    c.model_fluid.shields_number = 0.1;
    c.model_fluid.reynolds_number = 1.0;
    c.model_fluid.drag = model_fluid::ModelDrag::quadratic;
  }
  if (has_fluid(c)) {
    c.fluid.density = 1000.0;
    c.fluid.kinematic_viscosity = 1e-6;
    c.fluid.time_step = 2e-5;
  }
  return c;
}

// Derives step, rows and the box that the parts common to all systems need.
void fill_in_column(Case& c, const io::YamlDocument& document) {
  if (!c.run.time_step) c.run.time_step = column_time_step;
  if (!document.find("output.series.every")) c.output.series.every = *c.run.time_step;
  const continuum::ColumnParameters column = column_of(c).column;
  c.domain.spacing = column.spacing;
  c.domain.size = {column.spacing, column.spacing, column.cells * column.spacing};
  c.domain.faces[bottom].type = lbm::FaceType::no_slip;
  c.domain.faces[top].type = lbm::FaceType::free_slip;
}

constexpr double steps_per_contact = 50.0;  // dry grains, where the user gives no step

}  // namespace

Case read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides, const KnownBeds& known,
               MPI_Comm communicator) {
  const Ranks ranks(communicator);
  io::YamlDocument document(path, overrides, ranks);
  const FlowFilledIn flow = derive_flow(document, known, ranks);
  if (document.find("case") && !document.find("system"))
    throw InputError(fmt::format("{}: this is a sweep, not a case: thalweg sweep {} makes its runs.", path.string(),
                                 shell_word(path.string())));
  const std::string preset = lay_preset_beneath(document);
  Case c;
  io::read_document(document, c);
  c.filled_in.preset = preset;
  c.filled_in.flow = flow;
  c.flow.reset();
  if (c.system == SystemKind::continuum) {
    check_column(c, document);
    fill_in_column(c, document);
  }
  fill_in_grains(c, document, known, ranks);
  if (has_fluid(c)) c.fluid.fill_in_models();
  if (has_fluid(c) && !c.fluid.bulk_relaxation_time) c.fluid.bulk_relaxation_time = bulk_relaxation_time_for(c);
  if (has_grains(c.system)) {
    check_box(c, document);
  }
  for (std::optional<std::string>* source : {&c.initial.from.run, &c.initial.from.grains, &c.initial.from.fluid})
    if (*source && !(*source)->empty()) *source = document.path_beside(**source, "initial.from");
  fill_in_surfaces(c, document, ranks);
  check_solid_room(c, document);
  if (c.system != SystemKind::continuum) complete(c);
  if (!has_fluid(c) && !c.run.time_step)
    c.run.time_step = std::min(shortest_contact(c) / steps_per_contact, longest_contact_step(c));
  check_case(c, document);
  return c;
}

std::string resolved_yaml(const Case& c) { return io::written(with_stiffnesses(c), io::YamlStyle::plain); }

namespace {

using NamedSystem = NamedChoice<SystemKind>;

constexpr const char* how_to_read =
    "\n# Comments give the unit, the range and the meaning. \"example\": the key has no default, and the value is "
    "only\n"
    "# illustrative; keys that are commented out are optional, and their values are examples as well.\n";

io::SectionWriter documentation_of(SystemKind system) {
  io::SectionWriter writer(io::YamlStyle::documented);
  Case example = example_case(system);
  describe(writer, example);
  return writer;
}

// Documentation of one section in one system; none if the system has no such section.
std::optional<std::string> section_yaml(const NamedSystem& system, const std::vector<std::string>& path) {
  const std::optional<std::string> text = documentation_of(system.value).yaml_of(path);
  if (!text) return std::nullopt;
  return fmt::format("# {} of a case with system: {}, with its keys.{}{}", fmt::join(path, "."), system.name,
                     how_to_read, *text);
}

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  std::string part;
  std::istringstream stream(path);
  while (std::getline(stream, part, '.')) parts.push_back(part);
  return parts;
}

}  // namespace

std::string defaults_yaml(const std::string& what) {
  if (const std::optional<std::string_view> preset = preset_text(what)) return std::string(*preset);
  const std::vector<std::string> path = parts_of(what);
  const std::vector<NamedSystem> systems = choices_of(SystemKind{});
  const auto named = std::find_if(systems.begin(), systems.end(), [&](const NamedSystem& system) {
    return !path.empty() && system.name == path.front();
  });
  if (named != systems.end()) {
    if (path.size() == 1)
      return fmt::format("# Every key of a case with system: {}, with its default.{}{}", named->name, how_to_read,
                         documentation_of(named->value).yaml());
    if (const auto text = section_yaml(*named, {path.begin() + 1, path.end()})) return *text;
  }
  for (const NamedSystem& system : systems)
    if (const auto text = path.empty() ? std::nullopt : section_yaml(system, path)) return *text;
  std::vector<std::string> names;
  for (const NamedSystem& system : systems) names.push_back(system.name);
  throw InputError(fmt::format(
      "There is no system or section \"{}\": give one of {}, or a section such as contact, or both, such as "
      "grains.contact, or a preset ({}); the sections of resolved are {}.",
      what, fmt::join(names, ", "), preset_names(),
      fmt::join(documentation_of(SystemKind::resolved).sections(), ", ")));
}

std::string case_schema() {
  std::vector<std::string> names;
  std::vector<io::JsonObject> by_system;
  for (const NamedSystem& system : choices_of(SystemKind{})) {
    names.push_back(system.name);
    io::SectionSchema schema;
    Case example = example_case(system.value);
    describe(schema, example);
    const io::JsonObject is_it = io::JsonObject().set("const", system.name);
    by_system.push_back(io::JsonObject()
                            .set("if", io::JsonObject().set("properties", io::JsonObject().set("system", is_it)))
                            .set("then", schema.schema()));
  }
  const io::JsonObject system = io::JsonObject().set("enum", names).set("description", "what is simulated");
  return io::JsonObject()
             .set("$schema", "http://json-schema.org/draft-07/schema#")
             .set("title", "A case of Thalweg")
             .set("type", "object")
             .set("properties", io::JsonObject().set("system", system))
             .set("required", std::vector<std::string>{"system"})
             .set("allOf", by_system)
             .text() +
         "\n";
}

}  // namespace thalweg::driver
