// The wall that imposes the stress of the law of the wall: the law against a solution found otherwise, what every cell
// at a wall loses, and channels whose steady flow follows from the balance of forces.
#include "lbm/lattice/face_axes.hpp"
#include "lbm/walls/law_of_the_wall.hpp"
#include "tests/lbm/channel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace thalweg::lbm::wall_stress_test {
namespace {

// u+ at y+, in both parts of the law.
double velocity_in_wall_units(double y) { return y < 10.8 ? y : std::min(y, std::log(y) / 0.41 + 5.0); }

// y+ where y+ u+ has this value, by bisection.
double distance_in_wall_units(double reynolds) {
  double low = 0.0, high = reynolds + 1.0;
  for (int n = 0; n < 200; ++n) {
    const double middle = 0.5 * (low + high);
    (middle * velocity_in_wall_units(middle) < reynolds ? low : high) = middle;
  }
  return low;
}

TEST(FrictionVelocity, SolvesTheLaw) {
  const double distance = 1.5, viscosity = 3e-4;
  double last = 0.0;
  for (int k = -200; k <= 600; ++k) {
    const double reynolds = std::pow(10.0, 0.01 * k);
    const double found = friction_velocity(reynolds * viscosity / distance, distance, viscosity);
    EXPECT_NEAR(found * distance / viscosity / distance_in_wall_units(reynolds), 1.0, 1e-10) << reynolds;
    EXPECT_GT(found, last);
    last = found;
  }
  EXPECT_EQ(friction_velocity(0.0, distance, viscosity), 0.0);
}

// Both parts give y+ = u+ there: 10.80487, its square 116.7452.
TEST(FrictionVelocity, IsContinuousWhereTheTwoPartsMeet) {
  const double edge = 10.80487, reynolds = edge_of_viscous_sublayer * edge_of_viscous_sublayer;
  EXPECT_NEAR(edge_of_viscous_sublayer, edge, 0.5e-5);
  EXPECT_NEAR(logarithmic_law(edge_of_viscous_sublayer), edge_of_viscous_sublayer, 1e-14 * edge);
  const double below = friction_velocity(reynolds * (1.0 - 1e-12), 1.0, 1.0),
               above = friction_velocity(reynolds * (1.0 + 1e-12), 1.0, 1.0);
  EXPECT_NEAR(below, edge_of_viscous_sublayer, 1e-10 * edge);
  EXPECT_NEAR(above, edge_of_viscous_sublayer, 1e-10 * edge);
}

TEST(StressRatio, IsTheStressOverThatOfALaminarLayer) {
  const StressRatio ratio;
  for (int k = -200; k <= 1300; ++k) {
    const double reynolds = std::pow(10.0, 0.01 * k + 1e-3);  // beside the ends of the intervals as well as in them
    const double friction = friction_velocity(reynolds, 1.0, 1.0);
    // A cubic of the same values and slopes leaves h^4/384 of the fourth derivative, here 1/16 of an octave.
    EXPECT_NEAR(ratio(reynolds) / (friction * friction / reynolds), 1.0, 3e-8) << reynolds;
  }
  EXPECT_EQ(ratio(0.0), 1.0);
  EXPECT_EQ(ratio(100.0), 1.0);
}

FluidState swirl(const Vec3& p) {
  return {0.01 * std::sin(0.7 * p.x() + 0.3 * p.z()),
          Vec3(0.05 * std::sin(0.9 * p.y()), 0.04 * std::cos(0.8 * p.z()), 0.05 * std::sin(0.9 * p.x() + 0.7 * p.y()))};
}

// A box between two walls across one axis, after some steps of a flow that varies in all directions, with the incoming
// populations filled in. `solid`: cells, without links, that are covered after these steps.
template <typename Real>
class Box {
public:
  Box(CollisionModel model, int normal, int steps, const std::function<bool(const Index3&)>& solid = {})
      : normal_(normal),
        decomposition_(cells, 1.0, periodic(), {1, 1, 1}),
        fluid_(decomposition_, MPI_COMM_SELF, parameters(model), faces()) {
    fluid_.initialise(swirl);
    for (int step = 0; step < steps - 2; ++step) fluid_.advance();
    if (solid) cover(solid);
    // The stress is the mean of those after the last two sweeps.
    fluid_.advance();
    for (const int face : {face_of(normal, false), face_of(normal, true)})
      for_each_cell_at(face, [&](const Index3& at) { before_.push_back(law(at, face)); });
    fluid_.advance();
    for (const int face : {face_of(normal, false), face_of(normal, true)})
      for_each_cell_at(face, [&](const Index3& at) { now_.push_back(law(at, face)); });
    fluid_.exchange_halo();
    fluid_.apply_walls();
  }

  Fluid<Real>& fluid() { return fluid_; }

  // A population of a cell at the wall that comes from there: a step of `sign` along `axis`.
  int direction(int face, int axis, int sign) const {
    for (int i = 0; i < D3Q19::directions; ++i)
      if (D3Q19::c[i][face / 2] == (face % 2 == 0 ? 1 : -1) && (axis < 0 || D3Q19::c[i][axis] == sign) &&
          D3Q19::length_squared(i) == (axis < 0 ? 1 : 2))
        return i;
    return -1;
  }

  std::ptrdiff_t cell(const Index3& at) const { return fluid_.indexing().index(at[0], at[1], at[2]); }
  // The next cell along an axis of the face, round the box.
  std::ptrdiff_t beside(Index3 at, int axis, int sign) const {
    at[axis] = (at[axis] + sign + cells[axis]) % cells[axis];
    return cell(at);
  }
  bool is_fluid(std::ptrdiff_t cell) const { return fluid_.cells().is_fluid(cell); }

  // The mean of the law's stress of two steps.
  Vec3 stress(const Index3& at, int face) const {
    std::size_t n = 0, found = 0;
    for (const int one : {face_of(normal_, false), face_of(normal_, true)})
      for_each_cell_at(one, [&](const Index3& other) {
        if (one == face && other == at) found = n;
        ++n;
      });
    return 0.5 * (before_[found] + now_[found]);
  }

  // rho u_tau^2 along u, as the law has it, from the last of five cells, or of those up to the middle, before a body.
  Vec3 law(const Index3& at, int face) const {
    const int inward = face % 2 == 0 ? 1 : -1;
    Index3 next = at, last = at;
    double distance = 0.5;
    for (next[normal_] += inward; is_fluid(cell(next)) && distance + 1.0 < 5.0; next[normal_] += inward) {
      if (2.0 * (distance + 1.0) > cells[normal_]) break;
      last = next;
      distance += 1.0;
    }
    const auto along_wall = [&](const Index3& place) {
      Vec3 along = fluid_.state_at(cell(place)).velocity;
      along[normal_] = 0.0;
      return along;
    };
    const auto density = [&](const Index3& place) { return 1.0 + fluid_.state_at(cell(place)).density_deviation; };
    const Vec3 along = along_wall(last);
    if (along.norm() * distance / viscosity <= edge_of_viscous_sublayer * edge_of_viscous_sublayer)
      return density(at) * viscosity * along_wall(at) / 0.5;
    const double friction = distance_in_wall_units(along.norm() * distance / viscosity) * viscosity / distance;
    return density(last) * friction * friction * along.normalized();
  }

  void for_each_cell_at(int face, const std::function<void(const Index3&)>& visit) const {
    Index3 at;
    at[normal_] = face % 2 == 0 ? 0 : cells[normal_] - 1;
    const int u = first_axis(normal_), v = second_axis(normal_);
    for (at[v] = 0; at[v] < cells[v]; ++at[v])
      for (at[u] = 0; at[u] < cells[u]; ++at[u])
        if (is_fluid(cell(at))) visit(at);
  }

  static constexpr double viscosity = 1e-4;
  static constexpr Index3 cells{11, 9, 7};

private:
  std::array<bool, 3> periodic() const { return {normal_ != 0, normal_ != 1, normal_ != 2}; }
  FaceConditions faces() const {
    FaceConditions faces;
    faces[face_of(normal_, false)].type = faces[face_of(normal_, true)].type = FaceType::law_of_the_wall;
    return faces;
  }
  static CollisionParameters parameters(CollisionModel model) {
    CollisionParameters p;
    p.model = model;
    p.relaxation_time = 0.5 + 3.0 * viscosity;
    p.force[0] = 2e-5;
    p.force[1] = -1e-5;
    p.force[2] = 3e-5;
    return p;
  }
  void cover(const std::function<bool(const Index3&)>& solid) {
    Index3 at;
    for (at[2] = -1; at[2] <= cells[2]; ++at[2])
      for (at[1] = -1; at[1] <= cells[1]; ++at[1])
        for (at[0] = -1; at[0] <= cells[0]; ++at[0]) {
          Index3 inside;
          for (int a = 0; a < 3; ++a) inside[a] = (at[a] + cells[a]) % cells[a];
          if (inside[normal_] == at[normal_] && solid(inside)) fluid_.cells().assign(at[0], at[1], at[2], 0);
        }
  }

  int normal_;
  Decomposition decomposition_;
  Fluid<Real> fluid_;
  std::vector<Vec3> before_, now_;  // the law's stresses at the cells of both faces
};

// A population is rounded to half a unit in its last place, and is below 0.1; a moment is a sum of 19.
template <typename Real>
constexpr double rounding = sizeof(Real) == 4 ? 0.1 * 0x1p-23 : 0.1 * 0x1p-52;

// StressRatio is exact to 3e-8, of a stress up to 2e-5 here.
constexpr double table = 3e-8 * 2e-5;

// The two populations along an axis differ from specular reflection by half the stress each, where the cells they come
// from are fluid; elsewhere one of them bounces back whole and the other is what has been reflected.
template <typename Real>
void expect_stress_in(Box<Real>& box, int face, const Index3& at) {
  const Populations<Real>& f = box.fluid().populations();
  const Vec3 stress = box.stress(at, face);
  const int normal = face / 2;
  const std::ptrdiff_t cell = box.cell(at);
  const int straight = box.direction(face, -1, 0);
  EXPECT_EQ(f.incoming(straight, cell), f.post_collision(D3Q19::opposite(straight), cell));
  for (const int axis : {first_axis(normal), second_axis(normal)}) {
    const bool both = box.is_fluid(box.beside(at, axis, 1)) && box.is_fluid(box.beside(at, axis, -1));
    for (const int sign : {-1, 1}) {
      const int o = box.direction(face, axis, sign);
      const std::ptrdiff_t source = box.beside(at, axis, -sign);
      const double bounced = f.post_collision(D3Q19::opposite(o), cell),
                   reflected = f.post_collision(D3Q19::mirror(o, normal), source);
      if (both)
        EXPECT_NEAR(f.incoming(o, cell), reflected - 0.5 * sign * stress[axis], rounding<Real> + table);
      else
        EXPECT_EQ(f.incoming(o, cell), box.is_fluid(source) ? reflected : bounced);
    }
  }
}

template <typename Real>
void expect_exact_stress(CollisionModel model) {
  for (const int normal : {0, 1, 2})
    for (const int steps : {4, 5}) {  // one for each arrangement in memory
      Box<Real> box(model, normal, steps);
      Vec3 sums[2] = {Vec3::Zero(), Vec3::Zero()};
      for (const bool high : {false, true}) {
        const int face = face_of(normal, high);
        box.for_each_cell_at(face, [&](const Index3& at) {
          expect_stress_in(box, face, at);
          sums[high] += box.stress(at, face);
        });
      }
      const std::array<Vec3, 6> forces = box.fluid().wall_forces();
      const double cells = 11.0 * 9.0 * 7.0 / Box<Real>::cells[normal];
      for (const bool high : {false, true})
        for (const int axis : {first_axis(normal), second_axis(normal)})
          EXPECT_NEAR(forces[face_of(normal, high)][axis], sums[high][axis],
                      4.0 * cells * rounding<Real> + cells * table)
              << normal << high << axis;
    }
}

TEST(WallStress, IsExactlyThatOfTheLaw) {
  for (const CollisionModel model : {CollisionModel::bgk, CollisionModel::trt}) {
    expect_exact_stress<double>(model);
    expect_exact_stress<float>(model);
  }
}

// Cells that a body leaves alone, or touches along one axis or both, from the side or from above.
template <typename Real>
void expect_walls_to_give_back_what_they_get(int normal) {
  const auto solid = [](const Index3& at) { return (at[0] * 5 + at[1] * 3 + at[2] * 7 + at[0] * at[1]) % 6 == 0; };
  Box<Real> box(CollisionModel::bgk, normal, 5, solid);
  const Populations<Real>& f = box.fluid().populations();
  for (const bool high : {false, true}) {
    const int face = face_of(normal, high);
    double sent = 0.0, returned = 0.0;
    int cells = 0;
    box.for_each_cell_at(face, [&](const Index3& at) {
      expect_stress_in(box, face, at);
      for (int o = 0; o < D3Q19::directions; ++o) {
        if (D3Q19::c[o][normal] != (high ? -1 : 1)) continue;
        returned += f.incoming(o, box.cell(at));
        sent += f.post_collision(D3Q19::opposite(o), box.cell(at));
      }
      ++cells;
    });
    EXPECT_GT(cells, 20);
    EXPECT_NEAR(returned, sent, 5.0 * cells * rounding<Real>);
  }
}

TEST(WallStress, BesideBodiesKeepsTheMassAndTakesTheLastCellBefore) {
  for (const int normal : {0, 1, 2}) {
    expect_walls_to_give_back_what_they_get<double>(normal);
    expect_walls_to_give_back_what_they_get<float>(normal);
  }
}

// Momentum that changes sign along the wall and from step to step: a wall takes energy from it, or leaves it alone.
TEST(WallStress, LetsQuietWaterComeToRest) {
  const Decomposition decomposition({6, 6, 6}, 1.0, {true, false, true}, {1, 1, 1});
  CollisionParameters parameters;
  parameters.relaxation_time = 0.505;
  FaceConditions faces;
  faces[2].type = faces[3].type = FaceType::law_of_the_wall;
  Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
  const double start = 0.001;
  fluid.initialise([&](const Vec3& p) {
    return FluidState{0.0, Vec3(std::fmod(p.x(), 2.0) < 1.0 ? start : -start, 0.0, start)};
  });
  for (int step = 0; step < 20000; ++step) fluid.advance();
  double largest = 0.0;
  for (int y = 0; y < 6; ++y)
    largest = std::max(largest, fluid.state_at(fluid.indexing().index(2, y, 2)).velocity.norm());
  EXPECT_LT(largest, std::sqrt(2.0) * start);
}

TEST(WallStress, FoundAgainIsTheSame) {
  Box<float> box(CollisionModel::bgk, 1, 5);
  std::vector<float> first, again;
  const auto collect = [&](std::vector<float>& values) {
    for (const int face : {2, 3})
      box.for_each_cell_at(face, [&](const Index3& at) {
        for (int o = 0; o < D3Q19::directions; ++o)
          if (D3Q19::c[o][1] == (face == 2 ? 1 : -1))
            values.push_back(box.fluid().populations().incoming(o, box.cell(at)));
      });
  };
  collect(first);
  box.fluid().apply_walls();
  collect(again);
  EXPECT_EQ(first, again);
}

Channel between_walls(int height, double tau, double force, CollisionModel model, int normal) {
  Channel channel;
  channel.height = height;
  channel.collision.model = model;
  channel.collision.relaxation_time = tau;
  channel.collision.force[0] = force;
  channel.low.type = channel.high.type = FaceType::law_of_the_wall;
  channel.normal = normal;
  return channel;
}

// Where the sublayer is resolved, the wall takes nu rho u/d with u at the distance d = 1/2, and F h/2 in steady flow.
// So u(d) = F h d/(2 nu), and the lattice carries the parabola exactly:
//   u(y) = F/(2 nu) [y (h - y) + d^2],
// that of no slip up to 1/h^2 of its largest value.
TEST(WallStress, IsThatOfNoSlipInASublayerThatIsResolved) {
  const double force = 1e-6;
  for (const CollisionModel model : {CollisionModel::bgk, CollisionModel::trt})
    for (const int normal : {0, 1, 2})
      for (const double tau : {0.6, 0.9})
        for (const int height : {1, 2, 3, 20}) {
          const double nu = (tau - 0.5) / 3.0, h = height;
          const int steps = static_cast<int>((h + 6.0) * (h + 6.0) * 3.0 / nu);
          const std::vector<double> u = velocity_across(between_walls(height, tau, force, model, normal), steps);
          const double largest = force / (2.0 * nu) * (0.25 * h * h + 0.25);
          for (int k = 0; k < height; ++k) {
            const double y = k + 0.5;
            EXPECT_NEAR(u[k], force / (2.0 * nu) * (y * (h - y) + 0.25), 1e-10 * largest) << height << " " << k;
          }
        }
}

// A fluid at rest under a pressure p = delta/3 presses on each face of a closed box with p A, along the normal alone:
// its rows at the edges press on both faces that meet there.
TEST(WallForces, OfAFluidAtRestAreItsPressureAlongTheNormal) {
  const Decomposition decomposition({5, 7, 6}, 1.0, {false, false, false}, {1, 1, 1});
  const double delta = 0.01, area[3] = {7.0 * 6.0, 5.0 * 6.0, 5.0 * 7.0};
  for (const FaceType sides : {FaceType::no_slip, FaceType::free_slip}) {
    FaceConditions faces;
    for (auto& face : faces) face.type = FaceType::no_slip;
    faces[2].type = faces[3].type = sides;
    CollisionParameters parameters;
    parameters.relaxation_time = 0.8;
    Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
    fluid.initialise([&](const Vec3&) { return FluidState{delta, Vec3::Zero()}; });
    for (int step = 0; step < 3; ++step) fluid.advance();
    const std::array<Vec3, 6> forces = fluid.wall_forces();
    for (int face = 0; face < 6; ++face) {
      Vec3 expected = Vec3::Zero();
      expected[face / 2] = (face % 2 == 0 ? -1.0 : 1.0) * delta / 3.0 * area[face / 2];
      EXPECT_LT((forces[static_cast<std::size_t>(face)] - expected).norm(), 1e-10) << face;
    }
  }
}

// Under a force F each wall takes F h/2 in steady flow, whatever happens between them, and the fifth cell moves as the
// law says for that stress: u_tau = 0.008, y+ = 12.
TEST(WallStress, BalancesTheForceAtTheVelocityOfTheLaw) {
  const double nu = 3e-3, friction = 0.008, y_plus = 4.5 * friction / nu;
  const double speed = friction * (std::log(y_plus) / 0.41 + 5.0);
  const int height = 12, area = 16;
  const Decomposition decomposition({4, height, 4}, 1.0, {true, false, true}, {1, 1, 1});
  FaceConditions faces;
  faces[2].type = faces[3].type = FaceType::law_of_the_wall;
  for (const CollisionModel model : {CollisionModel::bgk, CollisionModel::trt})
    for (const Subgrid& subgrid : {Subgrid::none(), Subgrid::smagorinsky(0.2), Subgrid::qr()}) {
      CollisionParameters parameters;
      parameters.model = model;
      parameters.relaxation_time = 0.5 + 3.0 * nu;
      parameters.subgrid = subgrid;
      parameters.force[0] = 2.0 * friction * friction / height;
      Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
      fluid.initialise([&](const Vec3&) { return FluidState{0.0, Vec3(speed, 0.0, 0.0)}; });
      for (int step = 0; step < 100000; ++step) fluid.advance();
      const std::array<Vec3, 6> forces = fluid.wall_forces();
      // The walls' forces are sums of multiples of 2^-44.
      const double driving = parameters.force[0] * height * area;
      EXPECT_NEAR(forces[2].x() + forces[3].x(), driving, 1e-8 * driving);
      EXPECT_NEAR(forces[2].x(), 0.5 * driving, 1e-8 * driving);
      for (const int fifth : {4, height - 5})
        EXPECT_NEAR(fluid.state_at(fluid.indexing().index(2, fifth, 1)).velocity.x(), speed, 1e-7 * speed);
    }
}

}  // namespace
}  // namespace thalweg::lbm::wall_stress_test
