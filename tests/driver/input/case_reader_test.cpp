// Case files: the example of the documentation and round trips.
#include "driver/input/case_reader.hpp"
#include "core/base/error.hpp"
#include "driver/estimate/filled_in.hpp"
#include "tests/driver/case_texts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace thalweg::driver::case_reader_test {
namespace {

using testing::flume;
using testing::message_of;

Case read(const std::string& yaml, const std::vector<std::string>& overrides = {}) {
  return testing::read_text(yaml, overrides);
}

TEST(CaseReader, ReadsWhatTheFileSays) {
  const Case c = read(flume);
  EXPECT_EQ(c.system, SystemKind::resolved);
  EXPECT_EQ(c.name, "small flume");
  EXPECT_EQ(cells_of(c.domain), (Index3{120, 21, 150}));
  EXPECT_EQ(c.domain.faces[x_high].type, lbm::FaceType::periodic);
  EXPECT_EQ(c.domain.faces[y_low], (coupling::FaceKeys{lbm::FaceType::slip_law_of_the_wall, 2.35}));
  EXPECT_EQ(c.domain.faces[top].type, lbm::FaceType::free_slip);
  EXPECT_EQ(c.fluid.smagorinsky_constant, 0.27);
  EXPECT_EQ(c.fluid.precision, coupling::Precision::single);
  EXPECT_EQ(*c.gravity.slope, 0.07);
  ASSERT_EQ(c.grains.size(), 2u);
  EXPECT_EQ(c.grains[0].placement.pattern, beds::PlacementPattern::random);
  EXPECT_EQ(c.grains[0].placement.region->upper, Vec3(0.06, 0.0105, 0.05));
  EXPECT_EQ(c.grains[1].count, 2);
  EXPECT_TRUE(c.grains[1].fixed);
  EXPECT_EQ(grain_count(c), 152);
  EXPECT_EQ(c.output.fluid.fields, std::vector<io::FluidField>{io::FluidField::velocity});
  EXPECT_EQ(c.output.checkpoint.keep, 3);
  EXPECT_EQ(c.analysis.observers.of<analysis::TransportRateKeys>()->from, 1.0);
}

// A spacing with few digits, as that of a third of a millimetre, makes the box a little smaller than its size.
TEST(CaseReader, WhatEndsAtTheSizeOfTheBoxIsInIt) {
  const std::string all = "{lower: [0, 0, 0], upper: [0.06, 0.0105, 0.075]}";
  EXPECT_NO_THROW(read(
      flume, {"domain.spacing=0.4999999e-3", "grains.0.placement.region=" + all,
              "grains.1.placement.positions.1=[0.06, 0.005, 0.06]",
              "supplies=[{population: 0, rate: 10, region: " + all + "}]",
              "sinks=[{region: " + all + ", recirculation: {region: " + all + "}}]", "output.fluid.region=null",
              "output.fluid.box=" + all, "output.fluid_parts=[{name: end, every: 0.1, plane: {axis: x, at: 0.06}}]",
              "analysis.probes={points: [[0.06, 0.0105, 0.075]], lines: [{from: [0, 0, 0], to: [0.06, 0.0105, 0.075], "
              "points: 3}]}"}));
}

TEST(CaseReader, GrainsAndFluidMayComeFromTwoRuns) {
  const Case none = read(flume);
  EXPECT_TRUE(none.initial.from.none());
  EXPECT_FALSE(none.initial.takes(InitialField::fluid));
  for (const std::string one : {"initial={from: a, fields: [grains]}", "initial={from: {run: a}, fields: [grains]}"}) {
    const Case c = read(flume, {one});
    EXPECT_TRUE(c.initial.source_of(InitialField::grains).path.ends_with("/a"));
    EXPECT_EQ(c.initial.source_of(InitialField::grains).key, "initial.from");
    EXPECT_FALSE(c.initial.takes(InitialField::fluid));
    EXPECT_EQ(read(resolved_yaml(c)), c) << resolved_yaml(c);
  }
  const Case two = read(flume, {"initial.from={grains: a, fluid: b}"});
  EXPECT_TRUE(two.initial.source_of(InitialField::grains).path.ends_with("/a"));
  EXPECT_TRUE(two.initial.source_of(InitialField::fluid).path.ends_with("/b"));
  EXPECT_EQ(two.initial.source_of(InitialField::fluid).key, "initial.from.fluid");
  EXPECT_EQ(read(resolved_yaml(two)), two) << resolved_yaml(two);
  const Case bed = read(flume, {"initial={from: {grains: a}, fluid: {uniform: [0.1, 0, 0]}}"});
  EXPECT_TRUE(bed.initial.takes(InitialField::grains));
  EXPECT_FALSE(bed.initial.takes(InitialField::fluid));
  EXPECT_THROW(read(flume, {"initial={from: {grains: a, fluid: b}, fields: [grains]}"}), InputError);
  EXPECT_THROW(read(flume, {"initial={from: {run: a, fluid: b}}"}), InputError);
}

TEST(CaseReader, FramesOfGrainsMayBeOfSome) {
  const Case c =
      read(flume, {"output.grains={every: 1, fields: [density, id]}",
                   "output.grain_parts=[{name: fixed, every: 0.1, population: 1, ids: [150, 151], box: {lower: "
                   "[0, 0, 0], upper: [0.06, 0.0105, 0.02]}}]"});
  EXPECT_EQ(c.output.grains.fields, (std::vector<io::GrainField>{io::GrainField::density, io::GrainField::id}));
  ASSERT_EQ(c.output.grain_parts.size(), 1u);
  EXPECT_EQ(c.output.grain_parts[0].population, 1);
  EXPECT_TRUE(c.output.grain_parts[0].fields.empty());
  EXPECT_EQ(read(resolved_yaml(c)), c) << resolved_yaml(c);
}

// The lightest free pair of the flume touches for 0.0001999 s: 2e-5 s of the fluid are 2.001 twentieths of it.
TEST(CaseReader, TakesAsManySubStepsAsTheContactNeeds) {
  const Case c = read(flume, {"coupling.grain_steps_per_fluid_step=auto", "contact.normal_stiffness=20000"});
  EXPECT_EQ(c.coupling.grain_steps_per_fluid_step, 3);
  EXPECT_EQ(sub_steps_needed(c), 3);
  EXPECT_LE(grain_time_step(c), shortest_contact(c) / 20.0);
  // The run keeps the number.
  EXPECT_NE(resolved_yaml(c).find("grain_steps_per_fluid_step: 3\n"), std::string::npos);
  EXPECT_EQ(read(flume, {"contact.normal_stiffness=20000", "fluid.time_step=1e-6"}).coupling.grain_steps_per_fluid_step,
            1);
}

// 6 pi eta a/(1e-5 m) of the flume's glass in 0.01 Pa s, 2.881e5/s: half of its inverse is 11.5 times in 2e-5 s. The
// fixed grains, of 4 mm, would need more.
TEST(CaseReader, TakesAsManySubStepsAsLubricationNeeds) {
  const std::vector<std::string> oil = {"fluid.kinematic_viscosity=1e-5", "coupling.lubrication={minimum_gap: 1e-5}",
                                        "coupling.grain_steps_per_fluid_step=auto"};
  EXPECT_EQ(read(flume, oil).coupling.grain_steps_per_fluid_step, 12);
}

// Beyond the critical damping 2 sqrt(k m*) = 2.55 kg/s a contact must be resolved in pi/beta = 2 pi m*/gamma.
TEST(CaseReader, TakesAsManySubStepsAsStrongDashpotsNeed) {
  const Case c = read(flume, {"contact.restitution=null", "contact.damping=5.1", "contact.attraction=none",
                              "contact.normal_stiffness=20000", "coupling.grain_steps_per_fluid_step=auto"});
  const double lighter = 0.5 * 2550.0 * std::numbers::pi / 6.0 * std::pow(4.95e-3, 3);
  EXPECT_NEAR(shortest_contact(c), 2.0 * std::numbers::pi * lighter / 5.1, 1e-12);
  EXPECT_LE(grain_time_step(c), shortest_contact(c) / 20.0 * (1.0 + 1e-9));
}

TEST(CaseReader, ReadsEveryFormOfFacesGravityStepAndStart) {
  const Case c = read(flume, {"domain.boundaries={x_low: no_slip, x_high: free_slip, y: periodic, bottom: "
                              "{type: no_slip}, top: law_of_the_wall}",
                              "gravity={vector: [0.1, 0, -9.8], mode: reduced}", "fluid.time_step=null",
                              "contact={damping: 0.09, attraction: none}",
                              "initial.fluid={log_profile: {bed_height: 0.05, shear_velocity: 0.06, roughness: 2e-4}}",
                              "grains.1.fixed=false", "grains.1.prescribed_angular_velocity=[0, 1, 0]"});
  EXPECT_EQ(c.domain.faces[x_low].type, lbm::FaceType::no_slip);
  EXPECT_EQ(c.domain.faces[x_high].type, lbm::FaceType::free_slip);
  EXPECT_EQ(c.domain.faces[top], coupling::FaceKeys{lbm::FaceType::law_of_the_wall});
  EXPECT_EQ(gravity_vector(c.gravity), Vec3(0.1, 0, -9.8));
  EXPECT_EQ(c.gravity.mode, GravityMode::reduced);
  EXPECT_LE(fluid_time_step(c), suitable_time_step(c));  // shorter where contacts need it
  EXPECT_EQ(*c.contact.damping, 0.09);
  EXPECT_FALSE(c.contact.attraction);
  EXPECT_EQ(c.initial.fluid.log_profile->shear_velocity, 0.06);
  EXPECT_EQ(*c.grains[1].prescribed_angular_velocity, Vec3(0, 1, 0));
  EXPECT_EQ(read(resolved_yaml(c)), c);
}

TEST(CaseReader, TheResolvedCaseReadsBackAsTheSameCase) {
  const Case c = read(flume);
  EXPECT_EQ(read(resolved_yaml(c)), c) << resolved_yaml(c);
}

TEST(CaseReader, AFluidAloneHasNoKeysOfGrains) {
  const std::string text = defaults_yaml("fluid");
  const Case c = read(text);
  EXPECT_EQ(c.system, SystemKind::fluid);
  EXPECT_TRUE(c.grains.empty());
  EXPECT_EQ(text.find("contact:"), std::string::npos);
  EXPECT_EQ(read(resolved_yaml(c)), c);
  for (const std::string key :
       {"grains=[]", "contact={restitution: 0.9}", "coupling={refill: grad}", "output.grains={}"})
    EXPECT_THROW(read(text, {key}), InputError) << key;
}

TEST(CaseReader, AFluidWithoutGrainsIsACase) {
  const Case c = read(flume, {"grains=[]", "contact=null", "analysis=null"});
  EXPECT_EQ(grain_count(c), 0);
  EXPECT_EQ(read(resolved_yaml(c)), c);
}

TEST(CaseReader, ReadsTheBulkViscosityAndTheRamp) {
  const Case plain = read(flume), c = read(flume, {"fluid.bulk_relaxation_time=10", "run.ramp=0.2"});
  EXPECT_EQ(plain.fluid.bulk_relaxation_time, 1.0);  // bgk in the open and a subgrid model
  const Case published = read(flume, {"fluid.bulk_relaxation_time=0"});
  EXPECT_EQ(read(flume, {"fluid.collision=bgk"}).fluid.bulk_relaxation_time, 1.0);
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{"fluid.smagorinsky_constant=null", "fluid.subgrid_model=none"},
        {"fluid.collision=trt"}})
    EXPECT_EQ(read(flume, other).fluid.bulk_relaxation_time, 0.0) << other.back();
  Case clear = plain;
  clear.system = SystemKind::fluid;
  EXPECT_EQ(bulk_relaxation_time_for(clear), 1.0);
  EXPECT_EQ(plain.run.ramp, 0.0);
  EXPECT_EQ(c.fluid.bulk_relaxation_time, 10.0);
  EXPECT_EQ(c.run.ramp, 0.2);
  EXPECT_EQ(read(resolved_yaml(c)), c);
  EXPECT_NEAR(bulk_viscosity(c), 2.0 / 9.0 * 9.5 * 0.5e-3 * 0.5e-3 / 2e-5, 1e-15);
  EXPECT_NEAR(bulk_viscosity(published), 2.0 / 3.0 * 1e-6, 1e-15);  // 2/3 nu
  EXPECT_EQ(read(defaults_yaml("fluid"), {"run.ramp=0.2"}).run.ramp, 0.2);
}

TEST(CaseReader, ReadsTheSubgridModel) {
  using lbm::Subgrid;
  const auto subgrid = [](const std::vector<std::string>& overrides) {
    const Case c = read(flume, overrides);
    EXPECT_EQ(read(resolved_yaml(c)), c) << resolved_yaml(c);
    return c.fluid.subgrid();
  };
  EXPECT_EQ(subgrid({}), Subgrid::smagorinsky(0.27));  // which its constant says
  EXPECT_EQ(subgrid({"fluid.subgrid_model=smagorinsky"}), Subgrid::smagorinsky(0.27));
  EXPECT_EQ(subgrid({"fluid.smagorinsky_constant=null"}), Subgrid::qr());
  EXPECT_EQ(subgrid({"fluid.smagorinsky_constant=null", "fluid.subgrid_model=none"}), Subgrid::none());
  EXPECT_EQ(subgrid({"fluid.smagorinsky_constant=null", "fluid.subgrid_model=smagorinsky"}),
            Subgrid::smagorinsky(0.27));
}

// All keys at any depth, of the text with its commented-out keys brought to life.
void collect_keys(const YAML::Node& node, const std::string& path, std::vector<std::string>& keys) {
  if (node.IsMap())
    for (const auto& entry : node) {
      keys.push_back(path + entry.first.as<std::string>());
      collect_keys(entry.second, keys.back() + ".", keys);
    }
  else if (node.IsSequence())
    for (const auto& item : node) collect_keys(item, path, keys);
}

TEST(CaseReader, ReadsEveryWallAndCollision) {
  const Case c = read(flume, {"domain.boundaries={x_low: {type: velocity_inlet, velocity: [0.2, 0, 0]}, x_high: {type: "
                              "pressure_outlet, pressure: 3}, y: {type: navier_slip, slip_length: 1e-4}, "
                              "bottom: law_of_the_wall, top: {type: moving, velocity: [0.1, 0, 0]}}",
                              "grains.0.fixed=true", "fluid.collision=trt", "fluid.magic_parameter=0.25",
                              "coupling.links=cli", "coupling.covered_momentum=to_grain"});
  EXPECT_EQ(c.coupling.links, bodies::LinkRule::cli);
  EXPECT_EQ(c.coupling.covered_momentum, coupling::CoveredMomentum::to_grain);
  EXPECT_EQ(c.domain.faces[x_low].velocity, Vec3(0.2, 0, 0));
  EXPECT_EQ(c.domain.faces[x_high].pressure, 3.0);
  EXPECT_EQ(c.domain.faces[y_high].slip_length, 1e-4);
  EXPECT_EQ(c.domain.faces[bottom].type, lbm::FaceType::law_of_the_wall);
  EXPECT_EQ(c.domain.faces[top].velocity, Vec3(0.1, 0, 0));
  EXPECT_EQ(c.fluid.collision, lbm::CollisionModel::trt);
  EXPECT_EQ(c.fluid.magic_parameter, 0.25);
  EXPECT_EQ(read(resolved_yaml(c)), c);  // and writes them all
}

TEST(CaseReader, ReadsTheSlipLawOfTheWall) {
  const Case c =
      read(flume, {"domain.boundaries={x: periodic, y_low: {type: slip_law_of_the_wall, of_first_cell: true}, "
                   "y_high: slip_law_of_the_wall, bottom: no_slip, top: free_slip}",
                   "fluid.mean_velocity={velocity: 0.3, response_time: 0.05}"});
  EXPECT_EQ(c.fluid.mean_velocity->response_time, 0.05);
  const auto conditions = coupling::conditions_of(c.domain.faces, units_of(c));
  EXPECT_EQ(conditions[y_low].type, lbm::FaceType::slip_law_of_the_wall);
  EXPECT_TRUE(conditions[y_low].slip_of_first_cell);
  EXPECT_EQ(conditions[y_high].type, lbm::FaceType::slip_law_of_the_wall);
  EXPECT_FALSE(conditions[y_high].slip_of_first_cell);
  EXPECT_EQ(conditions[y_high].slip_coefficient, 8.36);
  EXPECT_EQ(read(resolved_yaml(c)), c);
}

TEST(CaseReader, StartsWithALinearProfile) {
  const Case c = read(flume, {"initial.fluid={linear_profile: {lower: 0.01, upper: 0.05, velocity: [0.4, 0, 0.2]}}"});
  EXPECT_EQ(read(resolved_yaml(c)), c);
  const auto start = coupling::initial_fluid(c.initial.fluid, {1, 1, 1}, {true, true, false}, 1e-3);
  EXPECT_EQ(start(Vec3(0, 0, 0.005)).velocity, Vec3::Zero());
  EXPECT_LT((start(Vec3(0, 0, 0.02)).velocity - Vec3(0.1, 0, 0.05)).norm(), 1e-15);
  EXPECT_EQ(start(Vec3(0, 0, 0.06)).velocity, Vec3(0.4, 0, 0.2));
}

TEST(CaseReader, TheDefaultsAreValidAndNameEveryKey) {
  const std::string text = defaults_yaml("resolved");
  EXPECT_EQ(read(text).grains.at(0).placement.seed, 1);
  for (const std::string key : {"x_low", "y_high", "shields_number", "depth", "vector", "positions", "region", "lower",
                                "prescribed_velocity", "prescribed_angular_velocity", "damping", "uniform",
                                "log_profile", "bed_height", "shear_velocity", "roughness"})
    EXPECT_NE(text.find("# " + key + ": "), std::string::npos) << key;
  // Keys that belong to a choice the defaults do not make.
  for (const std::string key :
       {"magic_parameter", "coefficient", "of_first_cell", "slip_length", "oscillation", "pressure", "youngs_modulus"})
    EXPECT_NE(text.find("# " + key + ": "), std::string::npos) << key;
  EXPECT_NE(text.find("only with type: navier_slip\n"), std::string::npos);
  std::vector<std::string> keys;
  collect_keys(YAML::Load(text), "", keys);
  EXPECT_GE(keys.size(), 50u);
  for (const std::string key : {"domain.boundaries.y.type", "coupling.load", "gravity.mode", "output.checkpoint.keep",
                                "contact.attraction", "fluid.collision"})
    EXPECT_NE(std::find(keys.begin(), keys.end(), key), keys.end()) << key;
  EXPECT_NE(message_of<InputError>([] { defaults_yaml("shallow_water"); }).find("give one of resolved, fluid, grains"),
            std::string::npos);
}

// Whatever has no default is marked, and nothing that has one: the comment behind a key.
TEST(CaseReader, DefaultsAndExamplesAreToldApart) {
  const std::string text = "\n" + defaults_yaml("resolved");
  const auto comment_of = [&text](const std::string& key) {
    const std::size_t at = text.find("\n" + key), mark = text.find("# ", at);
    return at == std::string::npos ? std::string("?") : text.substr(mark + 2, text.find('\n', mark) - mark - 2);
  };
  for (const std::string key :
       {"  size: [", "  spacing: ", "  density: 1000",
        "  time_step: ", "  magnitude: ", "  slope: ", "  restitution: ", "      value: ", "    density: 2550",
        "    count: ", "  until: ", "  transport_rate:", "      type: law_of_the_wall", "    x: periodic"})
    EXPECT_TRUE(comment_of(key).starts_with("example, ")) << key << comment_of(key);
  for (const std::string key :
       {"  precision: ", "  collision: ", "  mode: ", "      seed: ", "    velocity: ", "  friction: ", "  law: ",
        "  links: ", "  grain_steps_per_fluid_step: ", "domain:", "contact:", "    fixed: "})
    EXPECT_EQ(comment_of(key).find("example"), std::string::npos) << key << comment_of(key);
}

TEST(CaseReader, OneSectionOfTheDefaults) {
  const std::string dry = defaults_yaml("grains.contact"), wet = defaults_yaml("contact"),
                    population = defaults_yaml("resolved.grains.contact");
  EXPECT_NE(dry.find("system: grains"), std::string::npos);
  EXPECT_NE(wet.find("system: resolved"), std::string::npos);
  EXPECT_EQ(YAML::Load(dry)["contact"]["law"].as<std::string>(), "linear");
  EXPECT_EQ(YAML::Load(dry).size(), 1u);
  EXPECT_NE(population.find("\ngrains:"), std::string::npos) << population;
  EXPECT_NE(population.find("  - # contact:"), std::string::npos) << population;
  EXPECT_EQ(population.find("liquid_bridge"), std::string::npos);
  EXPECT_EQ(YAML::Load(defaults_yaml("gravity"))["gravity"]["mode"].as<std::string>(), "reduced");
  EXPECT_NE(defaults_yaml("fluid.mean_velocity").find("response_time"), std::string::npos);  // system and section
  EXPECT_NE(defaults_yaml("closures").find("system: continuum"), std::string::npos);
  for (const std::string what : {"grains.kontakt", "kontakt", "", "."})
    EXPECT_NE(message_of<InputError>([&] { defaults_yaml(what); }).find("or a section such as contact"),
              std::string::npos)
        << what;
}

TEST(CaseReader, TheDefaultsOfEverySystemAreValid) {
  for (const char* system : {"resolved", "fluid", "grains", "model_fluid", "continuum"})
    EXPECT_NO_THROW(read(defaults_yaml(system))) << system;
}

TEST(CaseReader, TheDefaultsFitOnAScreen) {
  for (const char* system : {"resolved", "fluid", "grains", "model_fluid", "continuum", "domain.boundaries.top"}) {
    std::istringstream text(defaults_yaml(system));
    for (std::string line; std::getline(text, line);) EXPECT_LE(line.size(), 110u) << line;
  }
}

// A list of choices is explained where it is shown first, also in a section shown alone.
TEST(CaseReader, TheDefaultsExplainChoicesOnce) {
  const std::string explanation = "navier_slip (slip velocity", all = defaults_yaml("resolved");
  const std::size_t first = all.find(explanation);
  EXPECT_NE(first, std::string::npos);
  EXPECT_EQ(all.find(explanation, first + 1), std::string::npos);
  EXPECT_NE(defaults_yaml("domain.boundaries.top").find(explanation), std::string::npos);
}

// The room of a sink before an outlet is that of the grains that come there: a fixed boulder does not.
TEST(CaseReader, MeasuresASinkByTheLongestFreeGrain) {
  const std::vector<std::string> reach = {
      "domain.boundaries={x_low: no_slip, x_high: pressure_outlet, y: no_slip, bottom: no_slip, top: free_slip}",
      "grains.1={diameter: 9.0e-3, density: 2550, placement: {positions: [[0.02, 0.005, 0.06]]}, fixed: true}"};
  const auto with_sink = [&](double depth) {
    std::vector<std::string> settings = reach;
    settings.push_back(
        fmt::format("sinks=[{{region: {{lower: [{:.9g}, 0, 0], upper: [0.06, 0.0105, 0.075]}}}}]", 0.06 - depth));
    return settings;
  };
  EXPECT_NO_THROW(testing::read_text(testing::flume, with_sink(4.95e-3)));
  EXPECT_THROW(testing::read_text(testing::flume, with_sink(4.9e-3)), InputError);
}

}  // namespace
}  // namespace thalweg::driver::case_reader_test
