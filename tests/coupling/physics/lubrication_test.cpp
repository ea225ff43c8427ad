// The force between a sphere and a wall, and between two equal spheres, that come slowly nearer: the resolved flow and
// the lubrication correction together against the exact series of Brenner 1961 (Chem. Eng. Sci. 16, 242).
#include "tests/coupling/water_box.hpp"

#include "core/parallel/mpi_session.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thalweg::coupling::lubrication_test {
namespace {

// Over 6 pi eta R U, of a sphere at height R + h above a wall towards which it moves with U.
double exact_at_wall(double gap) {
  const double alpha = std::acosh(1.0 + gap);
  double sum = 0.0;
  for (int n = 1; (2 * n + 1) * alpha < 80.0; ++n) {
    const double m = 2.0 * n + 1.0, sinh_half = std::sinh(0.5 * m * alpha), sinh_alpha = std::sinh(alpha);
    const double term = (2.0 * std::sinh(m * alpha) + m * std::sinh(2.0 * alpha)) /
                            (4.0 * sinh_half * sinh_half - m * m * sinh_alpha * sinh_alpha) -
                        1.0;
    sum += n * (n + 1.0) / ((2.0 * n - 1.0) * (2.0 * n + 3.0)) * term;
  }
  return 4.0 / 3.0 * std::sinh(alpha) * sum;
}

// The same of two equal spheres with a gap h R between them, each of which moves with U towards the other.
double exact_of_pair(double gap) {
  const double alpha = std::acosh(1.0 + 0.5 * gap);
  double sum = 0.0;
  for (int n = 1; (2 * n + 1) * alpha < 80.0; ++n) {
    const double m = 2.0 * n + 1.0, cosh_half = std::cosh(0.5 * m * alpha), sinh_alpha = std::sinh(alpha);
    const double term = (4.0 * cosh_half * cosh_half + m * m * sinh_alpha * sinh_alpha) /
                            (2.0 * std::sinh(m * alpha) - m * std::sinh(2.0 * alpha)) -
                        1.0;
    sum += n * (n + 1.0) / ((2.0 * n - 1.0) * (2.0 * n + 3.0)) * term;
  }
  return 4.0 / 3.0 * std::sinh(alpha) * sum;
}

struct Resistance {
  double resolved, added;  // over 6 pi eta R U, or 8 pi eta R^3 Omega

  double total() const { return resolved + added; }
};

struct Motion {
  Vec3 position;        // cells, of the centre
  Vec3 velocity, spin;  // directions
  Vec3 measured_along;  // of the force, or of the torque where there is a spin
};

constexpr double cells_in_radius = 5.0;

// Forces on the first body in a box of 48 cells, after the flow has become steady: 400 steps are 2.7 R^2/nu. The
// bodies move by 4e-4 cells in that time.
Resistance resistance(const std::vector<Motion>& bodies, bool floor) {
  constexpr double step_length = 1e-6;  // cells
  WaterBox box;
  box.cells = {48, 48, 48};
  box.periodic = {true, true, !floor};
  box.spacing = 0.5e-3;
  box.time_step = 1e-4;
  box.viscosity = box.spacing * box.spacing / box.time_step / 6.0;
  box.smagorinsky_constant = 0.0;
  box.collision = lbm::CollisionModel::trt;
  box.lubrication = true;
  box.sub_steps = 5;
  const double radius = cells_in_radius * box.spacing, speed = step_length * box.spacing / box.time_step;
  for (const Motion& body : bodies) {
    box.seeds.push_back(glass_sphere(static_cast<GlobalId>(box.seeds.size()), box.spacing * body.position,
                                     speed * body.velocity, radius));
    box.seeds.back().angular_velocity = speed / radius * body.spin;
    box.seeds.back().motion = dem::Motion::fixed;
  }
  const auto system =
      make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
  for (int step = 0; step < 400; ++step) system->advance();

  const dem::GrainStore& grains = system->grains().store();
  const bool turns = !bodies[0].spin.isZero();
  const double stokes = (turns ? 8.0 * radius : 6.0) * std::numbers::pi * 1000.0 * box.viscosity * radius * speed;
  Resistance result{0.0, 0.0};
  for (std::size_t g = 0; g < grains.owned; ++g) {
    if (grains.id[g] != 0) continue;
    const Vec3 fluid = turns ? grains.load_torque[g] : grains.load_force[g];
    const Vec3 added = turns ? grains.contact_torque[g] : grains.contact_force[g];
    result.resolved = -fluid.dot(bodies[0].measured_along) / stokes;
    result.added = -added.dot(bodies[0].measured_along) / stokes;
  }
  return {sum_over_ranks(MPI_COMM_WORLD, result.resolved), sum_over_ranks(MPI_COMM_WORLD, result.added)};
}

const Vec3 none = Vec3::Zero(), along = Vec3::UnitX(), across = Vec3::UnitY(), up = Vec3::UnitZ();

// gap: cells.
Motion above_floor(double gap, const Vec3& velocity, const Vec3& spin, const Vec3& measured_along) {
  return {Vec3(24.3, 24.17, cells_in_radius + gap), velocity, spin, measured_along};
}

// Two spheres one above the other, the middle of the gap at a height that puts more or fewer cells into it.
std::vector<Motion> approaching(double gap, double height) {
  const double half = cells_in_radius + 0.5 * gap;
  return {{Vec3(24.17, 24.0, height - half), up, none, up}, {Vec3(24.17, 24.0, height + half), -up, none, up}};
}

// Down to a gap of one cell the flow itself gives the force and nothing is added. What is left is the error of the flow
// in a gap of one or two cells, with the force at these distances five times Stokes' and more, and of the box: 7 %.
TEST(LubricationForce, IsTheFlowsWhereItIsResolved) {
  for (const double gap : {2.0, 1.0}) {
    const Resistance wall = resistance({above_floor(gap, -up, none, -up)}, true);
    const Resistance pair = resistance(approaching(gap, 24.3), false);
    EXPECT_EQ(wall.added, 0.0);
    EXPECT_EQ(pair.added, 0.0);
    EXPECT_NEAR(wall.resolved / exact_at_wall(gap / cells_in_radius), 1.0, 0.07) << gap;
    EXPECT_NEAR(pair.resolved / exact_of_pair(gap / cells_in_radius), 1.0, 0.07) << gap;
  }
}

// Below two thirds of a cell the resolved force stays at that of about this gap. It jumps by a quarter where the last
// cells leave the gap, which is what the fixed cut-off cannot know: 20 % at a wall, whose place on the lattice is
// always the same.
TEST(LubricationForce, OfASphereOnAWallFollowsTheSeriesBelowACell) {
  for (const double gap : {0.5, 0.2, 0.05}) {
    const Resistance wall = resistance({above_floor(gap, -up, none, -up)}, true);
    EXPECT_NEAR(wall.total() / exact_at_wall(gap / cells_in_radius), 1.0, 0.2) << gap;
    EXPECT_LT(wall.resolved / exact_at_wall(gap / cells_in_radius), gap < 0.4 ? 0.4 : 0.95) << gap;
  }
}

// Between two spheres there may or may not be a cell, so that the resolved part depends on where they are: 30 %.
TEST(LubricationForce, OfTwoSpheresFollowsTheSeriesBelowACell) {
  for (const double gap : {0.5, 0.2, 0.05})
    for (const double height : {24.0, 24.5}) {
      const Resistance pair = resistance(approaching(gap, height), false);
      EXPECT_NEAR(pair.total() / exact_of_pair(gap / cells_in_radius), 1.0, 0.3) << gap << " at " << height;
    }
  EXPECT_LT(resistance(approaching(0.05, 24.0), false).resolved / exact_of_pair(0.01), 0.2);
}

// Goldman, Cox and Brenner 1967 (Chem. Eng. Sci. 22, 637), for small gaps: 8/15 ln(R/h) + 0.9588 along the wall, torque
// 2/5 ln(R/h) + 0.3817. The logarithm hides the resolution: 10 %.
TEST(LubricationForce, OfASphereThatSlidesOrTurnsNearAWall) {
  for (const double gap : {0.2, 0.05}) {
    const double logarithm = std::log(cells_in_radius / gap);
    const Resistance slides = resistance({above_floor(gap, along, none, along)}, true);
    const Resistance turns = resistance({above_floor(gap, none, across, across)}, true);
    EXPECT_NEAR(slides.total() / (8.0 / 15.0 * logarithm + 0.9588), 1.0, 0.1) << gap;
    EXPECT_NEAR(turns.total() / (0.4 * logarithm + 0.3817), 1.0, 0.1) << gap;
    EXPECT_GT(slides.added, 0.1 * slides.total());
    EXPECT_GT(turns.added, 0.1 * turns.total());
  }
}

}  // namespace
}  // namespace thalweg::coupling::lubrication_test
