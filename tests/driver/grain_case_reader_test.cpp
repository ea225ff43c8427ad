// Case files of grains: sizes, materials, dry grains.
#include "core/base/error.hpp"
#include "driver/input/case_reader.hpp"
#include "driver/input/run_context.hpp"
#include "tests/driver/case_texts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace thalweg::driver::grain_case_reader_test {
namespace {

using testing::flume;
using testing::message_of;

Case read(const std::string& yaml, const std::vector<std::string>& overrides = {}) {
  return testing::read_text(yaml, overrides);
}

TEST(GrainCaseReader, DryGrainsTakeFiftyStepsAContact) {
  const Case c = read(defaults_yaml("grains"));
  EXPECT_EQ(c.system, SystemKind::grains);
  EXPECT_EQ(grain_time_step(c), shortest_contact(c) / 50.0);
  EXPECT_EQ(read(resolved_yaml(c)), c);
}

TEST(GrainCaseReader, ElasticSpheresHaveModuliInPlaceOfStiffnesses) {
  const std::string elastic =
      "contact={law: hertz_mindlin, youngs_modulus: 1e8, poisson_ratio: 0.25, restitution: 0.9, "
      "tangential_damping: 0.5}";
  const Case c = read(defaults_yaml("grains"), {elastic, "run.time_step=null"});
  EXPECT_EQ(c.contact.law, dem::Law::hertz_mindlin);
  EXPECT_EQ(c.contact.youngs_modulus, 1e8);
  EXPECT_EQ(c.contact.poisson_ratio, 0.25);
  EXPECT_EQ(c.contact.tangential_damping, 0.5);
  EXPECT_EQ(read(resolved_yaml(c)), c);
  // 2.868 (m*^2/(R* E*^2 v))^(1/5) at 1 m/s: m* = 8.1e-5 kg, R* = 1.2375 mm, E* = 5.33e7 Pa.
  const double mass = 0.5 * c.grains[0].lightest_mass(), radius = 0.25 * c.grains[0].diameter,
               modulus = 1e8 / (2.0 * 0.9375);
  EXPECT_NEAR(shortest_contact(c), 2.868 * std::pow(mass * mass / (radius * modulus * modulus), 0.2), 1e-15);
  EXPECT_THROW(read(defaults_yaml("grains"), {elastic, "run.time_step=null", "contact.normal_stiffness=20000"}),
               InputError);
  EXPECT_THROW(read(defaults_yaml("grains"), {elastic, "run.time_step=null", "contact.damping=0.1"}), InputError);
  EXPECT_THROW(read(defaults_yaml("grains"), {"contact.youngs_modulus=1e8"}), InputError);
}

TEST(GrainCaseReader, DryGrainsHaveNoStepsOfAFluid) {
  EXPECT_NE(message_of<InputError>([] {
              read(defaults_yaml("grains"), {"contact.duration={fluid_steps: 40}"});
            }).find("there is no fluid whose steps could be counted; give the duration in s"),
            std::string::npos);
}

// Two spheres of radius R whose centres are R apart: 4/3 pi R^3 each, less the lens of 5 pi/12 R^3 once.
TEST(GrainCaseReader, ClumpsHaveTheVolumeOfTheirUnion) {
  const std::vector<std::string> twins{
      "grains=[{shape: {clump: [{position: [0, 0, 0], diameter: 4.0e-3}, {position: [0, 0, 2.0e-3], diameter: "
      "4.0e-3}]}, "
      "density: 2500, count: 20, orientation: {axis: [0, 1, 0], angle: 0.3}}]"};
  const Case c = read(flume, twins);
  const double volume = (8.0 / 3.0 - 5.0 / 12.0) * std::numbers::pi * 8e-9;
  EXPECT_NEAR(c.grains[0].volume() / (20.0 * volume), 1.0, 1e-12);
  EXPECT_NEAR(c.grains[0].diameter / std::cbrt(6.0 * volume / std::numbers::pi), 1.0, 1e-12);
  EXPECT_NEAR(c.grains[0].largest_extent(), 6e-3, 1e-14);
  EXPECT_EQ(c.grains[0].largest_diameter(), 4e-3);
  EXPECT_EQ(c.grains[0].row_count(), 40);
  // The ends are lighter to the touch than the whole, but not lighter than a point of half the mass turning alone.
  EXPECT_LT(c.grains[0].lightest_mass(), 2500.0 * volume);
  EXPECT_GT(c.grains[0].lightest_mass(), 0.25 * 2500.0 * volume);
  EXPECT_EQ(read(resolved_yaml(c)), c);
  EXPECT_THROW(read(flume, {twins[0], "grains.0.orientation.axis=[0, 0, 0]"}), InputError);
  EXPECT_THROW(read(flume, {twins[0], "grains.0.motion={velocity: [0.1, 0, 0]}"}), InputError);
}

// The size of a clump is the diameter of the sphere of its volume, however large its shape is given: twins of radius R
// have the volume 4 pi/3 R^3 (2 - 5/16).
TEST(GrainCaseReader, ClumpsTakeSizesAsSpheresDo) {
  const std::string twins =
      "grains=[{shape: {clump: [{position: [0, 0, 0], diameter: 1}, {position: [0, 0, 0.5], diameter: 1}]}, density: "
      "2500, count: 20, diameter: ";
  const double member = std::cbrt(1.0 / (2.0 - 5.0 / 16.0));  // diameter over that of the clump
  const Case one = read(flume, {twins + "3e-3}]"});
  EXPECT_EQ(one.grains[0].diameter, 3e-3);
  EXPECT_NEAR(one.grains[0].volume() / (20.0 * std::numbers::pi / 6.0 * 27e-9), 1.0, 1e-12);
  EXPECT_NEAR(one.grains[0].largest_diameter(), member * 3e-3, 1e-14);
  EXPECT_NEAR(one.grains[0].largest_extent(), 1.5 * member * 3e-3, 1e-14);
  EXPECT_EQ(read(resolved_yaml(one)), one);

  const std::string mixed = "{sieve: {sizes: [2e-3, 4e-3], finer: [0, 1]}}}]";
  const Case clumps = read(flume, {twins + mixed});
  const Case spheres = read(flume, {"grains=[{density: 2500, count: 20, diameter: " + mixed});
  const beds::Population &clump = clumps.grains[0], &sphere = spheres.grains[0];
  EXPECT_EQ(clump.diameters, sphere.diameters);
  EXPECT_EQ(clump.diameter, sphere.diameter);
  EXPECT_NEAR(clump.volume() / sphere.volume(), 1.0, 1e-12);
  EXPECT_NEAR(clump.smallest_diameter() / (member * sphere.smallest_diameter()), 1.0, 1e-12);
  EXPECT_NEAR(clump.largest_diameter() / (member * sphere.largest_diameter()), 1.0, 1e-12);
  EXPECT_NEAR(clump.clumps.largest_extent / (1.5 * clump.largest_diameter()), 1.0, 1e-12);
  // Twins have <y^2> = (8/15 - 53/960)/(9/4) R^2 = 17/80 R^2 across the line of their centres, of both spheres less
  // their lens; the axis is 2 (5 <y^2>)^1/2, for any body as large as the smallest.
  EXPECT_NEAR(clump.narrowest() / clump.smallest_diameter(), std::sqrt(17.0 / 16.0), 1e-3);
  EXPECT_EQ(sphere.narrowest(), sphere.smallest_diameter());
  // The smallest is the lightest to the touch, in proportion to its mass.
  const double lighter = std::pow(sphere.smallest_diameter() / 3e-3, 3);
  EXPECT_NEAR(clump.lightest_mass() / (lighter * one.grains[0].lightest_mass()), 1.0, 1e-12);
  EXPECT_EQ(read(resolved_yaml(clumps)), clumps);
}

// Grain n of a lognormal population of N lies at the share (n + 1/2)/N of the cut distribution, in order of size.
TEST(GrainCaseReader, SizesFollowTheirDistribution) {
  const std::string sizes =
      "grains.0.diameter={distribution: lognormal, median: 4.5e-3, geometric_deviation: 1.3, minimum: 3e-3, maximum: "
      "6e-3}";
  const Case c = read(flume, {sizes});
  std::vector<double> d = c.grains[0].diameters;
  ASSERT_EQ(d.size(), 150u);
  EXPECT_FALSE(std::is_sorted(d.begin(), d.end()));  // the seed shuffles
  std::sort(d.begin(), d.end());
  const auto below = [](double diameter) {
    return 0.5 * std::erfc(-std::log(diameter / 4.5e-3) / std::log(1.3) / std::sqrt(2.0));
  };
  for (std::size_t n = 0; n < d.size(); ++n)
    EXPECT_NEAR((below(d[n]) - below(3e-3)) / (below(6e-3) - below(3e-3)), (static_cast<double>(n) + 0.5) / 150.0,
                1e-12);
  // Half of the mass is finer than the population's diameter.
  double finer = 0.0, all = 0.0;
  for (const double diameter : d) {
    all += std::pow(diameter, 3);
    if (diameter <= c.grains[0].diameter) finer += std::pow(diameter, 3);
  }
  EXPECT_NEAR(finer / all, 0.5, std::pow(6e-3, 3) / all);
  EXPECT_EQ(read(flume, {sizes, "grains.0.placement.seed=8"}).grains[0].smallest_diameter(), d.front());
  EXPECT_NE(read(flume, {sizes, "grains.0.placement.seed=8"}).grains[0].diameters, c.grains[0].diameters);
  EXPECT_EQ(read(resolved_yaml(c)), c) << resolved_yaml(c);
}

// Populations scatter their grains differently, unless the case gives them the same seed.
TEST(CaseReader, SeedsOfPopulationsDiffer) {
  const std::string three =
      "grains=[{count: 5, diameter: 4e-3, density: 2550}, {count: 5, diameter: 4e-3, density: 2550}, "
      "{count: 5, diameter: 4e-3, density: 2550, placement: {seed: 1}}]";
  const Case c = read(flume, {three});
  EXPECT_EQ(c.grains[0].placement.seed, 1);
  EXPECT_EQ(c.grains[1].placement.seed, 2);
  EXPECT_EQ(c.grains[2].placement.seed, 1);
  EXPECT_EQ(read(resolved_yaml(c)), c);
}

TEST(GrainCaseReader, ListedSizesHaveTheirShareOfTheNumber) {
  const Case c = read(flume, {"grains.0.diameter={sizes: [4e-3, 3e-3, 5e-3], fractions: [0.2, 0.3, 0.5]}"});
  const std::vector<double>& d = c.grains[0].diameters;
  EXPECT_EQ(std::count(d.begin(), d.end(), 4e-3), 30);
  EXPECT_EQ(std::count(d.begin(), d.end(), 3e-3), 45);
  EXPECT_EQ(std::count(d.begin(), d.end(), 5e-3), 75);
  EXPECT_EQ(c.grains[0].diameter, 5e-3);
  EXPECT_NEAR(c.grains[0].volume(), std::numbers::pi / 6.0 * (30 * 64e-9 + 45 * 27e-9 + 75 * 125e-9), 1e-20);
  EXPECT_EQ(smallest_diameter(c), 3e-3);
  EXPECT_EQ(read(resolved_yaml(c)), c) << resolved_yaml(c);
}

// Masses agree to within that of the largest grain; the seed shuffles, and the case as run has the same sizes.
TEST(GrainCaseReader, SizesAreGivenByMass) {
  const std::vector<std::string> all_sizes{
      "grains.0.diameter={sieve: {sizes: [3e-3, 4e-3, 5e-3, 6e-3], finer: [0, 0.16, 0.5, 1]}}",
      "grains.0.diameter={d16: 4e-3, d50: 5e-3, d84: 5.5e-3}"};
  for (const std::string& sizes : all_sizes) {
    const Case c = read(flume, {sizes});
    const std::vector<double>& d = c.grains[0].diameters;
    ASSERT_EQ(d.size(), 150u);
    EXPECT_FALSE(std::is_sorted(d.begin(), d.end()));
    const auto mass_finer = [&](double than) {
      double sum = 0.0;
      for (const double diameter : d) sum += diameter <= than ? beds::sphere_volume(diameter) : 0.0;
      return sum;
    };
    const double grain = beds::sphere_volume(c.grains[0].largest_diameter());
    EXPECT_NEAR(mass_finer(4e-3), 0.16 * c.grains[0].volume(), grain);
    EXPECT_NEAR(mass_finer(5e-3), 0.5 * c.grains[0].volume(), grain);
    EXPECT_NEAR(mass_finer(c.grains[0].diameter), 0.5 * c.grains[0].volume(), grain);
    EXPECT_EQ(read(resolved_yaml(c)), c) << resolved_yaml(c);
  }
  const Case uncut = read(flume, {all_sizes[1]});  // from d16^2/d50 to d84^2/d50
  EXPECT_GT(uncut.grains[0].smallest_diameter(), 3.2e-3);
  EXPECT_LT(uncut.grains[0].smallest_diameter(), 3.3e-3);
  EXPECT_LT(uncut.grains[0].largest_diameter(), 6.05e-3);
  const Case cut = read(flume, {all_sizes[1], "grains.0.diameter.minimum=3.8e-3"});
  EXPECT_GE(cut.grains[0].smallest_diameter(), 3.8e-3);
}

TEST(GrainCaseReader, SizesByMassThatCannotBe) {
  const auto refused = [](const std::string& sizes) {
    return message_of<InputError>([&] { read(flume, {"grains.0.diameter=" + sizes}); });
  };
  for (const auto& [sizes, words] : std::vector<std::pair<std::string, std::string>>{
           {"{sieve: {sizes: [4e-3], finer: [1]}}", "grains.0.diameter.sieve.sizes = [4e-3]: give at least two sieves"},
           {"{sieve: {sizes: [5e-3, 4e-3], finer: [0, 1]}}", "each at least 0.1 % wider than the one before"},
           {"{sieve: {sizes: [4e-5, 5e-3], finer: [0, 1]}}", "the widest sieve can be at most 100 times the finest"},
           {"{sieve: {sizes: [4e-3, 5e-3], finer: [0, 0.5, 1]}}", "as many shares of the mass as sieves"},
           {"{sieve: {sizes: [4e-3, 5e-3], finer: [0.1, 1]}}", "must rise from 0 at the first sieve to 1 at the last"},
           {"{sieve: {sizes: [4e-3, 5e-3, 6e-3], finer: [0, 1.2, 1]}}", "at most 1"},
           {"{d16: 4e-3, d84: 5e-3}", "grains.0.diameter.d16 = 4e-3: give d16, d50 and d84 together"},
           {"{d16: 4e-3, d50: 5e-3, d84: 5e-3}", "must rise in this order"},
           {"{d16: 4e-3, d50: 5e-3, d84: 6e-3, minimum: 4.5e-3}", "must rise in this order"},
           {"{d16: 4e-3, d50: 5e-3, d84: 6e-3, minimum: 5e-5}", "the largest can be at most 100 times the smallest"},
           {"{d16: 4e-3, d50: 5e-3, d84: 6e-3, median: 5e-3}", "only a distribution has it"},
           {"{sieve: {sizes: [4e-3, 5e-3], finer: [0, 1]}, minimum: 4e-3}", "only a distribution has it"},
           {"{sieve: {sizes: [4e-3, 5e-3], finer: [0, 1]}, value: 5e-3}", "give exactly one of value in m"}})
    EXPECT_NE(refused(sizes).find(words), std::string::npos) << refused(sizes);
}

// A key that is missing is reported when the section is read, and until then nothing is computed with it.
TEST(GrainCaseReader, SizesOfWhichAKeyIsMissing) {
  const auto refused = [](const std::string& sieve) {
    return message_of<InputError>([&] { read(flume, {"grains.0.diameter={sieve: " + sieve + "}"}); });
  };
  for (const std::string sieve : {"{sizes: [4e-3, 5e-3]}", "{sizes: [4e-3, 5e-3], fner: [0, 1]}"})
    EXPECT_NE(refused(sieve).find("finer"), std::string::npos) << sieve;
  EXPECT_NE(refused("{finer: [0, 1]}").find("sieve.sizes is missing"), std::string::npos);
}

// The fixed population of 4 mm is no sediment and makes no class.
TEST(GrainCaseReader, SizeClassesAreTheSievesOfFreeGrains) {
  const std::string sizes = "{sieve: {sizes: [4.2e-3, 5e-3, 6e-3], finer: [0, 0.5, 1]}}";
  const Case c = read(flume, {"grains.0.diameter=" + sizes, "analysis.fractional_transport={}"});
  const analysis::GrainContext sieved = *run_context(c).grains;
  EXPECT_EQ(sieved.size_class_edges, (std::vector<double>{4.2e-3, 5e-3, 6e-3}));
  EXPECT_EQ(sieved.smallest_free, c.grains[0].smallest_diameter());
  EXPECT_EQ(sieved.largest_free, c.grains[0].largest_diameter());
  EXPECT_EQ(read(resolved_yaml(c)), c) << resolved_yaml(c);
  const analysis::GrainContext alike = *run_context(read(flume, {"analysis.fractional_transport={}"})).grains;
  EXPECT_EQ(alike.size_class_edges.size(), 2u);
  EXPECT_EQ(alike.smallest_free, 4.95e-3);
  EXPECT_TRUE(run_context(read(flume)).grains->size_class_edges.empty()) << "nothing asks for them";
}

TEST(GrainCaseReader, PopulationsAndWallsChangeTheMaterial) {
  const Case c = read(flume, {"grains.1.contact={normal_stiffness: 5e4, friction: 0.2}",
                              "contact.walls={restitution: 0.5, tangential_stiffness: 100}"});
  EXPECT_FALSE(c.grains[0].contact.has_value());
  EXPECT_EQ(*c.grains[1].contact->normal_stiffness, 5e4);
  EXPECT_EQ(*c.contact.walls->restitution, 0.5);
  EXPECT_EQ(read(resolved_yaml(c)), c) << resolved_yaml(c);
}

TEST(GrainCaseReader, DryGrainsNeedGrains) {
  const std::string message = message_of<InputError>([] { read(defaults_yaml("grains"), {"grains=[]"}); });
  EXPECT_NE(message.find("--set grains=[]: grains = []: a run of dry grains needs at least one"), std::string::npos)
      << message;
}

TEST(GrainCaseReader, DryGrainsHaveNoWaterThatRings) {
  const std::string ramp = message_of<InputError>([] { read(defaults_yaml("grains"), {"run.ramp=0.1"}); });
  EXPECT_NE(ramp.find("run.ramp = 0.1: a ramp avoids pressure waves in a fluid, and there is none"), std::string::npos)
      << ramp;
  EXPECT_THROW(read(defaults_yaml("grains"), {"fluid.bulk_relaxation_time=10"}), InputError);
}

TEST(GrainCaseReader, DryGrainsRefuseAStepTooLong) {
  const std::string message = message_of<InputError>([] { read(defaults_yaml("grains"), {"run.time_step=1e-4"}); });
  EXPECT_NE(
      message.find("--set run.time_step=1e-4: run.time_step = 1e-4: a step of the grains of 0.0001 s is longer than "
                   "1/20 of their shortest contact (0.0001999 s); give at most 9.99e-06 s."),
      std::string::npos)
      << message;
}

TEST(GrainCaseReader, RollingAndKineticFrictionArePartsOfTheMaterial) {
  const Case c =
      read(flume, {"contact.rolling_friction=0.1", "contact.wall_rolling_friction=0.05", "contact.rolling_damping=0.5",
                   "contact.kinetic_friction_ratio=0.8", "grains.1.contact={rolling_friction: 0.2}"});
  EXPECT_EQ(c.contact.rolling_friction, 0.1);
  EXPECT_EQ(c.contact.wall_rolling_friction, 0.05);
  EXPECT_EQ(c.contact.rolling_damping, 0.5);
  EXPECT_EQ(c.contact.kinetic_friction_ratio, 0.8);
  EXPECT_EQ(*c.grains[1].contact->rolling_friction, 0.2);
  EXPECT_EQ(read(resolved_yaml(c)), c) << resolved_yaml(c);
  EXPECT_EQ(read(flume).contact.rolling_friction, 0.0);
  const std::string message = message_of<InputError>([] { read(flume, {"contact.walls={rolling_friction: 0.1}"}); });
  EXPECT_NE(message.find("the rolling friction of walls is contact.wall_rolling_friction"), std::string::npos)
      << message;
}

TEST(GrainCaseReader, WallsAndPopulationsMove) {
  const std::vector<std::string> settings{
      "domain.boundaries.bottom={type: moving, velocity: [0, 0, 0.1], oscillation: {amplitude: [0, 0, 1e-3], "
      "frequency: "
      "20, phase: 1.5}}",
      "walls=[{point: [0.01, 0, 0], normal: [1, 0, 1], friction: 0.2, velocity: [0.1, 0, 0]}]",
      "grains.0.motion={velocity: [0.1, 0, 0], rotation: {point: [0.03, 0, 0.03], angular_velocity: 2}}"};
  const Case c = read(defaults_yaml("grains"), settings);
  EXPECT_EQ(c.domain.faces[bottom].oscillation->phase, 1.5);
  EXPECT_EQ(c.walls.at(0).normal, Vec3(1.0, 0.0, 1.0));
  EXPECT_EQ(*c.walls[0].friction, 0.2);
  EXPECT_EQ(c.grains[0].motion->rotation->axis, Vec3::UnitY());
  EXPECT_EQ(read(resolved_yaml(c)), c) << resolved_yaml(c);
  const auto refused = [](const std::string& setting) {
    return message_of<InputError>([&] { read(flume, {setting}); });
  };
  EXPECT_NE(refused(settings[0]).find("only dry grains have walls that swing"), std::string::npos);
  EXPECT_NE(refused("domain.boundaries.bottom={type: moving, velocity: [0, 0, 0.1]}").find("moves in its own plane"),
            std::string::npos);
  EXPECT_NE(refused(settings[1]).find("only the faces of the box"), std::string::npos);
  // 40 rad/s, 40 mm away: 1.6 m/s and more; the lattice takes 0.173 cells a step, 4.3 m/s, at 20 us.
  EXPECT_NE(
      refused("grains.0.motion={rotation: {point: [0.03, 0, 0.03], angular_velocity: 200}}").find("cells per step"),
      std::string::npos);
}

}  // namespace
}  // namespace thalweg::driver::grain_case_reader_test
