// The grains, and their fields, that a part of the output shows: the rules one by one, and refusals.
#include "core/keys/key_error.hpp"
#include "io/vtk/grain_fields.hpp"
#include "io/vtk/output_keys.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace thalweg::io::grain_selection_test {
namespace {

const PopulationIds ends{{10, 10, 25}, {}};  // the second population has no grains
const Vec3 domain(0.1, 0.05, 0.02), middle(0.05, 0.025, 0.01);

TEST(GrainSelection, FindsThePopulationOfAGrain) {
  EXPECT_EQ(population_of(0, ends), 0);
  EXPECT_EQ(population_of(9, ends), 0);
  EXPECT_EQ(population_of(10, ends), 2);
  EXPECT_EQ(population_of(24, ends), 2);
}

TEST(GrainSelection, ShowsTheGrainsForWhichAllHolds) {
  EXPECT_TRUE(GrainSelection({}, ends).has(24, middle));
  const GrainSelection some({{20, 3, 8}, {}, {}}, ends);
  for (const GlobalId id : {3, 8, 20}) EXPECT_TRUE(some.has(id, middle));
  for (const GlobalId id : {0, 4, 24}) EXPECT_FALSE(some.has(id, middle));
  const GrainSelection third({{}, 2, {}}, ends);
  EXPECT_FALSE(third.has(9, middle));
  EXPECT_TRUE(third.has(10, middle));
  const GrainSelection both({{3, 20}, 2, {}}, ends);
  EXPECT_FALSE(both.has(3, middle));
  EXPECT_TRUE(both.has(20, middle));
  EXPECT_FALSE(both.has(21, middle));
}

TEST(GrainSelection, ABoxHasItsFaces) {
  const GrainSelection box({{}, {}, BoxKeys{{0.01, 0.0, 0.0}, {0.05, 0.025, 0.01}}}, ends);
  EXPECT_TRUE(box.has(0, middle));
  EXPECT_TRUE(box.has(0, {0.01, 0.0, 0.0}));
  EXPECT_FALSE(box.has(0, {0.0099, 0.01, 0.005}));
  EXPECT_FALSE(box.has(0, {0.02, 0.0251, 0.005}));
  EXPECT_FALSE(box.has(0, {0.02, 0.01, 0.0101}));
}

// The key and the remedy of what a part gets wrong; empty: nothing.
std::string refusal(const NamedGrainOutputKeys& part, const GrainOutputFacts& facts = {{}, ends, domain}) {
  OutputKeys output;
  output.grain_parts = {{}, part};
  try {
    check_grain_output(output, facts);
  } catch (const KeyError& error) {
    return error.key + ": " + error.what();
  }
  return "";
}

NamedGrainOutputKeys part_of(const GrainSelectionKeys& selection, const std::vector<GrainField>& fields = {}) {
  NamedGrainOutputKeys part;
  static_cast<GrainSelectionKeys&>(part) = selection;
  part.fields = fields;
  return part;
}

TEST(GrainSelection, WhatThereIsNotIsRefused) {
  EXPECT_EQ(refusal(part_of({{0, 24}, 2, BoxKeys{{0.0, 0.0, 0.0}, domain}})), "");
  // A domain of whole cells may be shorter than the case says by the tolerance of these.
  EXPECT_EQ(refusal(part_of({{}, {}, BoxKeys{{0.0, 0.0, 0.0}, (1.0 + 0.5 * whole_number_tolerance) * domain}})), "");
  EXPECT_EQ(refusal(part_of({{0, 25}, {}, {}})), "grain_parts.1.ids.1: there is no such grain; give ids from 0 to 24");
  EXPECT_EQ(refusal(part_of({{4, 1, 4}, {}, {}})), "grain_parts.1.ids.2: the id is given twice; remove one of the two");
  EXPECT_EQ(refusal(part_of({{}, 3, {}})), "grain_parts.1.population: there is no such population; give one of 0 to 2");
  EXPECT_NE(refusal(part_of({{}, {}, BoxKeys{middle, {0.05, 0.05, 0.02}}})).find("box: the box has no volume"),
            std::string::npos);
  EXPECT_NE(refusal(part_of({{}, {}, BoxKeys{middle, {0.1, 0.05, 0.021}}})).find("box: the box reaches out"),
            std::string::npos);
}

TEST(GrainSelection, FieldsAreThoseTheCaseHas) {
  const auto with = [](GrainField field) { return part_of({}, {GrainField::speed, field}); };
  GrainOutputFacts facts{{}, ends, domain};
  for (const GrainField field :
       {GrainField::clump, GrainField::orientation, GrainField::fluid_force, GrainField::fluid_stress}) {
    EXPECT_EQ(refusal(with(field), facts).find("grain_parts.1.fields.1: "), 0u);
    EXPECT_FALSE(there_is(field, facts));
  }
  facts.clumps = facts.fluid_force = facts.fluid_stress = true;
  for (const NamedChoice<GrainField>& field : grain_fields())
    EXPECT_EQ(refusal(part_of({}, {field.value}), facts), "") << field.name;
}

// A round of supplies brings a grain of population 2, then a clump of two members of population 0.
TEST(GrainSelection, KnowsThePopulationOfGrainsThatHaveComeIn) {
  const PopulationIds with_supplies{{10, 10, 25}, {2, 0, 0}};
  const std::vector<std::pair<GlobalId, std::int64_t>> known{{9, 0},  {10, 2}, {24, 2}, {25, 2},
                                                             {26, 0}, {27, 0}, {28, 2}, {25 + 3 * 1000 + 1, 0}};
  for (const auto& [id, population] : known) EXPECT_EQ(population_of(id, with_supplies), population) << id;
  EXPECT_EQ(population_of(7, {{}, {1}}), 1);
}

// Grain 0 is a sphere of 2 mm with 1 mg; 1 and 2 are the members of a clump.
TEST(GrainFields, DensityAndOrientationOfAMemberAreThoseOfItsClump) {
  const std::vector<GlobalId> id{0, 1, 2}, clump{-1, 1, 1};
  const std::vector<double> radius{1e-3, 1e-3, 1e-3}, mass{1e-6, 5e-6, 5e-6};
  const std::vector<std::uint8_t> motion{0, 5, 7};
  GrainView grains;
  grains.id = id;
  grains.radius = radius;
  grains.mass = mass;
  grains.clump = clump;
  grains.clumps = {{1, 5e-6, 2e-9, Vec3::Zero(), Vec3::Zero(), 0.0, {0.6, 0.0, 0.8, 0.0}}};
  EXPECT_NEAR(density_of(grains, 0), 1e-6 / (4.0 / 3.0 * std::numbers::pi * 1e-9), 1e-10);
  EXPECT_NEAR(density_of(grains, 2), 2500.0, 1e-9);
  EXPECT_EQ(orientation_of(grains, 0), (std::array<double, 4>{1.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(orientation_of(grains, 2), (std::array<double, 4>{0.6, 0.0, 0.8, 0.0}));
  EXPECT_EQ(grains.held(1), 0);  // nothing is known
  grains.motion = motion;
  EXPECT_EQ(grains.held(0), 0);
  EXPECT_EQ(grains.held(1), 1);
  EXPECT_EQ(grains.held(2), 3);
  grains.disk_thickness = 2e-3;
  EXPECT_NEAR(density_of(grains, 0), 1e-6 / (std::numbers::pi * 1e-6 * 2e-3), 1e-10);
}

}  // namespace
}  // namespace thalweg::io::grain_selection_test
