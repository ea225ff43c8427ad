// A gap of one cell between two bodies, so large that they are flat: what flows along it under a force.
#include "bodies/links/interpolated_bounce_back.hpp"
#include "core/geometry/sphere.hpp"
#include "lbm/fluid/fluid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace thalweg::bodies::narrow_gap_test {
namespace {

constexpr double force = 1e-7;

// A radius of 1e8 cells: 4.5e-8 cells are missing at three cells from the middle.
constexpr double radius = 1e8, curvature = 1e-3;

class Gap {
public:
  // Bodies at rest; both are moved up by `shift`, so that links cross at 1/2 + shift below and 1/2 - shift above.
  explicit Gap(const lbm::CollisionParameters& collision, double shift = 0.0)
      : decomposition_({cells[0], cells[1], cells[2]}, 1.0, {true, true, true}, {1, 1, 1}),
        fluid_(decomposition_, MPI_COMM_SELF, collision, {}),
        links_(fluid_.tiles().count()),
        bodies_(2) {
    for (int z = 0; z < 3; z += 2)
      for (int y = -1; y <= cells[1]; ++y)
        for (int x = -1; x <= cells[0]; ++x) fluid_.cells().assign(x, y, z, z / 2);
    for (LinkBody& body : bodies_) body.radius = radius;
    bodies_[0].centre = Vec3(3.0, 2.0, 1.0 - radius + shift);
    bodies_[1].centre = Vec3(3.0, 2.0, 2.0 + radius + shift);
    for (int body = 0; body < 2; ++body)
      for (int y = 0; y < cells[1]; ++y) add_links(body, y);
  }

  void run(int steps) {
    for (int step = 0; step < steps; ++step) {
      fluid_.exchange_halo();
      for (LinkBody& body : bodies_) body.clear_sums();
      InterpolatedBounceBack pass(fluid_, links_, box_, options_, bodies_);
      fluid_.stream_and_collide([&](int tile) { pass.apply_tile(tile); });
    }
  }

  double velocity() const {
    double sum = 0.0;
    for (int y = 0; y < cells[1]; ++y)
      for (int x = 0; x < cells[0]; ++x) sum += fluid_.state_at(fluid_.indexing().index(x, y, 1)).velocity.x();
    return sum / (cells[0] * cells[1]);
  }
  void set_link_rule(LinkRule rule) { options_.rule = rule; }
  void spoil_solid_cells() {
    for (int z = 0; z < 3; z += 2)
      for (int y = 0; y < cells[1]; ++y)
        for (int x = 0; x < cells[0]; ++x)
          for (int i = 0; i < lbm::D3Q19::directions; ++i)
            fluid_.populations().post_collision(i, fluid_.indexing().index(x, y, z)) = std::nan("");
  }

private:
  static constexpr std::array<int, 3> cells{6, 4, 3};

  // All links of a row: there is one tile a row, or more rows in one tile.
  void add_links(int body, int row) {
    const int tile = fluid_.tiles().tile_of(row, 1), first = fluid_.tiles().first_row(fluid_.tiles().block_of(tile));
    if (row != first) return;
    std::vector<Link> links;
    for (int y = first; y < cells[1] && fluid_.tiles().tile_of(y, 1) == tile; ++y)
      for (int x = 0; x < cells[0]; ++x)
        for (int i = 1; i < lbm::D3Q19::directions; ++i)
          if (lbm::D3Q19::c[i][2] == 2 * body - 1) links.push_back({LinkXY::of(x, y), LinkTag::of(i, 1 - body)});
    links_.replace(body, tile, links);
  }

  const Decomposition decomposition_;
  const PeriodicBox box_{Vec3(cells[0], cells[1], cells[2]), {true, true, false}};
  lbm::Fluid<double> fluid_;
  LinkTable links_;
  LinkOptions options_;
  std::vector<LinkBody> bodies_;
};

lbm::CollisionParameters parameters(lbm::CollisionModel model, double viscosity) {
  lbm::CollisionParameters p;
  p.model = model;
  p.relaxation_time = 0.5 + 3.0 * viscosity;
  p.force[0] = force;
  return p;
}

// Steps after which the start has decayed: with the flow's own rate 8 nu, and with that of the odd part.
int settling_steps(double viscosity) { return static_cast<int>(20.0 / (8.0 * std::min(viscosity, 0.02))); }

TEST(NarrowGaps, FlowAsTheMagicParameterSays) {
  // u = 2/3 Lambda F/nu (Ginzburg and d'Humieres 2003).
  for (const double viscosity : {0.01, 0.03}) {
    for (const lbm::CollisionModel model :
         {lbm::CollisionModel::bgk, lbm::CollisionModel::trt, lbm::CollisionModel::trt_at_bodies}) {
      const lbm::CollisionParameters p = parameters(model, viscosity);
      Gap gap(p);
      gap.run(settling_steps(viscosity));
      const double magic = (p.relaxation_time - 0.5) * (1.0 / p.odd_rate() - 0.5);
      const double expected = 2.0 / 3.0 * magic * force / viscosity;
      EXPECT_NEAR(gap.velocity(), expected, curvature * force / (8.0 * viscosity));
    }
  }
}

// x_ff of every link is a solid cell. The links of one of the bodies cross at 0.2, and would take a population from it.
TEST(NarrowGaps, TakeNothingOfWhatSolidCellsHold) {
  const lbm::CollisionParameters collision = parameters(lbm::CollisionModel::trt, 0.03);
  for (const double shift : {-0.3, 0.3})
    for (const LinkRule links : {LinkRule::bouzidi, LinkRule::cli}) {
      Gap clean(collision, shift), spoilt(collision, shift);
      spoilt.spoil_solid_cells();
      for (Gap* gap : {&clean, &spoilt}) {
        gap->set_link_rule(links);
        gap->run(5);
      }
      EXPECT_EQ(clean.velocity(), spoilt.velocity());
      EXPECT_GT(clean.velocity(), force);
    }
}

}  // namespace
}  // namespace thalweg::bodies::narrow_gap_test
