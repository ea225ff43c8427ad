// The fluid cells that are enclosed, alone or two together, wherever the borders between ranks are.
#include "bodies/map/enclosed_cells.hpp"

#include "tests/bodies/enclosed_by_definition.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <set>
#include <vector>

namespace thalweg::bodies::enclosed_cells_test {
namespace {

using thalweg::test::is_enclosed_by_definition;

const Index3 size{16, 12, 12};

struct Ball {
  GlobalId id;
  double radius;
  Vec3 centre;
};

// A box that is periodic along x and y and has walls below and above, of which one block is looked at.
class OneBlock {
public:
  OneBlock(const Decomposition& decomposition, int rank)
      : block_(decomposition.block_of(rank)),
        cells_(lbm::CellIndexing(block_.size(), 8), walls(block_)),
        map_(decomposition, block_, cells_),
        enclosed_(cells_) {}

  void place(const std::vector<Ball>& balls) {
    map_.begin_update();
    for (const Ball& ball : balls) {
      if (map_.slot_of(ball.id) == BodySlot::none) map_.add(ball.id, ball.radius);
      map_.remap(map_.slot_of(ball.id), ball.centre);
    }
    map_.settle();
    enclosed_.update(map_);
  }

  // Compares the cells found with those of the definition, which knows all spheres everywhere.
  template <typename IsFluid>
  testing::AssertionResult agrees(IsFluid is_fluid, std::set<Index3>& found) const {
    for (int z = 0; z < block_.size()[2]; ++z)
      for (int y = 0; y < block_.size()[1]; ++y)
        for (int x = 0; x < block_.size()[0]; ++x) {
          const Index3 global{x + block_.lower[0], y + block_.lower[1], z + block_.lower[2]};
          const bool is = is_enclosed_by_definition(global, is_fluid);
          if (enclosed_.contains({x, y, z}) != is)
            return testing::AssertionFailure()
                   << global[0] << " " << global[1] << " " << global[2] << " is " << (is ? "" : "not ") << "enclosed";
          if (is) found.insert(global);
        }
    return testing::AssertionSuccess();
  }

private:
  static lbm::WallPositions walls(const Block& block) {
    lbm::WallPositions places;
    places.lower[2] = -block.lower[2];
    places.upper[2] = size[2] - block.lower[2];
    return places;
  }

  Block block_;
  lbm::CellMap cells_;
  BodyMap map_;
  EnclosedCells enclosed_;
};

// Water nowhere but in the pores of spheres that lie so close that many cells are shut in, while they wander: 1, 2, 4
// and 8 blocks find the same cells, and all of them.
TEST(EnclosedCells, AreFoundAcrossBorders) {
  const PeriodicBox box{Vec3(size[0], size[1], size[2]), {true, true, false}};
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Ball> balls;
  for (GlobalId id = 0; id < 260; ++id)
    balls.push_back({id,
                     1.4 + uniform(generator),
                     {size[0] * uniform(generator), size[1] * uniform(generator), size[2] * uniform(generator)}});
  std::vector<Decomposition> decompositions;
  for (const Index3& layout : {Index3{1, 1, 1}, Index3{2, 1, 1}, Index3{2, 2, 1}, Index3{2, 2, 2}})
    decompositions.emplace_back(size, 1.0, std::array{true, true, false}, layout);
  std::deque<std::deque<OneBlock>> ranks;  // of each decomposition
  for (const Decomposition& decomposition : decompositions) {
    ranks.emplace_back();
    for (int rank = 0; rank < decomposition.ranks(); ++rank) ranks.back().emplace_back(decomposition, rank);
  }
  const auto is_fluid = [&](const Index3& at) {
    if (at[2] < 0 || at[2] >= size[2]) return false;
    const Vec3 centre(at[0] + 0.5, at[1] + 0.5, at[2] + 0.5);
    for (const Ball& ball : balls)
      if (box.difference(centre, ball.centre).norm() < ball.radius) return false;
    return true;
  };
  int alone = 0, in_pairs = 0;
  for (int round = 0; round < 20; ++round) {
    for (Ball& ball : balls)
      ball.centre = box.wrapped(ball.centre + Vec3(0.3 * uniform(generator), 0.3 * uniform(generator), 0.0));
    for (std::deque<OneBlock>& blocks : ranks) {
      std::set<Index3> found;
      for (OneBlock& block : blocks) {
        block.place(balls);
        ASSERT_TRUE(block.agrees(is_fluid, found)) << blocks.size() << " blocks, round " << round;
      }
      for (const Index3& cell : found) {
        bool has_other = false;
        for (const Index3& other : found) {
          Vec3 apart;
          for (int a = 0; a < 3; ++a) apart[a] = other[a] - cell[a];
          apart = box.difference(apart, Vec3::Zero());
          has_other =
              has_other || (other != cell && apart.squaredNorm() < 2.5 && apart.lpNorm<Eigen::Infinity>() < 1.5);
        }
        (has_other ? in_pairs : alone) += 1;
      }
    }
  }
  EXPECT_GT(alone, 100);
  EXPECT_GT(in_pairs, 100);
}

}  // namespace
}  // namespace thalweg::bodies::enclosed_cells_test
