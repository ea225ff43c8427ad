#include "driver/plan/check_report.hpp"

#include "driver/bed/bed_flow.hpp"
#include "driver/cost/disk_space.hpp"
#include "driver/cost/run_cost.hpp"
#include "driver/plan/flow_report.hpp"
#include "driver/warnings/case_warnings.hpp"
#include "driver/warnings/contact_warnings.hpp"
#include "driver/warnings/remedy.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/driver/text_search.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::driver::check_report_test {
namespace {

TEST(Cost, CountsCellsAndSteps) {
  const Case c = wide_bed();
  const Cost cost = cost_of(c, 10e9);
  EXPECT_EQ(cost.cells, 240.0 * 80.0 * 212.0);
  EXPECT_EQ(cost.steps, 1.5e6);  // 30 s of 2e-5 s
  EXPECT_EQ(cost.cell_updates, cost.cells * 1.5e6);
  EXPECT_EQ(cost.grain_steps, 1000.0 * 50.0 * 1.5e6);
  const Cost on_faster_memory = cost_of(c, 20e9);
  EXPECT_LT(on_faster_memory.core_seconds, cost.core_seconds);
  EXPECT_GT(on_faster_memory.core_seconds, 0.5 * cost.core_seconds);  // the grains do not get faster
}

// Contacts are those of spheres: a clump costs as much as it has members.
TEST(Cost, CountsTheMembersOfClumps) {
  const std::string shape =
      "grains.0.shape={clump: [{position: [0, 0, 0], diameter: 1.0}, {position: [0.5, 0, 0], diameter: 1.0}]}";
  const Case spheres = testing::read_text(testing::flume), clumps = testing::read_text(testing::flume, {shape});
  const auto spheres_of = [](const Case& c) {
    const Cost cost = cost_of(c, 10e9);
    return cost.grain_steps / cost.steps / static_cast<double>(grain_steps(c));
  };
  EXPECT_NEAR(spheres_of(clumps) / spheres_of(spheres), (2.0 * 150.0 + 2.0) / (150.0 + 2.0), 0.01);  // two are fixed
}

// A link takes 10 ns (docs/architecture.md) and up to four times that on other machines, and the sweep half of what
// slow memory allows. No core updates more than 250 million cells a second, however fast its memory.
TEST(Cost, TakesAccountOfTheLinks) {
  Case c = wide_bed();
  const double slow = 10e9;  // bytes/s
  const double with_grains = cost_of(c, slow).core_seconds;
  c.grains.clear();
  const double water = cost_of(c, slow).core_seconds, updates = 1.5e6 * 240.0 * 80.0 * 212.0;
  EXPECT_NEAR(water, updates * 152.0 / (0.5 * slow), 0.5 * water);
  EXPECT_GT(cost_of(c, 1e13).core_seconds, updates / 250e6);
  EXPECT_GT(with_grains - water, 1.5e6 * 1.58e6 * 10e-9);
  EXPECT_LT(with_grains - water, 1.5e6 * (1.58e6 * 40e-9 + 50.0 * 1000.0 * 400e-9));
}

// Bytes of the XML of a frame: 2970 of 15 arrays and of the line in the .pvd, measured with one grain.
double xml(int arrays) { return 1000.0 + 150.0 * arrays; }

// 30 s: 301 frames every 0.1 s, of 5 floats a cell in one layer of cells; 61 of grains; 3 of 30 checkpoints at a time.
TEST(DiskSpace, IsThatOfFramesCheckpointsAndRecords) {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic);
  c.domain.size = Vec3(0.120, 0.040, 0.106);
  c.output.fluid.every = 0.1;
  c.output.fluid.region = io::FluidRegion::slice_y;
  c.output.grains.every = 0.5;
  c.output.checkpoint = {.every = 1.0, .every_wall = 0.0, .keep = 2};
  c.analysis.observers.of<analysis::TracksKeys>().emplace().one_in = 3;
  const DiskSpace space = disk_space(c);
  EXPECT_NEAR(space.fluid, 301.0 * (240.0 * 212.0 * 5.0 * 4.0 + xml(3)), 1.0);
  EXPECT_NEAR(space.grains, 61.0 * (1000.0 * 41.0 * 8.0 + xml(15)), 1.0);
  EXPECT_NEAR(space.records, 30001.0 * 334.0 * 144.0, 1.0);
  Case reach = c;
  reach.analysis.observers.of<analysis::ReachKeys>() = {.record_every = 0.5, .sections = 24};
  EXPECT_NEAR(disk_space(reach).records - space.records, 61.0 * (2.0 + 24.0 * 9.0) * 8.0, 1.0);
  const double state = 240.0 * 80.0 * 212.0 * 19.0 * 4.0;
  EXPECT_GT(space.checkpoints, 3.0 * state);
  EXPECT_LT(space.checkpoints, 3.0 * (state + 1000.0 * 1000.0));
  EXPECT_NE(disk_line(space, 1e12).find(": fluid 307 MB, grains 20.2 MB, checkpoints"), std::string::npos)
      << disk_line(space, 1e12);
  EXPECT_NE(disk_line(space, 79e6).find("more than the 79 MB that are free in this folder"), std::string::npos);
  Case every_step = c;
  every_step.output.fluid.every = 1e-9;
  EXPECT_NEAR(disk_space(every_step).fluid, (1.5e6 + 1.0) * (240.0 * 212.0 * 5.0 * 4.0 + xml(3)), 1e6);
  EXPECT_TRUE(any_contains(warnings(every_step), "output.fluid.every = 1e-09 s is less than a step"));
  EXPECT_FALSE(any_contains(warnings(c), "less than a step"));
  Case of_parts = c;
  of_parts.output.grain_parts.emplace_back().every = 1e-9;
  of_parts.output.fluid_parts.emplace_back().every = 1e-9;
  EXPECT_TRUE(any_contains(warnings(of_parts), "output.grain_parts.0.every = 1e-09 s is less than a step"));
  EXPECT_TRUE(any_contains(warnings(of_parts), "output.fluid_parts.0.every = 1e-09 s is less than a step"));
  c.output.checkpoint.every = 0.0;
  EXPECT_NEAR(disk_space(c).checkpoints, space.checkpoints / 3.0, 1.0);
  c.output.checkpoint.every = 20.0;
  EXPECT_NEAR(disk_space(c).checkpoints, 2.0 * space.checkpoints / 3.0, 1.0);
  c.output.checkpoint.every_wall = 1800.0;
  EXPECT_NEAR(disk_space(c).checkpoints, space.checkpoints, 1.0);
}

// Members of clumps are tracked as the spheres they are, with the orientation of their clump.
TEST(DiskSpace, CountsTheTracksOfMembers) {
  const std::string shape =
      "grains.0.shape={clump: [{position: [0, 0, 0], diameter: 1.0}, {position: [0.5, 0, 0], diameter: 1.0}]}";
  const Case c = testing::read_text(testing::flume, {shape, "analysis={tracks: {every: 0.01}}"});
  EXPECT_NEAR(disk_space(c).records, 301.0 * (2.0 * 150.0 + 2.0) * 176.0, 1.0);
}

// A grain has six numbers for its place, radius and vertex in any frame.
TEST(DiskSpace, CountsTheGrainsAndFieldsOfParts) {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic);
  c.output.grains = {.every = 1.0, .fields = {io::GrainField::radius}};
  double frames = 31.0 * (1000.0 * 6.0 * 8.0 + xml(4));
  EXPECT_NEAR(disk_space(c).grains, frames, 1.0);
  const auto add = [&c](double every, const io::GrainSelectionKeys& selection,
                        const std::vector<io::GrainField>& fields) {
    io::NamedGrainOutputKeys& part = c.output.grain_parts.emplace_back();
    static_cast<io::GrainSelectionKeys&>(part) = selection;
    part.every = every;
    part.fields = fields;
  };
  add(0.5, {{4, 5, 6}, {}, {}}, {io::GrainField::id, io::GrainField::velocity});
  frames += 61.0 * (3.0 * 10.0 * 8.0 + xml(6));
  EXPECT_NEAR(disk_space(c).grains, frames, 1.0);
  add(10.0, {{}, 0, {}}, {io::GrainField::fluid_stress});
  frames += 4.0 * (1000.0 * 15.0 * 8.0 + xml(5));
  EXPECT_NEAR(disk_space(c).grains, frames, 1.0);
  // A tenth of a diameter wide: of 5 mm, at most 1.1^3 sqrt(2) = 1.9 have their centres in it.
  add(10.0, {{}, {}, io::BoxKeys{Vec3::Constant(0.01), Vec3::Constant(0.0105)}}, {io::GrainField::id});
  frames += 4.0 * (2.0 * 7.0 * 8.0 + xml(5));
  EXPECT_NEAR(disk_space(c).grains, frames, 1.0);

  c.output.fluid.every = 10.0;
  const double single = disk_space(c).fluid, of_xml = 4.0 * xml(3);
  c.output.fluid.precision = io::FieldPrecision::double_;
  EXPECT_NEAR(disk_space(c).fluid - of_xml, (single - of_xml) * 36.0 / 20.0, 1.0);  // four reals and one id
}

// What runs have written: 450 bytes a row of 26 columns without analyses, and 1600 of 112 with twelve of them, two
// populations and the forces on all faces.
TEST(DiskSpace, CountsTheSeries) {
  Case c = testing::read_text(testing::flume);
  c.output.series.every = 1e-3;
  c.analysis.observers.of<analysis::TransportRateKeys>().reset();
  const double rows = 3001.0, plain = disk_space(c).series;
  EXPECT_GT(plain, rows * 450.0);
  EXPECT_LT(plain, rows * 2.0 * 450.0);
  c.analysis.observers.for_each([](auto& keys) { keys.emplace(); });
  c.analysis.wall_forces.emplace();
  EXPECT_GT(disk_space(c).series, rows * 1600.0);
  c.output.series.every = 0.0;
  EXPECT_EQ(disk_space(c).series, 0.0);
}

// The figures by which a user plans a run, in lines of their own.
TEST(CheckReport, ShowsTimesOverlapsAndWhatTheSlopeAsksFor) {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic);
  const auto line = [&c](const std::string& name) -> std::string {
    for (const std::string& text : check_report(c, 10e9))
      if (text.starts_with(name)) return text;
    return {};
  };
  EXPECT_NE(line("times").find("H/u* 0.513 s"), std::string::npos) << line("times");  // 0.0412 m over 0.0804 m/s
  EXPECT_NE(line("flow").find("0.944 m/s (slope and depth)"), std::string::npos) << line("flow");
  EXPECT_NE(line("reference").find("diameter 0.005 m"), std::string::npos);
  EXPECT_NE(line("fall").find("0.48 m/s"), std::string::npos) << line("fall");
  for (const char* name : {"overlap", "drag", "base", "disk"}) EXPECT_NE(line(name), "") << name;
  c.gravity.slope = 0.0;
  c.domain.faces[top] = {.type = lbm::FaceType::moving, .velocity = Vec3(0.2, 0.0, 0.0)};
  EXPECT_NE(line("Shields").find("by a moving face, turbulent flow"), std::string::npos) << line("Shields");
  EXPECT_EQ(line("base"), "");
}

TEST(CheckReport, AsksForContactsAsLongAsSoundGoesAroundAGrain) {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic);
  const auto line = [&c]() -> std::string {
    for (const std::string& text : check_report(c, 10e9))
      if (text.find("rebound too weakly") != std::string::npos) return text;
    return {};
  };
  // Ten cells a diameter: pi 5 sqrt(3) = 27.2 steps around.
  EXPECT_NE(line().find("the 27.3 that sound takes around a grain"), std::string::npos) << line();
  // A contact lasts pi sqrt(m/(2 k)): as long as that with the stiffness that the line asks for, m = pi/6 d^3 rho.
  const double mass = std::numbers::pi / 6.0 * std::pow(5e-3, 3) * c.grains[0].density;
  const double longest = 0.5 * mass * std::pow(std::numbers::pi / (27.2 * *c.fluid.time_step), 2);
  c.contact.normal_stiffness = 1.01 * longest;
  EXPECT_NE(line(), "");
  c.contact.normal_stiffness = 0.99 * longest;
  EXPECT_EQ(line(), "");
  c.contact.normal_stiffness = 1.01 * longest;
  c.fluid.kinematic_viscosity = 1e-3;  // nothing rebounds: St = 2.55 x 0.9 m/s x 5 mm/(9 nu) = 1.3
  EXPECT_EQ(line(), "");
}

// e = exp(-pi zeta/sqrt(1 - zeta^2)), zeta = gamma/(2 sqrt(k m*)), of two grains m* = m/2, at a wall m* = m.
TEST(CheckReport, AsksForSofterContactsOfTheSameRestitution) {
  Case c = wide_bed();
  c.contact.restitution.reset();
  c.contact.damping = 0.09;
  c.domain.size[2] = 0.106;
  const double mass = std::numbers::pi / 6.0 * std::pow(5e-3, 3) * c.grains[0].density;
  const auto restitution = [](double damping, double stiffness, double effective) {
    const double zeta = damping / (2.0 * std::sqrt(stiffness * effective));
    return std::exp(-std::numbers::pi * zeta / std::sqrt(1.0 - zeta * zeta));
  };
  const auto report = check_report(c, 10e9);
  EXPECT_TRUE(
      any_contains(report, fmt::format("dry restitution {:.3g} of two grains and {:.3g} of grain and wall",
                                       restitution(0.09, 20000.0, 0.5 * mass), restitution(0.09, 20000.0, mass))));
  const Remedy softer = stiffness_changes(c, 0.1, 4, Rounding::down);
  EXPECT_EQ(text_of({softer.begin(), softer.begin() + 2}),
            "contact.normal_stiffness: 2000 and contact.tangential_stiffness: 571.4");
  const Case after = changed(c, softer);
  EXPECT_NEAR(restitution(*after.contact.damping, 2000.0, mass), restitution(0.09, 20000.0, mass), 1e-6);
}

TEST(Remedy, IsPrintedAsItIsPasted) {
  const Remedy one = {exact_change("a.b", 320.0, 2, [](Case&, double) {})};
  EXPECT_EQ(text_of(one), "a.b: 320");
  const Remedy three = joined(joined(one, {word_change("c", "{}", [](Case&) {})}),
                              {number_change("a.b", 0.01238, 2, Rounding::down, [](Case&, double) {}),
                               number_change("d", 0.01231, 2, Rounding::up, [](Case&, double) {})});
  EXPECT_EQ(text_of(three), "c: {}, a.b: 0.012 and d: 0.013");
}

// 80 by 40 by 36 cells of a millimetre: a third of it for six cells in grains of 2 mm. Sides of primes leave halves.
TEST(Remedy, IsASpacingThatDividesTheBox) {
  Case c;
  c.domain.size = Vec3(0.08, 0.04, 0.036);
  c.domain.spacing = 1e-3;
  EXPECT_EQ(spacing_change(c, 2.00031e-3 / 6.0).value, "0.000333333333");
  c.domain.size = Vec3(0.061, 0.019, 0.041);
  EXPECT_EQ(spacing_change(c, 0.9e-3).value, "0.0005");
}

// With trt and cli the drag of dense arrays is within 2 % at a relaxation time of 1.94
// (benchmarks/validation/simple_cubic_arrays).
TEST(CheckReport, WarnsOfLongRelaxationWhereItCostsAccuracy) {
  Case c = wide_bed();
  const auto warns = [&c](double relaxation_time) {
    c.fluid.kinematic_viscosity =
        (relaxation_time - 0.5) / 3.0 * c.domain.spacing * c.domain.spacing / *c.fluid.time_step;
    return any_contains(warnings(c), "is so large that walls and grains lose accuracy");
  };
  c.fluid.collision = lbm::CollisionModel::trt;
  c.coupling.links = bodies::LinkRule::cli;
  EXPECT_FALSE(warns(1.94));
  EXPECT_TRUE(warns(2.0));
  c.coupling.links = bodies::LinkRule::bouzidi;
  EXPECT_FALSE(warns(1.49));
  EXPECT_TRUE(warns(1.94));
  c.coupling.links = bodies::LinkRule::cli;
  c.fluid.collision = lbm::CollisionModel::trt_at_bodies;
  EXPECT_TRUE(warns(1.94));
}

// A fact and no warning: nothing is wrong with a case of light and heavy grains.
TEST(FlowReport, GivesTheShieldsNumberOfEveryDensity) {
  Case c = wide_bed();
  c.grains.push_back(c.grains.front());
  EXPECT_FALSE(any_contains(bed_lines(c), "densities"));
  c.grains[1].count = 500;
  c.grains[1].density = 1500.0;
  const double shields = flow_numbers(c).shields_hydraulic;
  const std::string line = fmt::format(
      "densities  several: Shields number {:.3g} and q* are those of the reference grain; of the populations by "
      "themselves {:.3g} for grains.0 (2550 kg/m^3, 0.005 m) to {:.3g} for grains.1 (1500 kg/m^3, 0.005 m)",
      shields, shields * 1200.0 / 1550.0, shields * 1200.0 / 500.0);
  EXPECT_TRUE(any_contains(bed_lines(c), line)) << line;
  EXPECT_FALSE(any_contains(warnings(c), "densit"));
  c.grains[1].fixed = true;  // a rough floor is no sediment
  EXPECT_FALSE(any_contains(bed_lines(c), "densities"));
  c.grains[1].fixed = false;
  c.gravity.slope = 0.0;  // no stress, no number
  EXPECT_FALSE(any_contains(bed_lines(c), "densities"));
  c.fluid.mean_velocity = coupling::FlowTargetKeys{.velocity = 0.3, .response_time = 1.0};
  EXPECT_TRUE(any_contains(bed_lines(c), "for grains.0"));
}

}  // namespace
}  // namespace thalweg::driver::check_report_test
