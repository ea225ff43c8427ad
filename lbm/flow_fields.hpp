// What can be seen in a lattice fluid besides density and velocity. Lattice units.
//
// Velocity gradients, for vorticity w = curl u and Q = (W_ab W_ab - S_ab S_ab)/2 with S, W the symmetric and
// antisymmetric parts of du_a/dx_b (Hunt, Wray and Moin 1988), are central differences of the velocity of the last
// collision, across the borders of ranks. Next to a wall or a solid cell they are one-sided: of second order with two
// fluid cells to look at, of first order with one, zero with none.
//
// The shear rate g = sqrt(2 S_ab S_ab) and the eddy viscosity C_s^2 g are not: they are those of the subgrid model
// itself, from the non-equilibrium moment that the coming collision will see (collision.hpp), which is of second order
// everywhere, at walls too, and is what acts on the flow. They belong to one step later than the velocity.
#pragma once

#include "core/ghosted_field.hpp"
#include "lbm/fluid.hpp"

namespace thalweg::lbm {

// Rows a, columns b: du_a/dx_b.
using Gradient = Eigen::Matrix3d;

// Velocity of every cell and whether it is fluid, with the two layers of ghosts that one-sided differences need.
// Collective.
template <typename Real>
GhostedField velocity_field(const Fluid<Real>& fluid);

// At an owned fluid cell of a velocity_field.
Gradient velocity_gradient(const GhostedField& velocity, int x, int y, int z);

Vec3 vorticity(const Gradient& gradient);
double q_criterion(const Gradient& gradient);

struct SubgridState {
  double shear_rate = 0.0;
  double eddy_viscosity = 0.0;
};

// Of an owned fluid cell. What streams in must lie ready: exchange_halo(), apply_walls(), and the links of bodies.
template <typename Real>
SubgridState subgrid_state(const Fluid<Real>& fluid, std::ptrdiff_t cell);

}  // namespace thalweg::lbm
