// A random velocity field without divergence, to trigger turbulence. Lattice units.
//
//   u' = curl A,  A = e sum over modes of a_m cos(2 pi n_m.x/L + phi_m)
//
// with central differences for the curl, so that the divergence by central differences vanishes to round-off. e goes to
// zero with the square of the distance to both ends of every axis that is not periodic, so that A, its slope and u'
// vanish there. Every mode varies along the first periodic axis of more than two cells in whole periods, so that the
// mean of u' along every line of that axis is zero to round-off, and a mean profile is left as it is; without such an
// axis every mode varies along z. Modes are drawn from counter-based random numbers of their own index: the same field
// on any number of ranks.
//
// Wavelengths run from the length of the axis down to a quarter of it, and not below 8 cells; all modes have the same
// expected energy and random directions.
#pragma once

#include "core/base/types.hpp"

#include <array>
#include <complex>
#include <cstdint>
#include <vector>

namespace thalweg::lbm {

struct NoiseBox {
  Index3 cells{0, 0, 0};
  std::array<bool, 3> periodic{false, false, false};
  double floor = 0.0;  // height (cells) below which e is zero, as of a bed, if z is not periodic
};

class SolenoidalNoise {
public:
  static constexpr int modes = 32;

  SolenoidalNoise(const NoiseBox& box, std::uint64_t seed);

  // u' at a cell (global coordinates), in units of the root mean square of one component where e = 1.
  Vec3 velocity(const Index3& cell) const;

private:
  Vec3 potential(const Index3& cell) const;
  double envelope(const Index3& cell) const;

  // e^{i 2 pi n_m x/L} (with the phase, in x) at all coordinates along each axis from -1 to n, and a_m.
  std::array<std::vector<std::complex<double>>, 3> waves_;
  std::array<std::vector<double>, 3> envelopes_;
  std::array<Vec3, modes> amplitudes_;
};

}  // namespace thalweg::lbm
