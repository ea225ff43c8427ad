// What every contact law is made of: its arguments, its result, and the friction across the contact (Cundall & Strack,
// Geotechnique 29 (1979) 47), which all laws share. A law is one functor: spring_dashpot.hpp, hertz_mindlin.hpp.
//
// v is the velocity of the first body's surface against the second's at the contact, n the unit normal from the second
// body to the first, delta the overlap. Force on the first body: F_n n + F_t. SI units.
#pragma once

#include <cmath>
#include <limits>

namespace thalweg::dem {

// Plain values and no branches, so that a loop over contacts in arrays is vectorised by the compiler.
struct ContactMotion {
  double overlap;           // m
  double nx, ny, nz;        // unit normal
  double vx, vy, vz;        // m/s
  double effective_radius;  // m, R1 R2/(R1 + R2); R against a wall
};

// Of a pair of materials; what the numbers mean is the law's business.
struct ContactCoefficients {
  double normal;      // linear: k_n, N/m;  Hertz: 4/3 E*, Pa
  double tangential;  // linear: k_t, N/m;  Hertz: 8 G*, Pa
  double friction;    // mu
};

struct TangentialSpring {
  double x, y, z;  // linear: displacement xi, m;  Hertz: xi times contact radius, m^2
};

struct ContactForce {
  double normal;      // N, positive pushes the bodies apart
  double tx, ty, tz;  // N: F_t
  TangentialSpring spring;
};

// How contacts end, and what the tangential dashpot is.
struct ContactManner {
  bool attraction = true;           // whether the normal dashpot may pull
  double tangential_damping = 0.0;  // tangential dashpot over normal dashpot
  double time_step = 0.0;           // s; with 0 the springs do not grow: a force without history

  double least_normal_force() const { return attraction ? -std::numeric_limits<double>::infinity() : 0.0; }
};

// The spring is turned into the present tangent plane, keeping its length (to the fourth order of the angle, which is
// that of one sub-step), shortened by `keep` and grown by growth v_t; F_t = -stiffness xi - damping v_t, both shortened
// to |F_t| <= mu |F_n| while the contact slides. closing: -v.n.
inline ContactForce with_friction(const ContactMotion& c, double closing, double normal, double friction,
                                  double stiffness, double damping, double keep, double growth,
                                  const TangentialSpring& spring) {
  const double off = spring.x * c.nx + spring.y * c.ny + spring.z * c.nz;
  const double px = spring.x - off * c.nx, py = spring.y - off * c.ny, pz = spring.z - off * c.nz;
  const double length2 = spring.x * spring.x + spring.y * spring.y + spring.z * spring.z;
  // 1/sqrt(1 - q) of the square q of the angle's sine, to first order: never more than 3/2, whatever rounding left.
  const double stretch = length2 > 0.0 ? keep * (1.0 + 0.5 * (off * off / length2)) : 0.0;
  const double ux = c.vx + closing * c.nx, uy = c.vy + closing * c.ny, uz = c.vz + closing * c.nz;
  const double x = stretch * px + growth * ux, y = stretch * py + growth * uy, z = stretch * pz + growth * uz;

  const double fx = stiffness * x + damping * ux, fy = stiffness * y + damping * uy, fz = stiffness * z + damping * uz;
  const double tangential = std::sqrt(fx * fx + fy * fy + fz * fz), limit = friction * std::fabs(normal);
  const double hold = tangential > limit ? limit / tangential : 1.0;
  // What is left of the spring when the dashpot keeps its share of the shortened force.
  const double share = damping > 0.0 && stiffness > 0.0 ? (1.0 - hold) * damping / stiffness : 0.0;
  return {normal,
          -hold * fx,
          -hold * fy,
          -hold * fz,
          {hold * x - share * ux, hold * y - share * uy, hold * z - share * uz}};
}

}  // namespace thalweg::dem
