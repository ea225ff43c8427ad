// Vorticity, Q, shear rate and eddy viscosity against flows where they are known, and on any number of ranks.
#include "lbm/fluid/flow_fields.hpp"
#include "core/parallel/mpi_session.hpp"
#include "lbm/lattice/for_each_cell.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace thalweg::lbm::flow_fields_test {
namespace {

Index3 layout_of_all_ranks(const Index3& cells) { return Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD)); }

template <typename Visit>
void for_each_cell(const Index3& n, Visit visit) {
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) visit(x, y, z);
}

Block whole_of(const Decomposition& decomposition) { return {{0, 0, 0}, decomposition.cells()}; }

struct Errors {
  double vorticity = 0.0, q = 0.0;  // largest, in units of k U and (k U)^2
};

// Taylor and Green's vortices u = U (-cos kx sin ky, sin kx cos ky): w_z = 2 k U cos kx cos ky and
// Q = (k U)^2 (cos^2 kx cos^2 ky - sin^2 kx sin^2 ky).
Errors taylor_green_errors(int n) {
  const Index3 cells{n, n, 4};
  const Decomposition decomposition(cells, 1.0, {true, true, true}, layout_of_all_ranks(cells));
  Fluid<double> fluid(decomposition, MPI_COMM_WORLD, {}, {});
  const double k = 2.0 * std::numbers::pi / n, u = 0.05;
  fluid.initialise([&](const Vec3& p) {
    return FluidState{
        0.0, u * Vec3(-std::cos(k * p.x()) * std::sin(k * p.y()), std::sin(k * p.x()) * std::cos(k * p.y()), 0.0)};
  });
  const GhostedField velocity = velocity_field(fluid, whole_of(fluid.decomposition()));
  Errors errors;
  for_each_cell(fluid.indexing().size(), [&](int x, int y, int z) {
    const double kx = k * (fluid.block().lower[0] + x + 0.5), ky = k * (fluid.block().lower[1] + y + 0.5);
    const double cc = std::cos(kx) * std::cos(ky), ss = std::sin(kx) * std::sin(ky);
    const Gradient gradient = velocity_gradient(velocity, x, y, z);
    const Vec3 w = vorticity(gradient) / (k * u);
    errors.vorticity = std::max({errors.vorticity, std::abs(w.z() - 2.0 * cc), std::abs(w.x()), std::abs(w.y())});
    errors.q = std::max(errors.q, std::abs(q_criterion(gradient) / (k * u * k * u) - (cc * cc - ss * ss)));
  });
  return {max_over_ranks(MPI_COMM_WORLD, errors.vorticity), max_over_ranks(MPI_COMM_WORLD, errors.q)};
}

TEST(FlowFields, VorticityAndQOfTaylorGreenVorticesAreOfSecondOrder) {
  // A central difference multiplies a harmonic by s = sin(k)/k = 1 - k^2/6 + ..., and the extrema lie half a cell from
  // the nearest centres, so the errors are known: 2 (1 - s) cos^2(k/2) and (1 - s^2) cos(k).
  for (const int n : {16, 32}) {
    const Errors errors = taylor_green_errors(n);
    const double k = 2.0 * std::numbers::pi / n, s = std::sin(k) / k;
    EXPECT_NEAR(errors.vorticity, 2.0 * (1.0 - s) * std::pow(std::cos(0.5 * k), 2), 1e-12);
    EXPECT_NEAR(errors.q, (1.0 - s * s) * std::cos(k), 1e-12);
    EXPECT_LT(errors.vorticity, k * k / 3.0);
    EXPECT_LT(errors.q, k * k / 3.0);
  }
}

// A linear flow has exact gradients wherever there are neighbours to look at: at walls and beside solid cells too.
TEST(FlowFields, GradientsOfALinearFlowAreExactAtWallsAndBesideSolidCells) {
  const Index3 cells{12, 10, 14};
  const Decomposition decomposition(cells, 1.0, {false, false, false}, layout_of_all_ranks(cells));
  FaceConditions faces;
  for (FaceCondition& face : faces) face.type = FaceType::no_slip;
  Fluid<double> fluid(decomposition, MPI_COMM_WORLD, {}, faces);
  Gradient exact;
  exact << 1.0, 2.0, -3.0, 0.5, -4.0, 1.5, 2.5, -0.5, 3.0;
  exact *= 1e-3;
  fluid.initialise([&](const Vec3& p) { return FluidState{0.0, exact * p}; });
  // A block of solid cells around the middle and a lone one that leaves one fluid cell to the wall.
  const auto solid = [&](const Index3& g) {
    return (g[0] >= 5 && g[0] < 7 && g[1] >= 4 && g[1] < 6 && g[2] >= 6 && g[2] < 8) || g == Index3{1, 1, 1};
  };
  const Index3 n = fluid.indexing().size(), from = fluid.block().lower;
  for (int z = -1; z <= n[2]; ++z)
    for (int y = -1; y <= n[1]; ++y)
      for (int x = -1; x <= n[0]; ++x)
        if (solid({from[0] + x, from[1] + y, from[2] + z})) fluid.cells().assign(x, y, z, 0);
  const GhostedField velocity = velocity_field(fluid, whole_of(fluid.decomposition()));
  std::int64_t looked_at = 0;
  for_each_cell(n, [&](int x, int y, int z) {
    const Index3 g{from[0] + x, from[1] + y, from[2] + z};
    if (solid(g)) return;
    Gradient expected = exact;
    if (g == Index3{0, 1, 1}) expected.col(0).setZero();  // between the wall and the lone cell: nothing to look at
    if (g == Index3{1, 0, 1}) expected.col(1).setZero();
    if (g == Index3{1, 1, 0}) expected.col(2).setZero();
    EXPECT_NEAR((velocity_gradient(velocity, x, y, z) - expected).cwiseAbs().maxCoeff(), 0.0, 1e-15)
        << g[0] << " " << g[1] << " " << g[2];
    ++looked_at;
  });
  EXPECT_EQ(sum_over_ranks(MPI_COMM_WORLD, looked_at), 12 * 10 * 14 - 9);
}

// Between plates under a force F every cell balances its momentum: (nu + nu_t) g = F |z - H/2|, with a subgrid model
// and without, up to the normal components of the moment, which are smaller by g (in a step) and add in squares. They
// are all that the model QR sees.
TEST(FlowFields, ShearRateAndEddyViscosityOfPoiseuilleFlowCarryTheForce) {
  for (const Subgrid& subgrid : {Subgrid::none(), Subgrid::smagorinsky(0.27), Subgrid::qr()}) {
    constexpr int height = 16;
    const Index3 cells{4, 4, height};
    const Decomposition decomposition(cells, 1.0, {true, true, false}, layout_of_all_ranks(cells));
    CollisionParameters parameters;
    parameters.relaxation_time = 0.8;
    parameters.subgrid = subgrid;
    parameters.force[0] = 1e-4;
    FaceConditions faces;
    faces[4].type = faces[5].type = FaceType::no_slip;
    Fluid<double> fluid(decomposition, MPI_COMM_WORLD, parameters, faces);
    const double nu = (parameters.relaxation_time - 0.5) / 3.0;
    // 25 e-folding times H^2/(nu pi^2) of what the start differs by.
    for (int step = 0; step < 25 * height * height / (nu * 9.87); ++step) fluid.advance();
    fluid.exchange_halo();
    fluid.apply_walls();
    const double scale = parameters.force[0] * height / 2.0, steepest = scale / nu;  // 8e-4, 8e-3
    for_each_cell(fluid.indexing().size(), [&](int x, int y, int z) {
      const SubgridState state = subgrid_state(fluid, fluid.indexing().index(x, y, z));
      const double stress = parameters.force[0] * std::abs(fluid.block().lower[2] + z + 0.5 - height / 2.0);
      EXPECT_NEAR((nu + state.eddy_viscosity) * state.shear_rate, stress, steepest * steepest * scale)
          << int(subgrid.model()) << " " << z;
      const double normal = subgrid.model() == SubgridModel::qr ? subgrid.constant() * steepest * steepest : 0.0;
      EXPECT_NEAR(state.eddy_viscosity, subgrid.viscosity_in_shear(state.shear_rate), 1e-15 + normal);
    });
  }
}

// sum c_ia c_ib f_i, of deviations.
Symmetric<double> second_moment(const std::array<double, 19>& f) {
  Symmetric<double> sum{};
  for (int i = 0; i < D3Q19::directions; ++i) {
    const auto& c = D3Q19::c[i];
    sum.xx += c[0] * c[0] * f[i];
    sum.yy += c[1] * c[1] * f[i];
    sum.zz += c[2] * c[2] * f[i];
    sum.xy += c[0] * c[1] * f[i];
    sum.xz += c[0] * c[2] * f[i];
    sum.yz += c[1] * c[2] * f[i];
  }
  return sum;
}

// (P + P^c)/2 = rho/3 + rho u u less both stresses, where P is taken before a collision and P^c after it: in the open,
// with one relaxation time, and beside covered cells and in the gap between them, with two.
void expect_mean_of_before_and_after(const Subgrid& subgrid, double bulk_relaxation_time) {
  const Index3 cells{12, 12, 12};
  const Decomposition decomposition(cells, 1.0, {true, true, true}, layout_of_all_ranks(cells));
  CollisionParameters parameters;
  parameters.model = CollisionModel::trt_at_bodies;
  parameters.relaxation_time = 0.501;
  parameters.bulk_relaxation_time = bulk_relaxation_time;
  parameters.subgrid = subgrid;
  parameters.force[0] = 1e-4;
  Fluid<double> fluid(decomposition, MPI_COMM_WORLD, parameters, {});
  fluid.cells().assign(2, 3, 2, 0);
  fluid.cells().assign(2, 1, 2, 0);
  fluid.initialise([](const Vec3& p) {
    return FluidState{0.0, 0.05 * Vec3(std::sin(0.5 * p.y()), std::cos(0.7 * p.x()), std::sin(0.4 * p.x() + p.z()))};
  });
  fluid.advance();
  fluid.exchange_halo();
  fluid.apply_walls();

  struct Before {
    std::ptrdiff_t cell;
    Symmetric<double> second_moment;
    MomentumFlux flux;
  };
  std::vector<Before> before;
  for_each_cell(fluid.indexing().size(), [&](int x, int y, int z) {
    const std::ptrdiff_t cell = fluid.indexing().index(x, y, z);
    if (!fluid.cells().is_fluid(cell)) return;
    std::array<double, 19> f;
    for (int i = 0; i < D3Q19::directions; ++i) f[i] = fluid.populations().incoming(i, cell);
    before.push_back({cell, second_moment(f), momentum_flux(fluid, {x, y, z})});
  });
  fluid.stream_and_collide([](int) {});
  for (const Before& b : before) {
    std::array<double, 19> f;
    for (int i = 0; i < D3Q19::directions; ++i) f[i] = fluid.populations().post_collision(i, b.cell);
    const Symmetric<double> after = second_moment(f);
    const MomentumFlux& flux = b.flux;
    const Vec3& u = flux.velocity;
    const double pressure = (flux.density - 1.0) / 3.0, rho = flux.density;
    const auto expect = [&](double one, double other, double viscous, double subgrid, double convected) {
      EXPECT_NEAR(0.5 * (one + other), convected - viscous - subgrid, 1e-15) << "cell " << b.cell;
    };
    expect(b.second_moment.xx, after.xx, flux.viscous.xx, flux.subgrid.xx, pressure + rho * u.x() * u.x());
    expect(b.second_moment.yy, after.yy, flux.viscous.yy, flux.subgrid.yy, pressure + rho * u.y() * u.y());
    expect(b.second_moment.zz, after.zz, flux.viscous.zz, flux.subgrid.zz, pressure + rho * u.z() * u.z());
    expect(b.second_moment.xy, after.xy, flux.viscous.xy, flux.subgrid.xy, rho * u.x() * u.y());
    expect(b.second_moment.xz, after.xz, flux.viscous.xz, flux.subgrid.xz, rho * u.x() * u.z());
    expect(b.second_moment.yz, after.yz, flux.viscous.yz, flux.subgrid.yz, rho * u.y() * u.z());
  }
}

TEST(FlowFields, MomentumFluxIsTheMeanOfBeforeAndAfterTheCollision) {
  for (const double bulk_relaxation_time : {0.0, 1.0}) {
    expect_mean_of_before_and_after(Subgrid::smagorinsky(0.27), bulk_relaxation_time);
    expect_mean_of_before_and_after(Subgrid::qr(), bulk_relaxation_time);
  }
}

template <typename Real>
void compare_with_one_rank() {
  const Index3 cells{21, 13, 18};
  const std::array<bool, 3> periodic{true, false, true};
  const Decomposition whole(cells, 1.0, periodic, {1, 1, 1}), cut(cells, 1.0, periodic, layout_of_all_ranks(cells));
  CollisionParameters parameters;
  parameters.relaxation_time = 0.51;
  parameters.subgrid = Subgrid::smagorinsky(0.2);
  FaceConditions faces;
  faces[2].type = FaceType::no_slip;
  faces[3].type = FaceType::slip_law_of_the_wall;
  Fluid<Real> alone(whole, MPI_COMM_SELF, parameters, faces), shared(cut, MPI_COMM_WORLD, parameters, faces);
  for (Fluid<Real>* fluid : {&alone, &shared}) {
    fluid->initialise([](const Vec3& p) {
      return FluidState{0.0, 0.05 * Vec3(std::sin(0.5 * p.y()), std::cos(0.7 * p.x()), std::sin(0.4 * p.x() + p.z()))};
    });
    for (int step = 0; step < 3; ++step) fluid->advance();
    fluid->exchange_halo();
    fluid->apply_walls();
  }
  const GhostedField velocity_alone = velocity_field(alone, whole_of(whole)),
                     velocity_shared = velocity_field(shared, whole_of(whole));
  const Index3 from = shared.block().lower;
  int differing = 0;
  for_each_cell(shared.indexing().size(), [&](int x, int y, int z) {
    const SubgridState a = subgrid_state(alone, alone.indexing().index(from[0] + x, from[1] + y, from[2] + z));
    const SubgridState s = subgrid_state(shared, shared.indexing().index(x, y, z));
    differing += a.shear_rate != s.shear_rate || a.eddy_viscosity != s.eddy_viscosity;
    differing += velocity_gradient(velocity_alone, from[0] + x, from[1] + y, from[2] + z) !=
                 velocity_gradient(velocity_shared, x, y, z);
  });
  EXPECT_EQ(differing, 0);
}

// Gradients of a slab at the periodic border and of one inside, whose neighbours the field must know as well.
TEST(FlowFields, TheGradientsOfARegionAreThoseOfTheWhole) {
  const Index3 cells{16, 12, 12};
  const Decomposition decomposition(cells, 1.0, {true, true, true}, layout_of_all_ranks(cells));
  Fluid<double> fluid(decomposition, MPI_COMM_WORLD, {}, {});
  fluid.initialise([](const Vec3& p) {
    return FluidState{0.0, 0.05 * Vec3(std::sin(0.5 * p.y()), std::cos(0.7 * p.x()), std::sin(0.4 * p.x() + p.z()))};
  });
  const GhostedField whole = velocity_field(fluid, whole_of(decomposition));
  for (int axis = 0; axis < 3; ++axis)
    for (const int first : {0, 1, 5, cells[axis] - 1}) {
      Block region = whole_of(decomposition);
      region.lower[axis] = first;
      region.upper[axis] = first + 1;
      const GhostedField near = velocity_field(fluid, region);
      int differing = 0;
      for_each_cell(fluid.indexing(), local_block(fluid.block(), region), [&](std::ptrdiff_t, const Index3& at) {
        differing += velocity_gradient(near, at[0], at[1], at[2]) != velocity_gradient(whole, at[0], at[1], at[2]);
      });
      EXPECT_EQ(differing, 0) << "axis " << axis << ", layer " << first;
    }
}

TEST(FlowFields, AreTheSameOnAnyRanks) {
  compare_with_one_rank<float>();
  compare_with_one_rank<double>();
}

}  // namespace
}  // namespace thalweg::lbm::flow_fields_test
