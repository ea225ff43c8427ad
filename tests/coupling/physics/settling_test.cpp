// A sphere falls through the fluid, lands on the floor and stays there.
#include "tests/coupling/water_box.hpp"

#include "core/parallel/mpi_session.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::coupling::settling_test {
namespace {

struct Location {
  double height = 0.0, speed = 0.0;  // m, m/s upwards
};

Location place_of_grain(const dem::GrainDynamics& grains) {
  Location p;
  if (grains.store().owned == 1) p = {grains.store().position[0].z(), grains.store().velocity[0].z()};
  return {sum_over_ranks(MPI_COMM_WORLD, p.height), sum_over_ranks(MPI_COMM_WORLD, p.speed)};
}

// Glass in a thick oil, 5 mm: Schiller and Naumann 1935 give the terminal speed of an unbounded sphere. The box is four
// diameters wide and periodic: its images hinder the fall, by less than a quarter (Richardson and Zaki 1954 at 1.4 % of
// solids give 6 %, Hasimoto's 1959 Stokes limit for this box, the upper bound, 1/(1 + 1.76 c^(1/3) ...) 36 %).
TEST(Settling, SphereReachesItsTerminalSpeedAndRestsOnTheFloor) {
  WaterBox box;
  box.cells = {32, 32, 72};
  box.spacing = 0.625e-3;  // 8 cells a diameter
  box.periodic = {true, true, false};
  box.viscosity = 5e-5;
  box.smagorinsky_constant = 0.0;
  box.gravity = Vec3(0.0, 0.0, -9.8);
  box.sub_steps = 20;
  box.seeds = {glass_sphere(0, Vec3(0.0101, 0.0099, 0.040))};
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));

  double terminal = 0.2;  // m/s; solve C_d(Re) 1/2 rho u^2 A = submerged weight by iteration
  for (int k = 0; k < 200; ++k) {
    const double reynolds = terminal * 5e-3 / box.viscosity;
    const double drag = 24.0 / reynolds * (1.0 + 0.15 * std::pow(reynolds, 0.687));
    terminal = std::sqrt(4.0 * 1.55 * 9.8 * 5e-3 / (3.0 * drag));
  }
  double fastest = 0.0;
  for (int step = 0; step < 6000; ++step) {
    system->advance();
    if (step % 20 == 0) fastest = std::min(fastest, place_of_grain(system->grains()).speed);
  }
  EXPECT_GT(-fastest, 0.64 * terminal);
  EXPECT_LT(-fastest, 1.05 * terminal);
  const Location at_rest = place_of_grain(system->grains());
  EXPECT_LT(std::abs(at_rest.speed), 1e-4);
  // The sphere is on the floor: the overlap that carries the submerged weight is m g (1 - 1/2.55) / k_n = 5e-8 m.
  EXPECT_NEAR(at_rest.height, 2.5e-3, 1e-6);
}

}  // namespace
}  // namespace thalweg::coupling::settling_test
