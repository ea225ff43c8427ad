// Flow between two walls against the exact solutions of the lattice.
#include "lbm/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::lbm {
namespace {

struct Channel {
  int height;
  double relaxation_time;
  double force;
  FaceCondition wall;
  int normal = 1;                       // axis across the channel; the flow is along x (along y where x is the normal)
};

// Velocity across the channel after so many steps.
std::vector<double> steady_profile(const Channel& channel, int steps, double initial_velocity = 0.0) {
  Index3 cells{4, 4, 4};
  cells[channel.normal] = channel.height;
  std::array<bool, 3> periodic{true, true, true};
  periodic[channel.normal] = false;
  const Decomposition decomposition(cells, 1.0, periodic, {1, 1, 1});
  const int along = channel.normal == 0 ? 1 : 0;
  CollisionParameters parameters;
  parameters.relaxation_time = channel.relaxation_time;
  parameters.force[along] = channel.force;
  FaceConditions faces;
  faces[face_of(channel.normal, false)] = faces[face_of(channel.normal, true)] = channel.wall;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
  FluidState start;
  start.velocity[along] = initial_velocity;
  fluid.initialise([&](const Vec3&) { return start; });
  for (int step = 0; step < steps; ++step) fluid.advance();
  std::vector<double> profile;
  for (int k = 0; k < channel.height; ++k) {
    Index3 at{1, 2, 1};
    at[channel.normal] = k;
    profile.push_back(fluid.state_at(fluid.indexing().index(at[0], at[1], at[2])).velocity[along]);
  }
  return profile;
}

// BGK with half-link bounce-back carries an exact parabola, shifted by F (16 (tau - 1/2)^2 - 3)/(24 nu): Ginzburg and
// d'Humieres 2003; the shift vanishes with the square of the resolution at fixed viscosity.
TEST(Poiseuille, IsTheKnownParabolaAtEveryWallNormal) {
  for (const int normal : {0, 1, 2})
    for (const double tau : {0.6, 0.8, 1.2}) {
      const Channel channel{21, tau, 1e-6, {FaceType::no_slip}, normal};
      const double nu = (tau - 0.5) / 3.0, h = channel.height;
      const std::vector<double> u = steady_profile(channel, static_cast<int>(3.0 * h * h / nu));
      const double shift = channel.force * (16.0 * (tau - 0.5) * (tau - 0.5) - 3.0) / (24.0 * nu);
      const double centre = channel.force * h * h / (8.0 * nu);
      for (int k = 0; k < channel.height; ++k) {
        const double y = k + 0.5;
        EXPECT_NEAR(u[k], channel.force / (2.0 * nu) * y * (h - y) + shift, 1e-10 * centre);
      }
    }
}

// Free slip carries no stress: a force accelerates the fluid as a block, u = F t to round-off.
TEST(FreeSlip, LetsTheFluidSlideAsABlock) {
  const std::vector<double> u = steady_profile({9, 0.7, 1e-5, {FaceType::free_slip}}, 500);
  for (const double value : u) EXPECT_NEAR(value, 1e-5 * (500 - 0.5), 1e-14);   // half the last force is still to come
}

// Laminar flow between walls that obey u_slip = A u_tau. With F the force and h the height, the wall stress is F h/2; the
// friction velocity is taken at the wall cell's centre, where the stress is smaller by 1 - 1/h:
//   u(y) = A u_tau / sqrt(1 - 1/h) + F y (h - y)/(2 nu) + shift,   u_tau^2 = F h/2.
TEST(LawOfTheWall, SlipsByItsCoefficientTimesTheFrictionVelocity) {
  const double tau = 0.55, nu = (tau - 0.5) / 3.0, force = 1e-7;
  const int h = 20;
  FaceCondition wall{FaceType::law_of_the_wall};
  wall.slip_coefficient = 8.36;
  for (const int normal : {0, 1, 2}) {
    const double friction_velocity = std::sqrt(force * h / 2.0);
    const double slip = 8.36 * friction_velocity / std::sqrt(1.0 - 1.0 / h);
    const double shift = force * (16.0 * (tau - 0.5) * (tau - 0.5) - 3.0) / (24.0 * nu);
    // A slip length far beyond h makes the way to steady state long, unless the start is near it.
    const std::vector<double> u = steady_profile({h, tau, force, wall, normal}, 100000, slip);
    // The scheme is of second order; the whole effect tested is 2.5 % of the slip velocity between cell and wall.
    for (int k = 0; k < h; ++k) {
      const double y = k + 0.5;
      EXPECT_NEAR(u[k], slip + force / (2.0 * nu) * y * (h - y) + shift, slip / (h * h));
    }
  }
}

}  // namespace
}  // namespace thalweg::lbm
