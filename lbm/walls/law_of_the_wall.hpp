// The law of the wall: mean velocity u at a distance y from a smooth wall in a turbulent boundary layer,
//   u+ = y+                      in the viscous sublayer, up to y+ = 10.8 where the two meet,
//   u+ = ln(y+)/0.41 + 5         beyond,          u+ = u/u_tau,  y+ = y u_tau/nu          (Zhang et al. 2022, A4).
// u_tau is the friction velocity; the wall takes the stress rho u_tau^2.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace thalweg::lbm {

constexpr double karman_constant = 0.41, wall_intercept = 5.0;
constexpr double edge_of_viscous_sublayer = 10.804870814050255;  // where y+ = ln(y+)/0.41 + 5

// u+ at y+ beyond the sublayer.
inline double logarithmic_law(double y_plus) { return std::log(y_plus) / karman_constant + wall_intercept; }

// u_tau where the velocity is `speed` (at least 0) at `distance` (above 0) from the wall, in any consistent units.
//
// Solves y+ u+(y+) = speed distance/nu. Beyond the sublayer u+ is nearly linear in the logarithm of this number, which
// gives a first guess to 2.3 %; two steps of Newton's method make 7e-11 of it.
inline double friction_velocity(double speed, double distance, double viscosity) {
  const double reynolds = speed * distance / viscosity;
  if (reynolds <= edge_of_viscous_sublayer * edge_of_viscous_sublayer) return std::sqrt(viscosity * speed / distance);
  double y_plus = reynolds / (0.33 + 2.2 * std::log(reynolds));
  for (int step = 0; step < 2; ++step) {
    const double u_plus = logarithmic_law(y_plus);
    y_plus -= (y_plus * u_plus - reynolds) / (u_plus + 1.0 / karman_constant);
  }
  return y_plus * viscosity / distance;
}

// The stress of the law over that of a laminar layer with the same velocity: u_tau^2/(nu u/y), a function of Re = u
// y/nu alone, 1 in the sublayer. From a table, as friction_velocity() in every cell of a wall would take a quarter of a
// step.
class StressRatio {
public:
  StressRatio() {
    for (double low = smallest; low < largest; low *= 2.0)
      for (int n = 0; n < intervals; ++n) add_interval(low * (1.0 + n / double(intervals)), low / intervals);
  }

  // Accurate to 3e-8. `reynolds`: at least 0.
  double operator()(double reynolds) const {
    if (reynolds <= edge_of_viscous_sublayer * edge_of_viscous_sublayer) return 1.0;
    const auto bits = std::bit_cast<std::uint64_t>(reynolds);
    const std::uint64_t interval = (bits >> fraction_bits) - (std::bit_cast<std::uint64_t>(smallest) >> fraction_bits);
    if (interval >= cubics_.size()) return exact(reynolds);  // also where Re is not a number
    const double t = static_cast<double>(bits & ((std::uint64_t(1) << fraction_bits) - 1)) /
                     static_cast<double>(std::uint64_t(1) << fraction_bits);
    const Cubic& c = cubics_[interval];
    return c.value + t * (c.first + t * (c.second + t * c.third));
  }

private:
  // Each octave of Re beyond the sublayer in equal intervals, which the leading bits of Re number.
  static constexpr int intervals = 16, fraction_bits = 52 - 4;
  static constexpr double smallest = 128.0, largest = 0x1p40;

  struct Cubic {
    double value, first, second, third;  // in the share of the interval
  };

  // Exact ratio with y = nu = 1, so that u_tau = y+.
  static double exact(double reynolds) {
    const double y_plus = friction_velocity(reynolds, 1.0, 1.0);
    return y_plus * y_plus / reynolds;
  }
  // d exact/d Re, from dy+/dRe = 1/(u+ + 1/kappa).
  static double slope(double reynolds) {
    const double y_plus = friction_velocity(reynolds, 1.0, 1.0), u_plus = logarithmic_law(y_plus);
    return y_plus / reynolds * (2.0 / (u_plus + 1.0 / karman_constant) - y_plus / reynolds);
  }
  // Adds a cubic with the values and slopes of the law at both ends.
  void add_interval(double low, double width) {
    const double a = exact(low), b = exact(low + width);
    const double da = width * slope(low), db = width * slope(low + width);
    cubics_.push_back({a, da, 3.0 * (b - a) - 2.0 * da - db, 2.0 * (a - b) + da + db});
  }

  std::vector<Cubic> cubics_;
};

}  // namespace thalweg::lbm
