// Standing waves of sound in a periodic box, for every collision and several bulk relaxation times: bin/sound
//
// A density wave of amplitude 1e-6 begins at rest. Its amplitude a(t) obeys a(t + m) = p a(t) - q a(t - m), p = 2
// e^{-gm} cos(wm), q = e^{-2gm}: least squares over two periods, after three in which the modes that relax die, give
// the damping g (1/steps) and the speed w/k (cells a step). Prints CSV in lattice units; compare.py has the theory.
#include "core/parallel/mpi_session.hpp"
#include "lbm/fluid/fluid.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

namespace thalweg::benchmark {
namespace {

struct Sound {
  double speed, damping;
};

// Damping and speed of the oscillation, sampled every step; m: about a quarter of its period.
Sound fitted(const std::vector<double>& wave, std::size_t m, double wave_number) {
  double xx = 0.0, xy = 0.0, yy = 0.0, xz = 0.0, yz = 0.0;
  for (std::size_t t = m; t + m < wave.size(); ++t) {
    const double x = wave[t], y = -wave[t - m], z = wave[t + m];
    xx += x * x, xy += x * y, yy += y * y, xz += x * z, yz += y * z;
  }
  const double determinant = xx * yy - xy * xy, p = (xz * yy - yz * xy) / determinant,
               q = (yz * xx - xz * xy) / determinant, steps = static_cast<double>(m);
  return {std::acos(0.5 * p / std::sqrt(q)) / (steps * wave_number), -0.5 * std::log(q) / steps};
}

Sound measure(const lbm::CollisionParameters& parameters, int cells) {
  const Decomposition decomposition({4, 4, cells}, 1.0, {true, true, true}, {1, 1, 1});
  lbm::Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, {});
  const double k = 2.0 * std::numbers::pi / cells;
  fluid.initialise([&](const Vec3& p) { return lbm::FluidState{1e-6 * std::cos(k * p.z()), Vec3::Zero()}; });
  const int quarter = static_cast<int>(cells * std::sqrt(3.0) / 4.0);
  for (int step = 0; step < 12 * quarter; ++step) fluid.advance();
  std::vector<double> wave;
  for (int step = 0; step < 8 * quarter; ++step) {
    fluid.advance();
    double sum = 0.0;
    for (int z = 0; z < cells; ++z)
      sum += std::cos(k * (z + 0.5)) * fluid.state_at(fluid.indexing().index(1, 2, z)).density_deviation;
    wave.push_back(sum);
  }
  return fitted(wave, static_cast<std::size_t>(quarter), k);
}

void run() {
  using lbm::CollisionModel;
  fmt::print("collision,cells,tau,tau_b,speed,damping\n");
  for (const CollisionModel model : {CollisionModel::bgk, CollisionModel::trt})
    for (const int cells : {96, 384})
      for (const double tau : {0.503, 0.6, 0.8})
        for (const double tau_b : {0.0, 1.0, 3.0, 10.0, 30.0, 100.0}) {
          lbm::CollisionParameters parameters;
          parameters.model = model;
          parameters.relaxation_time = tau;
          parameters.bulk_relaxation_time = tau_b;
          const Sound sound = measure(parameters, cells);
          fmt::print("{},{},{},{},{:.6f},{:.5e}\n", traits_of(model).name, cells, tau, tau_b, sound.speed,
                     sound.damping);
        }
}

}  // namespace
}  // namespace thalweg::benchmark

int main(int argc, char** argv) {
  thalweg::MpiSession session(argc, argv);
  thalweg::benchmark::run();
}
