// The force of one contact: linear spring and dashpot along the normal, Cundall and Strack's spring with Coulomb's
// limit across it (Cundall & Strack, Geotechnique 29 (1979) 47), no tangential dashpot.
//
//   F_n = k_n delta + gamma delta'                      delta: overlap, delta' = -v.n; without attraction F_n >= 0
//   F_t = -k_t xi,   xi = integral of v_t dt            |F_t| <= mu |F_n|, xi shortened to it while the contact slides
//
// v is the velocity of the first body's surface against the second's at the contact, n the unit normal from the second
// body to the first; xi is turned into the present tangent plane, keeping its length, before v_t dt is added.
// Force on the first body: F_n n + F_t. SI units.
#pragma once

#include <cmath>
#include <limits>

namespace thalweg::dem {

// Plain values and no branches, so that a loop over contacts in arrays is vectorised by the compiler.
struct ContactMotion {
  double overlap;        // m
  double nx, ny, nz;     // unit normal
  double vx, vy, vz;     // m/s
};

struct TangentialSpring {
  double x, y, z;        // m: the displacement xi
};

struct ContactForce {
  double normal;         // N, positive pushes the bodies apart
  double tx, ty, tz;     // N: F_t
  TangentialSpring spring;
};

class SpringDashpotFriction {
public:
  // Stiffnesses in N/m. With time_step 0 (s) the spring does not grow: a force without history.
  SpringDashpotFriction(double normal_stiffness, double tangential_stiffness, bool attraction, double time_step)
      : kn_(normal_stiffness), kt_(tangential_stiffness), time_step_(time_step),
        least_(attraction ? -std::numeric_limits<double>::infinity() : 0.0) {}

  // damping: kg/s; friction: mu; spring: as the last evaluation left it (zero in a new contact).
  ContactForce operator()(const ContactMotion& c, double damping, double friction,
                          const TangentialSpring& spring) const {
    const double closing = -(c.vx * c.nx + c.vy * c.ny + c.vz * c.nz);
    const double pressed = kn_ * c.overlap + damping * closing;
    const double normal = pressed > least_ ? pressed : least_;

    const double off = spring.x * c.nx + spring.y * c.ny + spring.z * c.nz;
    const double px = spring.x - off * c.nx, py = spring.y - off * c.ny, pz = spring.z - off * c.nz;
    const double length2 = spring.x * spring.x + spring.y * spring.y + spring.z * spring.z;
    const double projected2 = px * px + py * py + pz * pz;
    const double stretch = projected2 > 0.0 ? std::sqrt(length2 / projected2) : 0.0;
    const double x = stretch * px + time_step_ * (c.vx + closing * c.nx);
    const double y = stretch * py + time_step_ * (c.vy + closing * c.ny);
    const double z = stretch * pz + time_step_ * (c.vz + closing * c.nz);

    const double tangential = kt_ * std::sqrt(x * x + y * y + z * z);
    const double limit = friction * std::fabs(normal);
    const double hold = tangential > limit ? limit / tangential : 1.0;
    const TangentialSpring held{hold * x, hold * y, hold * z};
    return {normal, -kt_ * held.x, -kt_ * held.y, -kt_ * held.z, held};
  }

private:
  double kn_, kt_, time_step_, least_;
};

}  // namespace thalweg::dem
