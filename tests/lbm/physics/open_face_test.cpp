// Velocity inlet and pressure outlet.
#include "lbm/fluid/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace thalweg::lbm::open_face_test {
namespace {

constexpr double speed = 0.004;

FaceConditions through_flow(int axis, FaceType sides) {
  FaceConditions faces;
  faces[face_of(axis, false)].type = FaceType::velocity_inlet;
  faces[face_of(axis, false)].velocity[axis] = speed;
  faces[face_of(axis, true)].type = FaceType::pressure_outlet;
  faces[face_of((axis + 1) % 3, false)].type = faces[face_of((axis + 1) % 3, true)].type = sides;
  return faces;
}

// A uniform stream between free-slip walls satisfies every rule at once, in the edges too: it must stay as it is.
TEST(OpenFaces, LeaveAUniformStreamAlone) {
  for (const int axis : {0, 1, 2}) {
    std::array<bool, 3> periodic{true, true, true};
    periodic[axis] = periodic[(axis + 1) % 3] = false;
    const Decomposition decomposition({7, 6, 5}, 1.0, periodic, {1, 1, 1});
    CollisionParameters parameters;
    parameters.relaxation_time = 0.6;
    Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, through_flow(axis, FaceType::free_slip));
    Vec3 stream = Vec3::Zero();
    stream[axis] = speed;
    fluid.initialise([&](const Vec3&) { return FluidState{0.0, stream}; });
    for (int step = 0; step < 500; ++step) fluid.advance();
    for (int z = 0; z < 5; ++z)
      for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 7; ++x) {
          const FluidState s = fluid.state_at(fluid.indexing().index(x, y, z));
          EXPECT_NEAR((s.velocity - stream).norm(), 0.0, 1e-13);  // round-off of 500 steps
          EXPECT_NEAR(s.density_deviation, 0.0, 1e-13);
        }
  }
}

// From a flat inlet profile the flow between plates develops into the parabola of the same flux, 3/2 of the mean in the
// middle; at Re below 1 that takes less than one height of length, and the outlet reaches back as far. The pressure
// drop 12 nu u L/h^2 makes the density fall by 3 * 12 * 0.144 * 0.004 * 40/100 = 0.8 % along the way, which bounds the
// error of the flux; the profile at one place knows only the change over a height.
TEST(OpenFaces, DevelopTheParabolaOfTheSameFlux) {
  constexpr int length = 40, height = 10;
  const Decomposition decomposition({length, height, 4}, 1.0, {false, false, true}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = 0.5 + std::sqrt(3.0) / 4.0;  // no error of the half-link wall
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, through_flow(0, FaceType::no_slip));
  fluid.initialise([](const Vec3&) { return FluidState{0.0, Vec3(speed, 0.0, 0.0)}; });
  for (int step = 0; step < 8000; ++step) fluid.advance();
  const auto state = [&](int x, int y) { return fluid.state_at(fluid.indexing().index(x, y, 1)); };
  const auto flux = [&](int x) {
    double sum = 0.0;
    for (int y = 0; y < height; ++y) sum += (1.0 + state(x, y).density_deviation) * state(x, y).velocity.x();
    return sum;
  };
  for (int x = 1; x < length; ++x) EXPECT_NEAR(flux(x), flux(0), 1e-6 * flux(0));  // steady: one flux of mass
  const double mean = flux(length / 2) / height;
  for (int y = 0; y < height; ++y) {
    const double eta = (y + 0.5) / height;
    // The sum over cell centres of 6 eta (1 - eta) is not 1 but 1 + 1/(2 h^2).
    const double momentum = (1.0 + state(length / 2, y).density_deviation) * state(length / 2, y).velocity.x();
    EXPECT_NEAR(momentum, 6.0 * mean * eta * (1.0 - eta) / (1.0 + 0.5 / (height * height)), 0.003 * mean);
  }
  EXPECT_NEAR(mean, speed, 0.01 * speed);
  // The outlet's density is prescribed half a cell beyond the last centre, up to the viscous stress there, which is of
  // the order of one cell's fall (3 nu du/dx): two cells' falls bound both.
  EXPECT_NEAR(state(length - 1, height / 2).density_deviation, 0.0,
              2.0 * 3.0 * 12.0 * 0.144 * speed / (height * height));
}

// The rule of walls.hpp for an outlet, with the velocity of the populations as they are: they carry half the force of
// the last collision, and the force of the next, which is set already, changes nothing.
TEST(OpenFaces, ReckonWithTheForceOfTheLastCollision) {
  const Vec3 last(2e-4, -1e-4, 3e-4), next(-5e-3, 4e-3, 1e-3);
  const Decomposition decomposition({6, 5, 4}, 1.0, {true, true, false}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = 0.6;
  FaceConditions faces;
  faces[4].type = FaceType::no_slip;
  faces[5].type = FaceType::pressure_outlet;
  faces[5].density_deviation = 0.01;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
  fluid.set_force(last);
  for (int step = 0; step < 7; ++step) fluid.advance();
  fluid.set_force(next);
  EXPECT_EQ(fluid.carried_force(), last);
  fluid.exchange_halo();
  fluid.apply_walls();
  const Populations<double>& f = std::as_const(fluid).populations();
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 6; ++x) {
      const std::ptrdiff_t cell = fluid.indexing().index(x, y, 3);
      Vec3 momentum = Vec3::Zero();
      for (int i = 0; i < D3Q19::directions; ++i)
        momentum += f.post_collision(i, cell) * Vec3(D3Q19::c[i][0], D3Q19::c[i][1], D3Q19::c[i][2]);
      const Vec3 u = (momentum - 0.5 * last) / (1.0 + f.density_deviation(cell));
      EXPECT_LT((fluid.state_at(cell).velocity - u).norm(), 1e-16);
      for (int o = 1; o < D3Q19::directions; ++o) {
        if (D3Q19::c[o][2] != -1) continue;
        const double along = Vec3(D3Q19::c[o][0], D3Q19::c[o][1], D3Q19::c[o][2]).dot(u);
        const double even = 0.01 + 1.01 * (4.5 * along * along - 1.5 * u.squaredNorm());
        EXPECT_NEAR(f.incoming(o, cell), -f.post_collision(D3Q19::opposite(o), cell) + 2.0 * D3Q19::weight(o) * even,
                    1e-16);
      }
    }
  fluid.advance();
  EXPECT_EQ(fluid.carried_force(), next);
}

}  // namespace
}  // namespace thalweg::lbm::open_face_test
