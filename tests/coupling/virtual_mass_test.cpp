// A sphere lighter than the fluid, or hardly heavier, let go from rest: the equation of motion of Basset, Boussinesq
// and Oseen has the answer as long as the sphere has hardly moved,
//   (m + m_f/2) dv/dt = (m_f - m) g - 6 pi eta R v - 6 R^2 sqrt(pi rho eta) int_0^t v'(s)/sqrt(t - s) ds,
// whose first moment is the acceleration (rho_f - rho_s) g/(rho_s + rho_f/2).
#include "tests/coupling/water_box.hpp"

#include "core/mpi_session.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <exception>
#include <numbers>

namespace thalweg::coupling::virtual_mass_test {
namespace {

constexpr double fluid_density = 1000.0;  // kg/m^3
constexpr double radius = 2.5e-3;         // m: 5 cells
constexpr double step = 1e-4;             // s

struct Light {
  double density;  // kg/m^3
  double lattice_viscosity;
  double gravity;  // m/s^2
  bool virtual_mass;
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
  box.virtual_mass = light.virtual_mass;
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
// by less than R/5 meanwhile. The virtual mass makes no difference to what is stable without it.
TEST(VirtualMass, LightSpheresRiseByTheEquationOfMotion) {
  for (const double density : {100.0, 500.0, 800.0, 1050.0}) {
    const Light light{density, 0.02, 0.4, true};
    const std::vector<double> found = rise(light, 161), expected = expected_rise(light, 161);
    for (const int n : {20, 40, 80, 160}) EXPECT_NEAR(found[n] / expected[n], 1.0, 0.04) << density << " after " << n;
    // Nothing oscillates once the impulse at the start has gone: the sphere only becomes faster.
    for (std::size_t n = 20; n < found.size(); ++n)
      ASSERT_GT(found[n] / found[n - 1], 1.0) << density << " after " << n;
  }
}

TEST(VirtualMass, LeavesTheFinalVelocityAlone) {
  Light light{500.0, 1.0 / 6.0, 0.4, true};
  const std::vector<double> with = rise(light, 500);
  light.virtual_mass = false;
  const std::vector<double> without = rise(light, 500);
  // Nearly steady: it changes by less than 1 % in 10 steps, and the filter (s = 1/2) lags by one step.
  EXPECT_LT(std::abs(with[499] / with[489] - 1.0), 1e-2);
  EXPECT_NEAR(with[499] / without[499], 1.0, 1e-3);
}

// Without it the reaction of the fluid, ten times the sphere's own inertia, grows from step to step.
TEST(VirtualMass, HoldsTheLightestSphere) {
  EXPECT_THROW(rise({50.0, 0.02, 0.4, false}, 160), std::exception);
  const std::vector<double> found = rise({50.0, 0.02, 0.4, true}, 161);
  EXPECT_NEAR(found[160] / expected_rise({50.0, 0.02, 0.4, true}, 161)[160], 1.0, 0.04);
}

// A sphere at rest on the floor weighs what it weighs: the contacts are outside the filter.
TEST(VirtualMass, LeavesTheWeightOnAContactAlone) {
  const Light heavier{1050.0, 1.0 / 6.0, 9.8, true};
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
}  // namespace thalweg::coupling::virtual_mass_test
