#include "dem/laws/contact_parameters.hpp"

#include "core/base/error.hpp"
#include "core/keys/section_visitor.hpp"

#include <fmt/format.h>

#include <cmath>

namespace thalweg::dem {

std::vector<NamedChoice<Law>> choices_of(Law) {
  return {{Law::linear, "linear", "spring and dashpot"},
          {Law::hertz_mindlin, "hertz_mindlin", "elastic spheres, by youngs_modulus"}};
}

static void describe(SectionVisitor& visit, LiquidBridgeParameters& bridge) {
  visit.real("surface_tension", bridge.surface_tension,
             {.unit = "N/m", .meaning = "of the liquid", .required = true, .at_least = 0.0, .example = 0.073});
  visit.real("contact_angle", bridge.contact_angle,
             {.unit = "rad", .meaning = "between liquid and grain", .at_least = 0.0, .below = 1.57});
  visit.real("volume", bridge.volume,
             {.unit = "m^3",
              .meaning = "of each bridge, which breaks at a gap of (1 + contact_angle/2) volume^(1/3)",
              .required = true,
              .above = 0.0,
              .example = 1e-11});
}

static void describe(SectionVisitor& visit, ContactDuration& duration) {
  visit.real("seconds", duration.seconds, {.unit = "s", .meaning = "of a collision", .above = 0.0, .example = 1.6e-3});
  visit.real("fluid_steps", duration.fluid_steps,
             {.unit = "steps of the fluid", .meaning = "in place of seconds", .above = 0.0, .example = 40.0});
  visit.require(duration.seconds.has_value() != duration.fluid_steps.has_value(), "seconds",
                "give either seconds or fluid_steps");
}

static void describe_stiffness(SectionVisitor& visit, StiffnessKeys& stiffness, const OnlyIf& linear) {
  visit.section("duration", stiffness.duration,
                {.meaning = "of a collision of the two lightest free grains, half a period of its spring, in place of "
                            "normal_stiffness; in s, or {fluid_steps: 40}; default in a fluid: 4 fluid steps for each "
                            "cell of the smallest diameter, or less where overlaps would be too large",
                 .shorthand = "seconds",
                 .expected = "a number in s above 0, for example 0.0016, or {fluid_steps: 40}",
                 .only_if = linear});
  visit.real("normal_stiffness", stiffness.normal,
             {.unit = "N/m",
              .meaning = "of the normal spring; default: from the duration, without a fluid 20000",
              .above = 0.0,
              .example = 20000.0,
              .only_if = linear});
  visit.require(!(stiffness.duration && stiffness.normal), "normal_stiffness",
                "contact.duration already sets the stiffness; give one of the two");
  visit.real("tangential_stiffness", stiffness.tangential,
             {.unit = "N/m",
              .meaning = "of the tangential spring; default: 2/7 of the normal one",
              .above = 0.0,
              .example = 5714.0,
              .only_if = linear});
}

void describe(SectionVisitor& visit, ContactParameters& contact, StiffnessKeys& stiffness) {
  visit.choice("law", contact.law, {.meaning = "force of a contact"});
  const OnlyIf linear{contact.law == Law::linear,
                      "elastic spheres have youngs_modulus, poisson_ratio and restitution; remove it or set law: "
                      "linear"};
  const OnlyIf elastic{contact.law == Law::hertz_mindlin,
                       "the linear law has stiffnesses; remove it or set law: hertz_mindlin", "law: hertz_mindlin"};
  describe_stiffness(visit, stiffness, linear);
  visit.real("youngs_modulus", contact.youngs_modulus,
             {.unit = "Pa",
              .meaning = "of grains and walls",
              .required = true,
              .above = 0.0,
              .example = 70e9,
              .only_if = elastic});
  visit.real("poisson_ratio", contact.poisson_ratio,
             {.meaning = "of grains and walls", .at_least = 0.0, .at_most = 0.5, .only_if = elastic});
  visit.real("tangential_damping", contact.tangential_damping,
             {.meaning = "tangential over normal damping coefficient", .at_least = 0.0});
  visit.real("restitution", contact.restitution,
             {.meaning = "coefficient of restitution of a dry collision (in a fluid the film between the grains damps "
                         "slow ones critically); or give damping",
              .above = 0.0,
              .at_most = 1.0,
              .example = 0.93});
  visit.real("damping", contact.damping,
             {.unit = "kg/s",
              .meaning = "of the dashpot across a contact, in place of restitution",
              .at_least = 0.0,
              .example = 0.09,
              .only_if = linear});
  visit.require(!(contact.restitution && contact.damping), "restitution",
                "the loss in a collision is given twice; give either restitution or damping");
  visit.real("friction", contact.friction, {.meaning = "coefficient between grains", .at_least = 0.0});
  visit.real("wall_friction", contact.wall_friction,
             {.meaning = "coefficient between grain and wall", .at_least = 0.0});
  visit.real("kinetic_friction_ratio", contact.kinetic_friction_ratio,
             {.meaning = "kinetic over static friction: coefficient of sliding contacts over that of sticking ones",
              .above = 0.0,
              .at_most = 1.0,
              .example = 0.8});
  visit.real("rolling_friction", contact.rolling_friction,
             {.meaning = "rolling moment over normal force times radius R1 R2/(R1 + R2), between grains; 0: none",
              .at_least = 0.0});
  visit.real("wall_rolling_friction", contact.wall_rolling_friction,
             {.meaning = "the same between grain and wall", .at_least = 0.0});
  visit.real("rolling_damping", contact.rolling_damping,
             {.meaning = "of the rolling spring, over the critical damping", .at_least = 0.0});
  visit.choice<bool>("attraction", contact.attraction,
                     {{false, "none", "the force never pulls"},
                      {true, "allowed", "the dashpot may pull as grains part, as in the linear law"}},
                     {.meaning = "sign of the normal force"});
  visit.section("liquid_bridge", contact.liquid_bridge,
                {.meaning = "liquid bridges between grains, and between grains and walls, that have touched"});
}

void require(bool good, const char* name, double value, const char* unit, const char* remedy) {
  if (!good) throw InputError(fmt::format("Contact parameter {} is {:g}{}; it must be {}.", name, value, unit, remedy));
}

void require_not_negative(const char* name, double value, const char* unit) {
  require(std::isfinite(value) && value >= 0.0, name, value, unit, "zero or positive");
}

}  // namespace thalweg::dem
