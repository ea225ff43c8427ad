#include "driver/case_sections.hpp"

#include <fmt/format.h>

#include <utility>

// Functions named describe are static rather than in an unnamed namespace, where argument-dependent lookup from the
// visitor's templates would not find them.
namespace thalweg {

static void describe(io::SectionVisitor& visit, FlowTargetCase& target) {
  visit.real("velocity", target.velocity,
             {.unit = "m/s", .meaning = "mean over the fluid, along x", .required = true, .example = 0.3});
  visit.real("response_time", target.response_time,
             {.unit = "s",
              .meaning = "in which the force answers; not longer than the flow needs to come to rest",
              .required = true,
              .above = 0.0,
              .example = 0.1});
}

static void describe(io::SectionVisitor& visit, FluidCase& fluid) {
  visit.real("density", fluid.density,
             {.unit = "kg/m^3", .meaning = "mass density", .required = true, .above = 0.0, .example = 1000.0});
  visit.real("kinematic_viscosity", fluid.kinematic_viscosity,
             {.unit = "m^2/s", .meaning = "molecular viscosity", .required = true, .above = 0.0, .example = 1e-6});
  visit.real("smagorinsky_constant", fluid.smagorinsky_constant,
             {.meaning = "of the subgrid model; 0.27 for water, 0 switches it off", .at_least = 0.0, .below = 1.0});
  visit.real("time_step", fluid.time_step,
             {.unit = "s", .meaning = "of the fluid; or give the two velocities below", .above = 0.0, .example = 2e-5});
  visit.real("maximum_lattice_velocity", fluid.maximum_lattice_velocity,
             {.unit = "cells/step",
              .meaning = "with expected_velocity, in place of time_step: the step in which the "
                         "expected velocity covers this many cells",
              .above = 0.0,
              .at_most = 0.173,
              .example = 0.05});
  visit.real("expected_velocity", fluid.expected_velocity,
             {.unit = "m/s", .meaning = "the largest velocity expected in the fluid", .above = 0.0, .example = 0.5});
  visit.require(!(fluid.time_step && fluid.maximum_lattice_velocity), "time_step",
                "the step is given twice; give either time_step or maximum_lattice_velocity with expected_velocity");
  visit.require(fluid.time_step || fluid.maximum_lattice_velocity, "time_step",
                "the step is missing; give time_step in s, for example 2e-05, or maximum_lattice_velocity with "
                "expected_velocity");
  visit.require(!fluid.maximum_lattice_velocity || fluid.expected_velocity, "expected_velocity",
                "maximum_lattice_velocity needs it; give the largest velocity expected in m/s, for example 0.5");
  visit.choice<Collision>("collision", fluid.collision,
                          {{Collision::bgk, "bgk", "one relaxation time"},
                           {Collision::trt, "trt", "two; walls stay in place at any viscosity"},
                           {Collision::regularised, "regularised", "bgk without ghost modes; not near walls in water"}},
                          {.meaning = "collision operator"});
  if (fluid.collision == Collision::trt)
    visit.real("magic_parameter", fluid.magic_parameter,
               {.meaning = "of trt: (1/omega+ - 1/2)(1/omega- - 1/2); 3/16 puts walls exactly half way", .above = 0.0});
  else
    visit.not_here("magic_parameter", "only collision trt has a magic parameter; remove it");
  visit.choice<Precision>("precision", fluid.precision, {{Precision::single, "single"}, {Precision::double_, "double"}},
                          {.meaning = "of the stored populations"});
  visit.section("mean_velocity", fluid.mean_velocity,
                {.meaning = "hold this flow by a body force along x, in place of gravity along x"});
}

static void describe_gravity(io::SectionVisitor& visit, GravityCase& gravity, bool with_fluid) {
  visit.real("magnitude", gravity.magnitude,
             {.unit = "m/s^2", .meaning = "with slope; or give vector", .at_least = 0.0, .example = 9.8});
  visit.real("slope", gravity.slope,
             {.meaning = "tangent of the bed's angle, downhill along x; 0 where not given", .example = 0.016});
  visit.vec3("vector", gravity.vector, {.unit = "m/s^2", .meaning = "in place of magnitude and slope", .example = 0.0});
  visit.require(!gravity.vector || (!gravity.magnitude && !gravity.slope), "vector",
                "gravity is given twice; give either magnitude and slope or vector");
  visit.require(gravity.vector || gravity.magnitude, "magnitude",
                "gravity is missing; give magnitude in m/s^2, for example 9.8, with slope, or vector");
  if (with_fluid)
    visit.choice<GravityMode>("mode", gravity.mode,
                              {{GravityMode::reduced, "reduced", "hydrostatic pressure left out"}},
                              {.meaning = "how the weight of the resting fluid is treated"});
  else
    visit.not_here("mode", "a run without fluid has only one kind of gravity; remove the key");
}

static void describe(io::SectionVisitor& visit, RegionCase& region) {
  visit.vec3("lower", region.lower, {.unit = "m", .meaning = "lower corner", .required = true, .example = 0.0});
  visit.vec3("upper", region.upper, {.unit = "m", .meaning = "upper corner", .required = true, .example = 0.05});
}

static void describe(io::SectionVisitor& visit, PlacementCase& placement) {
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

static void describe(io::SectionVisitor& visit, PopulationCase& grains) {
  visit.real("diameter", grains.diameter,
             {.unit = "m", .meaning = "of every grain", .required = true, .above = 0.0, .example = 5e-3});
  visit.real("density", grains.density,
             {.unit = "kg/m^3", .meaning = "of every grain", .required = true, .above = 0.0, .example = 2550.0});
  visit.section("placement", grains.placement, {.meaning = "where the grains are at the start"});
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
  visit.flag("fixed", grains.fixed, {.meaning = "the grains never move"});
  visit.vec3("prescribed_velocity", grains.prescribed_velocity,
             {.unit = "m/s", .meaning = "kept whatever the forces", .example = 0.0});
  visit.vec3("prescribed_angular_velocity", grains.prescribed_angular_velocity,
             {.unit = "rad/s", .meaning = "kept whatever the torques", .example = 0.0});
  visit.require(!grains.fixed || (!grains.prescribed_velocity && !grains.prescribed_angular_velocity), "fixed",
                "a fixed grain cannot have a prescribed velocity; give one or the other");
  visit.require(!grains.fixed || (grains.velocity.isZero(0.0) && grains.angular_velocity.isZero(0.0)), "fixed",
                "a fixed grain cannot start with a velocity; remove fixed or the velocity");
  visit.require(!grains.prescribed_velocity || grains.velocity.isZero(0.0), "velocity",
                "prescribed_velocity already says how the grains move; remove one of the two");
  visit.require(!grains.prescribed_angular_velocity || grains.angular_velocity.isZero(0.0), "angular_velocity",
                "prescribed_angular_velocity already says how the grains turn; remove one of the two");
}

static void describe_contact(io::SectionVisitor& visit, ContactCase& contact, bool with_grains) {
  visit.choice<ContactLaw>("law", contact.law,
                           {{ContactLaw::linear, "linear", "spring and dashpot"},
                            {ContactLaw::hertz_mindlin, "hertz_mindlin", "elastic spheres, by youngs_modulus"}},
                           {.meaning = "force of a contact"});
  if (contact.law == ContactLaw::linear) {
    visit.real("normal_stiffness", contact.normal_stiffness,
               {.unit = "N/m", .meaning = "of the spring across a contact", .above = 0.0});
    visit.real("tangential_stiffness", contact.tangential_stiffness,
               {.unit = "N/m", .meaning = "of the spring along a contact", .above = 0.0});
    for (const char* key : {"youngs_modulus", "poisson_ratio"})
      visit.not_here(key, "the linear law has stiffnesses; remove it or set law: hertz_mindlin");
  } else {
    visit.real("youngs_modulus", contact.youngs_modulus,
               {.unit = "Pa", .meaning = "of grains and walls", .required = true, .above = 0.0, .example = 70e9});
    visit.real("poisson_ratio", contact.poisson_ratio,
               {.meaning = "of grains and walls", .at_least = 0.0, .at_most = 0.5});
    for (const char* key : {"normal_stiffness", "tangential_stiffness", "damping"})
      visit.not_here(key,
                     "elastic spheres have youngs_modulus, poisson_ratio and restitution; remove it or set law: "
                     "linear");
  }
  visit.real("tangential_damping", contact.tangential_damping,
             {.meaning = "dashpot along a contact over the one across it", .at_least = 0.0});
  visit.real("restitution", contact.restitution,
             {.meaning = "speed after over speed before a dry collision; or give damping",
              .above = 0.0,
              .at_most = 1.0,
              .example = 0.93});
  if (contact.law == ContactLaw::linear)
    visit.real("damping", contact.damping,
               {.unit = "kg/s",
                .meaning = "of the dashpot across a contact, in place of restitution",
                .at_least = 0.0,
                .example = 0.09});
  visit.require(!(contact.restitution && contact.damping), "restitution",
                "the loss in a collision is given twice; give either restitution or damping");
  visit.require(!with_grains || contact.restitution || contact.damping, "restitution",
                "the loss in a collision is missing; give restitution, for example 0.93, or damping in kg/s");
  visit.real("friction", contact.friction, {.meaning = "coefficient between grains", .at_least = 0.0});
  visit.real("wall_friction", contact.wall_friction,
             {.meaning = "coefficient between grain and wall", .at_least = 0.0});
  visit.choice<Attraction>(
      "attraction", contact.attraction,
      {{Attraction::none, "none", "the force never pulls"},
       {Attraction::allowed, "allowed", "the dashpot may pull as grains part, as in the linear law"}},
      {.meaning = "sign of the normal force"});
}

static void describe(io::SectionVisitor& visit, CouplingCase& coupling) {
  visit.integer("grain_steps_per_fluid_step", coupling.grain_steps_per_fluid_step,
                {.meaning = "sub-steps of the grains in one step of the fluid", .at_least = 1});
  visit.real("link_tolerance", coupling.link_tolerance,
             {.unit = "cells",
              .meaning = "how far a grain may move before its surface is cut anew",
              .at_least = 0.0,
              .at_most = 0.1});
  visit.choice<MomentumExchange>("momentum_exchange", coupling.momentum_exchange,
                                 {{MomentumExchange::galilean_invariant, "galilean_invariant", "Wen et al. 2014"},
                                  {MomentumExchange::classical, "classical", "Mei et al. 2002"}},
                                 {.meaning = "how the force on a grain is summed"});
  visit.choice<WallDensity>("wall_density", coupling.wall_density,
                            {{WallDensity::local, "local", "of the fluid cell"},
                             {WallDensity::reference, "reference", "of the fluid at rest"}},
                            {.meaning = "density in the moving-wall term"});
  visit.choice<Refill>("refill", coupling.refill, {{Refill::equilibrium, "equilibrium"}},
                       {.meaning = "populations of a cell that a grain has uncovered"});
}

static void describe(io::SectionVisitor& visit, PerturbationCase& perturbation) {
  visit.real(
      "amplitude", perturbation.amplitude,
      {.meaning = "root mean square of a velocity component away from walls, over shear_velocity", .above = 0.0});
  visit.integer("seed", perturbation.seed, {.meaning = "another seed, other eddies", .at_least = 0});
}

static void describe(io::SectionVisitor& visit, LogProfileCase& profile) {
  visit.real("bed_height", profile.bed_height,
             {.unit = "m",
              .meaning = "above the bottom; the fluid below is at rest",
              .required = true,
              .at_least = 0.0,
              .example = 0.06});
  visit.real("shear_velocity", profile.shear_velocity,
             {.unit = "m/s",
              .meaning = "u(z) = shear_velocity / 0.41 ln((z - bed_height) / roughness)",
              .required = true,
              .above = 0.0,
              .example = 0.08});
  visit.real("roughness", profile.roughness,
             {.unit = "m",
              .meaning = "height above the bed at which the velocity is zero",
              .required = true,
              .above = 0.0,
              .example = 3.3e-4});
  visit.section("perturbation", profile.perturbation, {.meaning = "random eddies without divergence on top"});
}

static void describe(io::SectionVisitor& visit, InitialFluidCase& fluid) {
  visit.vec3("uniform", fluid.uniform, {.unit = "m/s", .meaning = "the same velocity everywhere", .example = 0.0});
  visit.section("log_profile", fluid.log_profile, {.meaning = "a turbulent profile along x over a bed"});
  visit.require(!(fluid.uniform && fluid.log_profile), "uniform",
                "the start is given twice; give either uniform or log_profile");
}

static void describe(io::SectionVisitor& visit, InitialCase& initial) {
  visit.text("from", initial.from,
             {.meaning = "run folder or checkpoint of another run to begin from, relative to this file; \"\": none"});
  visit.choice_list<InitialField>("fields", initial.fields, {{InitialField::fluid, "fluid"}},
                                  {.meaning = "what is taken from it"});
  visit.section("fluid", initial.fluid,
                {.meaning = "velocity at the start: rest, uniform or log_profile", .empty_name = "rest"});
  visit.require(initial.from.empty() || !(initial.fluid.uniform || initial.fluid.log_profile), "from",
                "the start of the fluid is given twice; remove either this key or the section fluid");
}

static void describe_run(io::SectionVisitor& visit, RunCase& run, bool with_fluid) {
  visit.real("until", run.until,
             {.unit = "s",
              .meaning = "simulated time at which the run ends",
              .required = true,
              .above = 0.0,
              .example = 30.0});
  if (with_fluid)
    visit.not_here("time_step", "with a fluid the step is fluid.time_step; remove the key");
  else
    visit.real("time_step", run.time_step,
               {.unit = "s",
                .meaning = "of the grains; 1/50 of the shortest contact where not given",
                .above = 0.0,
                .example = 4e-6});
}

static void describe(io::SectionVisitor& visit, SeriesOutputCase& series) {
  visit.real("every", series.every, {.unit = "s", .meaning = "between rows of series.csv; 0: none", .at_least = 0.0});
}

static void describe(io::SectionVisitor& visit, FluidOutputCase& fluid) {
  using io::FluidField;
  using io::FluidRegion;
  visit.real("every", fluid.every, {.unit = "s", .meaning = "between pictures of the fluid; 0: none", .at_least = 0.0});
  visit.choice<FluidRegion>("region", fluid.region,
                            {{FluidRegion::whole, "whole"},
                             {FluidRegion::slice_x, "slice_x"},
                             {FluidRegion::slice_y, "slice_y"},
                             {FluidRegion::slice_z, "slice_z"}},
                            {.meaning = "the whole box, or the middle layer of cells across an axis"});
  visit.choice_list<FluidField>("fields", fluid.fields,
                                {{FluidField::velocity, "velocity", "m/s"},
                                 {FluidField::pressure, "pressure", "Pa above the reference"},
                                 {FluidField::grain_id, "grain_id", "-1 in the fluid"},
                                 {FluidField::density, "density", "kg/m^3"},
                                 {FluidField::shear_rate, "shear_rate", "1/s, of the subgrid model"},
                                 {FluidField::eddy_viscosity, "eddy_viscosity", "m^2/s, of the subgrid model"},
                                 {FluidField::vorticity, "vorticity", "1/s"},
                                 {FluidField::q_criterion, "q_criterion", "1/s^2, vortices where positive"}},
                                {.meaning = "what the pictures show"});
}

static void describe(io::SectionVisitor& visit, GrainOutputCase& grains) {
  visit.real("every", grains.every,
             {.unit = "s", .meaning = "between pictures of the grains; 0: none", .at_least = 0.0});
}

static void describe(io::SectionVisitor& visit, CheckpointOutputCase& checkpoint) {
  visit.real("every", checkpoint.every,
             {.unit = "s", .meaning = "between checkpoints; 0: only at the end of the run", .at_least = 0.0});
  visit.integer("keep", checkpoint.keep, {.meaning = "number of newest checkpoints that are kept", .at_least = 1});
}

static void describe_output(io::SectionVisitor& visit, OutputCase& output, bool with_fluid, bool with_grains) {
  visit.section("series", output.series, {.meaning = "the table series.csv"});
  if (with_fluid)
    visit.section("fluid", output.fluid, {.meaning = "pictures of the fluid, fluid.pvd"});
  else
    visit.not_here("fluid", "a run without fluid has no pictures of it; remove the section");
  if (with_grains)
    visit.section("grains", output.grains, {.meaning = "pictures of the grains, grains.pvd"});
  else
    visit.not_here("grains", "system: fluid has no grains; remove the section or set system: resolved");
  visit.section("checkpoint", output.checkpoint, {.meaning = "states from which the run can be continued"});
}

static void describe(io::SectionVisitor& visit, TransportRateCase& rate) {
  visit.real("from", rate.from, {.unit = "s", .meaning = "start of the mean that summary.json gives", .at_least = 0.0});
}

static void describe_analysis(io::SectionVisitor& visit, AnalysisCase& analysis, bool with_fluid, bool with_grains) {
  if (with_grains)
    visit.section("transport_rate", analysis.transport_rate, {.meaning = "the grains' flux q and q* along x"});
  else
    visit.not_here("transport_rate", "system: fluid has no grains; remove the section or set system: resolved");
  if (with_fluid)
    visit.section("fluid_statistics", analysis.fluid_statistics,
                  {.meaning = "mean velocity and Reynolds stresses in profiles.h5: over z, and over y and z between "
                              "side walls"});
  else
    visit.not_here("fluid_statistics", "system: grains has no fluid; remove the section or set system: resolved");
}

void describe(io::SectionVisitor& visit, Case& c) {
  visit.choice<SystemKind>("system", c.system,
                           {{SystemKind::resolved, "resolved", "fluid with grains in it, every grain resolved"},
                            {SystemKind::fluid, "fluid", "fluid alone"},
                            {SystemKind::grains, "grains", "dry grains"}},
                           {.meaning = "what is simulated", .required = true});
  const bool with_fluid = has_fluid(c), with_grains = c.system != SystemKind::fluid;
  const auto only_with_fluid = [&](const std::string& key) {
    visit.not_here(key, "system: grains has no fluid; remove the section or set system: resolved");
  };
  const auto only_with_grains = [&](const std::string& key) {
    visit.not_here(key, "system: fluid has no grains; remove the section or set system: resolved");
  };
  visit.text("name", c.name, {.meaning = "what the run is called in its output"});
  visit.section("domain", c.domain, {.meaning = "the box, its cells and its faces", .required = true});
  if (with_fluid)
    visit.section("fluid", c.fluid, {.meaning = "what fills the box", .required = true});
  else
    only_with_fluid("fluid");
  visit.section("gravity", {.meaning = "given by magnitude and slope, or as a vector", .required = true},
                [&](io::SectionVisitor& inside) { describe_gravity(inside, c.gravity, with_fluid); });
  if (with_grains) {
    visit.list("grains", c.grains, {.meaning = "populations of grains", .required = !with_fluid});
    visit.require(with_fluid || !c.grains.empty(), "grains",
                  "a run of dry grains needs at least one population of them");
    visit.section("contact", {.meaning = "force between grains that touch, with friction"},
                  [&](io::SectionVisitor& inside) { describe_contact(inside, c.contact, !c.grains.empty()); });
  } else {
    only_with_grains("grains");
    only_with_grains("contact");
  }
  if (with_fluid && with_grains)
    visit.section("coupling", c.coupling, {.meaning = "how fluid and grains act on each other"});
  else if (with_fluid)
    only_with_grains("coupling");
  else
    only_with_fluid("coupling");
  if (with_fluid)
    visit.section("initial", c.initial, {.meaning = "state at the start"});
  else
    only_with_fluid("initial");
  if (!with_grains)
    visit.list("solids", c.solids, {.meaning = "bodies that stand still in the fluid"});
  else
    visit.not_here("solids",
                   "only system: fluid has them, because grains would not feel them; for spheres give a population of "
                   "grains with fixed: true");
  visit.section("run", {.meaning = "how long", .required = true},
                [&](io::SectionVisitor& inside) { describe_run(inside, c.run, with_fluid); });
  visit.section("output", {.meaning = "what the run writes, besides run.log and summary.json"},
                [&](io::SectionVisitor& inside) { describe_output(inside, c.output, with_fluid, with_grains); });
  visit.section("analysis", {.meaning = "what is measured while the run goes"},
                [&](io::SectionVisitor& inside) { describe_analysis(inside, c.analysis, with_fluid, with_grains); });
}

}  // namespace thalweg
