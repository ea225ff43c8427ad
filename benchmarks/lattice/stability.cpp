// The stability map of the collisions: how near to 1/2 the relaxation time may come at a given velocity.
//
//   bin/stability
//
// A Taylor-Green vortex of three dimensions in a periodic box of 32 cells with a lattice velocity u, for tau - 1/2 from
// 0.03 to 1e-4, with and without eddies, for so many turnover times that the flow has broken down to the size of a
// cell, which is what an under-resolved flow does to a collision. Stable: the kinetic energy never grew beyond its
// start. Prints a table in Markdown.
#include "core/mpi_session.hpp"
#include "lbm/fluid.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <numbers>

namespace thalweg::benchmark {
namespace {

constexpr int side = 32;
constexpr double turnovers = 12.0;                                   // the vortex breaks down after about nine
constexpr double excesses[] = {3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4};  // tau - 1/2
constexpr double velocities[] = {0.02, 0.05, 0.1, 0.15};

struct Model {
  const char* name;
  lbm::CollisionModel model;
};
constexpr Model models[] = {{"bgk", lbm::CollisionModel::bgk},
                            {"trt", lbm::CollisionModel::trt},
                            {"regularised", lbm::CollisionModel::regularised}};

double energy(const lbm::Fluid<float>& fluid) {
  double sum = 0.0;
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) sum += fluid.state_at(fluid.indexing().index(x, y, z)).velocity.squaredNorm();
  return sum;
}

bool survives(lbm::CollisionModel model, double excess, double velocity, double smagorinsky) {
  const Decomposition decomposition({side, side, side}, 1.0, {true, true, true}, {1, 1, 1});
  lbm::CollisionParameters parameters;
  parameters.model = model;
  parameters.relaxation_time = 0.5 + excess;
  parameters.smagorinsky_constant = smagorinsky;
  lbm::Fluid<float> fluid(decomposition, MPI_COMM_SELF, parameters, {});
  const double k = 2.0 * std::numbers::pi / side;
  fluid.initialise([&](const Vec3& p) {
    const double x = k * p.x(), y = k * p.y(), z = k * p.z();
    const double pressure = velocity * velocity / 16.0 * (std::cos(2 * x) + std::cos(2 * y)) * (std::cos(2 * z) + 2.0);
    return lbm::FluidState{3.0 * pressure, velocity * Vec3(std::sin(x) * std::cos(y) * std::cos(z),
                                                           -std::cos(x) * std::sin(y) * std::cos(z), 0.0)};
  });
  const double start = energy(fluid);
  const int steps = static_cast<int>(turnovers / (k * velocity));
  for (int step = 1; step <= steps; ++step) {
    fluid.advance();
    if ((step % 50 == 0 || step == steps) && !(energy(fluid) <= 1.05 * start)) return false;
  }
  return true;
}

void run() {
  for (const double smagorinsky : {0.0, 0.17, 0.27}) {
    fmt::print("\nC_s = {}: largest lattice velocity that stays stable\n\n| tau - 1/2 |", smagorinsky);
    for (const Model& m : models) fmt::print(" {} |", m.name);
    fmt::print("\n|---|---|---|---|\n");
    for (const double excess : excesses) {
      fmt::print("| {:g} |", excess);
      for (const Model& m : models) {
        double best = 0.0;
        for (const double velocity : velocities) {
          if (!survives(m.model, excess, velocity, smagorinsky)) break;
          best = velocity;
        }
        if (best == 0.0)
          fmt::print(" unstable |");
        else
          fmt::print(" {:g} |", best);
      }
      fmt::print("\n");
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace thalweg::benchmark

int main(int argc, char** argv) {
  thalweg::MpiSession session(argc, argv);
  thalweg::benchmark::run();
}
