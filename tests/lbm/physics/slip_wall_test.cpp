// Walls against the exact solutions of Couette and Poiseuille flow on the lattice.
#include "core/base/error.hpp"
#include "tests/lbm/channel.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace thalweg::lbm::slip_wall_test {
namespace {

constexpr double wall_velocity = 0.03;

FaceCondition moving_wall() {
  FaceCondition wall{FaceType::moving};
  wall.velocity[0] = wall_velocity;
  return wall;
}

// The flow below a moving wall at y = height for a lower wall of the given slip length at y = 0.
double couette(double y, double height, double slip_length) {
  return wall_velocity * (y + slip_length) / (height + slip_length);
}

// The lattice carries a linear profile exactly, whatever the collision; 20 h^2/nu steps leave nothing of the start.
void expect_couette(const FaceCondition& low, double slip_length, CollisionModel model, int normal) {
  Channel channel;
  channel.height = 9;
  channel.collision.model = model;
  channel.collision.relaxation_time = 0.9;
  channel.low = low;
  channel.high = moving_wall();
  channel.normal = normal;
  const std::vector<double> u = velocity_across(channel, 20 * 81 * 8);
  for (int k = 0; k < channel.height; ++k)
    EXPECT_NEAR(u[k], couette(k + 0.5, channel.height, slip_length), 1e-12) << "normal " << normal << " cell " << k;
}

TEST(Couette, IsExactForEveryWallCollisionAndNormal) {
  FaceCondition slip{FaceType::navier_slip};
  slip.slip_length = 1.7;
  // Slip velocity A u_tau, u_tau^2 = nu U/(h + s) and s = A nu/u_tau: u_tau^2 h/nu + A u_tau = U.
  const FaceCondition slip_law{FaceType::slip_law_of_the_wall};
  const double nu = 0.4 / 3.0, a = slip_law.slip_coefficient, h = 9.0;
  const double friction_velocity = nu / (2.0 * h) * (std::sqrt(a * a + 4.0 * h * wall_velocity / nu) - a);
  for (const CollisionModel model : {CollisionModel::bgk, CollisionModel::trt, CollisionModel::trt_at_bodies})
    for (const int normal : {0, 1, 2}) {
      expect_couette({FaceType::no_slip}, 0.0, model, normal);
      expect_couette({FaceType::law_of_the_wall}, 0.0, model, normal);  // the fifth cell is in the sublayer
      expect_couette(slip, 1.7, model, normal);
      expect_couette(slip_law, a * nu / friction_velocity, model, normal);
    }
}

TEST(Couette, FreeSlipFollowsTheMovingWall) {
  Channel channel;
  channel.height = 6;
  channel.low.type = FaceType::free_slip;
  channel.high = moving_wall();
  for (const double u : velocity_across(channel, 20 * 36 * 6)) EXPECT_NEAR(u, wall_velocity, 1e-12);
}

// A run that goes on with another slip length or viscosity has the profile of its own, also where it was saved with one
// that followed the shear and where it begins to do so. The eddies see the lattice's error in the normal stresses, as
// below, where the shear is two thirds of this one.
TEST(Couette, GoesOnWithAnotherSlipLengthOrViscosity) {
  const Decomposition decomposition({4, 5, 4}, 1.0, {true, false, true}, {1, 1, 1});
  const auto fluid_with = [&](double relaxation_time, double slip_length, double smagorinsky) {
    CollisionParameters parameters;
    parameters.model = CollisionModel::trt;
    parameters.relaxation_time = relaxation_time;
    parameters.subgrid = Subgrid::smagorinsky(smagorinsky);
    FaceConditions faces;
    faces[face_of(1, false)].type = FaceType::navier_slip;
    faces[face_of(1, false)].slip_length = slip_length;
    faces[face_of(1, true)] = moving_wall();
    return std::make_unique<Fluid<double>>(decomposition, MPI_COMM_SELF, parameters, faces);
  };
  const auto expect_profile = [](Fluid<double>& fluid, double slip_length, double eddies, const char* where) {
    const double error = eddies > 0.0 ? 1e-8 : 1e-11;
    for (int step = 0; step < 7500; ++step) fluid.advance();  // the start decays by exp(-0.006 t) or faster
    for (int k = 0; k < 5; ++k)
      EXPECT_NEAR(fluid.state_at(fluid.indexing().index(1, k, 1)).velocity[0], couette(k + 0.5, 5.0, slip_length),
                  error)
          << where << ", cell " << k;
  };
  for (const double eddies_before : {0.0, 0.3}) {
    const auto first = fluid_with(0.9, 1.7, eddies_before);
    expect_profile(*first, 1.7, eddies_before, "first");
    const test::MemoryArchive saved = test::saved(*first, MPI_COMM_SELF);
    const auto expect_on = [&](double relaxation_time, double slip_length, double eddies, const char* where) {
      const auto fluid = fluid_with(relaxation_time, slip_length, eddies);
      test::load(*fluid, saved);
      expect_profile(*fluid, slip_length, eddies, where);
    };
    expect_on(0.9, 4.0, 0.0, "another slip length");
    expect_on(0.7, 1.7, 0.0, "another viscosity");
    expect_on(0.9, 4.0, 0.3, "with eddies");
  }
}

// With eddies the slip length still counts: the fraction is taken with the viscosity of the cell at the wall. Taken
// with the molecular viscosity alone, the slip would be short by 4 %. The eddies also see the lattice's error in the
// normal stresses, u^2 or 1e-3 of the shear, which enters the eddy viscosity by its square times the eddies' share.
TEST(Couette, SlipLengthHoldsWithEddies) {
  Channel channel;
  channel.height = 8;
  channel.collision.relaxation_time = 0.52;
  channel.collision.subgrid = Subgrid::smagorinsky(0.3);
  channel.low.type = FaceType::navier_slip;
  channel.low.slip_length = 2.0;
  channel.high = moving_wall();
  const std::vector<double> u = velocity_across(channel, 200000);
  for (int k = 0; k < channel.height; ++k) EXPECT_NEAR(u[k], couette(k + 0.5, 8.0, 2.0), 1e-9);
}

// Slip velocity over velocity gradient at the wall of a Poiseuille flow between walls of bounced fraction r, both taken
// from the parabola u = gradient (y - y^2/h) + slip, y from the wall. Steady after the given number of decay times.
double slip_over_gradient(double tau, double r) {
  Channel channel;
  channel.height = 21;
  channel.collision.relaxation_time = tau;
  channel.collision.force[0] = 1e-6;
  channel.low.type = FaceType::navier_slip;
  channel.low.slip_length = (tau - 0.5) * (1.0 / r - 1.0);
  channel.high = channel.low;
  const double h = 21.0, first = 0.5, nu = (tau - 0.5) / 3.0;
  const double gradient = channel.collision.force[0] * h / (2.0 * nu);
  const double start = gradient * (channel.low.slip_length + h / 6.0);  // near the mean, or a long slip takes long
  const double slowest = h * h / (nu * 2.0) * (1.0 + 2.0 * channel.low.slip_length / h);
  const std::vector<double> u = velocity_across(channel, static_cast<int>(16.0 * slowest), start);
  return u[0] / gradient - first * (1.0 - first / h);
}

// Against figures computed elsewhere with an independent code, to all the digits given.
TEST(SlipTable, IsThatOfAnIndependentCode) {
  EXPECT_NEAR(slip_over_gradient(0.6, 1.0), -0.0113, 0.5e-4);
  EXPECT_NEAR(slip_over_gradient(0.6, 0.3), 0.2221, 0.5e-4);
  EXPECT_NEAR(slip_over_gradient(0.8, 0.3), 0.6938, 0.5e-4);
  EXPECT_NEAR(slip_over_gradient(1.0, 0.1), 4.5040, 0.5e-4);
  EXPECT_NEAR(slip_over_gradient(1.5, 0.3), 2.3849, 0.5e-4);
}

// The wall error of the half-link wall is F (16 L - 3)/(24 nu) with L the magic parameter (Ginzburg and d'Humieres
// 2003): none at 3/16, at any viscosity.
TEST(ExactPoiseuille, ForTrtWithMagicParameterThreeSixteenths) {
  for (const double magic : {3.0 / 16.0, 0.25})
    for (const double tau : {0.55, 0.8, 2.0}) {
      Channel channel;
      channel.height = 12;
      channel.collision.model = CollisionModel::trt;
      channel.collision.magic_parameter = magic;
      channel.collision.relaxation_time = tau;
      channel.collision.force[0] = 1e-6;
      channel.low.type = channel.high.type = FaceType::no_slip;
      const double h = 12.0, nu = (tau - 0.5) / 3.0, shift = 1e-6 * (16.0 * magic - 3.0) / (24.0 * nu);
      const std::vector<double> u = velocity_across(channel, static_cast<int>(4.0 * h * h / nu));
      for (int k = 0; k < channel.height; ++k) {
        const double y = k + 0.5;
        EXPECT_NEAR(u[k], 1e-6 / (2.0 * nu) * y * (h - y) + shift, 1e-11 * h * h * 1e-6 / nu + 1e-16);
      }
    }
}

TEST(Walls, RefuseWhatMakesNoSense) {
  const Decomposition decomposition({8, 8, 8}, 1.0, {true, true, false}, {1, 1, 1});
  const auto build = [&](const FaceCondition& top) {
    FaceConditions faces;
    faces[4].type = FaceType::no_slip;
    faces[5] = top;
    const Fluid<float> fluid(decomposition, MPI_COMM_SELF, {}, faces);
  };
  FaceCondition lifting{FaceType::moving}, negative{FaceType::navier_slip};
  lifting.velocity[2] = 0.01;
  negative.slip_length = -1.0;
  EXPECT_THROW(build(lifting), InputError);
  EXPECT_THROW(build(negative), InputError);
}

// Every rank sees it, also one without a share in the wall.
TEST(Walls, RefuseALawOfTheWallWhoseCellsAreOnSeveralRanks) {
  FaceConditions faces;
  faces[4].type = faces[5].type = FaceType::law_of_the_wall;
  const auto build = [&](int height, int ranks) {
    const Decomposition decomposition({8, 8, height}, 1.0, {true, true, false}, {1, 1, ranks});
    for (int rank = 0; rank < ranks; ++rank)
      const Walls<float> walls(decomposition, rank, CellIndexing(decomposition.block_of(rank).size(), 8), faces, {});
  };
  EXPECT_THROW(build(12, 3), InputError);
  build(15, 3);
  build(4, 1);
}

}  // namespace
}  // namespace thalweg::lbm::slip_wall_test
