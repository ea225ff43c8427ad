#include "driver/case/case_sections.hpp"

#include "driver/case/preset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>

// Functions named describe are static rather than in an unnamed namespace, where argument-dependent lookup from the
// visitor's templates would not find them.
namespace thalweg::driver {

// The words for a system without lattice fluid.
static std::string no_fluid(SystemKind system) {
  return system == SystemKind::model_fluid ? "system: model_fluid has only its section model_fluid"
                                           : "system: grains has no fluid";
}

static OnlyIf only_with_fluid(SystemKind system) {
  return {has_fluid(system), no_fluid(system) + "; remove the section or set system: resolved"};
}

static OnlyIf only_with_grains(bool with_grains) {
  return {with_grains, "system: fluid has no grains; remove the section or set system: resolved"};
}

static void describe_gravity(SectionVisitor& visit, GravityCase& gravity, bool with_fluid) {
  visit.real("magnitude", gravity.magnitude,
             {.unit = "m/s^2", .meaning = "with slope; or give vector", .at_least = 0.0, .example = 9.8});
  visit.real("slope", gravity.slope,
             {.meaning = "tangent of the bed's angle, downhill along x; default: 0", .example = 0.016});
  visit.vec3("vector", gravity.vector, {.unit = "m/s^2", .meaning = "in place of magnitude and slope", .example = 0.0});
  visit.require(!gravity.vector || (!gravity.magnitude && !gravity.slope), "vector",
                "gravity is given twice; give either magnitude and slope or vector");
  visit.require(gravity.vector || gravity.magnitude, "magnitude",
                "gravity is missing; give magnitude in m/s^2, for example 9.8, with slope, or vector");
  visit.choice<GravityMode>(
      "mode", gravity.mode,
      {{GravityMode::reduced, "reduced", "hydrostatic pressure left out"},
       {GravityMode::full, "full", "hydrostatic pressure in the fluid, and buoyancy from it"},
       {GravityMode::balanced, "balanced",
        "in a periodic box, the weight of the grains carried by a mean pressure gradient"}},
      {.meaning = "how the weight of the resting fluid is treated",
       .only_if = {with_fluid, "a run without fluid has only one kind of gravity; remove the key"}});
}

static void describe(SectionVisitor& visit, FlowCase& flow) {
  visit.real("shields_number", flow.shields_number,
             {.meaning = "of the reference grain, by the depth over the settled bed or, between side walls, the "
                         "hydraulic radius; gives gravity.slope, or with a slope the depth",
              .above = 0.0,
              .example = 0.05});
  visit.real("depth", flow.depth,
             {.unit = "m",
              .meaning = "of the water above the settled bed; gives the height of the box, where domain.size has only "
                         "two numbers",
              .above = 0.0,
              .example = 0.03});
}

static void describe_sources(SectionVisitor& visit, InitialFromCase& from, const OnlyIf& of_fluid, bool with_grains) {
  visit.text("run", from.run,
             {.meaning = "run folder or checkpoint, relative to this file, from which `fields` are taken",
              .example = "../other/run"});
  visit.text("grains", from.grains,
             {.meaning = "the same, for the grains",
              .example = "../bed/run",
              .only_if = {with_grains, "system: fluid has no grains; remove the key"}});
  visit.text("fluid", from.fluid,
             {.meaning = "the same, for the fluid",
              .example = "../flow/run",
              .only_if = {of_fluid.holds, "there is no fluid in this case; remove the key"}});
  visit.require(!from.run || !from.each(), "run", "give either run, with initial.fields, or grains and fluid");
  visit.require(!from.grains || !from.grains->empty(), "grains", "give a run folder or checkpoint, or remove the key");
  visit.require(!from.fluid || !from.fluid->empty(), "fluid", "give a run folder or checkpoint, or remove the key");
}

static void describe_initial(SectionVisitor& visit, InitialCase& initial, SystemKind system) {
  const OnlyIf of_fluid = only_with_fluid(system);
  const bool with_fluid = of_fluid.holds, with_grains = system != SystemKind::fluid;
  visit.section("from",
                {.meaning = "state of other runs to begin from: one run folder or checkpoint (short for run: PATH), "
                            "with fields, or one each for grains and fluid; {}: none",
                 .shorthand = "run",
                 .expected = "a run folder or checkpoint"},
                [&](SectionVisitor& inside) { describe_sources(inside, initial.from, of_fluid, with_grains); });
  if (!with_fluid && initial.fields == InitialCase{}.fields) initial.fields = {InitialField::grains};
  std::vector<NamedChoice<InitialField>> fields;
  if (with_fluid) fields.push_back({InitialField::fluid, "fluid"});
  if (with_grains) fields.push_back({InitialField::grains, "grains", "as many as the populations have"});
  visit.choice_list<InitialField>(
      "fields", initial.fields, fields,
      {.meaning = "what is taken from the run in `from`",
       .only_if = {!initial.from.each(), "from says which run each field is taken from; remove this key"}});
  visit.section("fluid", initial.fluid,
                {.meaning = "velocity at the start: rest, uniform, linear_profile or log_profile",
                 .empty_name = "rest",
                 .only_if = of_fluid});
  visit.require(!initial.takes(InitialField::fluid) || initial.fluid.count() == 0, "from",
                "the start of the fluid is given twice; take the grains alone from another run (fields: [grains]), or "
                "remove the section fluid");
}

static void describe(SectionVisitor& visit, AtRestCase& rest) {
  visit.real("largest_speed", rest.largest_speed, {.unit = "m/s", .meaning = "of a free grain at rest", .above = 0.0});
  visit.real("largest_acceleration", rest.largest_acceleration,
             {.unit = "m/s^2", .meaning = "of a free grain at rest, by all forces together", .above = 0.0});
  visit.real("quantile", rest.quantile,
             {.meaning = "share of the free grains that must be at rest", .above = 0.0, .at_most = 1.0});
}

static void describe_run(SectionVisitor& visit, RunCase& run, bool with_fluid) {
  visit.real("until", run.until,
             {.unit = "s",
              .meaning = "simulated time at which the run ends",
              .required = true,
              .above = 0.0,
              .example = 30.0});
  visit.not_here("grain_integrator", "the grains are moved by velocity Verlet; remove the key");
  visit.choice<loop::OutOfBounds>("watchdog", run.watchdog,
                                  {{loop::OutOfBounds::stop, "stop", "end the run with exit code 1"},
                                   {loop::OutOfBounds::warn, "warn", "continue as long as all figures are finite"}},
                                  {.meaning = "action when a diagnostic leaves its bounds (docs/stability.md)"});
  visit.section(
      "until_at_rest", run.until_at_rest,
      {.meaning = "the run ends when the grains are at rest (checked every 200 steps), or at run.until",
       .only_if = {!with_fluid, "grains in a fluid are never at rest; remove the section or set system: grains"}});
  visit.real(
      "ramp", run.ramp,
      {.unit = "s",
       .meaning =
           "time over which gravity, on fluid and grains, rises smoothly from zero; 0: full gravity from the start",
       .at_least = 0.0,
       .only_if = {with_fluid, "a ramp avoids pressure waves in a fluid, and there is none; remove the key"}});
  visit.real("time_step", run.time_step,
             {.unit = "s",
              .meaning = "of the grains; default: 1/50 of the shortest contact",
              .above = 0.0,
              .example = 4e-6,
              .only_if = {!with_fluid, "with a fluid the step is fluid.time_step; remove the key"}});
}

static void describe(SectionVisitor&, WallForcesCase&) {}

template <typename Keys>
OnlyIf belonging(SystemKind system) {
  const OnlyIf of_fluid = only_with_fluid(system);
  if (Keys::needs != analysis::Needs::fluid && system == SystemKind::fluid) return only_with_grains(false);
  if (Keys::needs == analysis::Needs::grains || of_fluid.holds) return {};
  if constexpr (requires { Keys::without_fluid; })
    return {false,
            fmt::format("{}; remove the section, {}, or set system: resolved", no_fluid(system), Keys::without_fluid)};
  return of_fluid;
}

static void describe_analysis(SectionVisitor& visit, AnalysisCase& analysis, SystemKind system) {
  const bool with_grains = system != SystemKind::fluid;
  visit.real(
      "reference_diameter", analysis.reference_diameter,
      {.unit = "m",
       .meaning = "d in q*, the Shields number and the moving speed; default: median by volume of all free grains",
       .above = 0.0,
       .example = 5e-3,
       .only_if = {with_grains, "system: fluid has no grains; remove the key or set system: resolved"}});
  analysis.observers.for_each([&](auto& keys) {
    using Keys = std::decay_t<decltype(*keys)>;
    visit.section(Keys::section, keys, {.meaning = Keys::meaning, .only_if = belonging<Keys>(system)});
  });
  visit.section("wall_forces", analysis.wall_forces,
                {.meaning = "force of grains and of the fluid on each wall, in series.csv; no keys: {}",
                 .only_if = only_with_grains(with_grains)});
}

static void describe(SectionVisitor& visit, DisksCase& disks) {
  visit.real("thickness", disks.thickness,
             {.unit = "m", .meaning = "along y; sets their mass", .required = true, .above = 0.0, .example = 5e-3});
}

static void describe(SectionVisitor& visit, SteadyCase& steady) {
  visit.real("unsteadiness", steady.unsteadiness,
             {.meaning = "over one step: change of momentum over that of the driving force, and relative change of q_s",
              .above = 0.0});
}

static void describe_column_run(SectionVisitor& visit, RunCase& run) {
  visit.real("until", run.until,
             {.unit = "s",
              .meaning = "simulated time at which the run ends",
              .required = true,
              .above = 0.0,
              .example = 120.0});
  visit.section("until_steady", run.until_steady,
                {.meaning = "the run ends when the column is steady, or at run.until; no keys: {}"});
  visit.real("time_step", run.time_step,
             {.unit = "s",
              .meaning = "between results and checks whether the column is steady; the equations are integrated in "
                         "steps of their own; default: 5",
              .above = 0.0,
              .example = 5.0});
}

// Sections of a column; all others belong to a box.
static void describe_column(SectionVisitor& visit, Case& c) {
  const std::string no_box = "system: continuum is a column and has no box of cells and grains; remove the section";
  for (const char* section :
       {"domain", "disks", "walls", "contact", "model_fluid", "coupling", "initial", "solids", "supplies", "sinks"})
    visit.not_here(section, no_box);
  visit.not_here("analysis", "system: continuum writes all results to series.csv and profiles.h5; remove the section");
  visit.section("fluid", c.continuum.fluid, {.meaning = "properties of the fluid", .required = true});
  visit.section("grains", c.continuum.grains, {.meaning = "properties of the grains", .required = true});
  visit.section("gravity", {.meaning = "given by magnitude and slope, or as a vector", .required = true},
                [&](SectionVisitor& inside) { describe_gravity(inside, c.gravity, false); });
  visit.section("column", c.continuum.column, {.meaning = "heights of water and bed", .required = true});
  visit.section("closures", c.continuum.closures, {.meaning = "constitutive laws of the two phases"});
  visit.section("creep", c.continuum.creep,
                {.meaning = "slow flow of the grains below the surface, by granular fluidity; no keys: {}"});
  visit.section("run", {.meaning = "duration and time integration", .required = true},
                [&](SectionVisitor& inside) { describe_column_run(inside, c.run); });
  visit.section("output", {.meaning = "what the run writes, besides run.log, profiles.h5 and summary.json"},
                [&](SectionVisitor& inside) {
                  const OnlyIf nothing{false, "a column has neither cells nor grains to show; remove the section"};
                  describe(inside, c.output, nothing, nothing);
                });
}

static void describe_box_and_flow(SectionVisitor& visit, Case& c) {
  const bool with_fluid = has_fluid(c);
  visit.section("domain", {.meaning = "the box, its cells and its faces", .required = true},
                [&](SectionVisitor& inside) { describe_domain(inside, c.domain, with_fluid); });
  visit.section("fluid", c.fluid,
                {.meaning = "properties of the fluid", .required = true, .only_if = only_with_fluid(c.system)});
  visit.section("gravity", {.meaning = "given by magnitude and slope, or as a vector", .required = true},
                [&](SectionVisitor& inside) { describe_gravity(inside, c.gravity, with_fluid); });
  visit.section("flow", c.flow,
                {.meaning = "the flow over the settled bed, in place of slope or height, which follow from it",
                 .only_if = {c.system == SystemKind::resolved,
                             "only system: resolved has a bed under water; remove the section"}});
}

static void describe_grains_and_walls(SectionVisitor& visit, Case& c) {
  const bool with_fluid = has_fluid(c);
  const OnlyIf of_grains = only_with_grains(has_grains(c.system));
  visit.section("disks", c.disks,
                {.meaning = "two dimensions: the grains are disks that move in the x-z plane",
                 .only_if = {!with_fluid, "only dry grains can be disks; remove the section or set system: grains"}});
  const OnlyIf of_walls =
      c.system == SystemKind::model_fluid
          ? OnlyIf{false, "the model fluid takes a wall for missing grains; remove the section"}
          : OnlyIf{!with_fluid, "with a fluid only the faces of the box are walls; remove the section"};
  visit.list("walls", c.walls, {.meaning = "solid planes, in addition to the faces of the box", .only_if = of_walls});
  visit.list("grains", c.grains, {.meaning = "populations of grains", .required = !with_fluid, .only_if = of_grains});
  visit.require(with_fluid || !c.grains.empty(), "grains", "a run of dry grains needs at least one population of them");
  visit.list("supplies", c.supplies, {.meaning = "grains that come in during the run", .only_if = of_grains});
  visit.list("sinks", c.sinks, {.meaning = "where grains leave the box", .only_if = of_grains});
  visit.section("contact", {.meaning = "force between grains that touch, with friction", .only_if = of_grains},
                [&](SectionVisitor& inside) {
                  describe(inside, c.contact);
                  const std::optional<dem::ContactDuration>& duration = c.contact.given.duration;
                  inside.require(with_fluid || !duration || !duration->fluid_steps, "duration",
                                 "there is no fluid whose steps could be counted; give the duration in s");
                  inside.require(
                      c.grains.empty() || c.contact.restitution || c.contact.damping, "restitution",
                      "the loss in a collision is missing; give restitution, for example 0.93, or damping in kg/s");
                });
}

static void describe_forces_of_fluid(SectionVisitor& visit, Case& c) {
  visit.section("model_fluid",
                {.meaning = "the force of Clark et al. (2017) in place of a fluid",
                 .required = true,
                 .only_if = {c.system == SystemKind::model_fluid,
                             "only system: model_fluid has it; remove the section or set system: model_fluid"}},
                [&](SectionVisitor& inside) { describe(inside, c.model_fluid, c.disks.has_value()); });
  visit.section("coupling",
                {.meaning = "interaction of the fluid with grains or solids", .only_if = only_with_fluid(c.system)},
                [&](SectionVisitor& inside) { describe(inside, c.coupling, has_grains(c.system)); });
}

static void describe_run_and_results(SectionVisitor& visit, Case& c) {
  const bool with_fluid = has_fluid(c);
  const bool with_grains = has_grains(c.system);
  visit.section("initial", {.meaning = "state at the start"},
                [&](SectionVisitor& inside) { describe_initial(inside, c.initial, c.system); });
  visit.list("solids", c.solids, {.meaning = "bodies in the way of fluid and grains"});
  visit.require(c.solids.empty() || !c.disks, "solids",
                "disks move in a plane, which a solid would push them out of; give walls");
  visit.section("run", {.meaning = "duration and time integration", .required = true},
                [&](SectionVisitor& inside) { describe_run(inside, c.run, with_fluid); });
  visit.section(
      "output", {.meaning = "what the run writes, besides run.log and summary.json"}, [&](SectionVisitor& inside) {
        describe(inside, c.output, {with_fluid, "a run without fluid has no output of it; remove the section"},
                 only_with_grains(with_grains));
      });
  visit.section("analysis", {.meaning = "what is measured during the run"},
                [&](SectionVisitor& inside) { describe_analysis(inside, c.analysis, c.system); });
}

std::vector<NamedChoice<SystemKind>> choices_of(SystemKind) {
  return {{SystemKind::resolved, "resolved", "fluid with grains in it, every grain resolved"},
          {SystemKind::fluid, "fluid", "fluid alone"},
          {SystemKind::grains, "grains", "dry grains"},
          {SystemKind::model_fluid, "model_fluid", "grains under a prescribed fluid force"},
          {SystemKind::continuum, "continuum", "a column of grains and water as two continua"}};
}

std::string name_of(SystemKind kind) {
  for (const NamedChoice<SystemKind>& choice : choices_of(kind))
    if (choice.value == kind) return choice.name;
  return {};
}

void describe(SectionVisitor& visit, Case& c) {
  visit.choice("system", c.system, {.meaning = "what is simulated", .required = true});
  std::optional<std::string> preset;  // has been laid beneath the case before it is read
  visit.text("preset", preset,
             {.meaning = fmt::format("named set of defaults, which keys of the case override: {}; `thalweg defaults "
                                     "zhang2022` shows them",
                                     preset_names()),
              .example = "zhang2022"});
  visit.text("name", c.name, {.meaning = "name of the run in its output"});
  if (c.system == SystemKind::continuum) {
    describe_column(visit, c);
    return;
  }
  for (const char* section : {"column", "closures", "creep"})
    visit.not_here(section, "only system: continuum has it; remove the section or set system: continuum");
  describe_box_and_flow(visit, c);
  describe_grains_and_walls(visit, c);
  describe_forces_of_fluid(visit, c);
  describe_run_and_results(visit, c);
}

}  // namespace thalweg::driver
