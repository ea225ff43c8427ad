// The holder of every cell, while overlapping bodies move by any distance, against the definition.
#include "bodies/map/body_map.hpp"

#include "core/base/counter_random.hpp"
#include "core/parallel/mpi_session.hpp"
#include "lbm/fluid/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace thalweg::bodies::body_map_test {
namespace {

constexpr Index3 cells{16, 14, 12};  // periodic along x and y
constexpr GlobalId count = 9;
constexpr GlobalId nobody = -1;

struct Ball {
  Vec3 centre;
  double radius;
};

// Offset of a cell's centre from a point, to the nearest image.
double offset(int axis, int cell, double from) {
  const int n = cells[static_cast<std::size_t>(axis)];
  const double d = (axis < 2 ? (cell % n + n) % n : cell) + 0.5 - from;
  if (axis == 2) return d;
  return d > 0.5 * n ? d - n : d < -0.5 * n ? d + n : d;
}

GlobalId holder_by_definition(const std::map<GlobalId, Ball>& balls, const Index3& cell) {
  if (cell[2] < 0 || cell[2] >= cells[2]) return nobody;
  for (const auto& [id, ball] : balls)
    if (Sphere{ball.radius}.holds(Vec3(offset(0, cell[0], ball.centre.x()), offset(1, cell[1], ball.centre.y()),
                                       offset(2, cell[2], ball.centre.z()))))
      return id;
  return nobody;
}

class MovingBalls {
public:
  MovingBalls()
      : decomposition_(cells, 1.0, {true, true, false}, Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD))),
        fluid_(decomposition_, MPI_COMM_WORLD, {}, faces()),
        map_(decomposition_, fluid_.block(), fluid_.cells()) {
    for (GlobalId id = 0; id < count; ++id) {
      balls_[id] = {wrapped(Vec3(draw() * 16.0, draw() * 14.0, draw() * 12.0)), 1.3 + 2.0 * draw()};
      slots_[id] = map_.add(id, balls_[id].radius);
    }
  }

  // Moves all by up to `way` cells along each axis.
  void move(double way) {
    map_.begin_update();
    const std::vector<GlobalId> before = holders();
    for (auto& [id, ball] : balls_) {
      ball.centre = wrapped(ball.centre + way * Vec3(2.0 * draw() - 1.0, 2.0 * draw() - 1.0, 2.0 * draw() - 1.0));
      map_.remap(slots_[id], ball.centre);
    }
    const std::vector<CellChange> changes = map_.settle();
    const std::vector<GlobalId> after = holders();
    std::size_t changed = 0;
    for (std::size_t n = 0; n < after.size(); ++n) changed += before[n] != after[n] ? 1 : 0;
    EXPECT_EQ(changes.size(), changed);
    for (const CellChange& change : changes)
      EXPECT_EQ(id_of(change.now), holder_by_definition(balls_, global(change.cell)));
  }

  void expect_as_defined() const {
    for_each_cell([&](const Index3& local) {
      ASSERT_EQ(holder(local), holder_by_definition(balls_, global(local)))
          << local[0] << ' ' << local[1] << ' ' << local[2];
    });
  }

private:
  static lbm::FaceConditions faces() {
    lbm::FaceConditions faces;
    faces[4].type = faces[5].type = lbm::FaceType::no_slip;
    return faces;
  }

  double draw() { return uniform_random(7, 3, draws_++); }
  static Vec3 wrapped(Vec3 x) {
    for (int a = 0; a < 2; ++a)
      x[a] -= cells[static_cast<std::size_t>(a)] * std::floor(x[a] / cells[static_cast<std::size_t>(a)]);
    return x;
  }

  // Cells in memory.
  template <typename Visit>
  void for_each_cell(Visit&& visit) const {
    const Index3& n = fluid_.indexing().size();
    for (int z = -1; z <= n[2]; ++z)
      for (int y = -1; y <= n[1]; ++y)
        for (int x = -1; x <= n[0]; ++x) visit(Index3{x, y, z});
  }
  Index3 global(const Index3& local) const {
    const Index3& lower = fluid_.block().lower;
    return {local[0] + lower[0], local[1] + lower[1], local[2] + lower[2]};
  }
  GlobalId id_of(std::int32_t slot) const {
    return slot == lbm::CellMap::fluid ? nobody : map_.bodies()[static_cast<std::size_t>(slot)].id;
  }
  GlobalId holder(const Index3& local) const {
    return id_of(fluid_.cells().body(fluid_.indexing().index(local[0], local[1], local[2])));
  }
  std::vector<GlobalId> holders() const {
    std::vector<GlobalId> all;
    for_each_cell([&](const Index3& local) { all.push_back(holder(local)); });
    return all;
  }

  Decomposition decomposition_;
  lbm::Fluid<double> fluid_;
  BodyMap map_;
  std::map<GlobalId, Ball> balls_;
  std::map<GlobalId, BodySlot> slots_;
  std::uint64_t draws_ = 0;
};

TEST(BodyMap, HoldsWhatTheDefinitionSaysHoweverFarBodiesMove) {
  MovingBalls balls;
  balls.move(0.0);
  balls.expect_as_defined();
  for (int n = 0; n < 60; ++n)
    for (const double way : {1e-3, 0.1, 0.5, 2.0}) {
      balls.move(way);
      balls.expect_as_defined();
    }
}

}  // namespace
}  // namespace thalweg::bodies::body_map_test
