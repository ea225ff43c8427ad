// Sizes by mass, as a sieve gives them, and the grains that have them.
//
// F(d) is the share of the mass that is finer than d. The number of grains between two sizes is the integral of dF over
// the mass of a grain, which goes as d^3, of disks as d^2; all grains have the same density.
#pragma once

#include <cstdint>
#include <vector>

namespace thalweg::beds {

// F at a few diameters, linear in ln d between them.
struct GradingCurve {
  std::vector<double> diameters;  // m, rising
  std::vector<double> finer;      // 1, as many; from 0 to 1, never falling
};

// The curve through d16, d50 and d84 (m): ln d is normally distributed with one deviation from d50 down and another one
// from d50 up. The tails beyond d16 and d84 are cut at minimum and maximum (m) and hold 0.16 of the mass each, so that
// the three sizes are those of the whole. It differs from these distributions by less than 1e-5.
GradingCurve curve_through(double minimum, double d16, double d50, double d84, double maximum);

// `count` diameters (m), rising. Each stands for an equal share of the number of grains of the curve and has the mean
// mass of that share, so that the mass finer than any d differs from F(d) by less than that of the one grain whose
// share contains d. mass_power: 3 for spheres, 2 for disks.
std::vector<double> diameters_by_mass(const GradingCurve& curve, std::int64_t count, double mass_power);

}  // namespace thalweg::beds
