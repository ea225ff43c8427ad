// Fields derived from the populations besides density and velocity. Lattice units.
//
// Velocity gradients, for vorticity w = curl u and Q = (W_ab W_ab - S_ab S_ab)/2 with S, W the symmetric and
// antisymmetric parts of du_a/dx_b (Hunt, Wray and Moin 1988), are central differences of the velocity of the last
// collision, across the borders of ranks. Next to a wall or a solid cell they are one-sided: of second order with two
// fluid cells to look at, of first order with one, zero with none.
//
// The shear rate g = sqrt(2 S_ab S_ab) and the eddy viscosity are not: they are those of the subgrid model
// itself, from the non-equilibrium moment that the coming collision will see (cell_moments.hpp), which is of second
// order everywhere, at walls too, and is what acts on the flow. They belong to one step later than the velocity.
#pragma once

#include "core/parallel/ghosted_field.hpp"
#include "lbm/fluid/fluid.hpp"

namespace thalweg::lbm {

// Rows a, columns b: du_a/dx_b.
using Gradient = Eigen::Matrix3d;

// Velocity (three components) and a flag, 1 in fluid, of the cells of a region (global coordinates) and up to two cells
// from it, which one-sided differences need, also across ranks and periodic faces; zero elsewhere. Collective.
template <typename Real>
GhostedField velocity_field(const Fluid<Real>& fluid, const Block& region);

// Gradient at an owned fluid cell of the region of a velocity_field.
Gradient velocity_gradient(const GhostedField& velocity, int x, int y, int z);

Vec3 vorticity(const Gradient& gradient);
double q_criterion(const Gradient& gradient);

struct SubgridState {
  double shear_rate = 0.0;
  double eddy_viscosity = 0.0;
};

// The momentum flux through a cell, the mean of before and after the coming collision: with P = sum c_a c_b f_i each,
//   (P + P^c)/2 = rho/3 delta_ab + rho u_a u_b + (1 - omega/2) Pi_ab
// exactly, whatever the collision model. The last term is minus the stress of viscosity and subgrid model, which share
// it in proportion to their relaxation times: omega (tau_0 - 1/2) and omega (tau - tau_0). With a bulk relaxation time
// of its own the trace has omega_b, all of it viscosity's; beside bodies, with trt_at_bodies, that part 1 - a of it
// (collision_trt_at_bodies.hpp).
struct MomentumFlux {
  double density = 1.0;  // rho
  Vec3 velocity = Vec3::Zero();
  Symmetric<double> viscous{}, subgrid{};  // stresses, positive in tension
};

// Momentum flux of an owned fluid cell (local coordinates). The incoming populations must be ready: exchange_halo(),
// apply_walls(), and the links of bodies.
template <typename Real>
MomentumFlux momentum_flux(const Fluid<Real>& fluid, const Index3& cell);
template <typename Real>
SubgridState subgrid_state(const Fluid<Real>& fluid, std::ptrdiff_t cell);

}  // namespace thalweg::lbm
