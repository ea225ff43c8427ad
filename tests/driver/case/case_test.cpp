// The numbers that follow from a case, against the tables of the two papers' parameters.
#include "driver/estimate/filled_in.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "driver/estimate/stability.hpp"
#include "driver/warnings/case_warnings.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::driver::case_test {
namespace {

// The wide wall-free flume WWF1 of Zhang et al. 2022 at Shields number 0.085.
Case wide_bed() {
  Case c;
  c.domain.size = {0.120, 0.040, 0.0};
  c.domain.spacing = 0.5e-3;
  c.domain.faces = {coupling::FaceKeys{lbm::FaceType::periodic}, coupling::FaceKeys{lbm::FaceType::periodic},
                    coupling::FaceKeys{lbm::FaceType::periodic}, coupling::FaceKeys{lbm::FaceType::periodic},
                    coupling::FaceKeys{lbm::FaceType::no_slip},  coupling::FaceKeys{lbm::FaceType::free_slip}};
  c.fluid.density = 1000.0;
  c.fluid.kinematic_viscosity = 1e-6;
  c.fluid.time_step = 2e-5;
  c.gravity.magnitude = 9.8;
  c.gravity.slope = 0.016;
  c.contact.damping = 0.09;
  c.coupling.grain_steps_per_fluid_step = 50;
  beds::Population glass;
  glass.count = 2884;
  glass.diameter = 5e-3;
  glass.density = 2550.0;
  c.grains = {glass};
  // 41.2 mm of water over a bed of solid fraction 0.6.
  c.domain.size[2] = 0.0412 + grain_volume(c) / (0.6 * 0.120 * 0.040);
  return c;
}

TEST(Case, MassesTimesAndTheStepOfThePaper) {
  const Case c = wide_bed();
  EXPECT_NEAR(c.grains[0].lightest_mass(), 1.669e-4, 0.0005e-4);  // kg, 5 mm glass sphere
  EXPECT_NEAR(grain_time_step(c), 4e-7, 1e-21);                   // 2e-5 s in 50 sub-steps
  EXPECT_NEAR(relaxation_time(c), 0.5 + 2.4e-4, 1e-12);           // water at 2e-5 s and 0.5 mm
  EXPECT_NEAR(shortest_contact(c) / grain_time_step(c), 508, 3);  // the paper's t_c / dt, damping left out (-0.1 %)
  EXPECT_EQ(periodic_axes(c.domain), (std::array<bool, 3>{true, true, false}));
}

TEST(Case, CellsAreRoundedNotCut) {
  DomainCase domain;
  domain.size = {0.3, 0.7, 0.0105};
  domain.spacing = 0.1e-3;
  EXPECT_EQ(cells_of(domain), (Index3{3000, 7000, 105}));  // 0.3 / 0.0001 is 2999.9999999999995
}

// A step as long as the flow, by its speed, or its viscosity, by the relaxation time, allows; two digits, rounded down.
TEST(Case, TheStepFollowsFromTheFlow) {
  Case c = wide_bed();
  c.run.until = 30.0;
  EXPECT_NEAR(suitable_time_step(c), 0.1 * c.domain.spacing / flow_estimate(c).speed, 0.1 * suitable_time_step(c));
  EXPECT_LE(flow_estimate(c).speed * suitable_time_step(c) / c.domain.spacing, 0.1);
  const double step = suitable_time_step(c);
  c.run.until *= 100.0;
  EXPECT_EQ(suitable_time_step(c), step);
  c.fluid.kinematic_viscosity = 1e-3;  // 0.15 x (0.5 mm)^2 / 3 nu = 1.25e-5 s
  EXPECT_EQ(suitable_time_step(c), 1.2e-5);
}

TEST(Case, GravityLeansByTheAngleOfTheSlope) {
  GravityCase gravity;
  gravity.magnitude = 10.0;
  gravity.slope = 0.75;  // the 3-4-5 triangle
  EXPECT_NEAR((gravity_vector(gravity) - Vec3(6.0, 0.0, -8.0)).norm(), 0.0, 1e-14);
}

// Printed estimate for this run: 0.94 m/s at the surface, u*/0.41 ln(30 H / 2 d) with u* = 0.080 m/s.
TEST(Case, TheVelocityEstimateIsTheLogLawOverABed) { EXPECT_NEAR(estimated_velocity(wide_bed()), 0.94, 0.01); }

// u* = sqrt(9.8 sin(atan 0.06) * 4.58 mm) = 0.0519 m/s, and 0.0519/0.41 ln(9 * 0.0519 * 5.25e-3/1e-6) by hand.
TEST(Case, TheVelocityEstimateKnowsSideWalls) {
  Case c = wide_bed();
  c.grains.clear();
  c.gravity.slope = 0.06;
  c.domain.size = Vec3(0.048, 0.0105, 0.036);
  c.domain.faces[y_low].type = lbm::FaceType::law_of_the_wall;
  c.domain.faces[y_high].type = lbm::FaceType::no_slip;
  EXPECT_NEAR(estimated_velocity(c), 0.988, 0.003);
  c.domain.faces[y_high].type = lbm::FaceType::free_slip;
  EXPECT_GT(estimated_velocity(c), 3.0);
}

// A film of oil: U = g sin(theta) H^2 / (2 nu) exactly.
TEST(Case, TheVelocityEstimateIsTheLaminarFilmInAThickFluid) {
  Case c = wide_bed();
  c.grains.clear();
  c.domain.size[2] = 0.01;
  c.fluid.kinematic_viscosity = 1e-3;
  const double expected = 9.8 * std::sin(std::atan(0.016)) * 1e-4 / 2e-3;
  EXPECT_NEAR(estimated_velocity(c), expected, 1e-12);
}

// The map's own entries, and between them the entry on the safe side.
TEST(Case, StabilityFollowsTheMap) {
  EXPECT_EQ(stable_lattice_velocity(lbm::CollisionModel::bgk, 0.003), 0.05);
  EXPECT_EQ(stable_lattice_velocity(lbm::CollisionModel::bgk, 0.0099), 0.05);
  EXPECT_EQ(stable_lattice_velocity(lbm::CollisionModel::trt, 0.0015), 0.0);
  EXPECT_EQ(stable_lattice_velocity(lbm::CollisionModel::trt, 0.5), 0.15);
  // bgk in the open.
  EXPECT_EQ(stable_lattice_velocity(lbm::CollisionModel::trt_at_bodies, 0.003), 0.05);
}

// The same with contacts that last as long as sound takes around a grain, for half a minute.
Case lasting_contacts() {
  Case c = wide_bed();
  c.domain.size.z() = std::round(c.domain.size.z() / c.domain.spacing) * c.domain.spacing;
  c.contact.normal_stiffness = 2700.0;
  c.run.until = 30.0;
  return c;
}

TEST(Case, WarnsOfWhatDeservesASecondLookAndOfNothingElse) {
  Case c = lasting_contacts();
  c.analysis.observers.of<analysis::TransportRateKeys>() = {20.0, 0.0};
  EXPECT_TRUE(warnings(c).empty());  // 0.94 m/s are 0.038 cells a step
  c.fluid.time_step = 1e-4;          // 0.19 cells a step
  c.fluid.subgrid_model = lbm::SubgridModel::none;
  c.domain.spacing = 1e-3;  // 5 cells a diameter, and 0.094 cells a step
  c.run.until = 10.0;       // before the mean begins
  const std::vector<std::string> found = warnings(c);
  const auto place_of = [&found](const char* words) {
    std::size_t n = 0;
    while (n < found.size() && found[n].find(words) == std::string::npos) ++n;
    return n;
  };
  EXPECT_LT(place_of("subgrid"), place_of("only 5 cells across"));  // the gravest first
  EXPECT_LT(place_of("only 5 cells across"), place_of("analysis.transport_rate begins at 20 s, after the end"));
  EXPECT_LT(place_of("analysis.transport_rate begins at 20 s, after the end"), found.size());
}

TEST(Case, WarnsOfCoarseCellsUnlessTheyAreAccepted) {
  Case c = wide_bed();
  c.run.until = 30.0;
  const auto warning = [&c] {
    for (const std::string& text : warnings(c))
      if (text.find("cells across") != std::string::npos) return text;
    return std::string();
  };
  EXPECT_EQ(warning(), "");
  c.domain.spacing = smallest_diameter(c) / 5.5;
  c.domain.size = Vec3(132, 44, 117) * c.domain.spacing;
  EXPECT_NE(warning().find("only 5.5 cells across; drag of a grain alone in a stream about"), std::string::npos)
      << warning();
  c.domain.spacing = smallest_diameter(c) / 5.998;
  c.domain.size = Vec3(144, 48, 128) * c.domain.spacing;
  EXPECT_NE(warning().find("only 5.9 cells across; drag"), std::string::npos) << warning();
  c.domain.spacing = smallest_diameter(c) / 3.25;
  c.domain.size = Vec3(78, 26, 69) * c.domain.spacing;
  EXPECT_NE(warning().find("only 3.2 cells across, which does not resolve"), std::string::npos) << warning();
  EXPECT_NE(warning().find("accept it with coupling.fewest_cells_per_diameter: 3.2."), std::string::npos) << warning();
  c.coupling.fewest_cells_per_diameter = 3.2;
  EXPECT_EQ(warning(), "");
}

// A height that follows from the flow is made of whole cells, whatever they are.
TEST(Case, ASpacingNeedNotDivideAHeightThatFollows) {
  Case c = wide_bed();
  c.domain.size = Vec3(0.06, 0.03, 0.040625);
  c.domain.spacing = 0.625e-3;
  EXPECT_EQ(spacing_below(c, 0.55e-3), 0.5 * 0.625e-3);  // 192 by 96 by 130 cells
  c.filled_in.flow.height = true;
  EXPECT_EQ(spacing_below(c, 0.55e-3), 0.06 / 110);  // and 55 cells
}

TEST(Case, WarnsOfABulkViscosityThatMakesTrtUnstable) {
  Case c = lasting_contacts();
  c.fluid.collision = lbm::CollisionModel::trt;
  c.fluid.subgrid_model = lbm::SubgridModel::none;
  const std::size_t without = warnings(c).size();
  c.fluid.bulk_relaxation_time = 3.0;
  ASSERT_EQ(warnings(c).size(), without + 1);
  const auto warned = [&] {
    const std::vector<std::string> all = warnings(c);
    return std::any_of(all.begin(), all.end(),
                       [](const std::string& one) { return one.find("bulk relaxation") != std::string::npos; });
  };
  EXPECT_TRUE(warned());
  c.fluid.subgrid_model = lbm::SubgridModel::qr;
  EXPECT_FALSE(warned());
  c.fluid.subgrid_model = lbm::SubgridModel::none;
  c.fluid.collision = lbm::CollisionModel::bgk;
  EXPECT_FALSE(warned());
}

// The drag of dense arrays is off by tens of percent where it depends on the relaxation time
// (benchmarks/validation/simple_cubic_arrays), which it does except with trt and cli.
TEST(Case, WarnsOfLinksWhoseDragDependsOnTheViscosity) {
  Case c = wide_bed();
  c.domain.size.z() = cells_of(c.domain)[2] * c.domain.spacing;
  c.run.until = 30.0;
  c.fluid.bulk_relaxation_time = 0.0;
  c.fluid.kinematic_viscosity = 0.5 / 3.0 * c.domain.spacing * c.domain.spacing / fluid_time_step(c);  // tau = 1
  const auto recommends = [&](const char* words) {
    for (const std::string& warning : warnings(c))
      if (warning.find("In a dense bed") != std::string::npos) return warning.find(words) != std::string::npos;
    return false;
  };
  c.fluid.collision = lbm::CollisionModel::bgk;
  EXPECT_TRUE(recommends("consider fluid.collision: trt and coupling.links: cli"));
  c.fluid.collision = lbm::CollisionModel::trt;
  EXPECT_TRUE(recommends("consider coupling.links: cli"));
  c.coupling.links = bodies::LinkRule::cli;
  EXPECT_FALSE(recommends(""));
  c.coupling.links = bodies::LinkRule::bouzidi;
  c.fluid.smagorinsky_constant = 0.27;  // the published water
  EXPECT_FALSE(recommends(""));
}

// docs/stability.md: at tau - 1/2 = 0.003 a stream is stable up to 0.10 cells a step with three steps, 0.16 with one.
TEST(Case, WarnsOfABulkViscosityThatMakesAFastStreamUnstable) {
  Case c = lasting_contacts();
  c.fluid.bulk_relaxation_time = 3.0;
  const double a_cell_a_step = c.domain.spacing / flow_estimate(c).speed;
  const auto grows = [&c] {
    for (const std::string& warning : warnings(c))
      if (warning.find("grows stripes") != std::string::npos) return true;
    return false;
  };
  c.fluid.time_step = 0.09 * a_cell_a_step;
  EXPECT_FALSE(grows());
  c.fluid.time_step = 0.099 * a_cell_a_step;
  EXPECT_TRUE(grows());
  c.fluid.bulk_relaxation_time = 1.0;
  EXPECT_FALSE(grows());
}

}  // namespace
}  // namespace thalweg::driver::case_test
