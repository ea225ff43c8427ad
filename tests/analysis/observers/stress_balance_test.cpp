// The balance of momentum by layers: flows whose stress follows from the force that drives them.
#include "analysis/tools/sphere_in_layer.hpp"
#include "tests/analysis/balanced_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace thalweg::analysis::stress_balance_test {
namespace {

using coupling::FluidInitialState;

double result(const StressBalance& balance, const std::string& name) {
  return find_diagnostic(balance.results(), name).value();
}

// A viscous fluid among spheres of 9 or 6 cells; what the tests below have in common.
WaterBox viscous_box(const Index3& cells, double cells_per_diameter, double tau) {
  WaterBox box;
  box.cells = cells;
  box.periodic = {true, true, false};
  box.spacing = 5e-3 / cells_per_diameter;
  box.time_step = 1e-4;
  box.viscosity = (tau - 0.5) / 3.0 * box.spacing * box.spacing / box.time_step;
  box.smagorinsky_constant = 0.0;
  box.collision = lbm::CollisionModel::trt;
  box.links.rule = bodies::LinkRule::cli;
  return box;
}

// Over some steps one after the other: exchanges over links swing a little from step to step, which the mean of two
// takes out of the loads (docs/theory.md, section 3). Stresses are such a mean from the second step on that measures
// them.
void measure(StressBalance& balance, LatticeSystem<double>& system) {
  advance_with_stress(system);
  for (int n = 0; n < 20; ++n) {
    system.record_momentum();
    system.measure_grain_stress();
    system.advance();
    balance.observe(system.snapshot());
  }
}

double integral(const Values& values, const std::string& name) {
  double sum = 0.0;
  for (std::size_t l = 0; l < values.at("z").size(); ++l) sum += values.at(name)[l] * values.at("thickness")[l];
  return sum;
}

double largest_apart(const Values& values, const std::string& one, const std::string& other) {
  double largest = 0.0;
  for (std::size_t l = 0; l < values.at(one).size(); ++l)
    largest = std::max(largest, std::abs(values.at(one)[l] - values.at(other)[l]));
  return largest;
}

// Flow down a slope over a bed of spheres that are held, at Re below 0.1. The balance of the lattice is exact plane by
// plane, so that total and driving stress differ by the change of momentum in time alone. Its slowest part decays as
// exp(-t/T), T = 4 H^2/(pi^2 nu) with H below the whole height (Stokes flow between a wall and a free surface); after
// 10 T that of a start at rest is 5e-5.
TEST(StressBalance, OfASlowFlowOverHeldSpheresIsTheWeightAbove) {
  WaterBox box = viscous_box({18, 18, 36}, 9.0, 1.5);
  box.gravity = Vec3(0.02, 0.0, -9.8);
  for (int k = 0; k < 4; ++k)
    box.seeds.push_back(glass_sphere(k, Vec3((k % 2 + 0.31) * 5e-3, (k / 2 + 0.17) * 5e-3, 2.9e-3 + 0.4e-3 * k)));
  for (dem::GrainSeed& seed : box.seeds) seed.motion = dem::Motion::fixed;
  const auto system = system_of(box);
  const double nu = (1.5 - 0.5) / 3.0, decay = 4.0 * 36.0 * 36.0 / (std::numbers::pi * std::numbers::pi * nu);
  for (int step = 0; step < static_cast<int>(10.0 * decay); ++step) system->advance();
  StressBalance balance = balance_of(box, *system, 1.2e-3, {{0, 4}});
  measure(balance, *system);
  const Values values = by_name(balance);
  const double bed_stress = result(balance, "bed_stress");
  EXPECT_LT(largest_apart(values, "total_stress", "driving_stress"), 1e-4 * bed_stress);

  // Above the spheres there is fluid alone, and its weight above a layer's middle is known.
  const double height = 36.0 * box.spacing;
  for (std::size_t l = 0; l < values.at("z").size(); ++l)
    if (values.at("z")[l] - 0.5 * values.at("thickness")[l] > 2.9e-3 + 1.2e-3 + 2.5e-3) {
      EXPECT_NEAR(values.at("driving_stress")[l], 1000.0 * 0.02 * (height - values.at("z")[l]), 1e-9 * bed_stress);
      EXPECT_NEAR(values.at("viscous_stress")[6 * l + 4], values.at("total_stress")[l], 1e-3 * bed_stress);
    }
  // Spread over a grain's volume or not, the stress is the same in the whole: each force acts within half a link of
  // the height it is counted at, and together the forces are no more than the bed carries with its own driving, below
  // the weight of the whole fluid column.
  EXPECT_NEAR(integral(values, "sum_of_stresses"), integral(values, "total_stress"),
              0.5 * box.spacing * 1000.0 * 0.02 * height);
  // The drag of all grains is what drives the fluid less what the floor takes: less than its weight, and most of it.
  double drag = 0.0;
  for (std::size_t l = 0; l < values.at("z").size(); ++l)
    drag += values.at("drag_density")[3 * l] * values.at("thickness")[l];
  double loads = 0.0;
  for (const Vec3& force : system->snapshot().grains.fluid_force) loads += force.x();
  loads = sum_over_ranks(MPI_COMM_WORLD, loads) / (18.0 * 18.0 * box.spacing * box.spacing);
  EXPECT_NEAR(drag, loads, 1e-4 * bed_stress);  // of the last step, against the mean of twenty
  EXPECT_GT(drag, 0.5 * bed_stress);
}

// Spheres held at the top, of which half lies beyond it, hold the flow back as much as the floor. All their force is
// above the fluid between, in which the viscous stress is the whole one.
TEST(StressBalance, CountsAllTheForceOnGrainsThatTheTopCuts) {
  WaterBox box = viscous_box({18, 18, 36}, 9.0, 1.5);
  box.gravity = Vec3(0.02, 0.0, -9.8);
  const double top = 36.0 * box.spacing;
  for (int k = 0; k < 4; ++k)
    box.seeds.push_back(glass_sphere(k, Vec3((k % 2 + 0.31) * 5e-3, (k / 2 + 0.17) * 5e-3, top - 0.2e-3)));
  for (dem::GrainSeed& seed : box.seeds) seed.motion = dem::Motion::fixed;
  const auto system = system_of(box);
  for (int step = 0; step < 10000; ++step) system->advance();
  StressBalance balance = balance_of(box, *system, 1.2e-3, {{0, 4}});
  measure(balance, *system);
  const Values values = by_name(balance);
  const double weight = 1000.0 * 0.02 * top;
  EXPECT_LT(largest_apart(values, "total_stress", "driving_stress"), 1e-4 * weight);
  for (std::size_t l = 0; l < values.at("z").size(); ++l)
    if (values.at("z")[l] + 0.5 * values.at("thickness")[l] < top - 0.2e-3 - 2.5e-3) {
      EXPECT_NEAR(values.at("viscous_stress")[6 * l + 4], values.at("total_stress")[l], 1e-3 * weight);
    }
}

// Spheres held at the floor and just below the top of a shear cell: no flow goes over them, so the difference is a
// share of the largest driving stress, not of the small one that the upper spheres leave above their middle.
TEST(StressBalance, GrainsThatReachTheTopAreNoBed) {
  WaterBox box = viscous_box({18, 18, 24}, 9.0, 1.5);
  const double d = 5e-3, top = 24.0 * box.spacing;
  box.plate_velocity = 0.01;
  for (int k = 0; k < 4; ++k)
    box.seeds.push_back(glass_sphere(k, Vec3((k % 2 + 0.31) * d, 0.4 * d, k < 2 ? 0.52 * d : top - 0.55 * d)));
  for (dem::GrainSeed& seed : box.seeds) seed.motion = dem::Motion::fixed;
  const auto system = system_of(box);
  for (int step = 0; step < 100; ++step) system->advance();
  StressBalance balance = balance_of(box, *system, 1.2e-3, {{0, 4}});
  measure(balance, *system);
  const Values values = by_name(balance);
  double largest = 0.0;
  for (const double driving : values.at("driving_stress")) largest = std::max(largest, std::abs(driving));
  EXPECT_EQ(result(balance, "bed_height"), 0.0);
  EXPECT_NEAR(std::abs(result(balance, "bed_stress")), largest, 1e-12 * largest);
}

// A sphere held between two plates that slide: nothing drives the fluid but the plates, so that the total stress is the
// same everywhere once the flow is steady (T = H^2/(pi^2 nu), 10 T: 5e-5 of the start, which is linear and differs from
// the end by the share of the solid). The rotation stress is the torque on the sphere per area of the box, integrated
// over the height: an identity.
TEST(StressBalance, OfAHeldSphereInShearIsThatOfThePlates) {
  WaterBox box = viscous_box({20, 18, 24}, 9.0, 1.5);
  const double height = 24.0 * box.spacing, rate = 0.02 * box.viscosity / (2.5e-3 * 2.5e-3);
  box.plate_velocity = 0.5 * rate * height;
  static double shear, middle;
  shear = rate;
  middle = 0.5 * height;
  box.initial = [](const Vec3& p) { return FluidInitialState{0.0, Vec3(shear * (p.z() - middle), 0.0, 0.0)}; };
  box.seeds = {glass_sphere(0, Vec3(9.2 * box.spacing, 8.1 * box.spacing, middle + 0.7 * box.spacing))};
  box.seeds[0].motion = dem::Motion::fixed;
  const auto system = system_of(box);
  const double decay = 24.0 * 24.0 / (std::numbers::pi * std::numbers::pi / 3.0);
  for (int step = 0; step < static_cast<int>(10.0 * decay); ++step) system->advance();
  StressBalance balance = balance_of(box, *system, box.spacing, {{0, 1}});
  measure(balance, *system);
  const Values values = by_name(balance);
  const double unit = 1000.0 * box.viscosity * rate;
  EXPECT_LT(largest_apart(values, "total_stress", "driving_stress"), 1e-4 * unit);
  EXPECT_GT(values.at("total_stress").front(), unit);  // the sphere makes the suspension stiffer

  double torque = 0.0, force = 0.0;
  const GrainView grains = system->snapshot().grains;
  if (!grains.id.empty()) torque = grains.fluid_torque[0].y(), force = grains.fluid_force[0].x();
  torque = sum_over_ranks(MPI_COMM_WORLD, torque);
  force = sum_over_ranks(MPI_COMM_WORLD, force);
  const double area = 20.0 * 18.0 * box.spacing * box.spacing;
  EXPECT_NEAR(integral(values, "rotation_stress"), torque / area, 1e-6 * unit * height);
  EXPECT_GT(torque, 0.0);
  // A layer above the sphere carries the stress of the plate, one below differs by the force that holds the sphere.
  EXPECT_NEAR(values.at("driving_stress").front() - values.at("driving_stress").back(), -force / area, 1e-9 * unit);
}

// The same of a clump of two spheres, one above the other and askew. The stress of its parts, spread over its volume or
// not, is the same in the whole, which it is only with arms from the centre of the clump: the fluid pushes the spheres
// in opposite directions.
TEST(StressBalance, OfAHeldClumpInShearIsThatOfThePlates) {
  WaterBox box = viscous_box({20, 18, 24}, 9.0, 1.5);
  const double height = 24.0 * box.spacing, rate = 0.02 * box.viscosity / (2.5e-3 * 2.5e-3);
  box.plate_velocity = 0.5 * rate * height;
  static double shear, middle;
  shear = rate;
  middle = 0.5 * height;
  box.initial = [](const Vec3& p) { return FluidInitialState{0.0, Vec3(shear * (p.z() - middle), 0.0, 0.0)}; };
  const std::vector<dem::PlacedSphere> pair{{{-0.6e-3, 0.0, -1.6e-3}, 2e-3}, {{0.6e-3, 0.0, 1.6e-3}, 2e-3}};
  box.clumps = {coupling::glass_clump(0, pair, Vec3(9.2 * box.spacing, 8.1 * box.spacing, middle))};
  box.clumps[0].motion = dem::Motion::fixed;
  const auto system = system_of(box);
  const double decay = 24.0 * 24.0 / (std::numbers::pi * std::numbers::pi / 3.0);
  for (int step = 0; step < static_cast<int>(10.0 * decay); ++step) system->advance();
  StressBalance balance = balance_of(box, *system, box.spacing, {{0, 2}});
  measure(balance, *system);
  const Values values = by_name(balance);
  const double unit = 1000.0 * box.viscosity * rate, area = 20.0 * 18.0 * box.spacing * box.spacing;
  EXPECT_LT(largest_apart(values, "total_stress", "driving_stress"), 1e-4 * unit);
  EXPECT_NEAR(integral(values, "sum_of_stresses") / integral(values, "total_stress"), 1.0, 0.02);
  EXPECT_NEAR(integral(values, "solid_fraction") * area / box.clumps[0].shape->volume, 1.0, 1e-9);

  const Snapshot snapshot = system->snapshot();
  double torque = 0.0;
  for (std::size_t n = 0; n < snapshot.grains.id.size(); ++n) {
    const Vec3 arm = snapshot.grains.position[n] - snapshot.grains.clumps[0].position;
    torque += (snapshot.grains.fluid_torque[n] + arm.cross(snapshot.grains.fluid_force[n])).y();
  }
  EXPECT_NEAR(integral(values, "rotation_stress"), torque / area, 1e-6 * unit * height);
  EXPECT_GT(torque, 0.0);
}

// A bed at rest in a viscous fluid that flows down a slope it can bear: two sheets of free spheres, each in the hollows
// of the one below, on a sheet that is held. Weight and contacts come in. The start is the parabola over the bed; what
// is not steady yet decays by exp(-4), and was a quarter of the bed stress at most (a bed surface wrong by half a grain
// in a depth of four).
TEST(StressBalance, OfABedAtRestHasTheWeightOfItsGrains) {
  WaterBox box = viscous_box({24, 12, 36}, 6.0, 1.0);
  box.sub_steps = 20;
  box.gravity = Vec3(9.8 * 0.03, 0.0, -9.8);
  const double rise = 2.5e-3 * std::numbers::sqrt2;
  static double nu, pull, top, bed;
  nu = box.viscosity;
  pull = box.gravity.x();
  top = 36.0 * box.spacing;
  bed = 5e-3 + 2.0 * rise;
  box.initial = [](const Vec3& p) {
    const double z = std::max(0.0, p.z() - bed), depth = top - bed;
    return FluidInitialState{0.0, Vec3(pull / nu * z * (depth - 0.5 * z), 0.0, 0.0)};
  };
  for (int sheet = 0; sheet < 3; ++sheet)
    for (int k = 0; k < 8; ++k) {
      const double aside = 0.5 * (sheet % 2);
      box.seeds.push_back(glass_sphere(
          8 * sheet + k, Vec3((k % 4 + 0.31 + aside) * 5e-3, (k / 4 + 0.17 + aside) * 5e-3, 2.5e-3 + rise * sheet)));
      if (sheet == 0) box.seeds.back().motion = dem::Motion::fixed;
    }
  const auto system = system_of(box);
  const double depth = (top - bed + 2.5e-3) / box.spacing;  // the flow may reach half a grain into the bed
  const double decay = 4.0 * depth * depth / (std::numbers::pi * std::numbers::pi / 6.0);
  for (int step = 0; step < static_cast<int>(4.0 * decay); ++step) system->advance();
  StressBalance balance = balance_of(box, *system, 1.25e-3, {{0, 8}});
  const double area = 24.0 * 12.0 * box.spacing * box.spacing;
  double holding = 0.0;
  constexpr int steps = 20;
  for (int n = 0; n < steps; ++n) {
    system->record_momentum();
    system->measure_grain_stress();
    system->advance();
    const Snapshot snapshot = system->snapshot();
    balance.observe(snapshot);
    const GrainView& grains = snapshot.grains;
    for (std::size_t g = 0; g < grains.id.size(); ++g)
      if (grains.id[g] < 8) holding += (grains.fluid_force[g].x() + grains.contact_force[g].x()) / (steps * area);
  }
  holding = sum_over_ranks(MPI_COMM_WORLD, holding);
  const Values values = by_name(balance);
  EXPECT_LT(std::abs(result(balance, "largest_difference")), 0.25 * std::exp(-4.0));
  EXPECT_NEAR(result(balance, "bed_height"), bed, 1.3e-3);  // a layer
  const double sheet = 8.0 * 4.0 / 3.0 * std::numbers::pi * std::pow(2.5e-3, 3) / area;
  EXPECT_NEAR(integral(values, "solid_fraction"), 3.0 * sheet, 1e-9 * sheet);

  // The forces on the lowest sheet, and on the line in the middle of the lowest layer, which has the part of it above:
  // together the weight along the slope, of the free grains and of the fluid above. The spheres cover their volume
  // within a few per cent.
  const double middle = values.at("z").front(),
               below = sphere_volume_below(2.5e-3, middle) / sphere_volume_below(2.5e-3, 1);
  const double fluid = top - middle - (3.0 - below) * sheet;
  const double weight = box.gravity.x() * (2550.0 * 2.0 * sheet + 1000.0 * fluid);
  EXPECT_NEAR(values.at("driving_stress").front() + (1.0 - below) * holding, weight, 0.02 * weight);
  EXPECT_NEAR(holding, weight, 0.1 * weight);  // the floor under the spheres sees little of the flow
}

// Nothing moves under full gravity: the pressure is that of the height, and a sphere has that of its centre on every
// axis (eq. 13), a few per cent more or less by the cells that it covers.
TEST(StressBalance, HasThePressureOfAFluidAtRest) {
  WaterBox box = viscous_box({18, 18, 36}, 9.0, 1.0);
  box.full_gravity = true;
  box.gravity = Vec3(0.0, 0.0, -0.5);
  const double centre = 4.8e-3, top = 36.0 * box.spacing;
  box.seeds.push_back(glass_sphere(0, Vec3(5.1e-3, 4.9e-3, centre)));
  box.seeds.back().motion = dem::Motion::fixed;
  const auto system = system_of(box);
  StressBalance balance = balance_of(box, *system, 1.25e-3, {{0, 1}});
  measure(balance, *system);
  const Values values = by_name(balance);
  double mean = 0.0;  // height of the fluid
  const double fluid = top - integral(values, "solid_fraction");
  for (std::size_t l = 0; l < values.at("z").size(); ++l)
    mean += values.at("z")[l] * (1.0 - values.at("solid_fraction")[l]) * values.at("thickness")[l] / fluid;
  const double weight = 1000.0 * 0.5, largest = 0.5 * weight * top;
  for (std::size_t l = 0; l < values.at("z").size(); ++l)
    EXPECT_NEAR(values.at("fluid_pressure")[l], weight * (mean - values.at("z")[l]), 0.02 * largest) << "layer " << l;
  double stress[3] = {0.0, 0.0, 0.0};
  for (std::size_t l = 0; l < values.at("z").size(); ++l)
    for (std::size_t a = 0; a < 3; ++a)
      stress[a] += values.at("grain_fluid_stress")[9 * l + 4 * a] * values.at("thickness")[l];
  for (const double s : stress)
    EXPECT_NEAR(s, -weight * (0.5 * top - centre) * integral(values, "solid_fraction"),
                0.05 * weight * (0.5 * top - centre) * integral(values, "solid_fraction"));
}

// Total stress and what side walls and solids take add up to the driving stress in every layer; tolerance: Pa.
void expect_closed(const StressBalance& balance, const Values& values, double tolerance) {
  for (std::size_t l = 0; l < values.at("z").size(); ++l)
    EXPECT_NEAR(values.at("total_stress")[l] + values.at("side_wall_stress")[l], values.at("driving_stress")[l],
                tolerance);
  EXPECT_LT(std::abs(result(balance, "largest_difference")) * result(balance, "bed_stress"), tolerance);
}

// Between side walls two held spheres, one of which touches a wall; the walls take what does not arrive at the floor.
// The slowest part of a start at rest decays faster than between plates H apart, T = H^2/(pi^2 nu) with H the width; 12
// T.
TEST(StressBalance, BetweenSideWallsCountsWhatTheyTakeOfTheFluid) {
  WaterBox box = viscous_box({18, 16, 30}, 9.0, 1.5);
  box.periodic = {true, false, false};
  box.closed = true;
  box.gravity = Vec3(0.02, 0.0, -9.8);
  box.seeds = {glass_sphere(0, Vec3(4e-3, 2.5e-3, 2.9e-3)), glass_sphere(1, Vec3(8.7e-3, 5.1e-3, 3.4e-3))};
  for (dem::GrainSeed& seed : box.seeds) seed.motion = dem::Motion::fixed;
  const auto system = system_of(box);
  const double decay = 16.0 * 16.0 / (std::numbers::pi * std::numbers::pi / 3.0);
  for (int step = 0; step < static_cast<int>(12.0 * decay); ++step) system->advance();
  StressBalance balance = balance_of(box, *system, 1.2e-3, {{0, 2}});
  measure(balance, *system);
  const Values values = by_name(balance);
  const double bed_stress = values.at("driving_stress").front();
  expect_closed(balance, values, 1e-4 * bed_stress);
  // Two walls twice as high as they are apart take most of it.
  EXPECT_GT(values.at("side_wall_stress").front(), 0.5 * bed_stress);
}

// A solid sphere beside a held grain takes its force at the height where the fluid gives it.
TEST(StressBalance, CountsWhatSolidsTake) {
  WaterBox box = viscous_box({18, 18, 30}, 9.0, 1.5);
  box.gravity = Vec3(0.02, 0.0, -9.8);
  box.seeds = {glass_sphere(0, Vec3(2.9e-3, 2.7e-3, 2.9e-3))};
  box.seeds[0].motion = dem::Motion::fixed;
  box.solids = {bodies::SolidSphere{Vec3(7.1e-3, 6.9e-3, 3.1e-3), 2.4e-3}};
  const auto system = system_of(box);
  const double decay = 4.0 * 30.0 * 30.0 / (std::numbers::pi * std::numbers::pi / 3.0);
  for (int step = 0; step < static_cast<int>(10.0 * decay); ++step) system->advance();
  StressBalance balance = balance_of(box, *system, 1.2e-3, {{0, 1}});
  measure(balance, *system);
  const Values values = by_name(balance);
  const double driven = values.at("driving_stress").front();
  expect_closed(balance, values, 1e-4 * driven);
  EXPECT_EQ(values.at("side_wall_stress").back(), 0.0);
  EXPECT_GT(values.at("side_wall_stress").front(), 0.1 * driven);
  const double taken =
      find_diagnostic(system->diagnostics(), "solid_0_force_x").value() / (18.0 * 18.0 * box.spacing * box.spacing);
  EXPECT_NEAR(values.at("side_wall_stress").front(), taken,
              0.02 * taken);  // of which the lowest layer has all but a little
}

// The residue in the balance of a held sphere at a place that scrapes along a wall at 1 mm/s.
Values of_scraping_sphere(WaterBox box, const Vec3& place) {
  box.closed = true;
  box.seeds = {glass_sphere(0, place, Vec3(1e-3, 0.0, 0.0))};
  box.seeds[0].motion = dem::Motion::fixed;
  const auto system = system_of(box);
  for (int step = 0; step < 1000; ++step) system->advance();
  StressBalance balance = balance_of(box, *system, 1.2e-3, {{0, 1}});
  measure(balance, *system);
  return by_name(balance);
}

// Pa: 0.45 of 20000 N/m times the overlap of 5e-6 m.
double friction_stress(const WaterBox& box) {
  return 0.45 * 20000.0 * 5e-6 / (box.cells[0] * box.cells[1] * box.spacing * box.spacing);
}

// A sphere that scrapes slowly along a side wall, pressed against it: the wall takes the friction at the height of the
// sphere's middle, and what moves the sphere gives it.
TEST(StressBalance, BetweenSideWallsCountsWhatTheyTakeOfTheGrains) {
  WaterBox box = viscous_box({18, 12, 24}, 9.0, 1.5);
  box.periodic = {true, false, false};
  const Values values = of_scraping_sphere(box, Vec3(5e-3, 2.495e-3, 6.1e-3));
  const double friction = friction_stress(box);
  for (std::size_t l = 0; l < values.at("z").size(); ++l) {
    EXPECT_NEAR(values.at("total_stress")[l] + values.at("side_wall_stress")[l], values.at("driving_stress")[l],
                1e-3 * friction);
    // The water's share is small: 3 pi eta d v for a sphere far from walls, several times that near one.
    const double below = values.at("z")[l] + 0.5 * values.at("thickness")[l] - 6.1e-3;
    const double above = below - values.at("thickness")[l];
    if (below < 0.0 || above > 0.0) {
      EXPECT_NEAR(values.at("side_wall_stress")[l], below < 0.0 ? friction : 0.0, 0.05 * friction);
    }
  }
}

// A held sphere that scrapes along the top, pressed against it: what takes the friction is the sphere, so that below it
// there is nothing, and in it, as far as it is above, the friction. A stress from the top is driving, not a side
// wall's.
TEST(StressBalance, TheTopDragsGrainsAsWell) {
  const WaterBox box = viscous_box({18, 20, 24}, 9.0, 1.5);
  const double top = 24.0 * box.spacing, friction = friction_stress(box);
  const Values values = of_scraping_sphere(box, Vec3(5e-3, 5e-3, top - 2.495e-3));
  for (std::size_t l = 0; l < values.at("z").size(); ++l) {
    EXPECT_NEAR(values.at("total_stress")[l], values.at("driving_stress")[l], 1e-3 * friction);
    EXPECT_EQ(values.at("side_wall_stress")[l], 0.0);
    if (values.at("z")[l] + 0.5 * values.at("thickness")[l] < top - 5e-3) {
      EXPECT_NEAR(values.at("total_stress")[l], 0.0, 0.05 * friction);
    }
  }
  // The friction points against the velocity; at the top none of the sphere is above to take it.
  EXPECT_LT(values.at("total_stress").back(), -0.5 * friction);
}

}  // namespace
}  // namespace thalweg::analysis::stress_balance_test
