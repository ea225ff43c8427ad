// Patches of a grain's surface that other grains or a wall hide: what the fluid's weight does there.
#include "bodies/links/occluded_links.hpp"

#include "bodies/map/body_map.hpp"
#include "core/parallel/mpi_session.hpp"
#include "lbm/fluid/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::bodies::occluded_links_test {
namespace {

using lbm::D3Q19;

struct Ball {
  Vec3 centre;
  double radius;
};

struct Load {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
};

constexpr Index3 cells{16, 14, 12};  // periodic along x and y

Vec3 difference(const Vec3& p, const Vec3& from) {
  Vec3 d = p - from;
  for (int a = 0; a < 2; ++a) d[a] -= cells[a] * std::round(d[a] / cells[a]);
  return d;
}

// Loads by definition: every lattice line from a cell of one ball, or from below the floor, into a cell of another,
// distances by bisection.
std::vector<Load> loads_by_definition(const std::vector<Ball>& balls, const Hydrostatic& rest) {
  const auto owner = [&](const Vec3& p) {
    for (std::size_t s = 0; s < balls.size(); ++s)
      if (difference(p, balls[s].centre).norm() < balls[s].radius) return static_cast<int>(s);
    return -1;
  };
  std::vector<Load> loads(balls.size());
  for (int z = -1; z <= cells[2]; ++z)
    for (int y = 0; y < cells[1]; ++y)
      for (int x = 0; x < cells[0]; ++x)
        for (int i = 1; i < 19; ++i) {
          const Vec3 at(x + 0.5, y + 0.5, z + 0.5), c(D3Q19::c[i][0], D3Q19::c[i][1], D3Q19::c[i][2]);
          const bool beyond = z < 0 || z >= cells[2], ends_beyond = z + c.z() < 0 || z + c.z() >= cells[2];
          const int q = beyond ? -1 : owner(at), p = ends_beyond ? -1 : owner(at + c);
          if (p < 0 || p == q || (q < 0 && !beyond)) continue;
          const Ball& ball = balls[static_cast<std::size_t>(p)];
          double low = 0.0, high = 1.0;
          for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (low + high);
            (difference(at + middle * c, ball.centre).norm() < ball.radius ? high : low) = middle;
          }
          const Vec3 momentum = 2.0 * D3Q19::weight(i) * rest.deviation(at + high * c) * c;
          loads[static_cast<std::size_t>(p)].force += momentum;
          loads[static_cast<std::size_t>(p)].torque += difference(at + high * c, ball.centre).cross(momentum);
        }
  return loads;
}

// Touching and overlapping balls, one pair across the periodic faces, one on the floor. Fixed-point sums: 2^-45 a link.
TEST(OccludedLinks, CarryWhatTheDefinitionSaysOnAnyRanks) {
  const std::vector<Ball> balls{{Vec3(0.6, 7.1, 5.2), 3.0}, {Vec3(6.3, 6.3, 5.9), 3.1}, {Vec3(11.9, 9.4, 2.9), 3.2}};
  const Decomposition decomposition(cells, 1.0, {true, true, false},
                                    Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD)));
  lbm::FaceConditions faces;
  faces[4].type = faces[5].type = lbm::FaceType::no_slip;
  lbm::Fluid<double> fluid(decomposition, MPI_COMM_WORLD, {}, faces);
  BodyMap map(decomposition, fluid.block(), fluid.cells());
  const Hydrostatic rest = hydrostatic_under(Vec3(0.0, 0.0, -1e-3), decomposition);
  OccludedLinks links(decomposition, fluid.block(), fluid.cells(), rest);
  std::vector<LinkBody> bodies(balls.size());
  map.begin_update();
  for (std::size_t s = 0; s < balls.size(); ++s) {
    map.remap(map.add(static_cast<GlobalId>(s), balls[s].radius), balls[s].centre);
    bodies[s].radius = balls[s].radius;
    bodies[s].centre = balls[s].centre;
  }
  map.settle();
  links.update(map);
  links.apply(0, bodies, nullptr);
  const std::vector<Load> expected = loads_by_definition(balls, rest);
  EXPECT_GT(sum_over_ranks(MPI_COMM_WORLD, static_cast<std::int64_t>(links.count())), 40);
  for (std::size_t s = 0; s < balls.size(); ++s)
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(sum_over_ranks(MPI_COMM_WORLD, bodies[s].force.to_vec3()[a]), expected[s].force[a], 1e-11);
      EXPECT_NEAR(sum_over_ranks(MPI_COMM_WORLD, bodies[s].torque.to_vec3()[a]), expected[s].torque[a], 1e-11);
    }
}

}  // namespace
}  // namespace thalweg::bodies::occluded_links_test
