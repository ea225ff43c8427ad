// The error of populations in single precision, against double: bin/precision
//
// Two steady flows over a range of relaxation times and velocities (cells a step), each run in both:
//   channel  between half-link walls 32 cells apart, driven by a force, from the exact parabola on for 0.3 of the time
//            that viscosity needs to cross it: difference of the velocity profile, and of the stress on the walls, from
//            the slope at them;
//   sphere   ten cells across, fixed in a periodic cube of 24, driven by a force: difference of its drag over the mean
//            velocity, and of the velocity field.
// No faster than 0.05: at a relaxation time of 0.503 bgk is unstable at walls beyond that (docs/stability.md).
// Differences are divided by the largest velocity, or by the force in double. Prints a table in Markdown.
#include "bodies/links/interpolated_bounce_back.hpp"
#include "bodies/links/link_builder.hpp"
#include "bodies/map/body_map.hpp"
#include "core/parallel/mpi_session.hpp"
#include "lbm/fluid/fluid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace thalweg::benchmark {
namespace {

struct Result {
  std::vector<double> velocity;  // along the flow, lattice units
  double force = 0.0;            // on what resists the flow
};

struct Difference {
  double velocity, force;  // relative
};

Difference compare(const Result& in_single, const Result& in_double) {
  double largest = 0.0, difference = 0.0;
  for (std::size_t k = 0; k < in_double.velocity.size(); ++k) {
    largest = std::max(largest, std::abs(in_double.velocity[k]));
    difference = std::max(difference, std::abs(in_single.velocity[k] - in_double.velocity[k]));
  }
  return {difference / largest, std::abs(in_single.force / in_double.force - 1.0)};
}

template <typename Real>
Result channel(double excess, double velocity) {
  constexpr int height = 32;
  const double nu = excess / 3.0;
  const Decomposition decomposition({8, 2, height}, 1.0, {true, true, false}, {1, 1, 1});
  lbm::CollisionParameters parameters;
  parameters.relaxation_time = 0.5 + excess;
  parameters.force[0] = 8.0 * nu * velocity / (height * height);
  lbm::FaceConditions faces;
  faces[4].type = faces[5].type = lbm::FaceType::no_slip;
  lbm::Fluid<Real> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
  fluid.initialise([&](const Vec3& p) {
    return lbm::FluidState{0.0, Vec3(4.0 * velocity * p.z() * (height - p.z()) / (height * height), 0.0, 0.0)};
  });
  const int steps = static_cast<int>(0.3 * height * height / nu);
  for (int step = 0; step < steps; ++step) fluid.advance();
  Result result;
  for (int z = 0; z < height; ++z)
    result.velocity.push_back(fluid.state_at(fluid.indexing().index(1, 1, z)).velocity.x());
  const auto& u = result.velocity;
  result.force = nu * (9.0 * u[0] - u[1] + 9.0 * u[height - 1] - u[height - 2]) / 3.0;
  return result;
}

template <typename Real>
Result sphere(double excess, double velocity) {
  constexpr int side = 24;
  constexpr double diameter = 10.0;
  const double nu = excess / 3.0;
  const Decomposition decomposition({side, side, side}, 1.0, {true, true, true}, {1, 1, 1});
  lbm::CollisionParameters parameters;
  parameters.relaxation_time = 0.5 + excess;
  // About three times Stokes's drag at this distance from the images, and less at higher Reynolds numbers.
  parameters.force[0] = 3.0 * 3.0 * 3.14159 * nu * diameter * velocity / (side * side * side);
  lbm::Fluid<Real> fluid(decomposition, MPI_COMM_SELF, parameters, {});
  bodies::BodyMap map(decomposition, fluid.block(), fluid.cells());
  bodies::LinkTable links(fluid.tiles().count());
  bodies::LinkBuilder builder(decomposition, fluid.block(), fluid.cells(), fluid.tiles());
  std::vector<bodies::LinkBody> bodies(1);
  map.begin_update();
  bodies[0].radius = 0.5 * diameter;
  bodies[0].centre = Vec3(12.3, 11.9, 12.1);
  map.remap(map.add(0, bodies[0].radius), bodies[0].centre);
  map.settle();
  builder.update(map, links);
  fluid.initialise([&](const Vec3&) { return lbm::FluidState{0.0, Vec3(velocity, 0.0, 0.0)}; });
  const PeriodicBox box{Vec3(side, side, side), {true, true, true}};
  const bodies::LinkOptions options;
  const int steps = static_cast<int>(0.25 * side * side / nu);
  Result result;
  double drag = 0.0;
  for (int step = 0; step < steps; ++step) {
    fluid.exchange_halo();
    bodies[0].force = bodies[0].torque = {};
    bodies::InterpolatedBounceBack pass(fluid, links, box, options, bodies);
    fluid.stream_and_collide([&](int tile) { pass.apply_tile(tile); });
    drag = bodies[0].force.to_vec3().x();
  }
  double sum = 0.0;
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const std::ptrdiff_t cell = fluid.indexing().index(x, y, z);
        if (!fluid.cells().is_fluid(cell)) continue;
        result.velocity.push_back(fluid.state_at(cell).velocity.x());
        sum += result.velocity.back();
      }
  result.force = drag / (sum / (side * side * side));  // over the superficial velocity
  return result;
}

void run() {
  fmt::print("| tau | velocity | channel: profile | wall stress | sphere: velocity field | drag over velocity |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  for (const double tau : {0.503, 0.53, 0.6, 0.8, 1.5})
    for (const double velocity : {0.05, 0.01, 0.001, 0.0001}) {
      const double excess = tau - 0.5;
      const Difference c = compare(channel<float>(excess, velocity), channel<double>(excess, velocity));
      fmt::print("| {:g} | {:g} | {:.1e} | {:.1e} |", tau, velocity, c.velocity, c.force);
      // Above a Reynolds number of about a hundred the wake is not steady, and two runs part whatever their precision.
      if (10.0 * velocity / (excess / 3.0) < 100.0) {
        const Difference s = compare(sphere<float>(excess, velocity), sphere<double>(excess, velocity));
        fmt::print(" {:.1e} | {:.1e} |\n", s.velocity, s.force);
      } else {
        fmt::print(" - | - |\n");
      }
      std::fflush(stdout);
    }
}

}  // namespace
}  // namespace thalweg::benchmark

int main(int argc, char** argv) {
  thalweg::MpiSession session(argc, argv);
  thalweg::benchmark::run();
}
