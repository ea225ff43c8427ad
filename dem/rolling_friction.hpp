// Rolling friction: an elastic-plastic spring and dashpot against the rolling of one body over the other, model C of
// Ai, Chen, Rotter & Ooi, Powder Technology 206 (2011) 269, in its vector form.
//
//   M = -k_r theta - c_r w,   theta = integral of w dt, turned with the contact;   |M| <= mu_r R_r |F_n|
//   k_r = 2.25 k_n (mu_r R_r)^2,  c_r = 2 zeta_r sqrt(I_r k_r),  R_r = R1 R2/(R1 + R2),
//   1/I_r = 1/(I1 + m1 R1^2) + 1/(I2 + m2 R2^2)
//
// w is the spin of the first body against the second without its part along the normal (twisting is free); M acts on
// the first, -M on the second. It is the spring that lets a grain rest on a slope: a moment of constant size would not
// know which way to act. While the contact rolls, spring and dashpot together are cut to the limit, as friction is
// (contact_law.hpp). k_n is the stiffness of the contact at its overlap: of elastic spheres 3/2 of 4/3 E* a, their
// theta growing and relaxing with the contact radius a as their tangential spring does. SI units.
#pragma once

#include "dem/contact_law.hpp"

#include <cmath>

namespace thalweg::dem {

struct RollingCoefficients {
  double friction;       // mu_r
  double damping_ratio;  // zeta_r
  double inertia;        // kg m^2, I_r
};

// How the normal spring of a law resists more overlap: stiffness scale (N/m over the unit of scale), and what the
// rolling spring grows by per angle and keeps in this step.
struct NormalSpring {
  double stiffness;  // k_n = stiffness * scale
  double scale;      // 1, or the contact radius, m
  double growth;     // scale times the time step
  double keep;
};

struct RollingMoment {
  double x, y, z;  // N m, on the first body
  TangentialSpring spring;
};

// spin: of the first body against the second, rad/s; normal: F_n, N; spring: as the last evaluation left it.
inline RollingMoment rolling_moment(const ContactMotion& c, double wx, double wy, double wz, double normal,
                                    const NormalSpring& k, const RollingCoefficients& rolling,
                                    const TangentialSpring& spring) {
  const double arm = rolling.friction * c.effective_radius, stiffness = 2.25 * k.stiffness * arm * arm;
  const double dashpot = 2.0 * rolling.damping_ratio * std::sqrt(rolling.inertia * stiffness * k.scale);
  ContactMotion turning = c;
  turning.vx = wx, turning.vy = wy, turning.vz = wz;
  const double along = -(wx * c.nx + wy * c.ny + wz * c.nz);
  const ContactForce f = with_friction(turning, along, normal, arm, stiffness, dashpot, k.keep, k.growth, spring);
  return {f.tx, f.ty, f.tz, f.spring};
}

}  // namespace thalweg::dem
