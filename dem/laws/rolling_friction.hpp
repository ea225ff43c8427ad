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

#include "dem/laws/contact_law.hpp"
#include "dem/laws/contact_parameters.hpp"

#include <array>
#include <cmath>
#include <string_view>
#include <tuple>

namespace thalweg::dem {

struct RollingCoefficients {
  double friction;       // mu_r
  double damping_ratio;  // zeta_r
  double inertia;        // kg m^2, I_r
};

struct RollingMoment {
  double x, y, z;  // N m, on the first body
  TangentialSpring spring;
};

// normal: F_n, N; spring: as the last evaluation left it.
inline RollingMoment rolling_moment(const ContactMotion& c, double normal, const NormalSpring& k,
                                    const RollingCoefficients& rolling, const TangentialSpring& spring) {
  const double arm = rolling.friction * c.effective_radius, stiffness = 2.25 * k.stiffness * arm * arm;
  const double dashpot = 2.0 * rolling.damping_ratio * std::sqrt(rolling.inertia * stiffness * k.scale);
  ContactMotion turning = c;
  turning.vx = c.wx, turning.vy = c.wy, turning.vz = c.wz;
  const double along = -(c.wx * c.nx + c.wy * c.ny + c.wz * c.nz);
  const Friction f = friction_of(turning, along, normal, arm, stiffness, dashpot, k.keep, k.growth, spring);
  return {f.x, f.y, f.z, f.spring};
}

// Name of the rolling spring beside the law's own. That of elastic spheres is an angle times the contact radius, which
// the linear law cannot take over, nor the other way round.
constexpr const char* rolling_part_beside(const HistoryPart& spring) {
  return std::string_view(spring.name) == "spring" ? "rolling" : "mindlin_rolling";
}

// Another law with rolling friction.
template <typename Inner>
class WithRollingFriction {
public:
  using Coefficients = typename Inner::Coefficients;
  struct Constants {
    typename Inner::Constants inner;
    double friction, inertia;  // mu_r; kg m^2, I_r
  };
  static constexpr std::size_t of_inner = std::tuple_size_v<typename Inner::History>;
  using History = std::array<double, of_inner + 3>;  // after the law's: theta, rad; of elastic spheres a theta, m rad
  static constexpr std::array history_parts =
      joined(Inner::history_parts, HistoryPart{rolling_part_beside(Inner::history_parts.front()), 3});
  static constexpr bool rolls = true;

  WithRollingFriction(const Inner& inner, const ContactParameters& common)
      : inner_(inner), damping_ratio_(common.rolling_damping) {}

  double range() const { return inner_.range(); }
  static Constants constants_of(const ContactBodies& bodies) {
    return {Inner::constants_of(bodies), bodies.rolling_friction, bodies.rolling_inertia};
  }

  ContactLoad operator()(const ContactMotion& c, const Coefficients& k, const Constants& constants,
                         History& history) const {
    auto kept = first_of<of_inner>(history);
    ContactLoad load = inner_(c, k, constants.inner, kept);
    const RollingMoment m = rolling_moment(c, load.normal, inner_.normal_spring(c, k),
                                           {constants.friction, damping_ratio_, constants.inertia},
                                           {history[of_inner], history[of_inner + 1], history[of_inner + 2]});
    load.mx = m.x, load.my = m.y, load.mz = m.z;
    history = appended(kept, m.spring.x, m.spring.y, m.spring.z);
    return load;
  }

private:
  Inner inner_;
  double damping_ratio_;
};

}  // namespace thalweg::dem
