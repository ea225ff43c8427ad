// Elastic spheres: Hertz along the normal, Mindlin's tangential stiffness without slip in its incremental form.
//
//   a = sqrt(R* delta)                                  radius of the contact
//   F_n = 4/3 E* a delta + d sqrt(a) delta'             1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2
//   dF_t = -8 G* a v_t dt                               1/G* = (2 - nu1)/G1 + (2 - nu2)/G2, |F_t| <= mu |F_n|
//
// While the contact unloads, F_t is scaled by a/a_before, so that no energy is made (Thornton, Cummins & Cleary, Powder
// Technology 233 (2013) 30); a_before follows from delta - delta' dt. The dashpot d = zeta sqrt(5 m* 4/3 E*) makes the
// restitution independent of the speed: delta^(5/4) obeys the linear equation with the damping ratio zeta (Antypov &
// Elliott, EPL 94 (2011) 50004), so both closed forms of material.hpp hold exactly. SI units.
#pragma once

#include "dem/rolling_friction.hpp"

namespace thalweg::dem {

class HertzMindlin {
public:
  explicit HertzMindlin(const ContactManner& manner)
      : least_(manner.least_normal_force()), share_(manner.tangential_damping), time_step_(manner.time_step) {}

  // damping: d, kg/(s m^1/2); spring: F_t/(-8 G*), as the last evaluation left it (zero in a new contact).
  ContactForce operator()(const ContactMotion& c, const ContactCoefficients& k, double damping,
                          const TangentialSpring& spring) const {
    const double closing = -(c.vx * c.nx + c.vy * c.ny + c.vz * c.nz);
    const double overlap = c.overlap > 0.0 ? c.overlap : 0.0;  // rounding may leave a touch without one
    const double a = std::sqrt(c.effective_radius * overlap);
    const double dashpot = damping * std::sqrt(a);
    const double pressed = k.normal * a * overlap + dashpot * closing;
    const double normal = pressed > least_ ? pressed : least_;
    return with_friction(c, closing, normal, k.friction, k.tangential, share_ * dashpot, kept(closing, overlap),
                         a * time_step_, spring);
  }

  NormalSpring normal_spring(const ContactMotion& c, const ContactCoefficients& k) const {
    const double overlap = c.overlap > 0.0 ? c.overlap : 0.0, a = std::sqrt(c.effective_radius * overlap);
    return {1.5 * k.normal, a, a * time_step_, kept(-(c.vx * c.nx + c.vy * c.ny + c.vz * c.nz), overlap)};
  }

private:
  // a/a_before where the contact opens.
  double kept(double closing, double overlap) const {
    const double opening = closing < 0.0 ? -closing * time_step_ : 0.0;
    return opening > 0.0 ? std::sqrt(overlap / (overlap + opening)) : 1.0;
  }

  double least_, share_, time_step_;
};

}  // namespace thalweg::dem
