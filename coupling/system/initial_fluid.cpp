#include "coupling/system/initial_fluid.hpp"

#include "lbm/fluid/solenoidal_noise.hpp"
#include "lbm/walls/law_of_the_wall.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::coupling {

static void describe(SectionVisitor& visit, PerturbationKeys& perturbation) {
  visit.real("amplitude", perturbation.amplitude,
             {.meaning = "r.m.s. of a velocity component far from walls, over shear_velocity", .above = 0.0});
  visit.integer("seed", perturbation.seed, {.meaning = "seed of the random eddies", .at_least = 0});
}

static void describe(SectionVisitor& visit, LogProfileKeys& profile) {
  visit.real("bed_height", profile.bed_height,
             {.unit = "m",
              .meaning = "above the bottom; the fluid below is at rest; default: that of the settled bed",
              .at_least = 0.0,
              .example = 0.06});
  visit.real(
      "shear_velocity", profile.shear_velocity,
      {.unit = "m/s",
       .meaning =
           "u(z) = shear_velocity / 0.41 ln((z - bed_height) / roughness), negative towards -x; default: that of "
           "the flow that develops",
       .example = 0.08});
  visit.require(profile.shear_velocity != 0.0, "shear_velocity",
                "without a shear velocity the fluid is at rest; give one in m/s, or initial.fluid: rest");
  visit.real("roughness", profile.roughness,
             {.unit = "m",
              .meaning = "height above the bed at which the velocity is zero; default: a fifteenth of the largest "
                         "diameter, or that of a smooth floor",
              .above = 0.0,
              .example = 3.3e-4});
  visit.section("perturbation", profile.perturbation,
                {.meaning = "divergence-free random eddies, added to the profile"});
}

static void describe(SectionVisitor& visit, LinearProfileKeys& profile) {
  visit.real("lower", profile.lower,
             {.unit = "m", .meaning = "above the bottom; the fluid below is at rest", .at_least = 0.0});
  visit.real("upper", profile.upper,
             {.unit = "m",
              .meaning = "above the bottom; the fluid above has the full velocity",
              .required = true,
              .above = 0.0,
              .example = 0.04});
  visit.vec3("velocity", profile.velocity, {.unit = "m/s", .meaning = "at `upper`", .required = true, .example = 0.0});
  visit.require(profile.upper > profile.lower, "upper", "give a height above lower");
}

void describe(SectionVisitor& visit, InitialFluidKeys& fluid) {
  visit.vec3("uniform", fluid.uniform, {.unit = "m/s", .meaning = "the same velocity everywhere", .example = 0.0});
  visit.section("linear_profile", fluid.linear_profile,
                {.meaning = "velocity that rises linearly with height, as in simple shear"});
  visit.section("log_profile", fluid.log_profile, {.meaning = "a turbulent profile along x over a bed"});
  visit.require(fluid.count() <= 1, fluid.uniform ? "uniform" : "linear_profile",
                "the start is given twice; give only one of uniform, linear_profile and log_profile");
}

namespace {

using InitialFluid = std::function<FluidInitialState(const Vec3&)>;

InitialFluid with_perturbation(const LogProfileKeys& profile, const InitialFluid& calm, const Index3& cells,
                               const std::array<bool, 3>& periodic, double spacing) {
  const double strength = std::abs(*profile.shear_velocity) * profile.perturbation->amplitude;
  const lbm::NoiseBox box{cells, periodic, *profile.bed_height / spacing};
  const lbm::SolenoidalNoise noise(box, static_cast<std::uint64_t>(profile.perturbation->seed));
  return [calm, noise, strength, spacing](const Vec3& position) {
    FluidInitialState state = calm(position);
    Index3 cell;
    for (int a = 0; a < 3; ++a) cell[a] = static_cast<int>(std::floor(position[a] / spacing));
    state.velocity += strength * noise.velocity(cell);
    return state;
  };
}

}  // namespace

InitialFluid initial_fluid(const InitialFluidKeys& fluid, const Index3& cells, const std::array<bool, 3>& periodic,
                           double spacing) {
  if (fluid.uniform) return [u = *fluid.uniform](const Vec3&) { return FluidInitialState{0.0, u}; };
  if (fluid.linear_profile)
    return [profile = *fluid.linear_profile](const Vec3& position) {
      const double share = (position.z() - profile.lower) / (profile.upper - profile.lower);
      return FluidInitialState{0.0, std::clamp(share, 0.0, 1.0) * profile.velocity};
    };
  if (!fluid.log_profile) return {};
  const InitialFluid calm = [profile = *fluid.log_profile](const Vec3& position) {
    const double height = position.z() - *profile.bed_height;
    FluidInitialState state;
    if (height > *profile.roughness)
      state.velocity.x() = *profile.shear_velocity / lbm::karman_constant * std::log(height / *profile.roughness);
    return state;
  };
  return fluid.log_profile->perturbation ? with_perturbation(*fluid.log_profile, calm, cells, periodic, spacing) : calm;
}

}  // namespace thalweg::coupling
