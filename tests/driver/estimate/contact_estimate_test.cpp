#include "driver/estimate/contact_estimate.hpp"

#include "driver/warnings/case_warnings.hpp"
#include "tests/driver/case_texts.hpp"
#include "tests/driver/text_search.hpp"
#include "tests/driver/water_over_glass.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::driver::contact_estimate_test {
namespace {

constexpr double d = 5e-3, depth = 0.0412;

Case bed() { return water_over_glass(d, 0.016, depth, 0.040, lbm::FaceType::periodic); }

// benchmarks/validation/rebound_in_water: 2 % of a diameter for 555 N/m at 0.3 m/s, here at the speed of a fall.
TEST(Overlaps, OfLinearAndOfElasticContacts) {
  Case c = bed();
  c.contact.normal_stiffness = 555.0;
  const Overlaps soft = expected_overlaps(c);
  const double mass = 2550.0 * std::numbers::pi / 6.0 * d * d * d;
  EXPECT_NEAR(soft.in_impact, 0.48 * std::sqrt(0.5 * mass / 555.0) / d, 2e-4 + 0.01 * soft.in_impact);
  const double height = c.domain.size.z() - depth;
  EXPECT_NEAR(soft.under_weight, 0.6 * 1550.0 * 9.8 * std::cos(std::atan(0.016)) * height * d / 555.0, 1e-9);
  c.contact.normal_stiffness = 100.0;
  EXPECT_TRUE(any_contains(warnings(c), "would overlap"));
  c.contact.normal_stiffness = 20000.0;
  EXPECT_FALSE(any_contains(warnings(c), "would overlap"));

  // Hertz: the energy of the deepest overlap, 8/15 E* sqrt(R*) delta^(5/2), is that of the impact.
  c.contact.law = dem::Law::hertz_mindlin;
  c.contact.youngs_modulus = 1e7;
  c.contact.poisson_ratio = 0.2;
  const Overlaps elastic = expected_overlaps(c);
  const double modulus = 1e7 / (2.0 * (1.0 - 0.04)), energy = 0.5 * 0.5 * mass * elastic.speed * elastic.speed;
  EXPECT_NEAR(8.0 / 15.0 * modulus * std::sqrt(0.25 * d) * std::pow(elastic.in_impact * d, 2.5), energy, 1e-9 * energy);
}

// A grain that meets a wall has twice the effective mass of two grains: v sqrt(m/k) and, under the bed, p d^2/k.
TEST(Overlaps, OfSofterWallsAreTheirs) {
  Case c = bed();
  c.contact.normal_stiffness = 20000.0;
  const Overlaps of_grains = expected_overlaps(c);
  c.contact.walls.emplace();
  c.contact.walls->restitution = 0.5;  // as soft as the grains
  EXPECT_EQ(expected_overlaps(c).in_impact, of_grains.in_impact);
  c.contact.walls->normal_stiffness = 100.0;
  const Overlaps with_walls = expected_overlaps(c);
  EXPECT_NEAR(with_walls.in_impact, std::sqrt(2.0 * 200.0) * of_grains.in_impact, 1e-9 * with_walls.in_impact);
  EXPECT_NEAR(with_walls.under_weight, 200.0 * of_grains.under_weight, 1e-9 * with_walls.under_weight);
  EXPECT_TRUE(any_contains(warnings(c), "would overlap"));
}

// By the linear law those of the largest grains: under the pressure p of the bed p d/k of a diameter. A few fine grains
// change nothing.
TEST(Overlaps, OfAMixtureAreThoseOfItsLargestGrains) {
  Case c = bed();
  c.contact.normal_stiffness = 555.0;
  const Overlaps alike = expected_overlaps(c);
  beds::Population& grains = c.grains[free_populations(c).front()];
  grains.diameters.assign(static_cast<std::size_t>(grains.count), d);
  grains.diameters.front() = 0.25 * d;
  const Overlaps mixed = expected_overlaps(c);
  EXPECT_NEAR(mixed.in_impact / mixed.speed, alike.in_impact / alike.speed, 0.01 * alike.in_impact / alike.speed);
  EXPECT_NEAR(mixed.under_weight, alike.under_weight, 0.01 * alike.under_weight);
}

// A clump carries as much as the sphere of its volume, on the spring of one member: p D^2/(k d) of its diameter d.
TEST(Overlaps, OfClumpsAreThoseOfAMemberUnderTheWholeLoad) {
  const std::string stiffness = "contact.normal_stiffness=600",
                    shape =
                        "grains.0.shape={clump: [{position: [0, 0, 0], diameter: 1.0}, {position: [0.5, 0, 0], "
                        "diameter: 1.0}]}";
  const Case spheres = testing::read_text(testing::flume, {stiffness}),
             clumps = testing::read_text(testing::flume, {stiffness, shape});
  const double narrower = clumps.grains[0].largest_diameter() / spheres.grains[0].largest_diameter(),
               alike = expected_overlaps(spheres).under_weight;
  EXPECT_LT(narrower, 0.9);
  EXPECT_NEAR(expected_overlaps(clumps).under_weight, alike / narrower, 1e-6 * alike);
  EXPECT_TRUE(only_friction_holds_the_bed(spheres));
  EXPECT_FALSE(only_friction_holds_the_bed(clumps));
}

// Grains that are thrown at a wall or at held grains meet them as fast as they are thrown.
TEST(Overlaps, OfGrainsThatAreThrown) {
  Case c = bed();
  const double falling = expected_overlaps(c).speed;
  c.grains.front().velocity = Vec3(3.0, 0.0, -4.0);  // at the floor
  EXPECT_GT(5.0, falling);
  EXPECT_NEAR(expected_overlaps(c).speed, 5.0, 1e-12);
  for (const FaceIndex face : {bottom, top}) c.domain.faces[face].type = lbm::FaceType::periodic;
  EXPECT_NEAR(expected_overlaps(c).speed, falling, 1e-12);  // they all fly alike
  beds::Population target = c.grains.front();
  target.velocity = Vec3::Zero();
  target.fixed = true;
  c.grains.push_back(target);
  EXPECT_NEAR(expected_overlaps(c).speed, 5.0, 1e-12);
  c.grains.back().fixed = false;
  c.grains.back().prescribed_velocity = Vec3(-3.0, 0.0, 4.0);  // towards them
  EXPECT_NEAR(expected_overlaps(c).speed, 10.0, 1e-12);
}

// A wall throws a grain at rest at twice its speed along its normal, 2 A 2 pi f; one that slides in its own plane
// throws none. A solid, or a body of grains, meets grains at rest as fast as it is.
TEST(Overlaps, OfGrainsThatAreMet) {
  Case c = bed();
  c.system = SystemKind::grains;
  const double falling = expected_overlaps(c).speed, swing = 2.0 * std::numbers::pi * 100.0 * 4e-3;
  Case shaken = c, sheared = c, stirred = c, struck = c;
  shaken.domain.faces[bottom].type = lbm::FaceType::moving;
  shaken.domain.faces[bottom].oscillation = {Vec3(0.0, 0.0, 4e-3), 100.0};
  EXPECT_NEAR(expected_overlaps(shaken).speed, 2.0 * swing, 1e-9);
  sheared.walls.emplace_back();
  sheared.walls.front().point = Vec3(0.0, 0.0, 0.05);
  sheared.walls.front().normal = Vec3(0.0, 0.0, -2.0);
  sheared.walls.front().velocity = Vec3(9.0, 0.0, 0.0);
  EXPECT_EQ(speed_off_walls(sheared), 0.0);
  EXPECT_EQ(expected_overlaps(sheared).speed, falling);
  sheared.walls.front().velocity.z() = -2.0;
  EXPECT_NEAR(expected_overlaps(sheared).speed, 4.0, 1e-12);
  stirred.solids.emplace_back().sphere = SphereCase{Vec3(0.02, 0.005, 0.05), 0.004};
  stirred.solids[0].motion.emplace().velocity = Vec3(3.0, 0.0, 0.0);
  EXPECT_NEAR(expected_overlaps(stirred).speed, 3.0, 1e-12);
  beds::Population& body = struck.grains.emplace_back(struck.grains.front());
  body.motion.emplace();
  const double onto_it = expected_overlaps(struck).speed;
  body.motion->velocity.x() = 9.0;  // a plate that shears them
  EXPECT_EQ(expected_overlaps(struck).speed, onto_it);
  body.motion->velocity.z() = 3.0;
  EXPECT_NEAR(expected_overlaps(struck).speed, 6.0, 1e-12);
}

// A column of grains under water, by hand: shear stress rho_f g_x H + (rho_f + 0.6 excess) g_x h.
TEST(SlidingBed, IsThatOfTheStressesAtItsBase) {
  Case c = bed();
  const double height = c.domain.size.z() - depth, sine = std::sin(std::atan(0.016)),
               cosine = std::cos(std::atan(0.016));
  const double shear = (1000.0 * depth + (1000.0 + 0.6 * 1550.0) * height) * sine;
  EXPECT_NEAR(stress_ratio_at_base(c), shear / (0.6 * 1550.0 * height * cosine), 1e-12);
  Case lid = c;
  lid.domain.faces[top].type = lbm::FaceType::no_slip;  // holds half of the water
  EXPECT_NEAR(stress_ratio_at_base(lid), (shear - 500.0 * depth * sine) / (0.6 * 1550.0 * height * cosine), 1e-12);
  c.contact.friction = 0.5;
  EXPECT_FALSE(any_contains(warnings(c), "slides as a whole"));
  c.gravity.slope = 0.2;
  EXPECT_TRUE(any_contains(warnings(c), "slides as a whole"));
  c.system = SystemKind::grains;
  EXPECT_NEAR(stress_ratio_at_base(c), 0.2, 1e-12);  // dry: the tangent
  EXPECT_EQ(bulk_friction(0.5), 0.382);
  EXPECT_NEAR(bulk_friction(0.2), 0.5 * (0.268 + 0.357), 1e-12);
  EXPECT_EQ(bulk_friction(50.0), 0.405);
}

// Chialvo, Sun and Sundaresan (2012) have spheres without rolling friction or cohesion; what is held does not slide.
TEST(SlidingBed, IsNotThatOfGrainsWhichHoldMore) {
  const auto warned = [](const Case& c) { return any_contains(warnings(c), "slides as a whole"); };
  Case c = bed();
  c.gravity.slope = 0.3;
  c.contact.friction = 0.5;
  ASSERT_TRUE(warned(c));
  Case held = c, rolling = c, own = c, wet = c;
  held.grains.front().fixed = true;
  EXPECT_FALSE(warned(held));
  EXPECT_EQ(stress_ratio_at_base(held), 0.0);
  rolling.contact.rolling_friction = 0.3;
  EXPECT_FALSE(warned(rolling));
  EXPECT_EQ(stress_ratio_at_base(rolling), stress_ratio_at_base(c));
  own.grains.front().contact.emplace().rolling_friction = 0.3;
  EXPECT_FALSE(warned(own));
  own.contact.rolling_friction = 0.3;  // of walls and of no grain
  own.grains.front().contact->rolling_friction = 0.0;
  EXPECT_TRUE(warned(own));
  wet.contact.liquid_bridge.emplace();
  EXPECT_FALSE(only_friction_holds_the_bed(wet));
}

}  // namespace
}  // namespace thalweg::driver::contact_estimate_test
