// A single cell of fluid with nothing but bodies beside it, or bodies and a floor: what its links do to its density.
#include "bodies/links/interpolated_bounce_back.hpp"
#include "lbm/fluid/fluid.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace thalweg::bodies::enclosed_cell_test {
namespace {

constexpr std::array<int, 3> size{6, 5, 4};
constexpr double force = 1e-4;

struct Links {
  LinkRule rule;
  bool on_floor;
};

class EnclosedCell : public ::testing::TestWithParam<Links> {
protected:
  EnclosedCell()
      : fluid_(decomposition_, MPI_COMM_SELF, parameters(), faces()), links_(fluid_.tiles().count()), bodies_(1) {
    options_.rule = GetParam().rule;
    const int floor = GetParam().on_floor ? 0 : -1;  // no body covers what is beyond a wall
    for (int z = floor; z <= size[2]; ++z)
      for (int y = -1; y <= size[1]; ++y)
        for (int x = -1; x <= size[0]; ++x)
          if (Index3{x, y, z} != place) fluid_.cells().assign(x, y, z, 0);
    std::vector<Link> links;
    std::vector<LinkCrossing> crossings;
    for (int i = 1; i < lbm::D3Q19::directions; ++i) {
      if (fluid_.cells().is_fluid(cell() + fluid_.indexing().offset(i))) continue;
      links.push_back({LinkXY::of(place[0], place[1]), LinkTag::of(i, 0, true)});
      crossings.push_back({static_cast<float>(i) / 19.0f, {}});  // no two alike
    }
    links_.replace(0, fluid_.tiles().tile_of(place[1], place[2]), links, crossings);
  }

  static lbm::FaceConditions faces() {
    lbm::FaceConditions faces;
    if (GetParam().on_floor) faces[4].type = faces[5].type = lbm::FaceType::no_slip;
    return faces;
  }
  static lbm::CollisionParameters parameters() {
    lbm::CollisionParameters p;
    p.model = lbm::CollisionModel::trt;
    p.relaxation_time = 0.53;
    p.force[0] = force;
    return p;
  }

  std::ptrdiff_t cell() const { return fluid_.indexing().index(place[0], place[1], place[2]); }
  double density_deviation() const { return fluid_.state_at(cell()).density_deviation; }

  // Mass that the links have given to the cell.
  double run(int steps) {
    double given = 0.0;
    for (int step = 0; step < steps; ++step) {
      fluid_.exchange_halo();
      fluid_.apply_walls();
      bodies_[0].clear_sums();
      InterpolatedBounceBack<double> pass(fluid_, links_, box_, options_, bodies_);
      fluid_.stream_and_collide([&](int tile) { pass.apply_tile(tile); });
      given += LatticeFixed::to_double(bodies_[0].mass);
    }
    return given;
  }

  const Index3 place{2, 2, GetParam().on_floor ? 0 : 1};
  const Decomposition decomposition_{{size[0], size[1], size[2]}, 1.0, {true, true, !GetParam().on_floor}, {1, 1, 1}};
  const PeriodicBox box_ = decomposition_.cell_box();
  lbm::Fluid<double> fluid_;
  LinkTable links_;
  LinkOptions options_;
  std::vector<LinkBody> bodies_;
};

// The mass returned in a step is not much larger than the excess at which as much leaks out.
TEST_P(EnclosedCell, KeepsTheDensityOfRestWhateverItsBodiesReturn) {
  fluid_.initialise([](const Vec3&) { return lbm::FluidState{0.05, Vec3::Zero()}; });
  bodies_[0].returned = 1e-3;
  const double before = density_deviation();
  const double given = run(500);
  // Interpolation and force add what is of their order.
  EXPECT_NEAR(density_deviation(), bodies_[0].returned, 5.0 * force);
  EXPECT_NEAR(given, density_deviation() - before, 1e-9) << "not all of the loss is recorded";
  const double later = density_deviation();
  run(500);
  EXPECT_NEAR(density_deviation(), later, 1e-9) << "still changing";
}

// Water under another mean pressure than that of rest, as below an outlet.
TEST_P(EnclosedCell, KeepsTheDensityOfTheWaterAround) {
  options_.reference_density = 0.02;
  fluid_.initialise([](const Vec3&) { return lbm::FluidState{0.05, Vec3::Zero()}; });
  run(500);
  EXPECT_NEAR(density_deviation(), 0.02, 5.0 * force);
}

// Solid cells may be swept or not, so they may hold anything: in both arrangements of the lattice.
TEST_P(EnclosedCell, TakesNothingOfWhatSolidCellsHold) {
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x)
        for (int i = 0; i < lbm::D3Q19::directions && Index3{x, y, z} != place; ++i)
          fluid_.populations().post_collision(i, fluid_.indexing().index(x, y, z)) = std::nan("");
  for (int step = 0; step < 3; ++step) {
    const double given = run(1);
    EXPECT_LT(std::abs(density_deviation()), 5.0 * force) << step;
    EXPECT_LT(std::abs(given), 5.0 * force) << step;
  }
}

INSTANTIATE_TEST_SUITE_P(Links, EnclosedCell,
                         ::testing::Values(Links{LinkRule::bouzidi, false}, Links{LinkRule::cli, false},
                                           Links{LinkRule::bouzidi, true}, Links{LinkRule::cli, true}),
                         [](const auto& links) {
                           return std::string(links.param.rule == LinkRule::cli ? "cli" : "bouzidi") +
                                  (links.param.on_floor ? "OnAFloor" : "");
                         });

}  // namespace
}  // namespace thalweg::bodies::enclosed_cell_test
