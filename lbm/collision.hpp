// One cell's collision: BGK with Guo's force and the Smagorinsky closure in closed form. A pure function of 19 values;
// Number is a plain number or a SIMD pack of them. Lattice units, populations as deviations f_i - w_i.
//
//   u      = (sum c_i f_i + F/2) / rho
//   f_i^c  = f_i - (f_i - f_i^eq)/tau_e + (1 - 1/(2 tau_e)) w_i [3 (c_i - u).F + 9 (c_i.u)(c_i.F)]   (Guo et al. 2002)
//   tau_e  = [tau_0 + sqrt(tau_0^2 + 18 sqrt(2) C_s^2 Q/rho)]/2,  Q = sqrt(Pi_ab Pi_ab),             (Hou et al. 1994)
//   Pi_ab  = sum c_ia c_ib (f_i - f_i^eq) + (u_a F_b + u_b F_a)/2,   S_ab = -3/(2 rho tau_e) Pi_ab.
// The force term in Pi makes S exact to the order of the Chapman-Enskog expansion; C_s counts in cell sizes.
#pragma once

#include "lbm/d3q19.hpp"

#include <cmath>
#include <type_traits>

namespace thalweg::lbm {

struct CollisionParameters {
  double relaxation_time = 1.0;        // tau_0 = 1/2 + 3 nu dt/dx^2
  double smagorinsky_constant = 0.0;   // C_s; 0 switches the subgrid model off
  double force[3] = {0.0, 0.0, 0.0};   // force density on the fluid
};

// Moments of one cell that the collision needs and a wall model may want.
template <typename Number>
struct CellStress {
  Number xy, xz, yz;          // off-diagonal Pi
  Number inverse_rho_tau;     // 1/(rho tau_e); shear rate of a component: 2 |S_ab| = 3 |Pi_ab| / (rho tau_e)
};

// Sums over a pair of opposite directions.
template <typename Number>
struct PairSums {
  Number sum, difference;
  PairSums(const Number& plus, const Number& minus) : sum(plus + minus), difference(plus - minus) {}
};

// A constant in every lane, rounded once to the storage type.
template <typename Number>
[[gnu::always_inline]] inline Number pack_constant(double value) {
  if constexpr (std::is_arithmetic_v<Number>) return static_cast<Number>(value);
  else return Number(static_cast<typename Number::value_type>(value));
}

// Collides f in place. `with_eddies` false: plain BGK at tau_0.
template <bool with_eddies, typename Number>
[[gnu::always_inline]] inline CellStress<Number> collide(Number (&f)[19], const CollisionParameters& parameters) {
  using std::sqrt;
  constexpr auto constant = pack_constant<Number>;
  const Number fx = constant(parameters.force[0]), fy = constant(parameters.force[1]), fz = constant(parameters.force[2]);

  const PairSums<Number> x(f[1], f[2]), y(f[3], f[4]), z(f[5], f[6]);
  const PairSums<Number> xy(f[7], f[8]), xmy(f[9], f[10]), xz(f[11], f[12]), xmz(f[13], f[14]), yz(f[15], f[16]),
      ymz(f[17], f[18]);

  const Number in_xy = xy.sum + xmy.sum, in_xz = xz.sum + xmz.sum, in_yz = yz.sum + ymz.sum;
  const Number deviation = f[0] + ((x.sum + y.sum) + z.sum) + ((in_xy + in_xz) + in_yz);
  const Number rho = constant(1) + deviation;
  const Number inverse_rho = constant(1) / rho;
  const Number half = constant(0.5);
  // Momentum with half the force.
  const Number jx = x.difference + (xy.difference + xmy.difference) + (xz.difference + xmz.difference) + half * fx;
  const Number jy = y.difference + (xy.difference - xmy.difference) + (yz.difference + ymz.difference) + half * fy;
  const Number jz = z.difference + (xz.difference - xmz.difference) + (yz.difference - ymz.difference) + half * fz;
  const Number ux = jx * inverse_rho, uy = jy * inverse_rho, uz = jz * inverse_rho;

  const Number third = constant(1.0 / 3.0);
  CellStress<Number> stress;
  stress.xy = (xy.sum - xmy.sum) - jx * uy + half * (ux * fy + uy * fx);
  stress.xz = (xz.sum - xmz.sum) - jx * uz + half * (ux * fz + uz * fx);
  stress.yz = (yz.sum - ymz.sum) - jy * uz + half * (uy * fz + uz * fy);

  const Number tau0 = constant(parameters.relaxation_time);
  Number tau = tau0;
  if constexpr (with_eddies) {
    const Number xx = x.sum + in_xy + in_xz - third * deviation - jx * ux + ux * fx;
    const Number yy = y.sum + in_xy + in_yz - third * deviation - jy * uy + uy * fy;
    const Number zz = z.sum + in_xz + in_yz - third * deviation - jz * uz + uz * fz;
    const Number squared = (xx * xx + yy * yy + zz * zz) +
                           constant(2) * (stress.xy * stress.xy + stress.xz * stress.xz + stress.yz * stress.yz);
    const double cs = parameters.smagorinsky_constant;
    const Number eddy_coefficient = constant(25.455844122715711 * cs * cs);   // 18 sqrt(2) C_s^2
    tau = half * (tau0 + sqrt(tau0 * tau0 + eddy_coefficient * inverse_rho * sqrt(squared)));
  }
  const Number omega = constant(1) / tau;
  stress.inverse_rho_tau = inverse_rho * omega;

  // f_i^c = keep f_i + [omega w (d + rho(4.5 cu^2 - 1.5 uu)) + guo w (9 cu cF - 3 uF)]   (even in c)
  //                  + [3 w (omega c.j + guo c.F)]                                       (odd in c)
  const Number keep = constant(1) - omega;
  const Number guo = constant(1) - half * omega;
  const Number u_dot_f = ux * fx + uy * fy + uz * fz;
  const Number common = omega * (deviation - constant(1.5) * (jx * ux + jy * uy + jz * uz)) - constant(3) * guo * u_dot_f;
  const Number quadratic = constant(4.5) * omega * rho;
  const Number cross = constant(9) * guo;
  const Number ox = omega * jx + guo * fx, oy = omega * jy + guo * fy, oz = omega * jz + guo * fz;

  f[0] = keep * f[0] + constant(D3Q19::rest_weight) * common;
  const auto relax = [&](int plus, double weight, const Number& cu, const Number& cf,
                         const Number& odd) __attribute__((always_inline)) {
    const Number even = constant(weight) * (common + cu * (quadratic * cu + cross * cf));
    const Number odd_part = constant(3.0 * weight) * odd;
    f[plus] = keep * f[plus] + (even + odd_part);
    f[plus + 1] = keep * f[plus + 1] + (even - odd_part);
  };
  constexpr double axis = D3Q19::axis_weight, diagonal = D3Q19::diagonal_weight;
  relax(1, axis, ux, fx, ox);
  relax(3, axis, uy, fy, oy);
  relax(5, axis, uz, fz, oz);
  relax(7, diagonal, ux + uy, fx + fy, ox + oy);
  relax(9, diagonal, ux - uy, fx - fy, ox - oy);
  relax(11, diagonal, ux + uz, fx + fz, ox + oz);
  relax(13, diagonal, ux - uz, fx - fz, ox - oz);
  relax(15, diagonal, uy + uz, fy + fz, oy + oz);
  relax(17, diagonal, uy - uz, fy - fz, oy - oz);
  return stress;
}

}  // namespace thalweg::lbm
