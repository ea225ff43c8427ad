#include "driver/input/case_changes.hpp"

#include "core/base/error.hpp"

#include <gtest/gtest.h>

namespace thalweg::driver::case_changes_test {
namespace {

constexpr const char* before = R"(
system: resolved
name: a run
domain: {size: [0.1, 0.02, 0.1], spacing: 0.001}
fluid: {kinematic_viscosity: 1e-06, collision: bgk}
gravity: {magnitude: 9.81, mode: full}
grains:
  - {diameter: 0.005, density: 2550, placement: {pattern: random, seed: 1}}
  - {diameter: 0.004, density: 2550, contact: {friction: 0.3}}
initial: {from: ../settled}
output: {fluid: {fields: [velocity, pressure]}}
)";

std::string with(const std::string& old_text, const std::string& new_text) {
  std::string text = before;
  return text.replace(text.find(old_text), old_text.size(), new_text);
}

TEST(CaseChanges, SaysWhichKeysDiffer) {
  EXPECT_TRUE(case_changes(before, before).empty());
  const auto changes = case_changes(before, with("collision: bgk", "collision: trt, smagorinsky_constant: 0.1"));
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0].key + ": " + changes[0].before + " -> " + changes[0].now, "fluid.collision: bgk -> trt");
  EXPECT_EQ(changes[1].key + ": " + changes[1].before + " -> " + changes[1].now,
            "fluid.smagorinsky_constant: none -> 0.1");
  const auto fields = case_changes(before, with("[velocity, pressure]", "[velocity]"));
  ASSERT_EQ(fields.size(), 1u);
  EXPECT_EQ(fields[0].before + " -> " + fields[0].now, "[velocity, pressure] -> [velocity]");
  const auto gone = case_changes(before, with(", contact: {friction: 0.3}", ""));
  ASSERT_EQ(gone.size(), 2u);
  EXPECT_EQ(gone[0].key + ": " + gone[0].now, "grains.1.contact: none");
  EXPECT_EQ(gone[1].key + ": " + gone[1].now, "grains.1.contact.friction: none");
}

TEST(CaseChanges, ANumberMayBeWrittenInAnotherWay) {
  EXPECT_TRUE(case_changes(before, with("1e-06", "0.000001")).empty());
  EXPECT_EQ(case_changes(before, with("1e-06", "0.000002")).size(), 1u);
  EXPECT_TRUE(case_changes(before, with("[0.1, 0.02, 0.1]", "[0.1, 0.020000000000000004, 1e-1]")).empty());
  for (const char* other : {"[0.1, 0.02]", "[0.1, 0.02, 0.1, 0.1]", "[0.1, 0.02, -0.1]", "[0.1, 0.02, .inf]"})
    EXPECT_EQ(case_changes(before, with("[0.1, 0.02, 0.1]", other)).size(), 1u) << other;
}

TEST(CaseChanges, WhereGrainsWerePlacedDoesNotCount) {
  EXPECT_TRUE(case_changes(before, with("pattern: random, seed: 1", "file: bed.h5")).empty());
  EXPECT_TRUE(case_changes(before, with("../settled", "../moved/settled")).empty());
}

TEST(CaseChanges, WhatTheCheckpointContainsCannotBeChanged) {
  const auto refused = [](const std::string& now) {
    try {
      refuse_changes_of_state(case_changes(before, now), false);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused(with("density: 2550, placement", "density: 2650, placement"))
                .find("grains.0.density = 2650: the run to be continued has 2550"),
            0u);
  for (const auto& [old_text, new_text] : std::vector<std::pair<std::string, std::string>>{
           {"diameter: 0.004", "diameter: 0.0045"},
           {", contact: {friction: 0.3}", ""},
           {"placement: {pattern: random, seed: 1}", "contact: {friction: 0.9}"},
           {"system: resolved", "system: grains"},
           {"size: [0.1, 0.02, 0.1]", "size: [0.1, 0.02, 0.2]"},
           {"spacing: 0.001", "spacing: 0.0005"},
           {"mode: full", "mode: reduced"},
           {"  - {diameter: 0.004, density: 2550, contact: {friction: 0.3}}\n", ""}})
    EXPECT_FALSE(refused(with(old_text, new_text)).empty()) << new_text;
  for (const auto& [old_text, new_text] : std::vector<std::pair<std::string, std::string>>{
           {"a run", "the same run"}, {"1e-06", "2e-06"}, {"friction: 0.3", "friction: 0.4"}, {"9.81", "9.8"}})
    EXPECT_TRUE(refused(with(old_text, new_text)).empty()) << new_text;
}

TEST(CaseChanges, ACheckpointKeepsTheKeysThatCannotBeChanged) {
  const std::string kept = state_of_case(before, false);
  EXPECT_EQ(kept,
            "system: resolved\ndomain.size: [0.1, 0.02, 0.1]\ndomain.spacing: 0.001\ngravity.mode: full\n"
            "grains.0.diameter: 0.005\ngrains.0.density: 2550\n"
            "grains.1.diameter: 0.004\ngrains.1.density: 2550\ngrains.1.contact: a section\n");
  EXPECT_TRUE(state_changes(kept, before, false).empty());
  EXPECT_FALSE(state_changes(kept, with("mode: full", "mode: reduced"), false).empty());
  std::string earlier = kept;  // of a program that did not keep the mode
  const std::string mode = "gravity.mode: full\n";
  EXPECT_TRUE(state_changes(earlier.erase(earlier.find(mode), mode.size()), before, false).empty());
  EXPECT_TRUE(state_changes(kept, with("collision: bgk", "collision: trt"), false).empty());
  const auto denser = state_changes(kept, with("density: 2550, placement", "density: 2650, placement"), false);
  ASSERT_EQ(denser.size(), 1u);
  EXPECT_EQ(denser[0].key + ": " + denser[0].before + " -> " + denser[0].now, "grains.0.density: 2550 -> 2650");
  EXPECT_EQ(
      state_changes(kept, with("density: 2550, placement", "density: 2550, contact: {friction: 1}, placement"), false)
          .size(),
      1u);
}

TEST(CaseChanges, AWallIsWhereItsMotionSinceTheStartHasBroughtIt) {
  const std::vector<CaseChange> plate{{"walls.0.velocity.2", "0.1", "0"}},
      top{{"domain.boundaries.top.velocity.0", "0.1", "0"}}, held{{"grains.1.motion.velocity.0", "0.1", "0"}};
  EXPECT_THROW(refuse_changes_of_state(plate, false), InputError);
  EXPECT_THROW(refuse_changes_of_state(held, false), InputError);
  EXPECT_THROW(refuse_changes_of_state(top, true), InputError);
  EXPECT_NO_THROW(refuse_changes_of_state(top, false));  // of a fluid, in its own plane
}

// As a disk error or an editor may leave it.
TEST(CaseChanges, OfACaseThatIsDamagedAreRefused) {
  EXPECT_THROW(case_changes("run: {until: 1", "run: {until: 1}"), InputError);
  EXPECT_TRUE(case_changes("run: {until: 1}", "run: {until: 1}").empty());
}

}  // namespace
}  // namespace thalweg::driver::case_changes_test
