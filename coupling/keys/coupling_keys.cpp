#include "coupling/keys/coupling_keys.hpp"

namespace thalweg::coupling {

static void describe(SectionVisitor& visit, LubricationKeys& lubrication) {
  visit.real(
      "normal_cut_off", lubrication.normal_cut_off,
      {.unit = "cells", .meaning = "gap below which the squeezing flow is not resolved", .above = 0.0, .at_most = 2.0});
  visit.real("tangential_cut_off", lubrication.tangential_cut_off,
             {.unit = "cells",
              .meaning = "the same for sliding and rolling; 0: no correction for them",
              .at_least = 0.0,
              .at_most = 2.0});
  visit.real("minimum_gap", lubrication.minimum_gap,
             {.unit = "radii",
              .meaning = "narrower gaps count as this one, the roughness of the grains",
              .at_least = 1e-6,
              .at_most = 0.1});
}

// Keys of earlier versions.
static void refuse_former_keys(SectionVisitor& visit) {
  visit.not_here("mass_correction", "the fluid's mass is always kept; remove the key");
  visit.not_here("narrow_gaps", "water flows in narrow gaps with the default fluid.collision; remove the key");
  visit.not_here("refill", "uncovered cells begin with the equilibrium of their neighbours' density; remove the key");
  visit.not_here("wall_density", "the moving-wall term has the density of the fluid cell; remove the key");
  visit.not_here("link_tolerance",
                 "the cells of a grain are updated when it has moved by 0.001 of a cell; remove the key");
  visit.not_here("virtual_mass", "light grains are stable without it; remove the key");
  visit.not_here("near_contact",
                 "patches that grains hide from each other always count with the pressure around them; remove the key");
  visit.not_here("mass_balance",
                 "mass_by_links and the columns beside it in series.csv show where mass goes; remove the key");
  visit.not_here(
      "grain_stress",
      "frames of the grains have fluid_stress and the stress balance measures what it needs; remove the key");
}

void describe(SectionVisitor& visit, CouplingKeys& coupling, bool with_grains) {
  visit.choice("links", coupling.links, {.meaning = "interpolated bounce-back at grain surfaces"});
  refuse_former_keys(visit);
  if (!with_grains) {
    for (const char* key :
         {"grain_steps_per_fluid_step", "fewest_cells_per_diameter", "momentum_exchange", "covered_momentum", "load"})
      visit.not_here(key, "system: fluid has no grains; remove the key or set system: resolved");
    return;
  }
  visit.integer("grain_steps_per_fluid_step", coupling.grain_steps_per_fluid_step,
                {.meaning = "sub-steps of the grains in one step of the fluid; auto: as many as contacts (20 in the "
                            "shortest) and lubrication need",
                 .at_least = 1,
                 .automatic = CouplingKeys::as_many_as_needed});
  visit.real(
      "fewest_cells_per_diameter", coupling.fewest_cells_per_diameter,
      {.meaning = "across the narrowest grain (of a clump, its shortest axis); with fewer, check warns", .above = 0.0});
  visit.choice("momentum_exchange", coupling.momentum_exchange, {.meaning = "how the force on a grain is summed"});
  visit.choice<CoveredMomentum>(
      "covered_momentum", coupling.covered_momentum,
      {{CoveredMomentum::lost, "lost", "as published: grains get a little less than the fluid loses"},
       {CoveredMomentum::to_grain, "to_grain"}},
      {.meaning = "momentum, relative to the grain, of a cell that a grain covers"});
  visit.choice(
      "load", coupling.load, choices_of(LoadAveraging{}),
      {.meaning = "force and torque of the fluid that move a grain in a step; for light grains always filtered"});
  visit.section("lubrication", coupling.lubrication,
                {.meaning = "adds the force between near surfaces that the cells do not resolve, in every sub-step; "
                            "{}: with the defaults"});
}

}  // namespace thalweg::coupling
