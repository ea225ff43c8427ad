// Interpolated bounce-back on moving bodies (Bouzidi, Firdaouss and Lallemand 2001) and the momentum it exchanges.
//
// For a link from the fluid cell x_f along c_i into a body, i' the opposite, delta the distance to the surface, f^c
// post-collision, x_ff = x_f - c_i, u_w the velocity of the surface where the link meets it:
//   delta < 1/2:  f_i'(x_f, t+1) = 2 delta f_i^c(x_f) + (1 - 2 delta) f_i^c(x_ff)              - 6 w_i rho c_i.u_w
//   else:         f_i'(x_f, t+1) = f_i^c(x_f)/(2 delta) + (2 delta - 1)/(2 delta) f_i'^c(x_f) - (3/delta) w_i rho
//   c_i.u_w
// If x_ff is covered by a body, f_i^c(x_ff) is the equilibrium at the density of x_f and that body's velocity at x_ff
// (Zhang et al. 2022). If it lies beyond a wall, the population that the wall returns to x_f stands in.
//
// Force on the body per step: the Galilean-invariant exchange of Wen et al. 2014, sum (c_i - u_w) f_i^c - (c_i' - u_w)
// f_i', or the classical one of Mei et al. 2002, sum c_i (f_i^c + f_i'). Populations count less their weight w_i, so
// that touching bodies feel no false attraction from the cells they hide from each other.
#pragma once

#include "core/periodic_box.hpp"
#include "lbm/cell_map.hpp"
#include "lbm/link_table.hpp"
#include "lbm/populations.hpp"

#include <vector>

namespace thalweg::lbm {

enum class MomentumExchange { galilean_invariant, classical };
enum class WallDensity { local, reference };  // rho in the moving-wall term: of x_f, or 1

struct LinkOptions {
  MomentumExchange momentum_exchange = MomentumExchange::galilean_invariant;
  WallDensity wall_density = WallDensity::local;
};

// Writes, for every link, the population that the sweep will take from the solid side, and adds the momentum to
// bodies[...].force and torque (which the caller has cleared). Walls and halo must be done. CellMap holds slots of
// bodies. box: the domain in cells, for the minimum image between bodies.
template <typename Real>
void apply_links(Populations<Real>& populations, const CellMap& cells, const LinkTable& links, const PeriodicBox& box,
                 const LinkOptions& options, std::vector<LinkBody>& bodies);

}  // namespace thalweg::lbm
