// Flow between two walls against the exact solutions of the lattice.
#include "tests/lbm/channel.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::lbm::channel_test {
namespace {

Channel plain(int height, double tau, double force, const FaceCondition& wall, int normal = 1) {
  Channel channel;
  channel.height = height;
  channel.collision.relaxation_time = tau;
  channel.collision.force[0] = force;
  channel.low = channel.high = wall;
  channel.normal = normal;
  return channel;
}

// BGK with half-link bounce-back carries an exact parabola, shifted by F (16 (tau - 1/2)^2 - 3)/(24 nu): Ginzburg and
// d'Humieres 2003; the shift vanishes with the square of the resolution at fixed viscosity.
TEST(Poiseuille, IsTheKnownParabolaAtEveryWallNormal) {
  for (const int normal : {0, 1, 2})
    for (const double tau : {0.6, 0.8, 1.2}) {
      const double force = 1e-6;
      const Channel channel = plain(21, tau, force, {FaceType::no_slip}, normal);
      const double nu = (tau - 0.5) / 3.0, h = channel.height;
      const std::vector<double> u = velocity_across(channel, static_cast<int>(3.0 * h * h / nu));
      const double shift = force * (16.0 * (tau - 0.5) * (tau - 0.5) - 3.0) / (24.0 * nu);
      const double centre = force * h * h / (8.0 * nu);
      for (int k = 0; k < channel.height; ++k) {
        const double y = k + 0.5;
        EXPECT_NEAR(u[k], force / (2.0 * nu) * y * (h - y) + shift, 1e-10 * centre);
      }
    }
}

// Free slip carries no stress: a force accelerates the fluid as a block, u = F t to round-off.
TEST(FreeSlip, LetsTheFluidSlideAsABlock) {
  for (const int steps : {0, 1, 500})
    for (const double value : velocity_across(plain(9, 0.7, 1e-5, {FaceType::free_slip}), steps))
      EXPECT_NEAR(value, 1e-5 * steps, 1e-14) << steps;
}

// Laminar flow between walls that obey u_slip = A u_tau. With F the force and h the height, the wall stress is F h/2;
// the friction velocity is taken at the wall cell's centre, where the stress is smaller by 1 - 1/h:
//   u(y) = A u_tau / sqrt(1 - 1/h) + F y (h - y)/(2 nu) + shift,   u_tau^2 = F h/2.
TEST(SlipLawOfTheWall, SlipsByItsCoefficientTimesTheFrictionVelocity) {
  const double tau = 0.55, nu = (tau - 0.5) / 3.0, force = 1e-7;
  const int h = 20;
  FaceCondition wall{FaceType::slip_law_of_the_wall};
  wall.slip_coefficient = 8.36;
  for (const int normal : {0, 1, 2}) {
    const double friction_velocity = std::sqrt(force * h / 2.0);
    const double slip = 8.36 * friction_velocity / std::sqrt(1.0 - 1.0 / h);
    const double shift = force * (16.0 * (tau - 0.5) * (tau - 0.5) - 3.0) / (24.0 * nu);
    // A slip length far beyond h makes the way to steady state long, unless the start is near it.
    const std::vector<double> u = velocity_across(plain(h, tau, force, wall, normal), 100000, slip);
    // The scheme is of second order; the whole effect tested is 2.5 % of the slip velocity between cell and wall.
    for (int k = 0; k < h; ++k) {
      const double y = k + 0.5;
      EXPECT_NEAR(u[k], slip + force / (2.0 * nu) * y * (h - y) + shift, slip / (h * h));
    }
  }
}

// The tangent to u+ = ln(y+)/0.41 + 5 at 10.8 is 8.36 at the wall, and further out what the table of the side-wall
// channel has: A = 9.25 and 9.70 at dx+ = 31.0 and 37.3 (to the digits of dx+).
TEST(SlipLawOfTheWall, TakesTheTangentAtTheFirstCell) {
  EXPECT_EQ(slip_coefficient_at(3.0), 8.36);
  EXPECT_NEAR(slip_coefficient_at(10.8 + 1e-9), 8.36, 0.01);
  EXPECT_NEAR(slip_coefficient_at(0.5 * 31.0), 9.25, 0.01);
  EXPECT_NEAR(slip_coefficient_at(0.5 * 37.3), 9.70, 0.01);
}

// Where the first cell is nearer than 10.8 the coefficient is the constant one; further away, larger, and the flow
// faster.
TEST(SlipLawOfTheWall, OfTheFirstCellSlipsMoreUnderALargerStress) {
  const auto speed = [](double tau, double force, bool first_cell) {
    FaceCondition wall{FaceType::slip_law_of_the_wall};
    wall.slip_of_first_cell = first_cell;
    return velocity_across(plain(8, tau, force, wall), 20000, 0.1)[0];
  };
  EXPECT_EQ(speed(0.55, 1e-7, true), speed(0.55, 1e-7, false));  // y+ = 0.5 sqrt(4e-7)/0.0167 = 0.02
  EXPECT_GT(speed(0.5003, 1e-6, true), 1.001 * speed(0.5003, 1e-6, false));
}

}  // namespace
}  // namespace thalweg::lbm::channel_test
