// Additions of a user to the lattice, on a copy of lbm/ that extend.py has extended: a collision operator, a subgrid
// model and a wall, each against an exact solution.
#include "lbm/fluid/flow_fields.hpp"
#include "tests/lbm/channel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace thalweg::lbm::extension_test {
namespace {

constexpr int height = 8, steps = 20000;

template <typename Choice>
bool has_word(const std::string& word) {
  const auto choices = choices_of(Choice());
  return std::any_of(choices.begin(), choices.end(), [&](const auto& choice) { return choice.name == word; });
}

// (tau - 1/2)(1/1 - 1/2) = 3/16 at tau = 7/8: walls are exactly half way, and the parabola is exact (Ginzburg et al.
// 2008). With bgk, whose product is 9/64, the velocity would be too small by F/(32 nu), 0.4 % in the middle.
TEST(NewCollisionOperator, GivesTheExactParabola) {
  Channel channel;
  channel.height = height;
  channel.collision.model = CollisionModel::odd_at_once;
  channel.collision.relaxation_time = 0.875;
  channel.collision.force[0] = 1e-6;
  channel.low.type = channel.high.type = FaceType::no_slip;
  const std::vector<double> velocity = velocity_across(channel, steps);
  for (int k = 0; k < height; ++k) {
    const double z = k + 0.5, exact = 1e-6 / (2.0 * 0.125) * z * (height - z);
    EXPECT_NEAR(velocity[static_cast<std::size_t>(k)], exact, 1e-9 * exact) << k;
  }
  EXPECT_TRUE(has_word<CollisionModel>("odd_at_once"));
}

// Simple shear at the rate U/H has the eddy viscosity C^2 U/H.
TEST(NewSubgridModel, AddsItsViscosityInSimpleShear) {
  constexpr double constant = 0.3, speed = 0.02, rate = speed / height, nu = 0.01;
  Channel channel;
  channel.height = height;
  const Decomposition decomposition({4, 4, height}, 1.0, {true, true, false}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = 0.5 + 3.0 * nu;
  parameters.subgrid = Subgrid::shear(constant);
  FaceConditions faces;
  faces[face_of(2, false)].type = FaceType::no_slip;
  faces[face_of(2, true)].type = FaceType::moving;
  faces[face_of(2, true)].velocity = Vec3(speed, 0.0, 0.0);
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
  fluid.initialise([&](const Vec3& p) { return FluidState{0.0, Vec3(rate * p.z(), 0.0, 0.0)}; });
  for (int step = 0; step < steps; ++step) fluid.advance();
  const double stress = (nu + constant * constant * rate) * rate;
  EXPECT_NEAR(fluid.wall_forces()[face_of(2, false)].x(), 16.0 * stress, 1e-6 * 16.0 * stress);
  const SubgridState state = subgrid_state(fluid, fluid.indexing().index(1, 2, 3));
  EXPECT_NEAR(state.eddy_viscosity, constant * constant * rate, 1e-6 * constant * constant * rate);
  EXPECT_TRUE(has_word<SubgridModel>("shear"));
}

// Couette flow over a slip length of tau - 1/2.
TEST(NewWall, SlipsByItsLength) {
  constexpr double speed = 0.01, slip_length = 0.3;
  Channel channel;
  channel.height = height;
  channel.collision.relaxation_time = 0.5 + slip_length;
  channel.low.type = FaceType::half_slip;
  channel.high.type = FaceType::moving;
  channel.high.velocity = Vec3(speed, 0.0, 0.0);
  const std::vector<double> velocity = velocity_across(channel, steps);
  for (int k = 0; k < height; ++k) {
    const double exact = speed * (k + 0.5 + slip_length) / (height + slip_length);
    EXPECT_NEAR(velocity[static_cast<std::size_t>(k)], exact, 1e-9 * speed) << k;
  }
}

}  // namespace
}  // namespace thalweg::lbm::extension_test
