// The fluid of Clark, Shattuck, Ouellette & O'Hern, Phys. Rev. Fluids 2 (2017) 034305, which is no more than a force on
// every grain, given by its velocity v and the solid fraction phi around it:
//
//   F = B_1 w + B_2 |w| w + B_l l z,   w = v_0 f(phi) x - v
//   f = [exp(-b phi) - exp(-b phi_m)]/[exp(-b phi_t) - exp(-b phi_m)], not below 0      spheres
//   f = exp[-b (phi - phi_t)]                                                           disks
//   l = (phi_below - phi_above)/0.3
//
// phi is the solid fraction, the grain's own included, in a sphere (disk) of diameter D_i + 2 D_l about its centre, D_l
// being the largest diameter; phi_below and phi_above are those about the lowest and the highest point of the grain.
// The part of the sphere below the floor does not count. B_1 grows with the diameter of a grain, B_2 and B_l with its
// square.
//
// The misprints of the paper are settled as follows: |w| is missing in its equation 7, the denominator of f has phi_t
// (as in the caption of its figure 4). With D, m and g' the mean diameter, the mean mass and the reduced gravity,
//
//   Theta  = 2/3 (B_1 v_0 + B_2 v_0^2)/(m g')          Shields number
//   Re_*   = sqrt(3) (m/B_1) sqrt(Theta g'/D)          as printed; u_* D/nu is 6 times that for rho_g/rho_f = 3
//   F_l/F_d = B_l/(B_1 v_0 + B_2 v_0^2)
//   Re_p   = 60 B_2 v_0/B_1.
//
// SI units, or any consistent ones.
#pragma once

#include <cmath>

namespace thalweg::model_fluid {

enum class ModelDrag { linear, quadratic };

// Scales of the mean grain.
struct GrainScales {
  double diameter;  // m, D
  double mass;      // kg, m
  double gravity;   // m/s^2, g'
};

struct ModelFluidNumbers {
  double shields = 0.0;     // Theta
  double reynolds = 0.0;    // Re_*, as printed
  double lift_ratio = 0.0;  // F_l/F_d
  ModelDrag drag = ModelDrag::quadratic;
  double inertial = 0.5;  // B_2 D/m of quadratic drag
};

struct ModelFluidCoefficients {
  double viscous;   // kg/s, B_1 of the mean grain
  double inertial;  // kg/m, B_2
  double lift;      // N, B_l
  double velocity;  // m/s, v_0
};

inline constexpr double printed_to_physical_reynolds = 6.0;

// The same fluid (B_1 and B_2) with the v_0 that gives this Shields number; lift goes with drag.
inline ModelFluidCoefficients at_shields_number(double shields, double lift_ratio, const ModelFluidCoefficients& fluid,
                                                const GrainScales& s) {
  const double weight = shields * s.mass * s.gravity;  // Theta m g' = 2/3 (B_1 v_0 + B_2 v_0^2)
  const double b1 = fluid.viscous, b2 = fluid.inertial;
  // The root of B_2 v^2 + B_1 v = 3/2 Theta m g', written so that nothing cancels where B_2 is small.
  const double velocity = 3.0 * weight / (b1 + std::sqrt(b1 * b1 + 6.0 * b2 * weight));
  return {b1, b2, 1.5 * lift_ratio * weight, velocity};
}

// B_1 follows from Re_*, v_0 from Theta with B_2.
inline ModelFluidCoefficients coefficients_of(const ModelFluidNumbers& n, const GrainScales& s) {
  const double b1 = std::sqrt(3.0) * s.mass * std::sqrt(n.shields * s.gravity / s.diameter) / n.reynolds;
  const double b2 = n.drag == ModelDrag::linear ? 0.0 : n.inertial * s.mass / s.diameter;
  return at_shields_number(n.shields, n.lift_ratio, {b1, b2, 0.0, 0.0}, s);
}

inline double particle_reynolds(const ModelFluidCoefficients& c) { return 60.0 * c.inertial * c.velocity / c.viscous; }

// Decrease of the velocity of the fluid with the solid fraction.
struct VelocityProfile {
  double decay;    // b
  double top;      // phi_t, where f = 1
  double densest;  // phi_m, where f = 0; of spheres
  bool disks;

  static VelocityProfile of_spheres() { return {5.0, 0.42, 0.7, false}; }
  static VelocityProfile of_disks() { return {5.0, 0.5, 0.0, true}; }

  double operator()(double solid_fraction) const {
    if (disks) return std::exp(-decay * (solid_fraction - top));
    const double least = std::exp(-decay * densest);
    const double f = (std::exp(-decay * solid_fraction) - least) / (std::exp(-decay * top) - least);
    return f > 0.0 ? f : 0.0;
  }
};

// The force on a grain whose diameter is `size` mean diameters. Velocities: m/s; lift: l.
struct ModelForce {
  double x, y, z;  // N
};
inline ModelForce model_force(const ModelFluidCoefficients& c, double size, double fluid_velocity, double vx, double vy,
                              double vz, double lift) {
  const double wx = fluid_velocity - vx, wy = -vy, wz = -vz;
  const double drag = c.viscous * size + c.inertial * size * size * std::sqrt(wx * wx + wy * wy + wz * wz);
  return {drag * wx, drag * wy, drag * wz + c.lift * size * size * lift};
}

inline constexpr double lift_scale = 0.3;  // of phi_below - phi_above

}  // namespace thalweg::model_fluid
