// Case files with a mistake: a table of bad input with what the user reads about it.
#include "core/base/error.hpp"
#include "driver/input/case_reader.hpp"
#include "tests/driver/case_texts.hpp"

#include <gtest/gtest.h>

namespace thalweg::driver::refused_cases_test {
namespace {

using testing::flume;
using testing::message_of;

struct Bad {
  std::string name;
  std::vector<std::string> overrides;
  std::vector<std::string> parts;  // of the message, in order
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

class BadCase : public ::testing::TestWithParam<Bad> {};

TEST_P(BadCase, IsRefusedInOneSentence) {
  const std::string message = message_of<InputError>([&] { testing::read_text(flume, GetParam().overrides); });
  std::size_t at = 0;
  for (const std::string& part : GetParam().parts) {
    const std::size_t found = message.find(part, at);
    ASSERT_NE(found, std::string::npos) << "\"" << part << "\" in: " << message;
    at = found + part.size();
  }
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_TRUE(message.ends_with('.') || message.ends_with('?')) << message;
}

INSTANTIATE_TEST_SUITE_P(
    All, BadCase,
    ::testing::Values(
        Bad{"system_not_built",
            {"system=shallow_water"},
            {"system = \"shallow_water\": expected one of resolved, fluid, grains, model_fluid, continuum."}},
        Bad{"collision_not_built",
            {"fluid.collision=mrt"},
            {"fluid.collision = \"mrt\": expected one of bgk, trt, trt_at_bodies."}},
        Bad{"collision_removed",
            {"fluid.collision=regularised"},
            {"fluid.collision = \"regularised\": it was unstable along walls and is gone; write trt_at_bodies, or "
             "remove "
             "the key."}},
        Bad{"subgrid_constant_of_zero",
            {"fluid.smagorinsky_constant=0"},
            {"fluid.smagorinsky_constant = 0: a constant of zero is no subgrid model; write subgrid_model: none."}},
        Bad{"subgrid_constant_of_another_model",
            {"fluid.subgrid_model=qr"},
            {"fluid.smagorinsky_constant = 0.27: only subgrid_model: smagorinsky has this constant; remove one of the "
             "two."}},
        Bad{"face_not_built",
            {"domain.boundaries.top=porous"},
            {"top.type = \"porous\": expected one of periodic, no_slip, free_slip, moving, navier_slip, "
             "law_of_the_wall, slip_law_of_the_wall, velocity_inlet, pressure_outlet."}},
        Bad{"face_as_printed",
            {"domain.boundaries.top=law_of_the_wall_as_printed"},
            {"domain.boundaries.top.type = \"law_of_the_wall_as_printed\": the law with the coefficient that is "
             "printed is "
             "{type: slip_law_of_the_wall, coefficient: 2.35}; write that."}},
        Bad{"face_on_node",
            {"domain.boundaries.top={type: navier_slip, slip_length: 1e-4, on_node: true}"},
            {"domain.boundaries.top.on_node = \"true\": faces lie half a cell beyond the last cell centres; remove the "
             "key."}},
        Bad{"coefficient_of_the_law",
            {"domain.boundaries.top={type: law_of_the_wall, coefficient: 8.36}"},
            {"domain.boundaries.top.coefficient = 8.36: a law_of_the_wall imposes the stress of the law and has no "
             "coefficient; remove the key, or write type: slip_law_of_the_wall, which is the slip as published."}},
        Bad{"first_cell_of_the_law",
            {"domain.boundaries.top={type: law_of_the_wall, of_first_cell: true}"},
            {"domain.boundaries.top.of_first_cell = \"true\": a law_of_the_wall imposes the stress",
             "type: slip_law_of_the_wall"}},
        Bad{"both_coefficients",
            {"domain.boundaries.top={type: slip_law_of_the_wall, of_first_cell: true, coefficient: 9}"},
            {"top.coefficient = 9: of_first_cell finds the coefficient; remove one of the two."}},
        Bad{"bulk_without_damping",
            {"fluid.bulk_relaxation_time=0.5"},
            {"fluid.bulk_relaxation_time = 0.5", "give more than 0.5 steps"}},
        Bad{"bulk_below_zero", {"fluid.bulk_relaxation_time=-1"}, {"fluid.bulk_relaxation_time = -1", "at least 0"}},
        Bad{"virtual_mass",
            {"coupling.virtual_mass={}"},
            {"coupling.virtual_mass", "stable without it", "remove the key"}},
        Bad{"link_tolerance", {"coupling.link_tolerance=0.01"}, {"coupling.link_tolerance", "remove the key"}},
        Bad{"ramp_in_full_gravity",
            {"gravity.mode=full", "run.ramp=0.1"},
            {"run.ramp = 0.1", "at rest under its whole weight"}},
        Bad{"ramp_below_zero", {"run.ramp=-0.1"}, {"run.ramp = -0.1", "at least 0"}},
        Bad{"magic_without_trt",
            {"fluid.collision=bgk", "fluid.magic_parameter=0.25"},
            {"fluid.magic_parameter", "only collision trt"}},
        Bad{"slip_length_missing", {"domain.boundaries.top=navier_slip"}, {"slip_length"}},
        Bad{"wall_lifts_off",
            {"domain.boundaries.top={type: moving, velocity: [0.1, 0, 0.1]}"},
            {"top", "a moving wall moves in its own plane"}},
        Bad{"wall_too_fast",
            {"domain.boundaries.top={type: moving, velocity: [90, 0, 0]}"},
            {"domain.boundaries", "cells a step"}},
        Bad{"control_too_quick",
            {"fluid.mean_velocity={velocity: 0.3, response_time: 1e-5}"},
            {"fluid.mean_velocity.response_time", "give at least"}},
        Bad{"full_gravity_without_a_floor",
            {"gravity.mode=full", "domain.boundaries.bottom=periodic", "domain.boundaries.top=periodic"},
            {"gravity.mode", "periodic along z has no hydrostatic pressure"}},
        Bad{"full_gravity_with_an_outlet",
            {"gravity.mode=full",
             "domain.boundaries={x_low: {type: velocity_inlet, velocity: [0.2, 0, 0]}, x_high: pressure_outlet, "
             "y: no_slip, bottom: no_slip, top: free_slip}"},
            {"gravity.mode", "an outlet of one pressure"}},
        Bad{"free_grains_at_an_outlet",
            {"domain.boundaries={x_low: no_slip, x_high: pressure_outlet, y: no_slip, bottom: no_slip, top: "
             "free_slip}"},
            {"domain.boundaries.x_high", "would jam at this face", "give x: periodic in place of x_low and x_high",
             "grains.0.fixed: true"}},
        Bad{"free_grains_beside_an_inlet",
            {"domain.boundaries={x: periodic, y: {type: velocity_inlet, velocity: [0.1, 0, 0]}, bottom: no_slip, "
             "top: free_slip}"},
            {"domain.boundaries.y", "would jam at this face", "y: periodic"}},
        Bad{"too_many_steps",
            {"run.until=1e30"},
            {"run.until = 1e30: the run would take 5e+34 steps of 2e-05 s",
             "give a longer fluid.time_step, or at most "
             "1.8e+11 s"}},
        Bad{"full_gravity_from_another_run",
            {"gravity.mode=full", "initial.from=other"},
            {"gravity.mode", "its own hydrostatic pressure"}},
        Bad{"mass_correction_is_gone", {"coupling.mass_correction=100"}, {"coupling.mass_correction", "always kept"}},
        Bad{"narrow_gaps_is_gone", {"coupling.narrow_gaps=slip"}, {"narrow_gaps = \"slip\"", "remove the key"}},
        Bad{"near_contact_is_gone", {"coupling.near_contact=paper"}, {"near_contact = \"paper\"", "remove the key"}},
        Bad{"mass_balance_is_gone",
            {"coupling.mass_balance=true"},
            {"mass_balance = \"true\"", "mass_by_links", "remove the key"}},
        Bad{"refill_is_gone", {"coupling.refill=grad"}, {"coupling.refill", "remove the key"}},
        Bad{"wall_density_is_gone", {"coupling.wall_density=reference"}, {"coupling.wall_density", "remove the key"}},
        Bad{"unknown_key", {"fluid.densty=1000"}, {"fluid.densty = 1000: unknown key; did you mean fluid.density?"}},
        Bad{"text_for_number",
            {"fluid.density=water"},
            {"fluid.density = \"water\": expected a number in kg/m^3 above 0, for example 1000."}},
        Bad{"negative_diameter",
            {"grains.0.diameter=-0.005"},
            {"grains.0.diameter = -0.005: expected a number in m above 0, for example 0.005."}},
        Bad{"not_whole_cells",
            {"domain.size=[0.0602, 0.0105, 0.075]"},
            {"domain.size = [0.0602, 0.0105, 0.075]: the 0.0602 m along x are 120.4 cells of 0.0005 m",
             "0.06 or 0.0605 m"}},
        Bad{"smaller_than_a_cell", {"domain.size=[0.06, 0.0001, 0.075]"}, {"along y", "at least 0.0005 m"}},
        Bad{"too_coarse",
            {"domain.size=[0.06, 0.012, 0.075]", "domain.spacing=3e-3"},
            {"domain.spacing = 3e-3: the spacing is too coarse for grains of 0.004 m",
             "give at most 0.002298 m, better domain.spacing: 0.0006"}},
        Bad{"too_many_cells", {"domain.spacing=1e-9"}, {"domain.spacing = 1e-9", "6e+07 cells", "larger spacing in m"}},
        Bad{"narrow_periodic_axis",
            {"domain.size=[0.009, 0.0105, 0.075]", "grains.0.placement.region=null"},
            {"domain.size", "along x are too narrow for grains of 0.00495 m; give at least 0.0099 m (two diameters"}},
        Bad{"narrow_walls",
            {"domain.size=[0.06, 0.0045, 0.075]"},
            {"along y are too narrow", "0.00495 m (one diameter)"}},
        Bad{"too_many_grains",
            {"grains.0.count=800", "grains.0.placement.region=null"},
            {"grains = [", "802 grains do not fit: they would fill 108 % of the box, and at most 64 %",
             "at most 59 % of them"}},
        Bad{"too_many_in_region",
            {"grains.0.placement.region.upper=[0.06, 0.0105, 0.01]"},
            {"grains.0.count = 150: 150 grains do not fit in their region: they would fill 151 % of it"}},
        Bad{"region_upside_down",
            {"grains.0.placement.region.lower=[0, 0, 0.06]"},
            {"grains.0.placement.region.upper", "lower below upper"}},
        Bad{"position_outside",
            {"grains.1.placement.positions.1=[0.02, 0.005, 0.6]"},
            {"grains.1.placement.positions.1 = [0.02, 0.005, 0.6]: the grain is outside the box",
             "[0.06, 0.0105, 0.075]"}},
        Bad{"positions_and_pattern",
            {"grains.1.placement.seed=3"},
            {"grains.1.placement.seed = 3: the positions are given one by one"}},
        // 0.06 x 0.0105 x 0.05 m, periodic along x: 12 x 2 x 10 places of 4.95 mm; 250 of them fill 0.504.
        Bad{"too_many_for_a_lattice",
            {"grains.0.count=250", "grains.0.placement.pattern=uniform"},
            {"grains.0.placement.pattern = \"uniform\": 250 grains do not fit on a lattice of places for the largest, "
             "0.00495 m wide: 240 would; give fewer or smaller grains"}},
        Bad{"count_and_positions", {"grains.1.count=3"}, {"grains.1.count = 3: there are 2 positions"}},
        Bad{"no_count", {"grains.0.count=null"}, {"grains.0.count: the number of grains is missing"}},
        Bad{"fixed_and_moving",
            {"grains.1.velocity=[0, 0, 1]"},
            {"grains.1.fixed = \"true\": a fixed grain cannot start"}},
        Bad{"removed_step",
            {"fluid.expected_velocity=5"},
            {"fluid.expected_velocity = 5: the step follows from the flow"}},
        Bad{"grain_too_fast",
            {"grains.0.velocity=[6, 0, 0]"},
            {"grains.0.velocity = [6, 0, 0]: 6 m/s would be 0.24 cells"}},
        Bad{"start_too_fast",
            {"initial.fluid={uniform: [6, 0, 0]}"},
            {"initial.fluid.uniform = [6, 0, 0]", "0.24 cells"}},
        Bad{"sub_step_too_long",
            {"coupling.grain_steps_per_fluid_step=1", "contact.normal_stiffness=20000"},
            {"coupling.grain_steps_per_fluid_step = 1: a step of the grains of 2e-05 s is longer than 1/20 of their "
             "shortest "
             "contact (0.0001999",
             "give coupling.grain_steps_per_fluid_step: 3 or more, or a longer contact.duration"}},
        // Glass of 4.95 mm, 1.619e-4 kg, in 0.01 Pa s: 6 pi eta a/(1e-5 m) = 2.881e5/s, half of whose inverse is the
        // step.
        Bad{"sub_step_too_long_for_lubrication",
            {"fluid.kinematic_viscosity=1e-5", "coupling.lubrication={minimum_gap: 1e-5}",
             "coupling.grain_steps_per_fluid_step=5"},
            {"coupling.grain_steps_per_fluid_step = 5: a step of the grains of 4e-06 s is too long for the lubrication "
             "force on the smallest that are free, which needs one of at most 1.73e-06 s; give "
             "coupling.grain_steps_per_fluid_step: 12 or more, or coupling.lubrication.minimum_gap: 2.31e-05 or more"}},
        Bad{"sub_steps_zero",
            {"coupling.grain_steps_per_fluid_step=0"},
            {"expected a whole number, at least 1, for example 1, or auto"}},
        Bad{"stiff_across",
            {"coupling.grain_steps_per_fluid_step=3", "contact.normal_stiffness=20000",
             "contact.tangential_stiffness=4e6"},
            {"is too long for contact.tangential_stiffness", "coupling.grain_steps_per_fluid_step: "}},
        Bad{"no_loss", {"contact.restitution=null"}, {"contact.restitution: the loss in a collision is missing"}},
        Bad{"both_losses",
            {"contact.damping=0.09"},
            {"contact.restitution = 0.93: the loss in a collision is given twice"}},
        Bad{"stiffness_and_duration",
            {"contact.normal_stiffness=700", "contact.duration=1.0e-3"},
            {"contact.normal_stiffness = 700: the stiffness is that with which a collision lasts as long as "
             "contact.duration says; give one of the two"}},
        Bad{"duration_in_words",
            {"contact.duration=long"},
            {"contact.duration = \"long\": expected a number in s above 0"}},
        Bad{"duration_in_two_units",
            {"contact.duration={seconds: 1.0e-3, fluid_steps: 40}"},
            {"contact.duration.seconds = 1.0e-3: give either seconds or fluid_steps"}},
        Bad{"duration_of_elastic_spheres",
            {"contact={law: hertz_mindlin, youngs_modulus: 1.0e7, restitution: 0.9, duration: 1.0e-3}"},
            {"contact.duration = 1.0e-3: elastic spheres have youngs_modulus"}},
        Bad{"restitution_above_one", {"contact.restitution=1.2"}, {"a number above 0 and at most 1, for example 0.93"}},
        Bad{"negative_stiffness", {"contact.normal_stiffness=-2e4"}, {"a number in N/m above 0, for example 20000"}},
        Bad{"half_periodic",
            {"domain.boundaries.bottom=periodic"},
            {"domain.boundaries.bottom = \"periodic\": an axis is periodic on both faces or on neither"}},
        Bad{"axis_twice",
            {"domain.boundaries.x_low=no_slip"},
            {"boundaries.x_low = \"no_slip\": the axis is given twice"}},
        Bad{"face_missing",
            {"domain.boundaries.top=null"},
            {"domain.boundaries.top: this face is missing; give one of"}},
        Bad{"axis_missing", {"domain.boundaries.y=null"}, {"domain.boundaries.y: these two faces are missing"}},
        Bad{"coefficient_of_no_slip",
            {"domain.boundaries.top={type: no_slip, coefficient: 2}"},
            {"top.coefficient = 2: only a slip_law_of_the_wall has a coefficient"}},
        Bad{"gravity_twice", {"gravity.vector=[0, 0, -9.8]"}, {"gravity.vector", "gravity is given twice"}},
        Bad{"gravity_missing", {"gravity={}"}, {"gravity.magnitude: gravity is missing"}},
        Bad{"dry_with_fluid",
            {"system=grains"},
            {"case.yaml:7: fluid = a section with 4 keys: system: grains has no fluid"}},
        Bad{"step_of_wet_grains",
            {"run.time_step=1e-6"},
            {"run.time_step = 1e-6: with a fluid the step is fluid.time_step"}},
        Bad{"measuring_nothing",
            {"grains=[]"},
            {"case.yaml:27: analysis.transport_rate = a section with 1 key: there are no grains to measure"}},
        Bad{"log_profile_above_the_top",
            {"initial.fluid={log_profile: {bed_height: 0.08, shear_velocity: 0.06, roughness: 2e-4}}"},
            {"initial.fluid.log_profile.bed_height = 0.08: no fluid is left above the bed", "below 0.075"}},
        Bad{"log_profile_of_water_at_rest",
            {"gravity.slope=0", "initial.fluid={log_profile: {}}"},
            {"initial.fluid.log_profile", "nothing drives the water along the bed", "give shear_velocity in m/s"}},
        Bad{"two_starts",
            {"initial.fluid={uniform: [0.1, 0, 0], linear_profile: {upper: 0.05, velocity: [0.1, 0, 0]}}"},
            {"initial.fluid.uniform",
             "the start is given twice; give only one of uniform, linear_profile and log_profile"}},
        Bad{"linear_profile_upside_down",
            {"initial.fluid={linear_profile: {lower: 0.05, upper: 0.04, velocity: [0.1, 0, 0]}}"},
            {"initial.fluid.linear_profile.upper = 0.04: give a height above lower"}},
        Bad{"no_diameter", {"grains.0.diameter=null"}, {"grains.0.diameter is missing: give a number in m above 0"}},
        Bad{"diameter_with_unit",
            {"grains.0.diameter=5 mm"},
            {"grains.0.diameter = \"5 mm\": expected a number in m above 0, for example 0.005"}},
        Bad{"two_kinds_of_sizes",
            {"grains.0.diameter={value: 0.005, sizes: [0.004], fractions: [1]}"},
            {"grains.0.diameter.value = 0.005: give exactly one of value in m, distribution, sizes"}},
        Bad{"half_a_distribution",
            {"grains.0.diameter={distribution: lognormal, median: 0.005, minimum: 0.004, maximum: 0.006}"},
            {"grains.0.diameter.distribution = \"lognormal\"", "needs median, minimum and maximum", "deviation"}},
        Bad{"median_outside",
            {"grains.0.diameter={distribution: lognormal, median: 0.007, geometric_deviation: 1.2, minimum: 0.004, "
             "maximum: 0.006}"},
            {"grains.0.diameter.median = 0.007: minimum, median and maximum must rise"}},
        Bad{"cut_of_no_distribution",
            {"grains.0.diameter={value: 0.005, maximum: 0.006}"},
            {"grains.0.diameter.maximum = 0.006: only a distribution has it"}},
        Bad{"sizes_without_fractions",
            {"grains.0.diameter={sizes: [0.004, 0.005], fractions: [1]}"},
            {"grains.0.diameter.sizes = [0.004, 0.005]", "as many fractions as sizes"}},
        Bad{"fractions_of_what",
            {"grains.0.diameter={sizes: [0.004, 0.005], fractions: [0.6, 0.6]}"},
            {"grains.0.diameter.fractions = [0.6, 0.6]: the fractions add up to 1.2"}},
        Bad{"modulus_of_springs",
            {"grains.0.contact={youngs_modulus: 1e9}"},
            {"grains.0.contact.youngs_modulus = 1e9: contact.law is linear"}},
        Bad{"other_kind_of_loss",
            {"contact.walls={damping: 0.1}"},
            {"contact.walls.damping = 0.1: the section contact gives a restitution"}},
        Bad{"friction_of_walls",
            {"contact.walls={friction: 0.1}"},
            {"contact.walls.friction = 0.1: the friction of walls is contact.wall_friction"}},
        Bad{"wet_rest", {"run.until_at_rest={}"}, {"run.until_at_rest", "grains in a fluid are never at rest"}},
        Bad{"no_run", {"run=null"}, {"case.yaml:1: run is missing: give a section"}}),
    [](const auto& bad) { return bad.param.name; });

}  // namespace
}  // namespace thalweg::driver::refused_cases_test
