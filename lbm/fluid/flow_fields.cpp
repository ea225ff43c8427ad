#include "lbm/fluid/flow_fields.hpp"

#include "lbm/collision/collision.hpp"
#include "lbm/lattice/for_each_cell.hpp"

#include <cmath>

namespace thalweg::lbm {

namespace {

constexpr int fluid_flag = 3;  // component of a velocity_field after the velocity
constexpr int layers = 2;      // that a one-sided difference looks at

// Region with the neighbours of its cells; the whole axis if they may lie beyond its end.
Block widened(Block region, const Index3& cells) {
  for (int a = 0; a < 3; ++a) {
    region.lower[a] -= layers;
    region.upper[a] += layers;
    if (region.lower[a] >= 0 && region.upper[a] <= cells[a]) continue;
    region.lower[a] = 0;
    region.upper[a] = cells[a];
  }
  return region;
}

// The derivative along an axis from the cells at hand.
Vec3 derivative(const GhostedField& velocity, const Index3& cell, int axis) {
  const auto values = [&](int steps) {
    Index3 at = cell;
    at[axis] += steps;
    return velocity.at(at[0], at[1], at[2]);
  };
  const auto u = [&](int steps) {
    const double* v = values(steps);
    return Vec3(v[0], v[1], v[2]);
  };
  const auto fluid = [&](int steps) { return values(steps)[fluid_flag] != 0.0; };
  if (fluid(-1) && fluid(1)) return 0.5 * (u(1) - u(-1));
  for (const int side : {1, -1}) {
    if (!fluid(side)) continue;
    if (fluid(2 * side)) return side * (2.0 * u(side) - 1.5 * u(0) - 0.5 * u(2 * side));
    return side * (u(side) - u(0));
  }
  return Vec3::Zero();
}

}  // namespace

template <typename Real>
GhostedField velocity_field(const Fluid<Real>& fluid, const Block& region) {
  GhostedField field(fluid.decomposition(), fluid.communicator(), fluid_flag + 1, layers);
  const Block part = local_block(fluid.block(), widened(region, fluid.decomposition().cells()));
  for_each_cell(fluid.indexing(), part, [&](std::ptrdiff_t cell, const Index3& at) {
    if (!fluid.cells().is_fluid(cell)) return;
    const Vec3 u = fluid.state_at(cell).velocity;
    double* values = field.at(at[0], at[1], at[2]);
    for (int a = 0; a < 3; ++a) values[a] = u[a];
    values[fluid_flag] = 1.0;
  });
  field.exchange();
  return field;
}

Gradient velocity_gradient(const GhostedField& velocity, int x, int y, int z) {
  Gradient gradient;
  for (int axis = 0; axis < 3; ++axis) gradient.col(axis) = derivative(velocity, {x, y, z}, axis);
  return gradient;
}

Vec3 vorticity(const Gradient& g) { return {g(2, 1) - g(1, 2), g(0, 2) - g(2, 0), g(1, 0) - g(0, 1)}; }

double q_criterion(const Gradient& g) {
  const Gradient strain = 0.5 * (g + g.transpose()), rotation = 0.5 * (g - g.transpose());
  return 0.5 * (rotation.squaredNorm() - strain.squaredNorm());
}

namespace {

// The populations that enter the coming collision, and their moments.
struct Incoming {
  double f[D3Q19::directions];
  CellMoments<double> moments;
};

template <typename Real>
Incoming incoming_of(const Fluid<Real>& fluid, std::ptrdiff_t cell) {
  Incoming in;
  for (int i = 0; i < D3Q19::directions; ++i) in.f[i] = static_cast<double>(fluid.populations().incoming(i, cell));
  const CollisionConstants<double> constants(fluid.parameters());
  const bool bulk = fluid.parameters().with_bulk();
  in.moments = with_constant(fluid.parameters().subgrid.model(), [&]<SubgridModel subgrid>() {
    return bulk ? moments_of<subgrid, true>(in.f, constants) : moments_of<subgrid, false>(in.f, constants);
  });
  return in;
}

// The part 1 - a of the trace that relaxes with the bulk relaxation time.
template <typename Real>
double bulk_share(const Fluid<Real>& fluid, const Index3& cell, const Incoming& in) {
  const CollisionParameters& p = fluid.parameters();
  if (p.model != CollisionModel::trt_at_bodies || !fluid.cells().is_beside_bodies(cell)) return 1.0;
  const double in_gap = fluid.cells().is_in_gap(cell) ? 1.0 : 0.0;
  return 1.0 - calmness_of(in.f, in.moments, CollisionConstants<double>(p), in_gap);
}

Symmetric<double> times(double factor, const Symmetric<double>& s) {
  return {factor * s.xx, factor * s.yy, factor * s.zz, factor * s.xy, factor * s.xz, factor * s.yz};
}

void add_isotropic(double part, Symmetric<double>& s) {
  s.xx += part;
  s.yy += part;
  s.zz += part;
}

}  // namespace

template <typename Real>
SubgridState subgrid_state(const Fluid<Real>& fluid, std::ptrdiff_t cell) {
  const CollisionParameters& parameters = fluid.parameters();
  const CellMoments<double> m = incoming_of(fluid, cell).moments;
  const double squared = (parameters.with_bulk() ? m.pi.traceless() : m.pi).squared();
  SubgridState state;
  state.shear_rate = 1.5 * std::sqrt(2.0 * squared) * m.omega * m.inverse_rho;
  state.eddy_viscosity = (1.0 / m.omega - parameters.relaxation_time) / 3.0;
  return state;
}

template <typename Real>
MomentumFlux momentum_flux(const Fluid<Real>& fluid, const Index3& cell) {
  const CollisionParameters& p = fluid.parameters();
  const Incoming in = incoming_of(fluid, fluid.indexing().index(cell[0], cell[1], cell[2]));
  const CellMoments<double>& m = in.moments;
  MomentumFlux flux;
  flux.density = 1.0 + m.deviation;
  flux.velocity = m.inverse_rho * (Vec3(m.mx, m.my, m.mz) + 0.5 * p.force);
  const Symmetric<double> pi = p.with_bulk() ? m.pi.traceless() : m.pi;
  const double of_viscosity = -m.omega * (p.relaxation_time - 0.5), of_subgrid = -(1.0 - m.omega * p.relaxation_time);
  flux.viscous = times(of_viscosity, pi);
  flux.subgrid = times(of_subgrid, pi);
  if (p.with_bulk()) {
    const double share = bulk_share(fluid, cell, in), trace = m.pi.trace();
    const double bulk = -(1.0 - 0.5 / p.bulk_relaxation_time) * trace / 3.0, others = (1.0 - share) * trace / 3.0;
    add_isotropic(share * bulk + of_viscosity * others, flux.viscous);
    add_isotropic(of_subgrid * others, flux.subgrid);
  }
  return flux;
}

template GhostedField velocity_field(const Fluid<float>&, const Block&);
template GhostedField velocity_field(const Fluid<double>&, const Block&);
template SubgridState subgrid_state(const Fluid<float>&, std::ptrdiff_t);
template SubgridState subgrid_state(const Fluid<double>&, std::ptrdiff_t);
template MomentumFlux momentum_flux(const Fluid<float>&, const Index3&);
template MomentumFlux momentum_flux(const Fluid<double>&, const Index3&);

}  // namespace thalweg::lbm
