// A gap of one cell between two bodies, so large that they are flat: what flows along it under a force, and the
// pressure in it where it is closed.
#include "core/sphere.hpp"
#include "lbm/fluid.hpp"
#include "lbm/link_pass.ipp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::lbm::gap_slip_test {
namespace {

constexpr double force = 1e-7;

// Of radius 1e8 cells: 4.5e-8 cells are missing at three cells from the middle, which counts against 1 - s = 16
// nu/omega'.
constexpr double radius = 1e8, curvature = 1e-3;

enum class Ends { periodic, closed };

class Gap {
public:
  Gap(const CollisionParameters& collision, GapRule rule) : Gap(collision, rule, Ends::periodic, 0.0) {}

  // Bodies at rest; both are moved up by `shift`, so that links cross at 1/2 + shift below and 1/2 - shift above.
  Gap(const CollisionParameters& collision, GapRule rule, Ends ends, double shift)
      : decomposition_({cells[0], cells[1], cells[2]}, 1.0, {ends == Ends::periodic, true, true}, {1, 1, 1}),
        fluid_(decomposition_, MPI_COMM_SELF, collision, faces(ends)),
        links_(fluid_.tiles().count()),
        bodies_(2) {
    options_.gaps = rule;
    for (int z = 0; z < 3; z += 2)
      for (int y = -1; y <= cells[1]; ++y)
        for (int x = -1; x <= cells[0]; ++x) fluid_.cells().assign(x, y, z, z / 2);
    bodies_[0].centre = Vec3(3.0, 2.0, 1.0 - radius + shift);
    bodies_[1].centre = Vec3(3.0, 2.0, 2.0 + radius + shift);
    for (int body = 0; body < 2; ++body)
      for (int y = 0; y < cells[1]; ++y) add_links(body, y);
  }

  void run(int steps) {
    for (int step = 0; step < steps; ++step) {
      fluid_.exchange_halo();
      fluid_.apply_walls();
      for (LinkBody& body : bodies_) body.clear_sums();
      LinkPass pass(fluid_, links_, box_, options_, bodies_, std::span<const Sphere>(shapes_));
      fluid_.stream_and_collide([&](int tile) { pass.apply_tile(tile); });
    }
  }

  double velocity() const {
    double sum = 0.0;
    for (int y = 0; y < cells[1]; ++y)
      for (int x = 0; x < cells[0]; ++x) sum += fluid_.state_at(fluid_.indexing().index(x, y, 1)).velocity.x();
    return sum / (cells[0] * cells[1]);
  }
  // Of the density along the gap, at its middle; and the largest velocity in it.
  double density_gradient() const {
    const auto density = [&](int x) { return fluid_.state_at(fluid_.indexing().index(x, 1, 1)).density_deviation; };
    return density(cells[0] / 2) - density(cells[0] / 2 - 1);
  }
  double largest_velocity() const {
    double largest = 0.0;
    for (int x = 0; x < cells[0]; ++x)
      largest = std::max(largest, fluid_.state_at(fluid_.indexing().index(x, 1, 1)).velocity.norm());
    return largest;
  }
  void set_velocities(const Vec3& below, const Vec3& above) {
    bodies_[0].velocity = below;
    bodies_[1].velocity = above;
  }
  void set_link_rule(LinkRule rule) { options_.rule = rule; }
  void spoil_solid_cells() {
    for (int z = 0; z < 3; z += 2)
      for (int y = 0; y < cells[1]; ++y)
        for (int x = 0; x < cells[0]; ++x)
          for (int i = 0; i < D3Q19::directions; ++i)
            fluid_.populations().post_collision(i, fluid_.indexing().index(x, y, z)) = std::nan("");
  }
  const LinkBody& body(int b) const { return bodies_[static_cast<std::size_t>(b)]; }

  static constexpr int fluid_cells() { return cells[0] * cells[1]; }

private:
  static constexpr std::array<int, 3> cells{6, 4, 3};

  static FaceConditions faces(Ends ends) {
    FaceConditions faces;
    if (ends == Ends::closed) faces[0].type = faces[1].type = FaceType::no_slip;
    return faces;
  }

  // All links of a row: there is one tile a row, or more rows in one tile.
  void add_links(int body, int row) {
    const int tile = fluid_.tiles().tile_of(row, 1), first = fluid_.tiles().first_row(fluid_.tiles().block_of(tile));
    if (row != first) return;
    std::vector<Link> links;
    for (int y = first; y < cells[1] && fluid_.tiles().tile_of(y, 1) == tile; ++y)
      for (int x = 0; x < cells[0]; ++x)
        for (int i = 1; i < D3Q19::directions; ++i)
          if (D3Q19::c[i][2] == 2 * body - 1) links.push_back({LinkPlace::of(x, y), LinkTag::of(i, 1 - body)});
    links_.replace(body, tile, links);
  }

  const Decomposition decomposition_;
  const PeriodicBox box_{Vec3(cells[0], cells[1], cells[2]), {true, true, false}};
  Fluid<double> fluid_;
  LinkTable links_;
  LinkOptions options_;
  std::vector<LinkBody> bodies_;
  const std::vector<Sphere> shapes_{{radius}, {radius}};
};

CollisionParameters parameters(CollisionModel model, double viscosity) {
  CollisionParameters p;
  p.model = model;
  p.relaxation_time = 0.5 + 3.0 * viscosity;
  p.force[0] = force;
  return p;
}

// What is left of the start has decayed: with the flow's own rate 8 nu, and with that of the odd part.
int settling_steps(double viscosity) { return static_cast<int>(20.0 / (8.0 * std::min(viscosity, 0.02))); }

TEST(NarrowGaps, WithoutSlipFlowAsTheMagicParameterSays) {
  // u = 2/3 Lambda F/nu (Ginzburg and d'Humieres 2003).
  for (const double viscosity : {0.01, 0.03}) {
    for (const CollisionModel model :
         {CollisionModel::bgk, CollisionModel::regularised, CollisionModel::trt, CollisionModel::trt_at_bodies}) {
      const CollisionParameters p = parameters(model, viscosity);
      Gap gap(p, GapRule::no_slip);
      gap.run(settling_steps(viscosity));
      const double magic = (p.relaxation_time - 0.5) * (1.0 / p.odd_rate() - 0.5);
      const double expected = 2.0 / 3.0 * magic * force / viscosity;
      EXPECT_NEAR(gap.velocity(), expected, curvature * force / (8.0 * viscosity));
    }
  }
}

// x_ff of every link is a solid cell. The links of one of the bodies cross at 0.2, and would take a population from it.
TEST(NarrowGaps, TakeNothingOfWhatSolidCellsHold) {
  const CollisionParameters collision = parameters(CollisionModel::trt, 0.03);
  for (const double shift : {-0.3, 0.3})
    for (const GapRule gaps : {GapRule::no_slip, GapRule::slip})
      for (const LinkRule links : {LinkRule::bouzidi, LinkRule::cli}) {
        Gap clean(collision, gaps, Ends::periodic, shift), spoilt(collision, gaps, Ends::periodic, shift);
        spoilt.spoil_solid_cells();
        for (Gap* gap : {&clean, &spoilt}) {
          gap->set_link_rule(links);
          gap->run(5);
        }
        EXPECT_EQ(clean.velocity(), spoilt.velocity());
        EXPECT_GT(clean.velocity(), force);
      }
}

TEST(NarrowGaps, WithSlipFlowAsBetweenTwoPlatesUpToTheMagicParameter) {
  for (const double viscosity : {0.002, 0.01, 0.03, 0.08, 0.12}) {
    for (const CollisionModel model :
         {CollisionModel::bgk, CollisionModel::regularised, CollisionModel::trt, CollisionModel::trt_at_bodies}) {
      Gap gap(parameters(model, viscosity), GapRule::slip);
      gap.run(settling_steps(viscosity));
      const double expected = force / (8.0 * viscosity);
      EXPECT_NEAR(gap.velocity(), expected, curvature * expected) << "viscosity " << viscosity;
      // All of the force ends in the bodies, half in each.
      for (int b = 0; b < 2; ++b)
        EXPECT_NEAR(gap.body(b).force.to_vec3().x(), 0.5 * Gap::fluid_cells() * force,
                    curvature * Gap::fluid_cells() * force);
    }
  }
}

TEST(NarrowGaps, SlipIsRelativeToTheMeanOfBothBodiesWhereverTheyCrossTheLinks) {
  const double viscosity = 0.01;
  for (const LinkRule rule : {LinkRule::bouzidi, LinkRule::cli}) {
    for (const double shift : {0.0, -0.3, 0.2}) {
      Gap gap(parameters(CollisionModel::bgk, viscosity), GapRule::slip, Ends::periodic, shift);
      gap.set_link_rule(rule);
      gap.set_velocities(Vec3(0.01, 0.0, 0.0), Vec3(0.03, 0.0, 0.0));
      gap.run(settling_steps(viscosity));
      const double expected = 0.02 + force / (8.0 * viscosity);
      EXPECT_NEAR(gap.velocity(), expected, curvature * expected) << "shift " << shift;
      // To the rounding of its links, each to 2^-45.
      const double mass = LatticeFixed::to_double(gap.body(0).mass + gap.body(1).mass);
      EXPECT_NEAR(mass, 0.0, Gap::fluid_cells() * 10 * 0x1p-44);
    }
  }
}

TEST(NarrowGaps, ClosedAtTheirEndsAreAtRestWithThePressureGradientOfTheForce) {
  // grad p = F, p = rho/3: what flows under a force then flows under a pressure as well.
  for (const double viscosity : {0.002, 0.01, 0.03, 0.08, 0.12}) {
    for (const CollisionModel model : {CollisionModel::bgk, CollisionModel::regularised}) {
      for (const double shift : {0.0, -0.3, 0.2}) {
        Gap gap(parameters(model, viscosity), GapRule::slip, Ends::closed, shift);
        gap.run(4 * settling_steps(viscosity));  // sound decays more slowly than the flow
        EXPECT_NEAR(gap.density_gradient(), 3.0 * force, curvature * 3.0 * force)
            << "viscosity " << viscosity << ", shift " << shift;
        EXPECT_LT(gap.largest_velocity(), curvature * force / (8.0 * viscosity)) << "viscosity " << viscosity;
      }
    }
  }
}

TEST(NarrowGaps, KeepTheRuleOfTheirLinksFromAMagicParameterOfThreeSixteenthsOn) {
  for (double viscosity = 1e-4; viscosity < 1.0; viscosity *= 1.37) {
    CollisionParameters p = parameters(CollisionModel::trt, viscosity);
    for (const double magic : {3.0 / 16.0, 0.25, 1.0}) {
      p.magic_parameter = magic;
      EXPECT_EQ(gap_flow(p).kept, 1.0) << viscosity << " " << magic;
    }
    p.magic_parameter = 0.18;
    const GapFlow less = gap_flow(p);
    EXPECT_TRUE(less.kept >= 0.0 && less.kept < 1.0) << viscosity;
  }
  EXPECT_EQ(gap_flow(parameters(CollisionModel::bgk, 0.3)).kept, 1.0);  // Lambda = 0.81
}

}  // namespace
}  // namespace thalweg::lbm::gap_slip_test
