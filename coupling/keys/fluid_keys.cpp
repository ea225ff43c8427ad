#include "coupling/keys/fluid_keys.hpp"

namespace thalweg::coupling {

static void describe(SectionVisitor& visit, FlowTargetKeys& target) {
  visit.real("velocity", target.velocity,
             {.unit = "m/s", .meaning = "mean over the fluid, along x", .required = true, .example = 0.3});
  visit.real("response_time", target.response_time,
             {.unit = "s",
              .meaning = "response time of the force; at most the time the flow needs to come to rest",
              .required = true,
              .above = 0.0,
              .example = 0.1});
  visit.flag("on_grains", target.on_grains,
             {.meaning = "the force is a pressure gradient, which acts on grains, too; false: on the fluid alone"});
}

// The constant of Zhang et al. (2022).
constexpr double published_smagorinsky_constant = 0.27;

lbm::Subgrid FluidKeys::subgrid() const {
  using lbm::SubgridModel;
  switch (subgrid_model.value_or(smagorinsky_constant ? SubgridModel::smagorinsky : SubgridModel::qr)) {
    case SubgridModel::none:
      return lbm::Subgrid::none();
    case SubgridModel::smagorinsky:
      return lbm::Subgrid::smagorinsky(smagorinsky_constant.value_or(published_smagorinsky_constant));
    case SubgridModel::qr:
      return lbm::Subgrid::qr();
  }
  return {};
}

void FluidKeys::fill_in_models() {
  if (lbm::traits_of(collision).is_trt_near_bodies) magic_parameter = magic();
  const lbm::Subgrid read = subgrid();
  subgrid_model = read.model();
  if (read.model() == lbm::SubgridModel::smagorinsky) smagorinsky_constant = read.constant();
}

void describe(SectionVisitor& visit, FluidKeys& fluid) {
  visit.real("density", fluid.density,
             {.unit = "kg/m^3", .meaning = "mass density", .required = true, .above = 0.0, .example = 1000.0});
  visit.real("kinematic_viscosity", fluid.kinematic_viscosity,
             {.unit = "m^2/s", .meaning = "molecular viscosity", .required = true, .above = 0.0, .example = 1e-6});
  visit.choice(
      "subgrid_model", fluid.subgrid_model, choices_of(lbm::SubgridModel{}),
      {.meaning =
           "model of the eddies that cells do not resolve; default: smagorinsky where its constant is given, else qr"});
  visit.real("smagorinsky_constant", fluid.smagorinsky_constant,
             {.meaning = "C_s of subgrid_model: smagorinsky",
              .at_least = 0.0,
              .below = 1.0,
              .example = published_smagorinsky_constant});
  visit.require(fluid.smagorinsky_constant != 0.0, "smagorinsky_constant",
                "a constant of zero is no subgrid model; write subgrid_model: none");
  visit.require(
      !fluid.smagorinsky_constant || !fluid.subgrid_model || *fluid.subgrid_model == lbm::SubgridModel::smagorinsky,
      "smagorinsky_constant", "only subgrid_model: smagorinsky has this constant; remove one of the two");
  visit.real("time_step", fluid.time_step,
             {.unit = "s",
              .meaning = "of the fluid; default: as long as its speed and viscosity allow (thalweg check prints it)",
              .above = 0.0,
              .example = 2e-5});
  for (const char* removed : {"maximum_lattice_velocity", "expected_velocity"})
    visit.not_here(removed, "the step follows from the flow by default; remove the key, or give time_step in s");
  visit.choice(
      "collision", fluid.collision,
      {.meaning = "collision operator",
       .removed = {{"regularised",
                    "it was unstable along walls and has been removed; write trt_at_bodies, or remove the key"}}});
  visit.real(
      "magic_parameter", fluid.magic_parameter,
      {.meaning =
           "of trt and trt_at_bodies: (1/omega+ - 1/2)(1/omega- - 1/2); default: 3/16 with trt, which puts walls "
           "exactly half way between cell centres, 1/4 with trt_at_bodies, which damps disturbances fastest",
       .above = 0.0,
       .example = 0.1875,
       .only_if = {lbm::traits_of(fluid.collision).is_trt_near_bodies,
                   "only collision trt and trt_at_bodies have a magic parameter; remove it",
                   "collision: trt or trt_at_bodies"}});
  visit.real(
      "bulk_relaxation_time", fluid.bulk_relaxation_time,
      {.meaning =
           "relaxation time of the trace of the stress, in steps; damps only sound, by a bulk viscosity of 2/9 (tau - "
           "1/2); 0: the same as for shear, as published; default: 1 with bgk or trt_at_bodies and a subgrid model, "
           "else 0",
       .at_least = 0.0,
       .at_most = 1000.0,
       .example = 1.0});
  const double bulk = fluid.bulk_relaxation_time.value_or(0.0);
  visit.require(bulk == 0.0 || bulk > 0.5, "bulk_relaxation_time",
                "a fluid damps sound only above 1/2; give more than 0.5 steps, for example 1, or 0 for that of shear");
  visit.choice<Precision>("precision", fluid.precision, {{Precision::single, "single"}, {Precision::double_, "double"}},
                          {.meaning = "of the stored populations"});
  visit.section("mean_velocity", fluid.mean_velocity,
                {.meaning = "maintain this mean flow by a body force along x, in place of gravity along x"});
}

}  // namespace thalweg::coupling
