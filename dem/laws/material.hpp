// The materials of a contact, and how its damping follows from the restitution coefficient.
//
// Linear spring and dashpot, m* x'' + gamma x' + k x = 0: omega_0^2 = k/m*, zeta = gamma / (2 sqrt(k m*)),
// beta = zeta omega_0, omega = omega_0 sqrt(1 - zeta^2). The restitution depends on zeta alone and on how the contact
// ends (Schwager & Poeschel, Granular Matter 9 (2007) 465):
//   at zero overlap (the dashpot may pull):   e = exp(-pi beta/omega)
//   at zero force (no attraction):            e = exp{-(beta/omega) [pi - atan2(2 beta omega, omega^2 - beta^2)]},
//                         for zeta > 1:       e = exp{-(beta/Omega) ln[(beta + Omega)/(beta - Omega)]},
//                                             Omega = sqrt(beta^2 - omega_0^2).
//
// Elastic spheres (hertz_mindlin.hpp) have the same restitution with zeta of their own dashpot.
#pragma once

#include "dem/laws/contact_laws.hpp"

#include <cstring>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::dem {

// e of a damping ratio zeta >= 0; attraction allows zeta < 1 only (beyond, the grains never part: 0).
double restitution_of_damping_ratio(double zeta, bool attraction);

// The inverse: zeta of 0 < e <= 1. Without attraction by bisection, to the last bit.
double damping_ratio_of_restitution(double restitution, bool attraction);

// The dashpot coefficient of a contact: kg/s, or kg/(s m^1/2) of elastic spheres.
class Damping {
public:
  explicit Damping(const ContactParameters& parameters);  // parameters must have passed check()
  Damping(double stiffness, const ContactParameters& parameters);

  // effective_mass (kg): m1 m2/(m1 + m2) of two grains, m of a grain against a wall.
  double coefficient(double effective_mass) const { return damping_ratio_ * critical(effective_mass) + constant_; }
  // Critical coefficient, 2 sqrt(k m*), of a contact that just does not oscillate.
  double critical(double effective_mass) const;

  // Writes the two terms of coefficient() for a law.
  template <typename Coefficients>
  void write_into(Coefficients& k) const {
    k.damping_ratio = damping_ratio_;
    k.damping = constant_;
  }

private:
  double stiffness_;            // of the square root: damping_stiffness() of the law
  double constant_ = 0.0;       // kg/s, where the user gave it
  double damping_ratio_ = 0.0;  // zeta, where the user gave a restitution
};

// The contact of two bodies of different materials. Springs in series: stiffnesses and dashpots by the harmonic mean;
// frictions and restitution by the geometric mean; moduli are kept apart (hertz_mindlin.hpp). Throws InputError where
// one has a restitution and the other a damping, or where law, attraction, tangential or rolling damping, kinetic
// friction ratio or liquid bridges differ.
ContactParameters mixed(const ContactParameters& a, const ContactParameters& b);

double harmonic_mean(double a, double b);  // 0 where either is 0
double geometric_mean(double a, double b);

// All pairs of materials, and each against the walls.
class MaterialTable {
public:
  struct Entry {
    std::vector<double> coefficients;  // of the law
    Damping damping;
    double rolling_friction;
  };

  // walls: what walls are made of; empty: of each grain's own material. Their friction is the plane's. Throws
  // InputError for a material that is impossible or cannot be mixed.
  MaterialTable(std::span<const ContactParameters> materials, const std::optional<ContactParameters>& walls);

  int count() const { return count_; }
  const Entry& pair(int a, int b) const { return pairs_[static_cast<std::size_t>(a) * count_ + b]; }
  const Entry& wall(int material) const { return walls_[material]; }
  // Parameters that all materials have in common: law, attraction, tangential and rolling damping, kinetic friction
  // ratio, liquid bridges, film.
  const ContactParameters& common() const { return common_; }
  bool rolling_friction() const { return rolling_friction_; }  // true if any pair of grains has it

private:
  int count_;
  ContactParameters common_;
  bool rolling_friction_ = false;
  std::vector<Entry> pairs_, walls_;
};

// Coefficients as the law reads them.
template <typename Coefficients>
Coefficients coefficients_of(const MaterialTable::Entry& entry) {
  Coefficients coefficients;
  std::memcpy(&coefficients, entry.coefficients.data(), sizeof(Coefficients));
  return coefficients;
}

// m1 m2/(m1 + m2); a grain that is held moves as if its mass were infinite.
double effective_mass(double mass_1, bool held_1, double mass_2, bool held_2);

// The time a contact must be resolved in (s): t_c = pi/omega, or pi/beta where the damping is faster than the spring.
double contact_time(double normal_stiffness, double effective_mass, double damping);

// N/m: the normal stiffness with which a linear contact of this effective mass (kg) lasts so long (s): half a period of
// the spring with its dashpot, t_c = pi/sqrt(k/m* - (gamma/(2 m*))^2); pi/beta where that is shorter and there is no
// attraction: the force is then over long before half a period, which grows without limit towards zeta = 1.
double stiffness_lasting(double duration, const ContactParameters& parameters, double effective_mass);

// Contact time (s) of any law, between grains of one material and against a wall of another. effective_radius: m, used
// by elastic spheres only.
double contact_time(const ContactParameters& parameters, double effective_mass, double effective_radius);
double wall_contact_time(const ContactParameters& parameters, const ContactParameters& wall, double mass,
                         double radius);

// Sub-steps a contact time needs at least.
inline constexpr double fewest_steps_per_contact = 20.0;

// The longest time step (s) of such contacts: a twentieth of the contact time, or a tenth of the time of sliding or
// rolling against their springs and dashpots, if that is shorter.
double longest_step(const ContactParameters& parameters, double effective_mass, double effective_radius);
double longest_wall_step(const ContactParameters& parameters, const ContactParameters& wall, double mass,
                         double radius);

// Relative amount by which a step may exceed its longest: rounding of a quotient.
inline constexpr double rounding_of_a_step = 1e-9;

// Throws InputError if the time step (s) is longer than longest_step().
void check_time_step(const ContactParameters& parameters, double effective_mass, double effective_radius,
                     double time_step);

// check_time_step() for contacts with walls.
void check_wall_time_step(const ContactParameters& parameters, const ContactParameters& wall, double mass,
                          double radius, double time_step);

}  // namespace thalweg::dem
