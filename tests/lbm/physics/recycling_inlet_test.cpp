// Velocity inlet that recycles the flow of a plane downstream of it.
#include "core/base/error.hpp"
#include "lbm/fluid/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace thalweg::lbm::recycling_inlet_test {
namespace {

constexpr double speed = 0.004;

FaceConditions recycling(int plane, double inflow, FaceType sides) {
  FaceConditions faces;
  faces[0].type = FaceType::velocity_inlet;
  faces[0].velocity = Vec3(inflow, 0.0, 0.0);
  faces[0].recycling_plane = plane;
  faces[1].type = FaceType::pressure_outlet;
  faces[2].type = faces[3].type = sides;
  return faces;
}

// At the inlet itself a step would recycle what it has brought in before.
TEST(RecyclingInlet, TakesAPlaneWithinTheBoxAlone) {
  const Decomposition decomposition({12, 4, 4}, 1.0, {false, true, true}, {1, 1, 1});
  const auto fluid_with = [&](const FaceConditions& faces) {
    return Fluid<double>(decomposition, MPI_COMM_SELF, {}, faces);
  };
  for (const int plane : {-1, 0, 12})
    EXPECT_THROW(fluid_with(recycling(plane, speed, FaceType::periodic)), InputError) << plane;
  FaceConditions from_above = recycling(11, -speed, FaceType::periodic);
  std::swap(from_above[0], from_above[1]);
  EXPECT_THROW(fluid_with(from_above), InputError);
  from_above[1].recycling_plane = 10;
  EXPECT_NO_THROW(fluid_with(from_above));
}

// The parabola is the only steady flow that enters as it flows in the plane. From rest, and from the first cell on. The
// density falls by 0.4 % from the inlet to the plane, which the velocity gains: a tenth of that in a height.
TEST(RecyclingInlet, DevelopsTheProfile) {
  constexpr int length = 40, height = 10;
  const Decomposition decomposition({length, height, 4}, 1.0, {false, false, true}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = 0.5 + std::sqrt(3.0) / 4.0;  // no error of the half-link wall
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, recycling(20, speed, FaceType::no_slip));
  fluid.initialise([](const Vec3&) { return FluidState{}; });
  for (int step = 0; step < 8000; ++step) fluid.advance();
  for (const int x : {0, 1, 3, 20}) {
    double mean = 0.0;
    for (int y = 0; y < height; ++y) {
      const FluidState s = fluid.state_at(fluid.indexing().index(x, y, 1));
      const double eta = (y + 0.5) / height, momentum = (1.0 + s.density_deviation) * s.velocity.x();
      EXPECT_NEAR(momentum, 6.0 * speed * eta * (1.0 - eta) / (1.0 + 0.5 / (height * height)), 0.001 * speed)
          << x << " " << y;
      mean += momentum / height;
    }
    EXPECT_NEAR(mean, speed, 1e-5 * speed);  // once steady
  }
}

// The discharge is that of the whole face, though a step covers half of the inlet, and is there from the first exchange
// on, though the fluid is at rest.
TEST(RecyclingInlet, BringsTheDischargeAskedFor) {
  constexpr int length = 60, height = 12;
  const Decomposition decomposition({length, 4, height}, 1.0, {false, true, false}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = 0.6;
  FaceConditions faces = recycling(40, speed, FaceType::periodic);
  faces[4].type = faces[5].type = FaceType::free_slip;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
  for (int z = 0; z < height / 2; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 10; ++x) fluid.cells().assign(x, y, z, 0);
  fluid.initialise([](const Vec3&) { return FluidState{}; });
  const auto entering = [&] {  // the mass that the inlet adds in the exchange to come
    fluid.exchange_halo();
    fluid.apply_walls();
    const Populations<double>& f = std::as_const(fluid).populations();
    double sum = 0.0;
    for (int z = height / 2; z < height; ++z)
      for (int y = 0; y < 4; ++y) {
        const std::ptrdiff_t cell = fluid.indexing().index(0, y, z);
        for (int o = 1; o < D3Q19::directions; ++o)
          if (D3Q19::c[o][0] == 1) sum += f.incoming(o, cell) - f.post_collision(D3Q19::opposite(o), cell);
      }
    return sum;
  };
  const double asked_for = speed * 4 * height;
  EXPECT_NEAR(entering(), asked_for, 1e-12);
  for (int step = 0; step < 200; ++step) fluid.advance();
  EXPECT_NEAR(entering(), asked_for, 1e-12);
}

// A shear wave that the stream carries through the plane enters again, time after time, and decays as it would in a
// periodic box of one wavelength, the distance from the inlet to the plane, to the last digit: what enters at the plane
// enters at the inlet. It comes round five times. The decay is that of theory to the order (2 pi/40)^2.
TEST(RecyclingInlet, BringsAWaveBack) {
  constexpr int length = 80, plane = 40;
  constexpr double stream = 0.05, wave = 1e-3, viscosity = 0.01 / 3.0;
  const double wavelength = plane, k = 2.0 * std::numbers::pi / wavelength;
  const Decomposition decomposition({length, 4, 4}, 1.0, {false, true, true}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = 0.5 + 3.0 * viscosity;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, recycling(plane, stream, FaceType::periodic));
  fluid.initialise([=](const Vec3& at) { return FluidState{0.0, Vec3(stream, wave * std::sin(k * at.x()), 0.0)}; });
  const int steps = static_cast<int>(5.0 * wavelength / stream);
  for (int step = 0; step < steps; ++step) fluid.advance();
  double sine = 0.0, cosine = 0.0;
  for (int x = 0; x < plane; ++x) {
    const double v = fluid.state_at(fluid.indexing().index(x, 1, 1)).velocity.y();
    const double phase = k * (x + 0.5 - stream * steps);
    sine += 2.0 / plane * v * std::sin(phase);
    cosine += 2.0 / plane * v * std::cos(phase);
  }
  const double expected = wave * std::exp(-viscosity * k * k * steps);
  EXPECT_NEAR(std::hypot(sine, cosine), expected, 0.025 * expected);
  EXPECT_GT(sine, 0.99 * expected);  // in phase
}

// Sound that goes to and fro across a channel as high as a wavelength, between the inlet and a step beyond the plane,
// and through the plane. Nothing feeds it, so that it must not grow. With the velocities of the plane in place of
// its populations it grows without limit.
TEST(RecyclingInlet, DoesNotFeedSound) {
  constexpr int length = 90, height = 24, plane = 60;
  const Decomposition decomposition({length, 4, height}, 1.0, {false, true, false}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = 0.501;
  parameters.bulk_relaxation_time = 0.55;
  FaceConditions faces = recycling(plane, speed, FaceType::periodic);
  faces[4].type = faces[5].type = FaceType::free_slip;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
  for (int z = 0; z < height / 3; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 80; x < length; ++x) fluid.cells().assign(x, y, z, 0);
  fluid.initialise([](const Vec3& at) {
    return FluidState{1e-4 * std::cos(std::numbers::pi * at.z() / height) * std::sin(0.1 * at.x()),
                      Vec3(speed, 0.0, 0.0)};
  });
  const auto sound = [&] {  // mean square of the density, antisymmetric about half the height, over a period and more
    double sum = 0.0;
    for (int step = 0; step < 200; ++step) {
      fluid.advance();
      for (int x = 0; x < plane; x += 5) {
        const auto density = [&](int z) { return fluid.state_at(fluid.indexing().index(x, 1, z)).density_deviation; };
        const double across = density(0) - density(height - 1);
        sum += across * across;
      }
    }
    return sum;
  };
  const double at_first = sound();
  for (int step = 0; step < 6400; ++step) fluid.advance();
  EXPECT_LT(sound(), at_first);
}

}  // namespace
}  // namespace thalweg::lbm::recycling_inlet_test
