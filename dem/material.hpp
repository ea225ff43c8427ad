// What a contact is made of, and how its damping follows from the restitution coefficient.
//
// Linear spring and dashpot, m* x'' + gamma x' + k x = 0: omega_0^2 = k/m*, zeta = gamma / (2 sqrt(k m*)),
// beta = zeta omega_0, omega = omega_0 sqrt(1 - zeta^2). The restitution depends on zeta alone and on how the contact
// ends (Schwager & Poeschel, Granular Matter 9 (2007) 465):
//   at zero overlap (the dashpot may pull):   e = exp(-pi beta/omega)
//   at zero force (no attraction):            e = exp{-(beta/omega) [pi - atan2(2 beta omega, omega^2 - beta^2)]},
//                         for zeta > 1:       e = exp{-(beta/Omega) ln[(beta + Omega)/(beta - Omega)]},
//                                             Omega = sqrt(beta^2 - omega_0^2).
#pragma once

#include <optional>

namespace thalweg::dem {

struct ContactParameters {
  double normal_stiffness = 0.0;        // N/m, > 0
  double tangential_stiffness = 0.0;    // N/m, >= 0
  std::optional<double> restitution;    // 0 < e <= 1; exactly one of restitution and damping is given
  std::optional<double> damping;        // kg/s, >= 0, of every contact
  double friction = 0.0;                // between grains, >= 0
  double wall_friction = 0.0;           // between a grain and a wall, >= 0: the default of the planes in walls.hpp
  bool attraction = false;              // whether the dashpot may pull at the end of the contact
};

// Throws InputError naming the first parameter that is impossible.
void check(const ContactParameters& parameters);

// e of a damping ratio zeta >= 0; attraction allows zeta < 1 only (beyond, the grains never part: 0).
double restitution_of_damping_ratio(double zeta, bool attraction);

// The inverse: zeta of 0 < e <= 1. Without attraction by bisection, to the last bit.
double damping_ratio_of_restitution(double restitution, bool attraction);

// The dashpot coefficient of a contact (kg/s).
class Damping {
public:
  explicit Damping(const ContactParameters& parameters);   // parameters must have passed check()

  // effective_mass (kg): m1 m2/(m1 + m2) of two grains, m of a grain against a wall.
  double coefficient(double effective_mass) const;

private:
  double normal_stiffness_;
  double constant_ = 0.0;        // kg/s, where the user gave it
  double damping_ratio_ = 0.0;   // zeta, where the user gave a restitution
};

// m1 m2/(m1 + m2); a grain that is held moves as if its mass were infinite.
double effective_mass(double mass_1, bool held_1, double mass_2, bool held_2);

// The time a contact must be resolved in (s): t_c = pi/omega, or pi/beta where the damping is faster than the spring.
double contact_time(double normal_stiffness, double effective_mass, double damping);

// Sub-steps a contact time needs at least.
inline constexpr double fewest_steps_per_contact = 20.0;

// Throws InputError if the time step (s) is longer than t_c/20 of a contact with this effective mass (kg).
void check_time_step(const ContactParameters& parameters, double effective_mass, double time_step);

}  // namespace thalweg::dem
