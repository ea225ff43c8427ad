// Profiles of grains and their stresses against closed forms: layers of single spheres, a compressed lattice, a column
// and a bed under its weight.
#include "analysis/observers/grain_profiles.hpp"

#include "analysis/tools/sphere_in_layer.hpp"
#include "core/state/contact_stress.hpp"
#include "core/sums/reproducible_sum.hpp"
#include "dem/clumps/clump_of_body.hpp"
#include "dem/clumps/clump_seed.hpp"
#include "tests/dem/grain_cases.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace thalweg::analysis::grain_profiles_test {
namespace {

using dem::GrainDynamics;
using dem::GrainParameters;
using dem::GrainSeed;

constexpr double diameter = 2.0 * dem::test::glass_radius, g = 9.8;

// The grains of a GrainDynamics as a snapshot shows them.
class Shown : public ContactSource {
public:
  explicit Shown(const GrainDynamics& grains) : grains_(grains) {}
  void for_each_contact(const ContactVisitor& visit) const override { grains_.for_each_contact(visit); }
  void for_each_contact_of(std::span<const char> chosen, const ContactEndVisitor& visit) const override {
    grains_.for_each_contact_of(chosen, visit);
  }

  Snapshot snapshot(std::int64_t step = 0) const {
    const dem::GrainStore& s = grains_.store();
    Snapshot shown;
    shown.step = step;
    shown.decomposition = &grains_.decomposition();
    shown.contacts = this;
    shown.grains.global_count = grains_.global_count();
    shown.grains.id = {s.id.data(), s.owned};
    shown.grains.radius = {s.radius.data(), s.owned};
    shown.grains.mass = {s.mass.data(), s.owned};
    shown.grains.position = {s.position.data(), s.owned};
    shown.grains.velocity = {s.velocity.data(), s.owned};
    shown.grains.angular_velocity = {s.angular_velocity.data(), s.owned};
    grains_.show_clumps(shown.grains);
    return shown;
  }

private:
  const GrainDynamics& grains_;
};

std::map<std::string, std::vector<double>> by_name(const GrainProfiles& profiles) {
  std::map<std::string, std::vector<double>> values;
  for (const Profile& profile : profiles.profiles()) values[profile.name] = profile.values;
  return values;
}

GrainParameters plain() {
  GrainParameters p = dem::test::parameters(dem::test::glass(0.3), 8e-6, 20);
  p.contact.normal_stiffness = 20000.0;
  return p;
}

Decomposition box_of(const Index3& cells, double spacing, bool periodic_z) {
  return {cells, spacing, {true, true, periodic_z}, Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD))};
}

// Two spheres of radius R that share half a radius each, 2R to 3R long as they lie: the clump's volume, momentum and
// weight are in the layers once, whatever its members share, and it carries its weight through its foot.
TEST(GrainProfiles, AClumpIsItsUnionOnce) {
  const Decomposition decomposition = box_of({16, 16, 16}, 1.5e-3, false);
  const double r = dem::test::glass_radius;
  const std::vector<dem::PlacedSphere> pair{{Vec3::Zero(), r}, {Vec3(0.0, 0.0, r), r}};
  dem::ClumpSeed seed;
  seed.shape = std::make_shared<const dem::ClumpShape>(dem::clump_shape(pair));
  seed.density = dem::test::glass_density;
  const double weight = seed.mass() * g, overlap = weight / 20000.0;
  seed.position = Vec3(0.011, 0.013, 1.5 * r - overlap);
  seed.velocity = Vec3(0.2, -0.1, 0.0);
  GrainParameters p = plain();
  p.initial_overlap = 1e-2;
  p.walls = {dem::face_plane(decomposition.box(), 2, false, 0.0)};
  p.body_force = [](double mass, double) { return Vec3(0.0, 0.0, -g * mass); };
  const GrainDynamics grains(decomposition, MPI_COMM_WORLD, p, {}, {seed});
  GrainProfiles profiles(MPI_COMM_WORLD, decomposition, 1e-3, {});
  profiles.observe(Shown(grains).snapshot());
  const auto values = by_name(profiles);
  const double layer = 0.024 * 0.024 * 1e-3;
  double volume = 0.0, along = 0.0, stress = 0.0;
  for (std::size_t n = 0; n < values.at("z").size(); ++n) {
    volume += values.at("solid_fraction")[n] * layer;
    along += values.at("flux")[3 * n] * layer;
    stress += values.at("contact_stress")[9 * n + 8] * layer;
  }
  // 4/3 pi R^3 twice, less the lens 5 pi/12 R^3; the parts of a sphere in layers are differences rounded to 1e-16 of
  // it, the part below the floor, 1e-4 of it, is in no layer.
  const double exact = (8.0 / 3.0 - 5.0 / 12.0) * std::numbers::pi * r * r * r;
  EXPECT_NEAR(volume / exact, 1.0, 1e-6);
  EXPECT_NEAR(along / (0.2 * exact), 1.0, 1e-6);
  // F_z = m g at the foot, 3/2 R below the centre.
  EXPECT_NEAR(stress / (-weight * (1.5 * r - overlap)), 1.0, 1e-6);
}

// Spheres that stand for bodies with moments of 1, 2 and 2.5 about x, y and z: the long axis is x, the short one z. One
// lies as it is given, one is turned by a about y; a grain without a shape does not count.
TEST(GrainProfiles, OfClumpsHaveTheMeanOrientationOfTheirAxes) {
  const Decomposition decomposition = box_of({16, 16, 16}, 1.5e-3, false);
  const double r = dem::test::glass_radius, a = 0.7, volume = 4.0 / 3.0 * std::numbers::pi * r * r * r;
  dem::BodyMoments body;
  body.volume = volume;
  body.inertia = volume * r * r / 5.0 * Vec3(1.0, 2.0, 2.5).asDiagonal();
  dem::ClumpSeed lying;
  lying.shape = std::make_shared<const dem::ClumpShape>(
      dem::clump_shape(std::vector<dem::PlacedSphere>{{Vec3::Zero(), r}}, body));
  lying.density = dem::test::glass_density;
  lying.id = 1;
  lying.position = Vec3(0.004, 0.004, 0.005);
  dem::ClumpSeed turned = lying;
  turned.id = 2;
  turned.position = Vec3(0.018, 0.012, 0.005);
  turned.orientation = {std::cos(0.5 * a), 0.0, std::sin(0.5 * a), 0.0};
  dem::GrainSeed sphere;
  sphere.radius = r;
  sphere.density = dem::test::glass_density;
  sphere.position = Vec3(0.004, 0.018, 0.005);
  const GrainDynamics grains(decomposition, MPI_COMM_WORLD, plain(), {sphere}, {lying, turned});
  GrainProfiles profiles(MPI_COMM_WORLD, decomposition, 1e-3, {}, 0.0, true);
  profiles.observe(Shown(grains).snapshot());
  const auto values = by_name(profiles);
  const double s = std::sin(a), c = std::cos(a);
  const std::array<double, 6> long_axes{0.5 + 0.5 * c * c, 0.0, 0.5 * s * s, 0.0, -0.5 * s * c, 0.0},
      short_axes{0.5 * s * s, 0.0, 0.5 + 0.5 * c * c, 0.0, 0.5 * s * c, 0.0};
  double clumps = 0.0, all = 0.0;
  for (std::size_t n = 0; n < values.at("z").size(); ++n) {
    clumps += values.at("clump_fraction")[n] * 0.024 * 0.024 * 1e-3;
    all += values.at("solid_fraction")[n] * 0.024 * 0.024 * 1e-3;
    const bool any = values.at("clump_fraction")[n] > 0.0;
    for (std::size_t p = 0; p < 6; ++p) {
      EXPECT_NEAR(values.at("long_axis_alignment")[6 * n + p], any ? long_axes[p] : 0.0, 1e-9) << n << ' ' << p;
      EXPECT_NEAR(values.at("short_axis_alignment")[6 * n + p], any ? short_axes[p] : 0.0, 1e-9) << n << ' ' << p;
    }
  }
  EXPECT_NEAR(clumps / (2.0 * volume), 1.0, 1e-9);
  EXPECT_NEAR(all / (3.0 * volume), 1.0, 1e-9);

  const test::MemoryArchive archive = test::saved(profiles, MPI_COMM_WORLD);
  GrainProfiles after(MPI_COMM_WORLD, decomposition, 1e-3, {}, 0.0, true);
  EXPECT_TRUE(test::load(after, archive));
  EXPECT_EQ(by_name(after), values);
}

// A disk in a box five times as wide as it is thick: layers are as wide as the disk.
TEST(GrainProfiles, OfDisksAreAsWideAsTheyAreThick) {
  const Decomposition decomposition = box_of({16, 16, 16}, 1.5e-3, false);
  GrainParameters p = plain();
  p.disk_thickness = 0.024 / 5.0;
  dem::GrainSeed disk = dem::test::glass_sphere(0, Vec3(0.011, 0.012, 0.0123), Vec3(0.2, 0.0, 0.0));
  disk.thickness = p.disk_thickness;
  const GrainDynamics grains(decomposition, MPI_COMM_WORLD, p, {disk});
  GrainProfiles profiles(MPI_COMM_WORLD, decomposition, 1e-3, {}, p.disk_thickness);
  Snapshot snapshot = Shown(grains).snapshot();
  snapshot.grains.disk_thickness = p.disk_thickness;
  profiles.observe(snapshot);
  const auto values = by_name(profiles);
  double area = 0.0, flux = 0.0;  // per length of the box: pi R^2 and u pi R^2
  for (std::size_t n = 0; n < values.at("z").size(); ++n) {
    area += values.at("solid_fraction")[n] * 1e-3 * 0.024;
    flux += values.at("flux")[3 * n] * 1e-3 * 0.024;
  }
  const double exact = std::numbers::pi * dem::test::glass_radius * dem::test::glass_radius;
  EXPECT_NEAR(area / exact, 1.0, 1e-12);
  EXPECT_NEAR(flux / (0.2 * exact), 1.0, 1e-12);
}

TEST(SphereInLayer, PartsAddUpAndHalfIsHalf) {
  EXPECT_NEAR(sphere_volume_below(2.0, 2.0), 0.5 * volume_of(2.0, 0.0), 1e-14);
  EXPECT_NEAR(volume_of(2.0, 0.0), 4.0 / 3.0 * std::numbers::pi * 8.0, 1e-13);
  EXPECT_NEAR(sphere_volume_below(1.0, 0.5), std::numbers::pi * 0.25 * 2.5 / 3.0, 1e-15);  // pi h^2 (3 R - h)/3
  EXPECT_NEAR(volume_of(2.0, 0.3), std::numbers::pi * 4.0 * 0.3, 1e-14);
  EXPECT_NEAR(disk_volume_below(2.0, 0.3, 2.0), 0.5 * volume_of(2.0, 0.3), 1e-14);
  // A segment of 60 degrees to either side of the lowest point: R^2 (pi/3 - sqrt(3)/4).
  EXPECT_NEAR(disk_volume_below(2.0, 1.0, 1.0), 4.0 * (std::numbers::pi / 3.0 - std::sqrt(3.0) / 4.0), 1e-14);
  EXPECT_EQ(volume_between(1.0, 0.0, -3.0, -1.0), 0.0);
}

TEST(GrainProfiles, OfMovingSpheresInLayers) {
  const Decomposition decomposition = box_of({20, 20, 20}, 2.5e-3, true);
  std::vector<GrainSeed> seeds{dem::test::glass_sphere(0, Vec3(0.01, 0.01, 0.0125), Vec3(0.3, 0.0, -0.1)),
                               dem::test::glass_sphere(1, Vec3(0.03, 0.03, 0.0125), Vec3(0.1, 0.2, 0.1)),
                               dem::test::glass_sphere(2, Vec3(0.01, 0.03, 0.05), Vec3(0.0, 0.0, 0.5))};
  const GrainDynamics grains(decomposition, MPI_COMM_WORLD, plain(), seeds);
  GrainProfiles profiles(MPI_COMM_WORLD, decomposition, 5.1e-3, {0.0, 0.01});  // ten layers of 5 mm
  profiles.observe(Shown(grains).snapshot());
  profiles.observe(Shown(grains).snapshot());  // the same step does not count twice
  auto mean = by_name(profiles);
  ASSERT_EQ(mean["z"].size(), 10u);
  const double volume = volume_of(2.5e-3, 0.0), mass = 2550.0 * volume, room = 0.05 * 0.05 * 5e-3;
  EXPECT_NEAR(mean["z"][2], 0.0125, 1e-17);
  // Two spheres fill layer 2 from its floor to its lid; the third lies across the periodic ends, half and half.
  EXPECT_NEAR(mean["solid_fraction"][2], 2.0 * volume / room, 1e-15);
  EXPECT_NEAR(mean["solid_fraction"][0], 0.5 * volume / room, 1e-15);
  EXPECT_NEAR(mean["solid_fraction"][9], 0.5 * volume / room, 1e-15);
  EXPECT_EQ(mean["solid_fraction"][5], 0.0);
  EXPECT_NEAR(mean["velocity"][3 * 2 + 0], 0.2, 1e-15);
  EXPECT_NEAR(mean["velocity"][3 * 9 + 2], 0.5, 1e-15);
  EXPECT_NEAR(mean["flux"][3 * 2 + 1], 0.2 * volume / room, 1e-15);
  // Both differ from their mean (0.2, 0.1, 0) by (0.1, -0.1, -0.1).
  EXPECT_NEAR(mean["granular_temperature"][2], 0.01, 1e-15);
  EXPECT_NEAR(mean["granular_temperature"][0], 0.0, 1e-15);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(mean["kinetic_stress"][6 * 2 + a], -2.0 * mass * 0.01 / room, 1e-12);
  EXPECT_NEAR(mean["kinetic_stress"][6 * 2 + 3], 2.0 * mass * 0.01 / room, 1e-12);  // xy
  EXPECT_EQ(mean["contact_stress"][9 * 2 + 8], 0.0);
}

TEST(GrainProfiles, OfACompressedLatticeIsItsPressure) {
  // A simple cubic lattice with the spacing a < d: six contacts of k (d - a) each, s = -k (d - a)/a^2 on the diagonal
  // and nothing else. Grains cross the borders of layers, of ranks and of the box.
  const double a = 0.99 * diameter, spacing = a / 2.0;
  const Decomposition decomposition = box_of({16, 16, 16}, spacing, true);
  std::vector<GrainSeed> seeds;
  for (int n = 0; n < 512; ++n)
    seeds.push_back(dem::test::glass_sphere(n, Vec3((n % 8 + 0.21) * a, (n / 8 % 8 + 0.63) * a, (n / 64 + 0.37) * a)));
  GrainParameters p = plain();
  p.initial_overlap = 0.011;
  const GrainDynamics grains(decomposition, MPI_COMM_WORLD, p, seeds);
  GrainProfiles profiles(MPI_COMM_WORLD, decomposition, a, {0.0, 0.01});
  profiles.observe(Shown(grains).snapshot());
  const auto mean = by_name(profiles);
  const double pressure = 20000.0 * (diameter - a) / (a * a);
  for (int layer = 0; layer < 8; ++layer) {
    EXPECT_NEAR(mean.at("solid_fraction")[layer], volume_of(2.5e-3, 0.0) / (a * a * a), 1e-13);
    for (int c = 0; c < 9; ++c)
      EXPECT_NEAR(mean.at("contact_stress")[9 * layer + c], c % 4 == 0 ? -pressure : 0.0, 1e-10 * pressure);
  }
  // Stress of every grain: that of the lattice over its share of the volume.
  const double of_grain = pressure * a * a * a / volume_of(2.5e-3, 0.0);
  for (const Mat3& stress : contact_stresses(Shown(grains).snapshot()))
    EXPECT_LT((stress + of_grain * Mat3::Identity()).norm(), 1e-10 * of_grain);
}

TEST(GrainProfiles, OfAColumnIsTheWeightAboveIt) {
  // Five spheres on top of each other, each in a layer of its own: -(weight above its lower + above its upper end)/2 A.
  const Decomposition decomposition = box_of({20, 20, 20}, 2.5e-3, false);
  std::vector<GrainSeed> seeds;
  for (int n = 0; n < 5; ++n) seeds.push_back(dem::test::glass_sphere(n, Vec3(0.0249, 0.0249, (n + 0.5) * diameter)));
  GrainParameters p = plain();
  p.walls = {dem::face_plane(decomposition.box(), 2, false, 0.5)};
  p.body_force = [](double mass, double) { return Vec3(0.0, 0.0, -g * mass); };
  GrainDynamics grains(decomposition, MPI_COMM_WORLD, p, seeds);
  for (int n = 0; n < 1500; ++n) dem::test::step(grains);  // 0.24 s
  GrainProfiles profiles(MPI_COMM_WORLD, decomposition, diameter, {0.0, 0.01});
  profiles.observe(Shown(grains).snapshot());
  const auto mean = by_name(profiles);
  const double weight = 2550.0 * volume_of(2.5e-3, 0.0) * g, area = 0.05 * 0.05;
  for (int layer = 0; layer < 5; ++layer) {
    const double expected = -(4.0 - layer + 0.5) * weight / area;
    // The spheres sink into each other by up to 15 weights over 20 kN/m, 2.5e-4 of a diameter, in all.
    EXPECT_NEAR(mean.at("contact_stress")[9 * layer + 8], expected, 1e-3 * 5.0 * weight / area) << layer;
  }
}

TEST(GrainProfiles, OfABedBalanceItsWeight) {
  const Decomposition decomposition = box_of({10, 10, 24}, 2.5e-3, false);
  std::vector<GrainSeed> seeds;
  for (int n = 0; n < 120; ++n) {  // 16 to a sheet, every second one shifted so that they do not stack
    const double shift = 0.3 * (n / 16 % 2);
    seeds.push_back(dem::test::glass_sphere(
        n,
        Vec3((n % 4 + 0.5 + shift) * 6.25e-3, (n / 4 % 4 + 0.4 + shift) * 6.25e-3, (n / 16 + 0.55) * 1.02 * diameter)));
  }
  GrainParameters p = plain();
  p.contact.rolling_friction = p.contact.wall_rolling_friction = 0.05;
  p.contact.tangential_damping = 0.5;
  p.walls = {dem::face_plane(decomposition.box(), 2, false, 0.5)};
  p.walls[0].rolling_friction = 0.05;
  p.body_force = [](double mass, double) { return Vec3(0.0, 0.0, -g * mass); };
  GrainDynamics grains(decomposition, MPI_COMM_WORLD, p, seeds);
  for (int n = 0; n < 2500; ++n) dem::test::step(grains);  // 0.4 s
  GrainProfiles profiles(MPI_COMM_WORLD, decomposition, 0.5 * diameter, {0.0, 0.01});
  profiles.observe(Shown(grains).snapshot());
  const auto mean = by_name(profiles);
  const dem::GrainStore& s = grains.store();
  std::vector<double> terms;
  for (std::size_t i = 0; i < s.owned; ++i)
    terms.insert(terms.end(), {s.mass[i] * g, s.mass[i] * g * s.position[i][2]});
  const std::vector<double> sums = reproducible_sums(MPI_COMM_WORLD, terms, 2);
  const double area = 0.025 * 0.025, layer = 0.06 / 24;
  // At rest the virial theorem makes the integral of the stress the weights times their heights, exactly.
  double integral = 0.0, above = 0.0;
  for (int n = 0; n < 24; ++n) integral += mean.at("contact_stress")[9 * n + 8] * layer * area;
  EXPECT_NEAR(integral / sums[1], -1.0, 2e-3);
  // d s_zz/dz = rho g: each layer carries the weight above its middle, blurred by the reach of a grain, which is less
  // than the weight of one diameter of the bed.
  const double one_diameter = 2550.0 * 0.64 * g * diameter;
  for (int n = 23; n >= 0; --n) {
    const double own = 2550.0 * mean.at("solid_fraction")[n] * g * layer;
    EXPECT_NEAR(mean.at("contact_stress")[9 * n + 8], -(above + 0.5 * own), one_diameter) << n;
    above += own;
  }
  // But for what the lowest spheres sink into the floor: a cap of height h has (h/d)^2 of the volume, h/d < 1e-3.
  EXPECT_NEAR(above * area / sums[0], 1.0, 1e-6);
  EXPECT_GT(above, 5.0 * one_diameter / 2.0);
}

TEST(GrainProfiles, GoOnAfterARestartWithTheSameBits) {
  const Decomposition decomposition = box_of({16, 16, 16}, 2.5e-3, true);
  std::vector<GrainSeed> seeds;
  for (int n = 0; n < 100; ++n)
    seeds.push_back(dem::test::glass_sphere(n, Vec3(n % 5 + 0.5, n / 5 % 5 + 0.5, n / 25 + 0.5) * 7.5e-3,
                                            Vec3(std::sin(3.0 * n), std::cos(5.0 * n), std::sin(7.0 * n))));
  GrainDynamics grains(decomposition, MPI_COMM_WORLD, plain(), seeds);
  GrainProfiles whole(MPI_COMM_WORLD, decomposition, 2.5e-3, {0.0, 0.01});
  thalweg::test::MemoryArchive half;
  for (int n = 0; n < 40; ++n) {
    dem::test::step(grains);
    whole.observe(Shown(grains).snapshot(n));
    if (n == 19) half = thalweg::test::saved(whole, MPI_COMM_WORLD);
  }
  // The same on one rank, and from the half way on.
  GrainDynamics alone(Decomposition({16, 16, 16}, 2.5e-3, {true, true, true}, {1, 1, 1}), MPI_COMM_SELF, plain(),
                      seeds);
  GrainProfiles rest(MPI_COMM_SELF, decomposition, 2.5e-3, {0.0, 0.01});
  thalweg::test::load(rest, half);
  for (int n = 0; n < 40; ++n) {
    dem::test::step(alone);
    rest.observe(Shown(alone).snapshot(n));
  }
  EXPECT_EQ(by_name(rest), by_name(whole));
  EXPECT_LT(by_name(whole)["contact_stress"][8], 0.0);
  EXPECT_EQ(rest.results().at(1).value, 40.0);
}

}  // namespace
}  // namespace thalweg::analysis::grain_profiles_test
