// Linear spring and dashpot along the normal, linear spring with friction across it.
//
//   F_n = k_n delta + gamma delta'                      delta' = -v.n; without attraction F_n >= 0
//   F_t = -k_t xi - c gamma v_t,  xi = integral of v_t dt,  |F_t| <= mu |F_n|       c: tangential damping, 0 by default
// In a liquid both dashpots have the film's beside theirs (contact_film.hpp).
#pragma once

#include "dem/laws/contact_film.hpp"
#include "dem/laws/contact_law.hpp"
#include "dem/laws/contact_parameters.hpp"

#include <string>

namespace thalweg::dem {

struct SpringDashpot {
  struct Coefficients {
    double stiffness;             // N/m, k_n
    double tangential_stiffness;  // N/m, k_t
    double damping_ratio;         // of the dashpot over the critical one
    double damping;               // kg/s, beside it
    double friction;              // mu
  };
  struct Constants {
    double critical_damping;  // kg/s, 2 sqrt(k_n m*)
  };
  using History = std::array<double, 3>;  // m, xi
  static constexpr std::array history_parts{HistoryPart{"spring", 3}};
  static constexpr bool rolls = false;

  static constexpr double range() { return 0.0; }
  static Constants constants_of(const ContactBodies& bodies) { return {bodies.critical_damping}; }

  // Springs in series, the friction's geometric mean; with a wall the stiffness is that of the wall's contacts. Without
  // the damping, which the two materials have together (Damping::write_into).
  static Coefficients between(const ContactParameters& a, const ContactParameters& b);
  static Coefficients against_wall(const ContactParameters& grain, const ContactParameters& wall);

  // N/m, k of the dashpot 2 zeta sqrt(k m*) with the damping ratio zeta of material.hpp.
  static double damping_stiffness(const Coefficients& k) { return k.stiffness; }

  static double stiffness_ratio(const Coefficients& k) { return k.tangential_stiffness / k.stiffness; }  // k_t/k_n

  // s, of m* (kg) with the dashpot (kg/s).
  static double contact_time(const Coefficients& k, double damping, double effective_mass, double effective_radius);

  // m, of two grains of one material and diameter (m): under a force (N), and in an impact of an effective mass (kg) at
  // a speed (m/s) without damping.
  static double overlap_under(const ContactParameters& material, double force, double diameter);
  static double overlap_in_impact(const ContactParameters& material, double effective_mass, double speed,
                                  double diameter);
  // Powers of the stiffness: an overlap under a force falls as its inverse, one in an impact and the time of a contact
  // as the inverse of its root.
  static constexpr double overlaps_per_stiffness = 1.0, impacts_per_stiffness = 2.0;

  // The parameter that sets the stiffness, its key, and the unit of the dashpot.
  static constexpr double ContactParameters::*stiffness = &ContactParameters::normal_stiffness;
  static constexpr const char *stiffness_key = "normal_stiffness", *damping_unit = "kg/s";

  static void check(const ContactParameters& parameters);  // throws InputError
  // Property that makes a contact of a grain with another, or with a wall, softer; completes "a lower ..." in a
  // message.
  static std::string softer(const ContactParameters& grain, const ContactParameters& other);
};

// Film: ContactFilm or NoFilm.
template <typename Film>
class SpringDashpotFriction : public SpringDashpot {
public:
  SpringDashpotFriction(const ContactParameters& common, double time_step) : common_(common, time_step) {}

  ContactLoad operator()(const ContactMotion& c, const Coefficients& k, const Constants& constants,
                         History& history) const {
    const double closing = -(c.vx * c.nx + c.vy * c.ny + c.vz * c.nz), critical = constants.critical_damping;
    const double dry = k.damping_ratio * critical + k.damping;
    const Dashpots film = common_.film(c, closing, critical, k.stiffness);
    const double pressed = Film::pressed(k.stiffness * c.overlap + dry * closing, film.along, closing);
    const double normal = pressed > common_.least_normal_force ? pressed : common_.least_normal_force;
    const Friction f =
        friction_of(c, closing, normal, k.friction, k.tangential_stiffness, common_.share_across * dry + film.across,
                    1.0, common_.time_step, {history[0], history[1], history[2]});
    history = {f.spring.x, f.spring.y, f.spring.z};
    return {normal, f.x, f.y, f.z};
  }

  NormalSpring normal_spring(const ContactMotion&, const Coefficients& k) const {
    return {k.stiffness, 1.0, common_.time_step, 1.0};
  }

private:
  SpringsAndDashpots<Film> common_;
};

}  // namespace thalweg::dem
