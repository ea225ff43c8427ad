#include "driver/case/preset.hpp"

#include "driver/estimate/contact_stiffness.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/driver/text_search.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace thalweg::driver::preset_test {
namespace {

using testing::message_of;
using testing::put;
using testing::ScratchFolder;

// A case without the keys that the preset sets, but for the friction of walls.
const std::string published = R"(system: resolved
preset: zhang2022
domain:
  size: [0.060, 0.0105, 0.075]
  spacing: 0.5e-3
  boundaries: {x: periodic, bottom: no_slip, top: free_slip}
fluid: {density: 1000, kinematic_viscosity: 1.0e-6, time_step: 2.0e-5}
gravity: {magnitude: 9.8, slope: 0.07}
grains: [{count: 150, diameter: 4.95e-3, density: 2550}]
contact:
  wall_friction: 0.3
run: {until: 3.0}
)";

Case read(const std::vector<std::string>& overrides = {}) { return testing::read_text(published, overrides); }

// Zhang et al. 2022, section 2; their load and bulk viscosity do not run (docs/stability.md).
TEST(Preset, SetsWhatIsPublished) {
  const Case c = read();
  EXPECT_EQ(c.fluid.collision, lbm::CollisionModel::bgk);
  EXPECT_EQ(c.fluid.subgrid(), lbm::Subgrid::smagorinsky(0.27));
  EXPECT_EQ(c.contact.normal_stiffness, 20000.0);
  EXPECT_EQ(c.contact.tangential_stiffness, 5714.0);
  EXPECT_EQ(*c.contact.damping, 0.09);
  EXPECT_EQ(c.contact.friction, 0.5);
  EXPECT_EQ(c.coupling.grain_steps_per_fluid_step, 50);
  EXPECT_EQ(c.domain.faces[y_low].type, lbm::FaceType::slip_law_of_the_wall);
  EXPECT_EQ(c.domain.faces[y_high], c.domain.faces[y_low]);
  EXPECT_TRUE(contains(c.filled_in.preset, "zhang2022 sets "));
  EXPECT_TRUE(contains(c.filled_in.preset, "fluid.collision: bgk, "));
}

TEST(Preset, LetsTheCaseWin) {
  const Case c = read({"coupling.grain_steps_per_fluid_step=20", "domain.boundaries.y=periodic"});
  EXPECT_EQ(c.contact.wall_friction, 0.3);
  EXPECT_EQ(c.coupling.grain_steps_per_fluid_step, 20);
  EXPECT_EQ(c.domain.faces[y_low].type, lbm::FaceType::periodic);
  const std::string own = c.filled_in.preset.substr(c.filled_in.preset.find("by the case itself"));
  for (const char* key : {"contact.wall_friction", "coupling.grain_steps_per_fluid_step", "domain.boundaries.y"})
    EXPECT_TRUE(contains(own, key)) << own;
}

// A key that excludes one of the preset takes its place.
TEST(Preset, GivesWayToAlternatives) {
  const Case c = read({"contact.restitution=0.9", "contact.duration=1.0e-3", "domain.boundaries.y_low=no_slip",
                       "domain.boundaries.y_high=free_slip"});
  EXPECT_FALSE(c.contact.damping);
  EXPECT_NEAR(contact_duration(c), 1e-3, 1e-15);
  EXPECT_EQ(c.contact.tangential_stiffness, 2.0 / 7.0 * c.contact.normal_stiffness);
  EXPECT_EQ(c.domain.faces[y_low].type, lbm::FaceType::no_slip);
  EXPECT_EQ(c.domain.faces[y_high].type, lbm::FaceType::free_slip);
  const Case modern = read({"fluid.subgrid_model=qr", "fluid.collision=trt_at_bodies"});
  EXPECT_EQ(modern.fluid.subgrid(), lbm::Subgrid::qr());
  const Case elastic = read({"contact={law: hertz_mindlin, youngs_modulus: 1.0e7, restitution: 0.9}"});
  EXPECT_EQ(elastic.contact.law, dem::Law::hertz_mindlin);
}

TEST(Preset, IsPartOfWhatIsKept) {
  const Case c = read();
  EXPECT_EQ(testing::read_text(resolved_yaml(c)), c) << resolved_yaml(c);
  EXPECT_FALSE(contains(resolved_yaml(c), "preset"));
}

TEST(Preset, IsRefusedWithThePlaceAndTheNames) {
  const ScratchFolder folder;
  put(folder / "case.yaml", published);
  const auto message = [&](const std::vector<std::string>& overrides) {
    return message_of<InputError>([&] { read_case(folder / "case.yaml", overrides); });
  };
  EXPECT_TRUE(contains(message({"preset=zhang"}), "preset = \"zhang\": there is no such preset; expected zhang2022."));
  EXPECT_TRUE(contains(message({"system=grains"}), "case.yaml:2: preset = \"zhang2022\": it is for system: resolved"));
  // Keys of the case are located in the case, those of the preset in the preset; a removed key stays out.
  EXPECT_TRUE(contains(message({"contact.friction=-1"}), "--set contact.friction=-1: contact.friction = -1"));
  // A key that is missing in a section of the preset is missing in the case.
  std::string without = published;
  const std::size_t fluid = without.find("fluid: ");
  without.erase(fluid, without.find("gravity: ") - fluid);
  put(folder / "case.yaml", without);
  EXPECT_TRUE(contains(message({}), "case.yaml:1: fluid.density is missing"));
  put(folder / "case.yaml", published + "coupling: {load: wrong}\n");
  EXPECT_TRUE(contains(message({}), "case.yaml:13: coupling.load = \"wrong\""));
  put(folder / "case.yaml", published);
  EXPECT_TRUE(contains(message({"contact.damping=null"}), "contact.restitution: the loss in a collision is missing"));
  EXPECT_TRUE(contains(
      message({"fluid.time_step=2.0e-3"}),
      "case.yaml:2: preset zhang2022:19: coupling.grain_steps_per_fluid_step = 50: a step of the grains of 4e-05 s"));
}

TEST(Preset, IsShownAsItIs) {
  EXPECT_EQ(defaults_yaml("zhang2022"), *preset_text("zhang2022"));
  EXPECT_FALSE(preset_text("zhang"));
  EXPECT_TRUE(contains(message_of<InputError>([] { defaults_yaml("zhang"); }), "a preset (zhang2022)"));
}

}  // namespace
}  // namespace thalweg::driver::preset_test
