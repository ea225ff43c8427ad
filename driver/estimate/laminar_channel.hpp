// Steady laminar flow along a straight channel of rectangular section, on whose four sides the fluid is at rest. With
// half-widths a <= b, a body force per mass g and the sums over odd n (Boussinesq 1868; White, Viscous Fluid Flow,
// 3rd ed. 2006, eq. 3-48):
//
//   u_max = g a^2/(2 nu) [1 - 32/pi^3 sum (-1)^((n-1)/2) / (n^3 cosh(n pi b/(2 a)))]
//   U     = g a^2/(3 nu) [1 - 192 a/(pi^5 b) sum tanh(n pi b/(2 a)) / n^5]
//
// Between plates, b infinite, u_max = g a^2/(2 nu) and U = 2/3 u_max. A side that does not hold the fluid is a plane
// of symmetry: a film of depth H has a = H.
#pragma once

namespace thalweg::driver {

struct LaminarChannel {
  double largest;  // m/s, u_max
  double mean;     // m/s, U
  double spin_up;  // s, from rest to 95 % of U, by the slowest mode: 1.2/(nu (1/a^2 + 1/b^2))
};

// acceleration: m/s^2; viscosity: m^2/s; half-widths in m, in any order, one of them perhaps infinite.
LaminarChannel laminar_channel(double acceleration, double half_height, double half_width, double viscosity);

}  // namespace thalweg::driver
