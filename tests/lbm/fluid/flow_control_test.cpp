// The controlled body force: it reaches its target, and a restart does not change one bit, whatever the ranks.
#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "lbm/fluid/fluid.hpp"
#include "tests/support/memory_archive.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace thalweg::lbm::flow_control_test {
namespace {

struct Channel {
  std::array<bool, 3> periodic;
  FaceConditions faces;
};

Channel between_plates() {
  Channel channel{{true, false, true}, {}};
  channel.faces[2].type = channel.faces[3].type = FaceType::no_slip;
  return channel;
}

// An outlet looks at the velocity of the last step, and the controller sets the force of the next.
Channel under_an_outlet() {
  Channel channel{{true, true, false}, {}};
  channel.faces[4].type = FaceType::no_slip;
  channel.faces[5].type = FaceType::pressure_outlet;
  return channel;
}

CollisionParameters viscous() {
  CollisionParameters parameters;
  parameters.model = CollisionModel::trt;  // no wall error
  parameters.relaxation_time = 0.8;
  return parameters;
}

// In steady Poiseuille flow of mean U the force is 12 nu U/h^2; the mean over cell centres of the exact parabola is
// larger than U by the factor 1 + 1/(2 h^2). With the drag 0.012 u and T = 50 the error decays as exp(-0.0035 t):
// nothing is left after 20000 steps.
TEST(FlowControl, HoldsTheTargetWithTheForceOfPoiseuilleFlow) {
  const Decomposition decomposition({4, 10, 4}, 1.0, {true, false, true}, {1, 1, 1});
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, viscous(), between_plates().faces);
  fluid.control_flow({0, 0.01, 50.0, 5});
  for (int step = 0; step < 20000; ++step) fluid.advance();
  const FluidTotals sums = fluid.totals();
  const double mean = sums.momentum.x() / static_cast<double>(sums.cells) - 0.5 * fluid.parameters().force[0];
  EXPECT_NEAR(mean, 0.01, 1e-9);
  const double nu = 0.1, h = 10.0;
  EXPECT_NEAR(fluid.parameters().force[0], 12.0 * nu * 0.01 / (h * h) / (1.0 + 0.5 / (h * h)), 1e-10);
}

// The force that was set before acts in no step.
TEST(FlowControl, BeginsWithoutForce) {
  const Decomposition decomposition({4, 10, 4}, 1.0, {true, false, true}, {1, 1, 1});
  CollisionParameters parameters = viscous();
  parameters.force = Vec3(1e-4, 0.0, -2e-4);
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, between_plates().faces);
  fluid.control_flow({0, 0.01, 50.0, 5});
  EXPECT_EQ(fluid.parameters().force, Vec3(0.0, 0.0, -2e-4));
  EXPECT_EQ(fluid.carried_force(), Vec3(0.0, 0.0, -2e-4));
}

template <typename Real>
test::MemoryArchive state_after(int steps, const Channel& channel, MPI_Comm communicator, const Index3& layout,
                                const test::MemoryArchive* from = nullptr) {
  const Decomposition decomposition({17, 16, 18}, 1.0, channel.periodic, layout);
  Fluid<Real> fluid(decomposition, communicator, viscous(), channel.faces);
  fluid.control_flow({0, 0.02, 50.0, 4});
  if (from) {
    test::load(fluid, *from);
  }
  for (int step = 0; step < steps; ++step) fluid.advance();
  return test::saved(fluid, communicator);
}

TEST(FlowControl, RestartsToTheSameBitsOnAnyRanks) {
  const Index3 layout = Decomposition::best_layout({17, 16, 18}, size_of(MPI_COMM_WORLD));
  for (const Channel& channel : {between_plates(), under_an_outlet()}) {
    const test::MemoryArchive straight = state_after<float>(23, channel, MPI_COMM_SELF, {1, 1, 1});
    const test::MemoryArchive half = state_after<float>(9, channel, MPI_COMM_WORLD, layout);  // between two looks
    const test::MemoryArchive resumed = state_after<float>(14, channel, MPI_COMM_WORLD, layout, &half);
    EXPECT_EQ(test::first_difference(straight, resumed), "");
  }
}

// With and without a halo that is hidden behind the sweep.
TEST(FlowControl, HasTheSameBitsUnderAnOutletInAnyLayout) {
  const int ranks = size_of(MPI_COMM_WORLD), few = ranks < 8 ? 1 : 2, many = ranks / few;
  const auto expect_the_same = [&]<typename Real>(const Index3& layout) {
    const test::MemoryArchive alone = state_after<Real>(14, under_an_outlet(), MPI_COMM_SELF, {1, 1, 1});
    const test::MemoryArchive shared = state_after<Real>(14, under_an_outlet(), MPI_COMM_WORLD, layout);
    EXPECT_EQ(test::first_difference(alone, shared), "") << layout[0] << layout[1] << layout[2] << sizeof(Real);
  };
  for (const Index3& layout : {Index3{few, many, 1}, Index3{many, few, 1}, Index3{1, few, many}}) {
    expect_the_same.template operator()<float>(layout);
    expect_the_same.template operator()<double>(layout);
  }
}

// A flow that is held steady, as the start of another run: the same acceleration in other units, and no change of
// speed.
TEST(FlowControl, BeginsWithTheForceOfASavedFlow) {
  const Decomposition decomposition({4, 10, 4}, 1.0, {true, false, true}, {1, 1, 1});
  const FaceConditions faces = between_plates().faces;
  Fluid<double> steady(decomposition, MPI_COMM_SELF, viscous(), faces);
  Fluid<double> goes_on(decomposition, MPI_COMM_SELF, viscous(), faces);
  Fluid<double> halved(decomposition, MPI_COMM_SELF, viscous(), faces);
  Fluid<double> free(decomposition, MPI_COMM_SELF, viscous(), faces);
  for (Fluid<double>* fluid : {&steady, &goes_on, &halved}) fluid->control_flow({0, 0.01, 50.0, 5});
  const auto mean = [](const Fluid<double>& fluid) {
    const FluidTotals sums = fluid.totals();
    return sums.momentum.x() / static_cast<double>(sums.cells) - 0.5 * fluid.carried_force()[0];
  };
  for (int step = 0; step < 20000; ++step) steady.advance();
  const test::MemoryArchive saved = test::saved(steady, MPI_COMM_SELF);

  test::MemoryReader reader(saved);
  goes_on.begin_control_of(reader, 1.0);
  goes_on.load_populations(reader);
  const double force = steady.parameters().force[0];
  for (int step = 0; step < 200; ++step) {
    goes_on.advance();
    ASSERT_NEAR(mean(goes_on), 0.01, 1e-8) << step;  // with a force of zero it loses a tenth in 50 steps
    ASSERT_NEAR(goes_on.parameters().force[0], force, 1e-6 * force) << step;
  }
  halved.begin_control_of(reader, 0.5);
  EXPECT_DOUBLE_EQ(halved.parameters().force[0], 0.5 * force);
  EXPECT_DOUBLE_EQ(halved.carried_force()[0], 0.5 * force);
  free.begin_control_of(reader, 1.0);
  EXPECT_EQ(free.parameters().force[0], 0.0);
}

// The flow of a run whose force was given: a control begins with that force, and the mean that it holds stays.
TEST(FlowControl, BeginsAFlowOfAGivenForceWithIt) {
  const Decomposition decomposition({4, 10, 4}, 1.0, {true, false, true}, {1, 1, 1});
  const FaceConditions faces = between_plates().faces;
  CollisionParameters driven = viscous();
  driven.force = Vec3(1e-4, 0.0, 0.0);
  Fluid<double> first(decomposition, MPI_COMM_SELF, driven, faces);
  for (int step = 0; step < 10000; ++step) first.advance();  // 10 h^2/nu, until it is steady
  const auto mean = [](const Fluid<double>& fluid) {
    const FluidTotals sums = fluid.totals();
    return sums.momentum.x() / static_cast<double>(sums.cells) - 0.5 * fluid.carried_force()[0];
  };
  const test::MemoryArchive saved = test::saved(first, MPI_COMM_SELF);
  test::MemoryReader reader(saved);
  Fluid<double> held(decomposition, MPI_COMM_SELF, viscous(), faces);
  held.control_flow({0, mean(first), 50.0, 5});
  held.begin_control_of(reader, 1.0);
  held.load_populations(reader);
  for (int step = 0; step < 100; ++step) {
    held.advance();
    ASSERT_NEAR(held.parameters().force[0], 1e-4, 1e-10) << step;
  }
  Fluid<double> restarted(decomposition, MPI_COMM_SELF, viscous(), faces);
  restarted.control_flow({0, mean(first), 50.0, 5});
  test::load(restarted, saved);
  EXPECT_EQ(restarted.parameters().force[0], 1e-4);
}

// A flow that has not reached its target, as the start of another run: saved where the control looks next, it goes on
// as the first one does. The part of the force that answers the error is made anew; counted twice, it would make the
// force larger by more than a half here.
TEST(FlowControl, BeginsAFlowThatSpeedsUpAsItWouldGoOn) {
  const Decomposition decomposition({4, 10, 4}, 1.0, {true, false, true}, {1, 1, 1});
  const FaceConditions faces = between_plates().faces;
  Fluid<double> first(decomposition, MPI_COMM_SELF, viscous(), faces);
  Fluid<double> goes_on(decomposition, MPI_COMM_SELF, viscous(), faces);
  for (Fluid<double>* fluid : {&first, &goes_on}) fluid->control_flow({0, 0.01, 50.0, 5});
  for (int step = 0; step < 60; ++step) first.advance();
  const test::MemoryArchive saved = test::saved(first, MPI_COMM_SELF);
  test::MemoryReader reader(saved);
  goes_on.begin_control_of(reader, 1.0);
  goes_on.load_populations(reader);
  EXPECT_EQ(goes_on.parameters().force[0], first.parameters().force[0]);
  for (int step = 0; step < 100; ++step) {
    first.advance();
    goes_on.advance();
    const double force = first.parameters().force[0];
    ASSERT_NEAR(goes_on.parameters().force[0], force, 1e-9 * force) << step;
  }
}

// With another response time the force goes on from where it was, in a steady flow and in one that speeds up: over the
// next interval the error falls by at most k F, which is k/T of F = e/T and more, and the integral adds k e/(4 T^2), a
// quarter of that.
TEST(FlowControl, GoesOnWithAnotherResponseTime) {
  const Decomposition decomposition({4, 10, 4}, 1.0, {true, false, true}, {1, 1, 1});
  const auto fluid_with = [&](double response_time) {
    auto fluid = std::make_unique<Fluid<double>>(decomposition, MPI_COMM_SELF, viscous(), between_plates().faces);
    fluid->control_flow({0, 0.01, response_time, 5});
    return fluid;
  };
  for (const bool is_steady : {true, false}) {
    const auto before = fluid_with(50.0);
    for (int step = 0; step < (is_steady ? 20000 : 23); ++step) before->advance();
    const test::MemoryArchive saved = test::saved(*before, MPI_COMM_SELF);
    const double force = before->parameters().force[0];
    for (const double response_time : {100.0, 60.0, 51.0}) {
      const auto after = fluid_with(response_time);
      test::load(*after, saved);
      EXPECT_EQ(after->parameters().force[0], force);
      for (int step = 0; step < 5; ++step) after->advance();
      EXPECT_NEAR(after->parameters().force[0], force, (is_steady ? 1e-6 : 1.25 * 5.0 / 50.0) * force) << response_time;
    }
    // A saved state of an earlier version, which does not tell its response time.
    test::MemoryArchive older = saved;
    older.attributes.erase("fluid/flow_control_response_time");
    const auto same = fluid_with(50.0), from_older = fluid_with(50.0);
    test::load(*same, saved);
    test::load(*from_older, older);
    for (int step = 0; step < 20; ++step) same->advance(), from_older->advance();
    EXPECT_EQ(test::first_difference(test::saved(*same, MPI_COMM_SELF), test::saved(*from_older, MPI_COMM_SELF)), "");
  }
}

TEST(FlowControl, RefusesToRespondFasterThanItLooks) {
  EXPECT_THROW(FlowControl({0, 0.1, 20.0, 10}), InputError);
  EXPECT_THROW(FlowControl({0, 0.1, 100.0, 0}), InputError);
}

}  // namespace
}  // namespace thalweg::lbm::flow_control_test
