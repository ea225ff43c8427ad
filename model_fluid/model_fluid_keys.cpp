#include "model_fluid/model_fluid_keys.hpp"

#include "core/keys/key_error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace thalweg::model_fluid {

namespace {

VelocityProfile profile_of(const ModelFluidKeys& fluid, bool disks) {
  VelocityProfile profile = disks ? VelocityProfile::of_disks() : VelocityProfile::of_spheres();
  profile.decay = fluid.decay;
  profile.top = fluid.top_fraction.value_or(profile.top);
  profile.densest = fluid.densest_fraction;
  return profile;
}

ShieldsRampParameters ramp_parameters(const ShieldsRampKeys& ramp, const GrainScales& s) {
  const double speed = std::sqrt(s.gravity * s.diameter);
  return {
      ramp.step, ramp.every, ramp.hold, ramp.mobile_share, ramp.largest_speed, ramp.largest_acceleration * s.gravity,
      speed};
}

}  // namespace

void describe(SectionVisitor& visit, ShieldsRampKeys& ramp) {
  visit.real("step", ramp.step, {.meaning = "relative step of the Shields number", .above = 0.0, .at_most = 1.0});
  visit.real(
      "every", ramp.every,
      {.unit = "s", .meaning = "shortest time between two steps", .required = true, .above = 0.0, .example = 5.0});
  visit.real("hold", ramp.hold,
             {.unit = "s",
              .meaning = "motion that lasts longer counts as endless and finishes the run",
              .required = true,
              .above = 0.0,
              .example = 1000.0});
  visit.require(ramp.hold > ramp.every, "hold", "it must be longer than `every`; give for example 100 times as much");
  visit.real("mobile_share", ramp.mobile_share,
             {.meaning = "if a larger share of the grains is faster than sqrt(g'D), their motion counts as endless at "
                         "once; 1: only `hold` counts",
              .above = 0.0,
              .at_most = 1.0});
  visit.real("largest_speed", ramp.largest_speed,
             {.unit = "v_0", .meaning = "largest speed of a grain at rest", .above = 0.0});
  visit.real("largest_acceleration", ramp.largest_acceleration,
             {.unit = "g'", .meaning = "largest acceleration of a grain at rest", .above = 0.0});
}

ModelFluidNumbers ModelFluidKeys::numbers() const {
  const double printed = reynolds_number ? *reynolds_number : *shear_reynolds_number / printed_to_physical_reynolds;
  return {shields_number, printed, lift_ratio, *drag, inertial_coefficient};
}

void describe(SectionVisitor& visit, ModelFluidKeys& fluid, bool disks) {
  visit.real("shields_number", fluid.shields_number,
             {.meaning = "drag at the top of the bed over the weight of the mean grain, times 2/3",
              .required = true,
              .above = 0.0,
              .example = 0.1});
  visit.real("reynolds_number", fluid.reynolds_number,
             {.meaning = "Re_* as printed by Clark et al. (2017): sqrt(3) (m/B_1) sqrt(shields_number g'/D); with a "
                         "ramp that of the first Shields number",
              .above = 0.0,
              .example = 1.0});
  visit.real("shear_reynolds_number", fluid.shear_reynolds_number,
             {.meaning = "u_* D/nu, in place of reynolds_number and six times as large", .above = 0.0, .example = 6.0});
  visit.require(fluid.reynolds_number || fluid.shear_reynolds_number, "reynolds_number",
                "the Reynolds number is missing; give reynolds_number, as printed, or shear_reynolds_number");
  visit.require(!fluid.reynolds_number || !fluid.shear_reynolds_number, "shear_reynolds_number",
                "the Reynolds number is given twice; remove this key or reynolds_number");
  visit.choice<ModelDrag>(
      "drag", fluid.drag,
      {{ModelDrag::linear, "linear", "B_1 w"}, {ModelDrag::quadratic, "quadratic", "B_1 w + B_2 |w| w"}},
      {.meaning = "force at a velocity w of the fluid relative to the grain"});
  visit.require(fluid.drag.has_value(), "drag", "the drag law is missing; give linear or quadratic");
  const bool quadratic = fluid.drag == ModelDrag::quadratic;
  visit.real("inertial_coefficient", fluid.inertial_coefficient,
             {.meaning = "B_2 D/m of the mean grain",
              .above = 0.0,
              .only_if = {quadratic, "only quadratic drag has it; remove it"}});
  visit.real("lift_ratio", fluid.lift_ratio, {.meaning = "lift over drag at the top of the bed", .at_least = 0.0});
  visit.real("fluid_density", fluid.fluid_density,
             {.unit = "kg/m^3", .meaning = "for the buoyancy; 0: gravity is the reduced gravity", .at_least = 0.0});
  visit.real("decay", fluid.decay, {.meaning = "b of exp(-b phi)", .above = 0.0});
  visit.real("top_fraction", fluid.top_fraction,
             {.meaning = "solid fraction at the top of the bed, where the fluid has its velocity; default: 0.42, of "
                         "disks 0.5",
              .above = 0.0,
              .below = 1.0,
              .example = 0.42});
  visit.real("densest_fraction", fluid.densest_fraction,
             {.meaning = "solid fraction at which the fluid is at rest",
              .above = 0.0,
              .below = 1.0,
              .only_if = {!disks, "the velocity of the fluid among disks has no zero; remove it"}});
  visit.require(disks || fluid.densest_fraction > fluid.top_fraction.value_or(VelocityProfile::of_spheres().top),
                "densest_fraction", "it must be larger than top_fraction; give for example 0.7");
  visit.real(
      "margin", fluid.margin,
      {.unit = "m",
       .meaning = "distance around a grain within which the solid fraction counts; default: the largest diameter",
       .above = 0.0,
       .example = 5e-3});
  visit.real("tolerance", fluid.tolerance,
             {.unit = "diameters",
              .meaning = "distance a grain moves before solid fractions are computed again",
              .at_least = 0.0,
              .at_most = 0.1});
  visit.section("ramp", fluid.ramp,
                {.meaning = "raises the Shields number by a step whenever all grains are at rest, until motion does "
                            "not end: the threshold of the bed"});
  visit.flag("rough_floor", fluid.rough_floor, {.meaning = "grains that touch the floor do not move along it"});
  visit.choice<ModelUnits>(
      "units", fluid.units,
      {{ModelUnits::si, "si"},
       {ModelUnits::grain, "grain", "mean diameter, mean mass and reduced gravity are 1, which is checked"}},
      {.meaning = "of all numbers of the case"});
}

std::optional<std::string> units_text(const ModelFluidKeys& fluid) {
  if (fluid.units == ModelUnits::si) return std::nullopt;
  return "grain units: m stands for the mean diameter D, s for sqrt(D/g'), kg for the mean mass";
}

GrainScales scales_of(const ModelFluidKeys& fluid, const MeanGrain& mean, double gravity) {
  return {mean.diameter, mean.mass, gravity * (1.0 - fluid.fluid_density * mean.volume / mean.mass)};
}

void check(const ModelFluidKeys& fluid, const MeanGrain& mean, double gravity) {
  const GrainScales scales = scales_of(fluid, mean, gravity);
  if (!(scales.gravity > 0.0))
    throw KeyError("fluid_density", "the grains float; give a fluid lighter than the grains, in kg/m^3");
  constexpr double tolerance = 1e-6;
  const auto is_one = [](double value) { return std::abs(value - 1.0) < tolerance; };
  if (fluid.units == ModelUnits::grain && !(is_one(scales.diameter) && is_one(scales.mass) && is_one(scales.gravity)))
    throw KeyError("units",
                   fmt::format("in grain units mean diameter, mean mass and reduced gravity are 1, and here they "
                               "are {:.6g}, {:.6g} and {:.6g}; give units: si, or change grains and gravity",
                               scales.diameter, scales.mass, scales.gravity));
}

ModelFluidParameters model_fluid_parameters(const ModelFluidKeys& fluid, const MeanGrain& mean, double gravity,
                                            bool disks) {
  ModelFluidParameters parameters;
  const GrainScales scales = scales_of(fluid, mean, gravity);
  parameters.numbers = fluid.numbers();
  parameters.scales = scales;
  parameters.profile = profile_of(fluid, disks);
  parameters.solid_fraction.largest_radius = 0.5 * mean.largest_diameter;
  parameters.solid_fraction.margin = fluid.margin.value_or(mean.largest_diameter);
  parameters.solid_fraction.tolerance = fluid.tolerance * mean.diameter;
  parameters.solid_fraction.disks = disks;
  parameters.solid_fraction.lift = fluid.lift_ratio > 0.0;
  parameters.solid_fraction.clumps = mean.longest > 0.0;
  parameters.solid_fraction.largest_member = 0.5 * mean.largest_member;
  parameters.solid_fraction.largest_offset = 0.5 * mean.longest;
  if (fluid.ramp) parameters.ramp = ramp_parameters(*fluid.ramp, scales);
  return parameters;
}

}  // namespace thalweg::model_fluid
