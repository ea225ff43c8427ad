// The fluid has the same bits on any number of ranks, however the box is cut: every rank runs the whole box alone as
// well and compares its own block.
#include "core/parallel/mpi_session.hpp"
#include "lbm/fluid/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::lbm::ranks_test {
namespace {

FluidState swirl(const Vec3& p) {
  return {0.01 * std::sin(0.7 * p.x() + 0.3 * p.z()),
          Vec3(0.05 * std::sin(0.5 * p.y()), 0.04 * std::cos(0.6 * p.z()), 0.05 * std::sin(0.4 * p.x() + 0.2 * p.y()))};
}

// All that leave every rank enough cells.
std::vector<Index3> layouts_of(const Index3& cells, int ranks) {
  const auto fits = [&](int axis, int slabs) {
    return slabs == 1 || cells[axis] / slabs >= Decomposition::min_cells_per_rank;
  };
  std::vector<Index3> layouts;
  for (int x = 1; x <= ranks; ++x)
    for (int y = 1; x * y <= ranks; ++y)
      if (const int z = ranks / (x * y); ranks == x * y * z && fits(0, x) && fits(1, y) && fits(2, z))
        layouts.push_back({x, y, z});
  return layouts;
}

struct Box {
  const char* name;
  FaceConditions faces;
  Index3 cells{41, 42, 43};  // five for each of eight ranks along any axis
};

std::vector<Box> boxes() {
  const FaceCondition periodic{FaceType::periodic}, no_slip{FaceType::no_slip}, free_slip{FaceType::free_slip},
      law{FaceType::law_of_the_wall}, slip_law{FaceType::slip_law_of_the_wall};
  FaceCondition slip{FaceType::navier_slip}, first_cell = slip_law, lid{FaceType::moving},
                                             inlet{FaceType::velocity_inlet}, outlet{FaceType::pressure_outlet};
  slip.slip_length = 0.8;
  first_cell.slip_of_first_cell = true;
  lid.velocity = Vec3(0.03, 0.02, 0.0);
  inlet.velocity = Vec3(0.03, 0.01, 0.0);
  outlet.density_deviation = 0.002;
  FaceCondition recycled = inlet, recycled_from_above{FaceType::velocity_inlet};
  recycled.recycling_plane = 23;
  recycled_from_above.velocity = Vec3(0.0, -0.04, 0.0);
  recycled_from_above.recycling_plane = 11;
  return {{"periodic", {periodic, periodic, periodic, periodic, periodic, periodic}},
          {"flume", {periodic, periodic, law, law, no_slip, free_slip}},
          {"published flume", {periodic, periodic, slip_law, slip_law, no_slip, free_slip}},
          {"closed by three walls", {law, free_slip, no_slip, first_cell, free_slip, first_cell}},
          {"under a lid", {slip, no_slip, slip_law, law, slip, lid}},
          {"duct", {periodic, periodic, law, slip, law, law}},
          {"channel of one cell", {periodic, periodic, law, law, no_slip, free_slip}, {37, 1, 35}},
          {"channel of two cells", {periodic, periodic, law, law, no_slip, free_slip}, {37, 2, 35}},
          {"channel of three cells", {law, law, periodic, periodic, no_slip, free_slip}, {3, 37, 35}},
          {"channel of five cells a rank at most", {periodic, periodic, law, law, law, free_slip}, {37, 10, 10}},
          {"open", {inlet, outlet, law, slip, no_slip, free_slip}},
          {"open, recycling", {recycled, outlet, law, slip, no_slip, free_slip}},
          {"open across, recycling", {periodic, periodic, outlet, recycled_from_above, no_slip, free_slip}}};
}

struct Model {
  CollisionModel collision;
  Subgrid subgrid;
};

template <typename Real>
void compare(const Box& box, const Model& model, const Index3& layout, double bulk_relaxation_time = 0.0) {
  const Index3& cells = box.cells;
  std::array<bool, 3> periodic;
  for (int a = 0; a < 3; ++a) periodic[a] = box.faces[2 * a].type == FaceType::periodic;
  CollisionParameters parameters;
  parameters.model = model.collision;
  parameters.relaxation_time = 0.503;
  parameters.subgrid = model.subgrid;
  parameters.bulk_relaxation_time = bulk_relaxation_time;
  parameters.force[0] = 1e-5;
  const Decomposition whole(cells, 1.0, periodic, {1, 1, 1}), cut(cells, 1.0, periodic, layout);
  Fluid<Real> alone(whole, MPI_COMM_SELF, parameters, box.faces), shared(cut, MPI_COMM_WORLD, parameters, box.faces);
  alone.initialise(swirl);
  shared.initialise(swirl);
  for (int step = 0; step < 7; ++step) {  // odd: ends in the other arrangement
    alone.advance();
    shared.advance();
  }
  const Index3 n = shared.indexing().size(), from = shared.block().lower;
  std::int64_t differing = 0;
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x)
        for (int i = 0; i < 19; ++i)
          differing +=
              shared.populations().post_collision(i, shared.indexing().index(x, y, z)) !=
              alone.populations().post_collision(i, alone.indexing().index(from[0] + x, from[1] + y, from[2] + z));
  EXPECT_EQ(differing, 0) << box.name << ", layout " << layout[0] << "," << layout[1] << "," << layout[2];
  const FluidTotals a = alone.totals(), s = shared.totals();
  EXPECT_EQ(a.mass_deviation, s.mass_deviation);
  EXPECT_EQ(a.momentum, s.momentum);
}

TEST(Ranks, DoNotChangeOneBit) {
  // Every box with one model, every model in two boxes at least; layouts take turns between the two storages.
  const Model models[] = {{CollisionModel::bgk, Subgrid::smagorinsky(0.27)},
                          {CollisionModel::trt, Subgrid::qr()},
                          {CollisionModel::trt_at_bodies, Subgrid::qr()}};
  const bool few = size_of(MPI_COMM_WORLD) < 4;
  int next = 0, turn = 0;
  for (const Box& box : boxes()) {
    const Model& model = models[next++ % 3];
    for (const Index3& layout : layouts_of(box.cells, size_of(MPI_COMM_WORLD))) {
      if (few || turn % 2 == 0) compare<float>(box, model, layout);
      if (few || turn % 2 == 1) compare<double>(box, model, layout);
      ++turn;
    }
    ++turn;
  }
}

TEST(Ranks, DoNotChangeOneBitWithABulkViscosityOfItsOwn) {
  const Box flume = boxes()[1];
  const Index3 layout = layouts_of(flume.cells, size_of(MPI_COMM_WORLD)).front();
  compare<float>(flume, {CollisionModel::bgk, Subgrid::smagorinsky(0.27)}, layout, 10.0);
  compare<double>(flume, {CollisionModel::trt, Subgrid::qr()}, layout, 3.0);
  compare<float>(flume, {CollisionModel::trt_at_bodies, Subgrid::qr()}, layout, 1.0);
}

}  // namespace
}  // namespace thalweg::lbm::ranks_test
