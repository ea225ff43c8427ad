// Velocity inlet and pressure outlet.
#include "lbm/fluid/fluid.hpp"
#include "lbm/lattice/equilibrium.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

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
  OutletDensity outlet(0.01, 4);
  for (int step = 0; step < 7; ++step) {
    fluid.advance();
    double momentum = 0.0;
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 6; ++x) {
        const FluidState s = fluid.state_at(fluid.indexing().index(x, y, 3));
        momentum += (1.0 + s.density_deviation) * s.velocity.z() / 30.0;
      }
    outlet.update(momentum);
  }
  fluid.set_force(next);
  EXPECT_EQ(fluid.carried_force(), last);
  fluid.exchange_halo();
  fluid.apply_walls();
  const Populations<double>& f = std::as_const(fluid).populations();
  EXPECT_GT(std::abs(outlet.deviation() - 0.01), 1e-4);  // the flow has just begun
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 6; ++x) {
      const std::ptrdiff_t cell = fluid.indexing().index(x, y, 3);
      Vec3 momentum = Vec3::Zero();
      for (int i = 0; i < D3Q19::directions; ++i)
        momentum += f.post_collision(i, cell) * Vec3(D3Q19::c[i][0], D3Q19::c[i][1], D3Q19::c[i][2]);
      const Vec3 u = (momentum - 0.5 * last) / (1.0 + f.density_deviation(cell));
      EXPECT_LT((fluid.state_at(cell).velocity - u).norm(), 1e-16);
      const double speed = outlet.entering_speed();
      const bool enters = u.z() < 0.0;
      const Vec3 beyond = enters ? Vec3(0.0, 0.0, -speed) : u;
      const double deviation = outlet.deviation() - (enters ? 1.5 * speed * speed : 0.0);
      for (int o = 1; o < D3Q19::directions; ++o)
        if (D3Q19::c[o][2] == -1) {
          EXPECT_NEAR(f.incoming(o, cell), equilibrium_deviation(o, deviation, beyond), 1e-13);
        }
    }
  fluid.advance();
  EXPECT_EQ(fluid.carried_force(), next);
}

FaceConditions along_x(double inflow) {
  FaceConditions faces = through_flow(0, FaceType::periodic);
  faces[0].velocity = Vec3(inflow, 0.0, 0.0);
  return faces;
}

// Water at a Reynolds number of a few hundred a cell, with the subgrid model of the defaults, which leaves flow in two
// dimensions alone.
CollisionParameters nearly_inviscid() {
  CollisionParameters parameters;
  parameters.relaxation_time = 0.5015;
  parameters.subgrid = Subgrid::qr();
  return parameters;
}

// Sound that leaves: a pulse that travels to the outlet. A fixed pressure sends all of it back, turned over; fluid of
// zero gradient sends back (1 - 3 c_s)/(1 + 3 c_s) = -0.27 of it. Here the face has the impedance of the fluid, so that
// what comes back is of the order of the Mach number, 0.09, and of the wavelength over the path c_s T.
TEST(OpenFaces, LetSoundLeave) {
  constexpr int length = 200;
  constexpr double inflow = 0.05, amplitude = 1e-4, speed_of_sound = std::numbers::inv_sqrt3;
  const Decomposition decomposition({length, 4, 4}, 1.0, {false, true, true}, {1, 1, 1});
  for (const double width : {4.0, 10.0, 30.0}) {
    Fluid<double> fluid(decomposition, MPI_COMM_SELF, nearly_inviscid(), along_x(inflow));
    fluid.initialise([&](const Vec3& at) {
      const double deviation = amplitude * std::exp(-std::pow((at.x() - 0.5 * length) / width, 2.0));
      return FluidState{deviation, Vec3(inflow + speed_of_sound * deviation, 0.0, 0.0)};
    });
    const double there = 0.5 * length / (speed_of_sound + inflow), and_back = 60.0 / (speed_of_sound - inflow);
    for (int step = 0; step < static_cast<int>(there + and_back); ++step) fluid.advance();
    double reflected = 0.0;
    for (int x = 0; x < length; ++x)
      reflected = std::max(reflected, std::abs(fluid.state_at(fluid.indexing().index(x, 1, 1)).density_deviation));
    EXPECT_LT(reflected, 0.09 * amplitude) << width;
  }
}

// A column of fluid at rest that the inlet begins to push is an organ pipe: with a fixed pressure it rings on and on.
// With this outlet every passage of sound takes nearly all of it, and what is left of the push decays with T.
TEST(OpenFaces, LetAColumnComeToItsSpeed) {
  constexpr int length = 120;
  constexpr double inflow = 0.05;
  const Decomposition decomposition({length, 4, 4}, 1.0, {false, true, true}, {1, 1, 1});
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, nearly_inviscid(), along_x(inflow));
  fluid.initialise([](const Vec3&) { return FluidState{}; });
  for (int step = 0; step < 6000; ++step) fluid.advance();  // 6 T
  double most = 0.0;
  for (int step = 0; step < 1000; ++step) {  // five passages of sound, there and back
    fluid.advance();
    const FluidState s = fluid.state_at(fluid.indexing().index(length / 2, 1, 1));
    most = std::max({most, std::abs(s.velocity.x() / inflow - 1.0), std::abs(s.density_deviation)});
  }
  EXPECT_LT(most, std::exp(-5.0));
}

// A vortex that leaves, in a box whose outlet it meets and in one where it is still far from it. Of 1.2 times the speed
// of the stream it lets fluid in. A fixed pressure across the face is not the pressure of a vortex, so that both differ
// while it passes; afterwards nothing of it may be left, as speed or as sound.
class LeavingVortex {
public:
  LeavingVortex(int length, double strength)
      : decomposition_({length, height, 4}, 1.0, {false, true, true}, {1, 1, 1}),
        fluid_(decomposition_, MPI_COMM_SELF, nearly_inviscid(), along_x(stream)) {
    fluid_.initialise([=](const Vec3& at) {
      const double x = (at.x() - 60.0) / radius, y = (at.y() - 0.5 * height) / radius, square = x * x + y * y;
      const double speed = strength * stream * std::exp(0.5 - 0.5 * square);  // largest at the radius
      const double deviation = -1.5 * std::pow(strength * stream, 2.0) * std::exp(1.0 - square);
      return FluidState{deviation, Vec3(stream - speed * y, speed * x, 0.0)};
    });
  }
  void advance() { fluid_.advance(); }
  FluidState at(int x, int y) const { return fluid_.state_at(fluid_.indexing().index(x, y, 1)); }

  static constexpr int height = 60;
  static constexpr double stream = 0.05, radius = 6.0;

private:
  Decomposition decomposition_;
  Fluid<double> fluid_;
};

// What is left of a vortex in the first 60 cells when it has left: as a share of its speed, and of rho U v as pressure.
struct Remains {
  double speed = 0.0, pressure = 0.0;
};

Remains remains_of_vortex(double strength) {
  LeavingVortex leaving(100, strength), staying(220, strength);
  for (int step = 0; step < 1500; ++step) {  // its centre has then been carried 35 cells beyond the outlet
    leaving.advance();
    staying.advance();
  }
  Remains remains;
  const double vortex = strength * LeavingVortex::stream;
  for (int y = 0; y < LeavingVortex::height; ++y)
    for (int x = 0; x < 60; ++x) {
      const FluidState a = leaving.at(x, y), b = staying.at(x, y);
      const double pressure = std::abs(a.density_deviation - b.density_deviation) / 3.0;
      remains.speed = std::max(remains.speed, (a.velocity - b.velocity).norm() / vortex);
      remains.pressure = std::max(remains.pressure, pressure / (LeavingVortex::stream * vortex));
    }
  return remains;
}

TEST(OpenFaces, LetAVortexLeave) {
  for (const double strength : {0.5, 1.2}) {
    const Remains remains = remains_of_vortex(strength);
    EXPECT_LT(remains.speed, 0.05) << strength;
    EXPECT_LT(remains.pressure, 0.05) << strength;
  }
}

// Backflow of twice the stream: fluid that came in with the velocity of the cell would keep bringing energy, and the
// pressure would be beyond three times that of the vortex itself.
TEST(OpenFaces, LetBackflowComeFromRest) {
  const Remains remains = remains_of_vortex(3.0);
  EXPECT_LT(remains.speed, 0.1);
  EXPECT_LT(remains.pressure, 0.1);
}

// Without friction the pressure between two outlets becomes kinetic energy, and no more: u^2 = 2 dp/rho (Bernoulli), to
// the order of the square of the Mach number, 0.6 %. The flow nears it as tanh(t u/(2 L)), and eleven times as slowly,
// for either outlet resists as five lengths of fluid would (5 L/c_s of memory). An inflow at the pressure itself would
// become faster for ever: here seven times as fast.
TEST(OpenFaces, LetFluidInFromRest) {
  constexpr int length = 40;
  constexpr double pressure = 0.001;
  const double speed_at_the_end = std::sqrt(2.0 * pressure);
  const Decomposition decomposition({length, 4, 4}, 1.0, {false, true, true}, {1, 1, 1});
  FaceConditions faces = through_flow(0, FaceType::periodic);
  faces[0].type = FaceType::pressure_outlet;
  faces[0].density_deviation = 3.0 * pressure;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, nearly_inviscid(), faces);
  fluid.initialise([](const Vec3&) { return FluidState{}; });
  for (int step = 0; step < 120000; ++step) fluid.advance();
  const FluidState s = fluid.state_at(fluid.indexing().index(length / 2, 1, 1));
  EXPECT_NEAR(s.velocity.x(), speed_at_the_end, 0.02 * speed_at_the_end);
}

// Water of the defaults, past a wall, that a pressure drives from outlet to outlet, and that begins with the speed that
// the pressure can give it, u^2 = 2 dp/rho. With the velocity of the cell that it enters, faster fluid would bring in
// more of itself, and the flow broke down in 250 steps.
TEST(OpenFaces, LetWaterInOverTheWholeFace) {
  constexpr double stream = 0.06;
  const Decomposition decomposition({48, 24, 24}, 1.0, {false, true, false}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = 0.5006;
  parameters.model = CollisionModel::trt_at_bodies;
  parameters.subgrid = Subgrid::qr();
  FaceConditions faces = through_flow(0, FaceType::periodic);
  faces[0].type = FaceType::pressure_outlet;
  faces[0].density_deviation = 1.5 * stream * stream;
  faces[4].type = FaceType::no_slip;
  faces[5].type = FaceType::free_slip;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
  fluid.initialise([=](const Vec3&) { return FluidState{0.0, Vec3(stream, 0.0, 0.0)}; });
  double fastest = 0.0;
  for (int step = 0; step < 1500; ++step) {
    fluid.advance();
    for (int z = 0; z < 24 && step % 50 == 0; ++z)
      for (const int x : {0, 1, 24, 47})
        fastest = std::max(fastest, fluid.state_at(fluid.indexing().index(x, 12, z)).velocity.norm());
  }
  EXPECT_LT(fastest,
            1.5 * stream);  // and what the layer at the wall displaces; a flow that breaks down passes any bound
}

// Velocity along x and y, and rho - 1, in a box with inlets at x_low and y_low and outlets of different pressures
// opposite, by cells along x and y; `turned`: with x for y.
std::vector<Vec3> between_two_outlets(bool turned) {
  const int first = turned ? 1 : 0, second = 1 - first;
  const Index3 cells{turned ? 10 : 12, turned ? 12 : 10, 4};
  const Decomposition decomposition(cells, 1.0, {false, false, true}, {1, 1, 1});
  FaceConditions faces;
  for (const int axis : {first, second}) {
    faces[face_of(axis, false)].type = FaceType::velocity_inlet;
    faces[face_of(axis, false)].velocity[axis] = axis == first ? 0.05 : 0.03;
    faces[face_of(axis, true)].type = FaceType::pressure_outlet;
    faces[face_of(axis, true)].density_deviation = axis == first ? 0.0 : 0.01;
  }
  CollisionParameters parameters;
  parameters.relaxation_time = 0.6;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
  fluid.initialise([](const Vec3&) { return FluidState{}; });
  for (int step = 0; step < 300; ++step) fluid.advance();
  std::vector<Vec3> states;
  for (int v = 0; v < 10; ++v)
    for (int u = 0; u < 12; ++u) {
      const FluidState s = fluid.state_at(fluid.indexing().index(turned ? v : u, turned ? u : v, 1));
      states.emplace_back(s.velocity[first], s.velocity[second], s.density_deviation);
    }
  return states;
}

// What enters out of the edge between two outlets does not depend on which of them has the axis that comes first.
TEST(OpenFaces, AreAlikeAtTheEdgeOfTwoOutlets) {
  const std::vector<Vec3> states = between_two_outlets(false), turned = between_two_outlets(true);
  for (std::size_t n = 0; n < states.size(); ++n) EXPECT_LT((states[n] - turned[n]).norm(), 1e-14) << n;
}

// The flow between plates that two outlets of different pressure drive: that of the pressure over the length. What each
// outlet is off by is at most the fall over a cell or two.
TEST(OpenFaces, OfDifferentPressuresDriveTheirFlow) {
  constexpr int length = 40, height = 10;
  constexpr double tau = 0.5 + std::numbers::sqrt3 / 4.0, viscosity = (tau - 0.5) / 3.0, mean = 0.01;
  const Decomposition decomposition({length, height, 4}, 1.0, {false, false, true}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = tau;
  FaceConditions faces = through_flow(0, FaceType::no_slip);
  faces[0].type = FaceType::pressure_outlet;
  faces[0].density_deviation = 3.0 * 12.0 * viscosity * mean * length / (height * height);
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
  fluid.initialise([](const Vec3&) { return FluidState{}; });
  for (int step = 0; step < 6000; ++step) fluid.advance();
  double found = 0.0;
  for (int y = 0; y < height; ++y) {
    const FluidState s = fluid.state_at(fluid.indexing().index(length / 2, y, 1));
    found += (1.0 + s.density_deviation) * s.velocity.x() / height;
  }
  EXPECT_NEAR(found, mean, 4.0 / length * mean);
}

}  // namespace
}  // namespace thalweg::lbm::open_face_test
