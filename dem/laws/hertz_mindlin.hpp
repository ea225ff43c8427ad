// Elastic spheres: Hertz along the normal, Mindlin's tangential stiffness without slip in its incremental form.
//
//   a = sqrt(R* delta)                                  radius of the contact
//   F_n = 4/3 E* a delta + d sqrt(a) delta'             1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2
//   dF_t = -8 G* a v_t dt                               1/G* = (2 - nu1)/G1 + (2 - nu2)/G2, |F_t| <= mu |F_n|
//
// While the contact unloads, F_t is scaled by a/a_before, so that no energy is made (Thornton, Cummins & Cleary, Powder
// Technology 233 (2013) 30); a_before follows from delta - delta' dt. The dashpot d = zeta sqrt(5 m* 4/3 E*) makes the
// restitution independent of the speed: delta^(5/4) obeys the linear equation with the damping ratio zeta (Antypov &
// Elliott, EPL 94 (2011) 50004), so both closed forms of material.hpp hold exactly. In a liquid it has the film's
// beside it (contact_film.hpp). SI units.
#pragma once

#include "dem/laws/contact_film.hpp"
#include "dem/laws/contact_law.hpp"
#include "dem/laws/contact_parameters.hpp"

#include <string>

namespace thalweg::dem {

struct HertzMindlin {
  struct Coefficients {
    double normal;         // Pa, 4/3 E*
    double tangential;     // Pa, 8 G*
    double damping_ratio;  // zeta
    double damping;        // 0: none beside it
    double friction;       // mu
  };
  struct Constants {
    double critical_damping;  // kg/(s m^1/2), sqrt(5 m* 4/3 E*)
  };
  using History = std::array<double, 3>;                                        // m^2, F_t/(-8 G*)
  static constexpr std::array history_parts{HistoryPart{"mindlin_spring", 3}};  // no spring for the linear law
  static constexpr bool rolls = false;

  static constexpr double range() { return 0.0; }
  static Constants constants_of(const ContactBodies& bodies) { return {bodies.critical_damping}; }

  // Each body with its own moduli.
  static Coefficients between(const ContactParameters& a, const ContactParameters& b);
  static Coefficients against_wall(const ContactParameters& grain, const ContactParameters& wall) {
    return between(grain, wall);
  }

  // Pa, k of the dashpot 2 zeta sqrt(k m*) with the damping ratio zeta of material.hpp.
  static double damping_stiffness(const Coefficients& k) { return 1.25 * k.normal; }

  // k_t/k_n at any overlap.
  static double stiffness_ratio(const Coefficients& k) { return k.tangential / (1.5 * k.normal); }

  // s, of an impact at the speed v = elastic_contact_speed, with whose fifth root it falls: 2.868 (m*^2/(R* E*^2
  // v))^(1/5) (Hertz); m* in kg, R* in m. Divided by the damping ratio where that is above 1.
  static double contact_time(const Coefficients& k, double damping, double effective_mass, double effective_radius);

  // m, of two grains of one material and diameter (m): under a force (N), and in an impact of an effective mass (kg) at
  // a speed (m/s) without damping.
  static double overlap_under(const ContactParameters& material, double force, double diameter);
  static double overlap_in_impact(const ContactParameters& material, double effective_mass, double speed,
                                  double diameter);
  // Powers of the modulus: an overlap under a force falls as its inverse to the 2/3, one in an impact and the time of a
  // contact as its inverse to the 2/5.
  static constexpr double overlaps_per_stiffness = 1.5, impacts_per_stiffness = 2.5;

  // The parameter that sets the stiffness, its key, and the unit of the dashpot.
  static constexpr double ContactParameters::*stiffness = &ContactParameters::youngs_modulus;
  static constexpr const char *stiffness_key = "youngs_modulus", *damping_unit = "kg/(s m^1/2)";

  static void check(const ContactParameters& parameters);  // throws InputError
  // Property that makes a contact of a grain with another, or with a wall, softer; completes "a lower ..." in a
  // message.
  static std::string softer(const ContactParameters& grain, const ContactParameters& other);
};

// Film: ContactFilm or NoFilm.
template <typename Film>
class HertzMindlinFriction : public HertzMindlin {
public:
  HertzMindlinFriction(const ContactParameters& common, double time_step) : common_(common, time_step) {}

  ContactLoad operator()(const ContactMotion& c, const Coefficients& k, const Constants& constants,
                         History& history) const {
    const double closing = -(c.vx * c.nx + c.vy * c.ny + c.vz * c.nz), critical = constants.critical_damping;
    const double overlap = c.overlap > 0.0 ? c.overlap : 0.0;  // rounding may leave a touch without one
    const double a = std::sqrt(c.effective_radius * overlap);
    const double root = std::sqrt(a);
    const double dry = k.damping_ratio * critical + k.damping;
    const Dashpots film = common_.film(c, closing, critical, damping_stiffness(k));
    const double pressed = Film::pressed(k.normal * a * overlap + root * dry * closing, root * film.along, closing);
    const double normal = pressed > common_.least_normal_force ? pressed : common_.least_normal_force;
    const Friction f =
        friction_of(c, closing, normal, k.friction, k.tangential, root * (common_.share_across * dry + film.across),
                    kept(closing, overlap), a * common_.time_step, {history[0], history[1], history[2]});
    history = {f.spring.x, f.spring.y, f.spring.z};
    return {normal, f.x, f.y, f.z};
  }

  NormalSpring normal_spring(const ContactMotion& c, const Coefficients& k) const {
    const double overlap = c.overlap > 0.0 ? c.overlap : 0.0, a = std::sqrt(c.effective_radius * overlap);
    return {1.5 * k.normal, a, a * common_.time_step, kept(-(c.vx * c.nx + c.vy * c.ny + c.vz * c.nz), overlap)};
  }

private:
  // a/a_before where the contact opens.
  double kept(double closing, double overlap) const {
    const double opening = closing < 0.0 ? -closing * common_.time_step : 0.0;
    return opening > 0.0 ? std::sqrt(overlap / (overlap + opening)) : 1.0;
  }

  SpringsAndDashpots<Film> common_;
};

inline constexpr double elastic_contact_speed = 1.0;  // m/s

}  // namespace thalweg::dem
