#include "lbm/fluid/solenoidal_noise.hpp"

#include "core/base/counter_random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::lbm {

namespace {

constexpr int longest_to_shortest = 4, fewest_cells_a_wave = 8;
constexpr double round_off = 1e-20;  // more than sin(pi)^2

// Purposes of the random numbers of a mode.
enum Draw : std::uint64_t { number, sign = 3, phase = 6, polarisation };

// A vector of length one across k, turned at random about it.
Vec3 direction_across(const Vec3& k, double turn) {
  const Vec3 axis = std::abs(k.x()) < 0.9 * k.norm() ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 first = k.cross(axis).normalized(), second = k.normalized().cross(first);
  return std::cos(2.0 * std::numbers::pi * turn) * first + std::sin(2.0 * std::numbers::pi * turn) * second;
}

// p^2 (2 - p^2) with p = 4 s (1 - s): flat in the middle, zero with zero slope at the ends s = 0 and 1.
double envelope_at(double s) {
  if (s <= 0.0 || s >= 1.0) return 0.0;
  const double p = 4.0 * s * (1.0 - s);
  return p * p * (2.0 - p * p);
}

}  // namespace

SolenoidalNoise::SolenoidalNoise(const NoiseBox& box, std::uint64_t seed) {
  // The axis along which every mode varies. Central differences see no wave in one or two cells.
  const auto has_waves = [&box](int a) { return box.periodic[a] && box.cells[a] > 2; };
  int through = 0;
  while (through < 2 && !has_waves(through)) ++through;
  for (int a = 0; a < 3; ++a) {
    waves_[a].resize(static_cast<std::size_t>(box.cells[a] + 2) * modes);
    for (int c = -1; c <= box.cells[a]; ++c) {
      const double floor = a == 2 ? box.floor : 0.0;
      envelopes_[a].push_back(box.periodic[a] ? 1.0 : envelope_at((c + 0.5 - floor) / (box.cells[a] - floor)));
    }
  }
  for (int m = 0; m < modes; ++m) {
    const auto random = [&](std::uint64_t draw) { return uniform_random(seed, static_cast<std::uint64_t>(m), draw); };
    Vec3 difference;  // sin(k)/1 along each axis: what a central difference makes of k
    for (int a = 0; a < 3; ++a) {
      const int most = std::clamp(box.cells[a] / fewest_cells_a_wave, 1, longest_to_shortest);
      const int least = a == through ? 1 : 0;
      int n = least + static_cast<int>(random(number + a) * (most - least + 1));
      if (random(sign + a) < 0.5) n = -n;
      const double k = 2.0 * std::numbers::pi * n / box.cells[a];
      difference[a] = std::sin(k);
      for (int c = -1; c <= box.cells[a]; ++c) {
        // Coordinates beyond a periodic end are those inside again, to the last bit.
        const int inside = box.periodic[a] ? (c + box.cells[a]) % box.cells[a] : c;
        const double angle = k * (inside + 0.5) + (a == 0 ? 2.0 * std::numbers::pi * random(phase) : 0.0);
        waves_[a][static_cast<std::size_t>(c + 1) * modes + m] = std::polar(1.0, angle);
      }
    }
    // i k x a has length one for a = u x k/k^2 with u across k; a cosine has a mean square of 1/2, so that `modes` of
    // them make a mean square of one for each of three components with this factor.
    const double scale = std::sqrt(6.0 / modes);
    const double squared = difference.squaredNorm();
    amplitudes_[m] = Vec3::Zero();
    if (squared > round_off)
      amplitudes_[m] = scale / squared * direction_across(difference, random(polarisation)).cross(difference);
  }
}

double SolenoidalNoise::envelope(const Index3& cell) const {
  double product = 1.0;
  for (int a = 0; a < 3; ++a) product *= envelopes_[a][static_cast<std::size_t>(cell[a] + 1)];
  return product;
}

Vec3 SolenoidalNoise::potential(const Index3& cell) const {
  const double e = envelope(cell);
  Vec3 sum = Vec3::Zero();
  if (e == 0.0) return sum;
  const std::complex<double>* wave[3];
  for (int a = 0; a < 3; ++a) wave[a] = waves_[a].data() + static_cast<std::size_t>(cell[a] + 1) * modes;
  for (int m = 0; m < modes; ++m) sum += amplitudes_[m] * (wave[0][m] * wave[1][m] * wave[2][m]).real();
  return e * sum;
}

Vec3 SolenoidalNoise::velocity(const Index3& cell) const {
  Vec3 difference[3];  // along each axis, of A
  for (int a = 0; a < 3; ++a) {
    Index3 low = cell, high = cell;
    --low[a];
    ++high[a];
    difference[a] = 0.5 * (potential(high) - potential(low));
  }
  return {difference[1].z() - difference[2].y(), difference[2].x() - difference[0].z(),
          difference[0].y() - difference[1].x()};
}

}  // namespace thalweg::lbm
