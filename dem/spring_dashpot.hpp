// Linear spring and dashpot along the normal, linear spring with friction across it.
//
//   F_n = k_n delta + gamma delta'                      delta' = -v.n; without attraction F_n >= 0
//   F_t = -k_t xi - c gamma v_t,  xi = integral of v_t dt,  |F_t| <= mu |F_n|       c: tangential damping, 0 by default
#pragma once

#include "dem/rolling_friction.hpp"

namespace thalweg::dem {

class SpringDashpotFriction {
public:
  explicit SpringDashpotFriction(const ContactManner& manner)
      : least_(manner.least_normal_force()), share_(manner.tangential_damping), time_step_(manner.time_step) {}

  // damping: gamma, kg/s; spring: as the last evaluation left it (zero in a new contact).
  ContactForce operator()(const ContactMotion& c, const ContactCoefficients& k, double damping,
                          const TangentialSpring& spring) const {
    const double closing = -(c.vx * c.nx + c.vy * c.ny + c.vz * c.nz);
    const double pressed = k.normal * c.overlap + damping * closing;
    const double normal = pressed > least_ ? pressed : least_;
    return with_friction(c, closing, normal, k.friction, k.tangential, share_ * damping, 1.0, time_step_, spring);
  }

  NormalSpring normal_spring(const ContactMotion&, const ContactCoefficients& k) const {
    return {k.normal, 1.0, time_step_, 1.0};
  }

private:
  double least_, share_, time_step_;
};

}  // namespace thalweg::dem
