// Linear spring and dashpot along the normal, linear spring with friction across it.
//
//   F_n = k_n delta + gamma delta'                      delta' = -v.n; without attraction F_n >= 0
//   F_t = -k_t xi - c gamma v_t,  xi = integral of v_t dt,  |F_t| <= mu |F_n|       c: tangential damping, 0 by default
#pragma once

#include "dem/contact_law.hpp"
#include "dem/contact_parameters.hpp"

#include <string>

namespace thalweg::dem {

class SpringDashpotFriction {
public:
  struct Coefficients {
    double stiffness;             // N/m, k_n
    double tangential_stiffness;  // N/m, k_t
    double friction;              // mu
  };
  struct Constants {
    double damping;  // kg/s, gamma
  };
  using History = std::array<double, 3>;  // m, xi
  static constexpr std::array history_parts{HistoryPart{"spring", 3}};
  static constexpr bool rolls = false;

  // common: of any material; time_step: s, with 0 the springs do not grow: a force without history.
  SpringDashpotFriction(const ContactParameters& common, double time_step)
      : least_(common.least_normal_force()), share_(common.tangential_damping), time_step_(time_step) {}

  static constexpr double range() { return 0.0; }
  static Constants constants_of(const ContactBodies& bodies) { return {bodies.damping}; }

  ContactLoad operator()(const ContactMotion& c, const Coefficients& k, const Constants& constants,
                         History& history) const {
    const double closing = -(c.vx * c.nx + c.vy * c.ny + c.vz * c.nz);
    const double pressed = k.stiffness * c.overlap + constants.damping * closing;
    const double normal = pressed > least_ ? pressed : least_;
    const Friction f = friction_of(c, closing, normal, k.friction, k.tangential_stiffness, share_ * constants.damping,
                                   1.0, time_step_, {history[0], history[1], history[2]});
    history = {f.spring.x, f.spring.y, f.spring.z};
    return {normal, f.x, f.y, f.z};
  }

  NormalSpring normal_spring(const ContactMotion&, const Coefficients& k) const {
    return {k.stiffness, 1.0, time_step_, 1.0};
  }

  // Springs in series, the friction's geometric mean; with a wall the stiffness is that of the wall's contacts.
  static Coefficients between(const ContactParameters& a, const ContactParameters& b);
  static Coefficients against_wall(const ContactParameters& grain, const ContactParameters& wall);

  // N/m, k of the dashpot 2 zeta sqrt(k m*) with the damping ratio zeta of material.hpp.
  static double damping_stiffness(const Coefficients& k) { return k.stiffness; }

  // s, of m* (kg) with the dashpot (kg/s).
  static double contact_time(const Coefficients& k, double damping, double effective_mass, double effective_radius);

  static void check(const ContactParameters& parameters);  // throws InputError
  // What makes a contact of a grain and another, or a wall, softer; completes "a lower ..." in a message.
  static std::string softer(const ContactParameters& grain, const ContactParameters& other);

private:
  double least_, share_, time_step_;
};

}  // namespace thalweg::dem
