// The in-place lattice with its packed links against a plain one: two copies, one loop over cells, links found anew.
#include "bodies/links/interpolated_bounce_back.hpp"
#include "bodies/links/link_builder.hpp"
#include "bodies/map/body_map.hpp"
#include "lbm/fluid/fluid.hpp"
#include "lbm/lattice/equilibrium.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

namespace thalweg::bodies::reference_lattice_test {
namespace {

using lbm::D3Q19;

struct Sphere {
  Vec3 centre, velocity, spin;
  double radius;
};

struct Load {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
};

// Everything by definition, in double; populations as deviations, post-collision at every cell. The box is periodic, or
// has a no-slip floor and a free-slip top.
class PlainLattice {
public:
  PlainLattice(const Index3& cells, bool walls, const lbm::CollisionParameters& parameters,
               const std::vector<Sphere>& spheres)
      : n_(cells),
        walls_(walls),
        parameters_(parameters),
        spheres_(spheres),
        f_(n_[0] * n_[1] * n_[2]),
        owner_(f_.size(), -1) {
    for (std::size_t at = 0; at < f_.size(); ++at)
      for (std::size_t s = 0; s < spheres_.size() && owner_[at] < 0; ++s)
        if (from(position(at), s).norm() < spheres_[s].radius) owner_[at] = static_cast<int>(s);
  }

  int owner(const Index3& c) const { return owner_[index(c)]; }
  std::array<double, 19>& populations(const Index3& c) { return f_[index(c)]; }

  std::vector<Load> step(const LinkOptions& options) {
    std::vector<Load> loads(spheres_.size());
    std::vector<std::array<double, 19>> streamed(f_.size());
    for (std::size_t at = 0; at < f_.size(); ++at) {
      if (owner_[at] >= 0) continue;
      for (int i = 0; i < 19; ++i) {
        if (beyond_wall(at, D3Q19::opposite(i))) {
          streamed[at][i] = from_wall(at, i);
          continue;
        }
        const std::size_t source = neighbour(at, D3Q19::opposite(i));
        streamed[at][i] = owner_[source] < 0 ? f_[source][i] : reflect(at, D3Q19::opposite(i), options, loads);
      }
    }
    for (std::size_t at = 0; at < f_.size(); ++at) {
      if (owner_[at] >= 0) continue;
      double cell[19];
      std::copy(streamed[at].begin(), streamed[at].end(), cell);
      if (parameters_.subgrid.model() == lbm::SubgridModel::qr)
        collide<lbm::SubgridModel::qr>(cell, at);
      else
        collide<lbm::SubgridModel::smagorinsky>(cell, at);
      std::copy(cell, cell + 19, f_[at].begin());
    }
    return loads;
  }

private:
  template <lbm::SubgridModel subgrid>
  void collide(double (&cell)[19], std::size_t at) const {
    if (parameters_.model == lbm::CollisionModel::trt_at_bodies && near_a_sphere(at))
      lbm::collide<lbm::CollisionModel::trt_at_bodies, subgrid>(cell, parameters_, in_gap(at) ? 1.0 : 0.0);
    else
      lbm::collide<lbm::CollisionModel::bgk, subgrid>(cell, parameters_);
  }

  bool near_a_sphere(std::size_t at) const {
    for (int i = 1; i < 19; ++i)
      if (!beyond_wall(at, i) && owner_[neighbour(at, i)] >= 0) return true;
    return false;
  }

  // True on a line with a sphere on one side, and a sphere or within three cells a wall on the other.
  bool in_gap(std::size_t at) const {
    const auto covered = [&](int i) { return !beyond_wall(at, i) && owner_[neighbour(at, i)] >= 0; };
    const auto meets_wall = [&](int i) {
      std::size_t cell = at;
      for (int steps = 0; steps < 3; ++steps) {
        if (beyond_wall(cell, i)) return true;
        cell = neighbour(cell, i);
      }
      return false;
    };
    for (int i = 1; i < 19; ++i)
      if (covered(i) && (covered(D3Q19::opposite(i)) || meets_wall(D3Q19::opposite(i)))) return true;
    return false;
  }

  // The population that comes back along the opposite of i, and its momentum for the sphere that sends it.
  double reflect(std::size_t at, int i, const LinkOptions& options, std::vector<Load>& loads) const {
    const int back = D3Q19::opposite(i), s = owner_[neighbour(at, i)];
    const Vec3 c(D3Q19::c[i][0], D3Q19::c[i][1], D3Q19::c[i][2]), d = from(position(at), s);
    // Distance by bisection, not by the formula under test.
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      ((d + middle * c).norm() < spheres_[s].radius ? high : low) = middle;
    }
    const double delta = high, weight = D3Q19::weight(i);
    const Vec3 arm = d + delta * c, wall = spheres_[s].velocity + spheres_[s].spin.cross(arm);
    double density = 0.0;
    for (const double f : f_[at]) density += f;
    const std::size_t behind = neighbour(at, back);
    const bool wall_behind = beyond_wall(at, back);
    const double incident = f_[at][i], opposite = f_[at][back];
    double upstream = wall_behind ? from_wall(at, i) : f_[behind][i];
    if (const int q = owner_[behind]; q >= 0 && !wall_behind) {
      const Vec3 velocity = spheres_[q].velocity + spheres_[q].spin.cross(from(position(behind), q));
      upstream = lbm::equilibrium_deviation(i, density, velocity);
    }
    const double towards_wall = c.dot(wall);
    double result;
    if (options.rule == LinkRule::cli && (wall_behind || owner_[behind] < 0)) {
      const double k = (1 - 2 * delta) / (1 + 2 * delta);
      result = incident + k * upstream - k * opposite - 12 / (1 + 2 * delta) * weight * (1 + density) * towards_wall;
    } else if (options.rule == LinkRule::cli) {  // a gap of one cell: bounce-back
      result = incident - 6 * weight * (1 + density) * towards_wall;
    } else if (delta < 0.5) {
      result = 2 * delta * incident + (1 - 2 * delta) * upstream - 6 * weight * (1 + density) * towards_wall;
    } else {
      result = incident / (2 * delta) + (2 * delta - 1) / (2 * delta) * opposite -
               3 / delta * weight * (1 + density) * towards_wall;
    }
    Vec3 momentum = c * (incident + result);
    if (options.momentum_exchange == MomentumExchange::galilean_invariant) momentum -= wall * (incident - result);
    loads[s].force += momentum;
    loads[s].torque += arm.cross(momentum);
    return result;
  }

  bool beyond_wall(std::size_t at, int i) const {
    const int z = static_cast<int>(at) / n_[0] / n_[1] + D3Q19::c[i][2];
    return walls_ && (z < 0 || z >= n_[2]);
  }
  // Population entering along i from beyond a wall: bounced at the floor, mirrored at the top unless it comes from a
  // sphere.
  double from_wall(std::size_t at, int i) const {
    const int back = D3Q19::opposite(i);
    if (D3Q19::c[i][2] > 0) return f_[at][back];
    const int along = D3Q19::index_of(-D3Q19::c[i][0], -D3Q19::c[i][1], 0);
    const std::size_t source = along == 0 ? at : neighbour(at, along);
    return owner_[source] >= 0 ? f_[at][back] : f_[source][D3Q19::mirror(i, 2)];
  }

  std::size_t index(const Index3& c) const { return (static_cast<std::size_t>(c[2]) * n_[1] + c[1]) * n_[0] + c[0]; }
  Vec3 position(std::size_t at) const {
    const int k = static_cast<int>(at);
    return {k % n_[0] + 0.5, k / n_[0] % n_[1] + 0.5, k / n_[0] / n_[1] + 0.5};
  }
  std::size_t neighbour(std::size_t at, int i) const {
    const int k = static_cast<int>(at);
    const Index3 c{k % n_[0], k / n_[0] % n_[1], k / n_[0] / n_[1]};
    Index3 to;
    for (int a = 0; a < 3; ++a) to[a] = (c[a] + D3Q19::c[i][a] + n_[a]) % n_[a];
    return index(to);
  }
  Vec3 from(const Vec3& p, std::size_t s) const {
    Vec3 d = p - spheres_[s].centre;
    for (int a = 0; a < (walls_ ? 2 : 3); ++a) d[a] -= n_[a] * std::round(d[a] / n_[a]);
    return d;
  }

  Index3 n_;
  bool walls_;
  lbm::CollisionParameters parameters_;
  std::vector<Sphere> spheres_;
  std::vector<std::array<double, 19>> f_;
  std::vector<int> owner_;
};

// Spheres that touch, overlap a little, leave gaps below a cell and stand across the periodic faces; with walls, a
// fraction of a cell from them.
std::vector<Sphere> crowd(bool walls) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Sphere> spheres;
  for (int k = 0; k < 9; ++k) {
    const double height = walls ? (k % 2 ? 8.7 : 3.2) : 9.0 + 0.7 * (k % 2);
    const Vec3 lattice(6.1 * (k % 3) + 1.0, 5.95 * (k / 3) + 0.5, height);
    spheres.push_back({lattice + 0.15 * Vec3(uniform(generator), uniform(generator), uniform(generator)),
                       0.03 * Vec3(uniform(generator), uniform(generator), uniform(generator)),
                       0.01 * Vec3(uniform(generator), uniform(generator), uniform(generator)), 3.0});
  }
  return spheres;
}

struct Model {
  lbm::CollisionModel collision;
  lbm::Subgrid subgrid;
};

class LinksAgainstPlainLattice : public ::testing::TestWithParam<std::tuple<MomentumExchange, LinkRule, bool, Model>> {
};

TEST_P(LinksAgainstPlainLattice, AgreeToRoundOff) {
  const bool walls = std::get<2>(GetParam());
  const Index3 cells{19, 18, walls ? 12 : 17};
  const std::array<bool, 3> periodic{true, true, !walls};
  const std::vector<Sphere> spheres = crowd(walls);
  lbm::CollisionParameters parameters;
  parameters.model = std::get<3>(GetParam()).collision;
  parameters.relaxation_time = 0.55;
  parameters.subgrid = std::get<3>(GetParam()).subgrid;
  parameters.force[0] = 1e-5;
  parameters.force[2] = -2e-6;
  PlainLattice plain(cells, walls, parameters, spheres);

  const Decomposition decomposition(cells, 1.0, periodic, {1, 1, 1});
  lbm::FaceConditions faces;
  if (walls) faces[4].type = lbm::FaceType::no_slip;
  if (walls) faces[5].type = lbm::FaceType::free_slip;
  lbm::Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
  BodyMap map(decomposition, fluid.block(), fluid.cells());
  LinkTable links(fluid.tiles().count());
  LinkBuilder builder(decomposition, fluid.block(), fluid.cells(), fluid.tiles());
  std::vector<LinkBody> bodies(spheres.size());
  map.begin_update();
  for (std::size_t s = 0; s < spheres.size(); ++s) {
    map.remap(map.add(static_cast<GlobalId>(s), spheres[s].radius), spheres[s].centre);
    bodies[s].radius = spheres[s].radius;
    bodies[s].centre = spheres[s].centre;
    bodies[s].velocity = spheres[s].velocity;
    bodies[s].angular_velocity = spheres[s].spin;
  }
  map.settle();
  builder.update(map, links);
  EXPECT_GT(links.count(), 900u);

  const auto state = [](const Vec3& p) {
    return lbm::FluidState{
        0.01 * std::sin(0.7 * p.x()),
        Vec3(0.05 * std::sin(0.5 * p.y()), 0.03 * std::cos(0.6 * p.z()), 0.04 * std::sin(0.4 * p.x()))};
  };
  fluid.initialise(state);
  const auto for_each_cell = [&](auto visit) {
    for (int z = 0; z < cells[2]; ++z)
      for (int y = 0; y < cells[1]; ++y)
        for (int x = 0; x < cells[0]; ++x) visit(Index3{x, y, z}, fluid.indexing().index(x, y, z));
  };
  for_each_cell([&](const Index3& c, std::ptrdiff_t) {
    const lbm::FluidState s = state(Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5));
    for (int i = 0; i < 19; ++i)
      // With half the force, as a collision leaves it.
      plain.populations(c)[i] =
          lbm::equilibrium_deviation(i, s.density_deviation, s.velocity) +
          1.5 * lbm::D3Q19::weight(i) *
              (lbm::D3Q19::c[i][0] * parameters.force[0] + lbm::D3Q19::c[i][2] * parameters.force[2]);
  });

  const LinkOptions options{std::get<0>(GetParam()), std::get<1>(GetParam())};
  const PeriodicBox box{Vec3(cells[0], cells[1], cells[2]), periodic};
  for (int step = 0; step < 9; ++step) {
    fluid.exchange_halo();
    fluid.apply_walls();
    for (LinkBody& body : bodies) body.force = body.torque = {};
    InterpolatedBounceBack pass(fluid, links, box, options, bodies);
    fluid.stream_and_collide([&](int tile) { pass.apply_tile(tile); });
    const std::vector<Load> loads = plain.step(options);
    // The sum over 600 links rounds each of its terms by 2^-45, so it is off by 1.7e-11 at most; a torque, whose terms
    // are rounded alike, no more. What the links themselves lose is some hundred times 1e-16.
    for (std::size_t s = 0; s < spheres.size(); ++s) {
      EXPECT_NEAR((bodies[s].force.to_vec3() - loads[s].force).norm(), 0.0, 2e-11)
          << "sphere " << s << ", step " << step;
      EXPECT_NEAR((bodies[s].torque.to_vec3() - loads[s].torque).norm(), 0.0, 2e-11)
          << "sphere " << s << ", step " << step;
    }
  }
  // Over nine steps, with a wall factor of up to 12 instead of 6 in the rule CLI, the same errors stay below this.
  double largest = 0.0;
  for_each_cell([&](const Index3& c, std::ptrdiff_t cell) {
    EXPECT_EQ(fluid.cells().is_fluid(cell), plain.owner(c) < 0);
    if (plain.owner(c) >= 0) return;
    for (int i = 0; i < 19; ++i)
      largest = std::max(largest, std::abs(fluid.populations().post_collision(i, cell) - plain.populations(c)[i]));
  });
  EXPECT_LT(largest, 1e-13);
}

INSTANTIATE_TEST_SUITE_P(
    ExchangesAndRules, LinksAgainstPlainLattice,
    ::testing::Combine(::testing::Values(MomentumExchange::galilean_invariant, MomentumExchange::classical),
                       ::testing::Values(LinkRule::bouzidi, LinkRule::cli), ::testing::Bool(),
                       ::testing::Values(Model{lbm::CollisionModel::bgk, lbm::Subgrid::smagorinsky(0.2)},
                                         Model{lbm::CollisionModel::trt_at_bodies, lbm::Subgrid::qr()})));

}  // namespace
}  // namespace thalweg::bodies::reference_lattice_test
