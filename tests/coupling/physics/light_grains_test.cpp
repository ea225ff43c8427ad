// A sphere lighter than the fluid, or hardly heavier, let go from rest: the equation of motion of Basset, Boussinesq
// and Oseen has the answer as long as the sphere has hardly moved,
//   (m + m_f/2) dv/dt = (m_f - m) g - 6 pi eta R v - 6 R^2 sqrt(pi rho eta) int_0^t v'(s)/sqrt(t - s) ds,
// whose first moment is the acceleration (rho_f - rho_s) g/(rho_s + rho_f/2).
#include "tests/coupling/water_box.hpp"

#include "core/parallel/mpi_session.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

namespace thalweg::coupling::light_grains_test {
namespace {

constexpr double fluid_density = 1000.0;  // kg/m^3
constexpr double radius = 2.5e-3;         // m: 5 cells
constexpr double step = 1e-4;             // s

struct Light {
  double density;  // kg/m^3
  double lattice_viscosity;
  double gravity;  // m/s^2
};

WaterBox box_of(const Light& light) {
  WaterBox box;
  box.cells = {40, 40, 48};
  box.periodic = {true, true, false};
  box.spacing = 0.5e-3;
  box.time_step = step;
  box.viscosity = light.lattice_viscosity * box.spacing * box.spacing / step;
  box.smagorinsky_constant = 0.0;
  box.collision = lbm::CollisionModel::trt;
  box.sub_steps = 50;
  box.gravity = Vec3(0.0, 0.0, -light.gravity);
  box.seeds = {glass_sphere(0, Vec3(0.01003, 0.00996, 0.01211), Vec3::Zero(), radius)};
  box.seeds[0].density = light.density;
  return box;
}

// Velocities (m/s, upwards) after each step.
std::vector<double> rise(const Light& light, int steps) {
  const WaterBox box = box_of(light);
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  std::vector<double> velocities;
  for (int n = 0; n < steps; ++n) {
    system->advance();
    const dem::GrainStore& grains = system->grains().store();
    velocities.push_back(sum_over_ranks(MPI_COMM_WORLD, grains.owned == 1 ? grains.velocity[0].z() : 0.0));
  }
  return velocities;
}

// The same by the equation of motion: v' constant over each of the short steps, the integral over each done exactly.
std::vector<double> expected_rise(const Light& light, int steps) {
  constexpr int parts = 4;
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3.0), dt = step / parts;
  const double eta = fluid_density * box_of(light).viscosity;
  const double inertia = (light.density + 0.5 * fluid_density) * volume;
  const double drag = 6.0 * std::numbers::pi * eta * radius;
  const double history = 12.0 * radius * radius * std::sqrt(std::numbers::pi * fluid_density * eta * dt);
  std::vector<double> rates, velocities;
  double v = 0.0;
  for (int n = 1; n <= parts * steps; ++n) {
    double force = (fluid_density - light.density) * volume * light.gravity - drag * v;
    for (int k = 0; k < n - 1; ++k) force -= history * rates[k] * (std::sqrt(n - k) - std::sqrt(n - k - 1));
    rates.push_back(force / (inertia + history + 0.5 * drag * dt));
    v += rates.back() * dt;
    if (n % parts == 0) velocities.push_back(v);
  }
  return velocities;
}

// From the 20th step on, when the pressure has gone around the sphere and the layer at its surface is a cell thick:
// what is left is the lattice's error there (4 cells in R sqrt(t nu)/R) and the walls of the box, 4 %. The sphere moves
// by less than R/5 meanwhile.
TEST(LightGrains, LightSpheresRiseByTheEquationOfMotion) {
  for (const double density : {100.0, 500.0, 800.0, 1050.0}) {
    const Light light{density, 0.02, 0.4};
    const std::vector<double> found = rise(light, 161), expected = expected_rise(light, 161);
    for (const int n : {20, 40, 80, 160}) EXPECT_NEAR(found[n] / expected[n], 1.0, 0.04) << density << " after " << n;
    // Nothing oscillates once the impulse at the start has gone: the sphere only becomes faster.
    for (std::size_t n = 20; n < found.size(); ++n)
      ASSERT_GT(found[n] / found[n - 1], 1.0) << density << " after " << n;
  }
}

// The reaction of the fluid is ten times the sphere's own inertia.
TEST(LightGrains, RiseWhereTheFluidOutweighsThem) {
  const Light light{50.0, 0.02, 0.4};
  EXPECT_NEAR(rise(light, 161)[160] / expected_rise(light, 161)[160], 1.0, 0.04);
}

// A free sphere that starts to spin in a fluid at rest. With l = R sqrt(p/nu), its spin is the inverse Laplace
// transform of I/(I p + (8/3) pi eta R^3 (3 + 3 l + l^2)/(1 + l)): w/w0 below, at t nu/R^2 = 0.0185, 0.075 and 0.15.
struct Spin {
  double density_ratio;
  std::array<double, 3> expected;
};
constexpr Spin spins[] = {{1.0, {0.4588, 0.2074, 0.1094}},
                          {0.5, {0.2718, 0.0972, 0.0471}},
                          {0.2, {0.1114, 0.0347, 0.0165}},
                          {0.1, {0.0541, 0.0165, 0.0078}}};

// A box of a fluid so viscous that the spin of a sphere of six cells' radius decays within some hundred steps.
WaterBox viscous_box(int cells, bodies::LinkRule rule) {
  WaterBox box;
  box.cells = {cells, cells, cells};
  box.spacing = 1e-4;
  box.time_step = 1e-4 / 3.0;
  box.viscosity = 1e-5;
  box.smagorinsky_constant = 0.0;
  box.collision = lbm::CollisionModel::trt;
  box.links.rule = rule;
  box.normal_stiffness = 1.0;
  return box;
}

class SuddenSpin : public ::testing::TestWithParam<std::tuple<Spin, bodies::LinkRule, dem::Motion>> {};

// 3 % for the lattice: in the first steps the layer that turns with the sphere is thinner than a cell. A light sphere
// gives its impulse away over m_C/m steps, so the fluid has it that much later, while the spin falls as 1/t or
// less steeply. It does not turn back, but for 0.3 % at a tenth of the density. Nothing moves the sphere, so that its
// spin is the same where its place is held.
TEST_P(SuddenSpin, DecaysAsInUnsteadyStokesFlow) {
  const auto [spin, rule, motion] = GetParam();
  WaterBox box = viscous_box(48, rule);
  box.seeds = {glass_sphere(0, Vec3(0.00243, 0.00238, 0.00241), Vec3::Zero(), 6e-4)};
  box.seeds[0].density = fluid_density * spin.density_ratio;
  box.seeds[0].motion = motion;
  box.seeds[0].angular_velocity = Vec3(30.0, 0.0, 40.0);
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  const std::array<int, 3> steps{20, 81, 162};
  const bool is_light = spin.density_ratio < 8.0 / 12.0;                  // LightLoad
  const double delay = is_light ? 5.0 / 12.0 / spin.density_ratio : 0.0;  // steps
  std::size_t next = 0;
  for (int step = 1; step <= steps.back(); ++step) {
    system->advance();
    const dem::GrainStore& grains = system->grains().store();
    const double along = grains.owned == 1 ? grains.angular_velocity[0].dot(Vec3(0.6, 0.0, 0.8)) / 50.0 : 0.0;
    const double left = sum_over_ranks(MPI_COMM_WORLD, along);
    EXPECT_GT(left, spin.density_ratio < 0.15 ? -0.003 : 0.0) << step;
    if (step != steps[next]) continue;
    EXPECT_NEAR(left / spin.expected[next], 1.0, 0.03 + 1.2 * delay / step) << step;
    ++next;
  }
}

INSTANTIATE_TEST_SUITE_P(Densities, SuddenSpin,
                         ::testing::Combine(::testing::ValuesIn(spins),
                                            ::testing::Values(bodies::LinkRule::bouzidi, bodies::LinkRule::cli),
                                            ::testing::Values(dem::Motion::free, dem::Motion::held_translation)));

// Two light spheres that are one body and begin to spin about their middle: by symmetry nothing moves it, so that it
// slows down as much where its place is held. Forces on the members turn it then.
TEST(LightGrains, AClumpWhosePlaceIsHeldTurnsAsAFreeOne) {
  const auto spin_left = [](dem::Motion motion) {
    WaterBox box = viscous_box(40, bodies::LinkRule::cli);
    box.clumps = {glass_clump(0, {{{4e-4, 0, 0}, 4e-4}, {{-4e-4, 0, 0}, 4e-4}}, Vec3(0.00203, 0.00198, 0.00201),
                              Vec3::Zero(), Vec3(0.0, 30.0, 40.0))};
    box.clumps[0].density = 0.2 * fluid_density;
    box.clumps[0].motion = motion;
    const auto system = make_system<double>(box, MPI_COMM_SELF, {1, 1, 1});
    for (int step = 0; step < 80; ++step) system->advance();
    return Vec3(system->grains().clumps()[0].angular_velocity);
  };
  const Vec3 free = spin_left(dem::Motion::free), held = spin_left(dem::Motion::held_translation);
  EXPECT_GT(free.norm(), 0.5);
  EXPECT_LT(free.norm(), 10.0);
  EXPECT_LT((held - free).norm(), 0.02 * free.norm());  // the staircase of the cells moves the free one a little
}

// A second member inside the first adds nothing to a sphere, and does not make it turn when it is let go.
TEST(LightGrains, AClumpThatIsASphereRisesAsOne) {
  for (const double density : {100.0, 500.0}) {
    WaterBox box = box_of({density, 0.05, 0.4});
    const dem::GrainSeed sphere = box.seeds[0];
    const auto moved = [&box] {
      const auto system = make_system<double>(box, MPI_COMM_SELF, {1, 1, 1});
      std::vector<Vec3> found;  // velocity (m/s) and spin (rad/s) after each step
      for (int n = 0; n < 30; ++n) {
        system->advance();
        const dem::GrainStore& store = system->grains().store();
        const dem::Clumps& clumps = system->grains().clumps();
        found.push_back(clumps.empty() ? store.velocity[0] : clumps[0].velocity);
        found.push_back(clumps.empty() ? store.angular_velocity[0] : clumps[0].angular_velocity);
      }
      return found;
    };
    const std::vector<Vec3> alone = moved();
    box.seeds.clear();
    box.clumps = {glass_clump(0, {{Vec3::Zero(), radius}, {Vec3(0.5 * radius, 0, 0), 0.4 * radius}}, sphere.position)};
    box.clumps[0].density = density;
    const std::vector<Vec3> clump = moved();
    const double speed = alone[alone.size() - 2].norm();
    for (std::size_t n = 0; n < alone.size(); n += 2) {
      ASSERT_LT((clump[n] - alone[n]).norm(), 1e-3 * speed) << "step " << n / 2;
      ASSERT_LT((clump[n + 1] - alone[n + 1]).norm() * radius, 1e-3 * speed) << "step " << n / 2;
    }
  }
}

// Rods of spheres of six cells turn about their long axis as their spheres do. Nothing moves them but a small spin,
// which must go: unfiltered, as a sphere of their volume would be, it changed its sign from step to step and grew.
TEST(LightGrains, RodsLoseTheirSpinAtAnyDensity) {
  struct Rod {
    int spheres;
    double density;
    bodies::LinkRule rule;
  };
  for (const Rod& rod : {Rod{5, 1000.0, bodies::LinkRule::cli},
                         {5, 850.0, bodies::LinkRule::cli},
                         {5, 1100.0, bodies::LinkRule::cli},
                         {2, 1100.0, bodies::LinkRule::cli},
                         {5, 300.0, bodies::LinkRule::cli},
                         {9, 700.0, bodies::LinkRule::bouzidi}}) {
    WaterBox box;
    box.cells = {6 * rod.spheres + 10, 20, 20};
    box.periodic = {true, false, false};
    box.closed = true;
    box.spacing = 1e-4;
    box.viscosity = 1e-5;
    box.time_step = 0.03 / 3.0 * 1e-8 / box.viscosity;
    box.smagorinsky_constant = 0.0;
    box.collision = lbm::CollisionModel::trt;
    box.links.rule = rod.rule;
    box.normal_stiffness = 1.0;
    std::vector<dem::PlacedSphere> members;
    for (int n = 0; n < rod.spheres; ++n)
      members.push_back({Vec3((6.0 * n - 3.0 * (rod.spheres - 1)) * 1e-4, 0, 0), 3e-4});
    const Vec3 middle(0.5 * box.cells[0] * 1e-4 + 1.3e-5, 1e-3, 1e-3);
    const double spin = 1e-3 / box.time_step;
    box.clumps = {glass_clump(0, members, middle, Vec3::Zero(), Vec3(spin, 0.0, 0.0))};
    box.clumps[0].density = rod.density;
    const auto system = make_system<double>(box, MPI_COMM_SELF, {1, 1, 1});
    for (int n = 0; n < 700; ++n) system->advance();
    EXPECT_LT(system->grains().clumps()[0].angular_velocity.norm(), 0.2 * spin) << rod.spheres << ", " << rod.density;
  }
}

// Acrylic, ice, wax and foam in oil, with six cells a diameter: the speed has no direction but that of gravity, and the
// spin stays small.
TEST(LightGrains, KeepTheirSpinSmallAtAnyDensity) {
  for (const bodies::LinkRule rule : {bodies::LinkRule::bouzidi, bodies::LinkRule::cli})
    for (const double density : {1150.0, 900.0, 400.0, 100.0})
      for (const double excess : {0.03, 0.2, 0.5}) {  // tau - 1/2
        WaterBox box;
        box.cells = {20, 20, 38};
        box.periodic = {false, false, false};
        box.closed = true;
        box.spacing = 1e-4;
        box.viscosity = 1e-5;
        box.time_step = excess / 3.0 * 1e-8 / box.viscosity;
        box.smagorinsky_constant = 0.0;
        box.collision = lbm::CollisionModel::trt;
        box.links.rule = rule;
        box.normal_stiffness = 0.05;
        box.gravity = Vec3(0.0, 0.0, -9.81 * 0.03 / excess);
        box.seeds = {glass_sphere(0, Vec3(0.00102, 0.00097, density > 1000.0 ? 0.0028 : 0.00093), Vec3::Zero(), 3e-4)};
        box.seeds[0].density = density;
        const auto system = make_system<double>(box, MPI_COMM_SELF, {1, 1, 1});
        for (int step = 0; step < 1500; ++step) system->advance();
        const dem::GrainStore& grains = system->grains().store();
        const double speed = grains.velocity[0].z() * (density > 1000.0 ? -1.0 : 1.0);
        EXPECT_GT(speed, 0.0) << density << " at " << excess;
        EXPECT_LT(grains.angular_velocity[0].norm() * 3e-4, 0.2 * speed) << density << " at " << excess;
      }
}

// A sphere at rest on the floor weighs what it weighs: the contacts are outside the filter.
TEST(LightGrains, LeavesTheWeightOnAContactAlone) {
  const Light heavier{1050.0, 1.0 / 6.0, 9.8};
  WaterBox box = box_of(heavier);
  box.seeds[0].position.z() = radius;
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  for (int n = 0; n < 200; ++n) system->advance();
  const dem::GrainStore& grains = system->grains().store();
  const double force = sum_over_ranks(MPI_COMM_WORLD, grains.owned == 1 ? grains.contact_force[0].z() : 0.0);
  const double weight = 50.0 * 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3.0) * 9.8;
  EXPECT_NEAR(force / weight, 1.0, 0.02);
}

}  // namespace
}  // namespace thalweg::coupling::light_grains_test
