// The film of liquid between grains that touch, as a dashpot.
//
// Spheres that meet slowly in a liquid hardly rebound. Against walls and against each other they keep of the dry
// restitution (Joseph et al. 2001; Gondret, Lance and Petit 2002; Yang and Hunt 2006)
//   exp(-35/St),   St = m* v/(6 pi eta R*^2),   R* = R1 R2/(R1 + R2), R against a wall.
// A lattice resolves what the film takes from a fast impact, while it is cells thick, but not the end of a slow one: at
// St = 80 and below it leaves all of the dry restitution. Beside the dashpot of the dry collision there is therefore
//   gamma = 2 sqrt(k m*)/[1 + (St/15)^2]
// with the present speed in St: critical where St is small, nothing in an impact that is fast. It does not hold grains
// together: as they part it takes no more than the spring gives. The constant 15 is fixed on rebounds at St = 17 to 150
// (benchmarks/validation/rebound_in_water). The film also keeps a bed at rest: grains on springs softer than glass
// would rattle on them.
//
// Across the contact, 2/7 of it: critical for a rolling grain, of which 2/7 of the mass counts, on a spring 2/7 as
// stiff.
#pragma once

#include "dem/laws/contact_law.hpp"
#include "dem/laws/contact_parameters.hpp"

#include <numbers>

namespace thalweg::dem {

inline constexpr double film_stokes_number = 15.0;

// m/s: the speed with this St of two bodies. Pa s, kg (m*), m (R*).
inline double film_speed(double viscosity, double effective_mass, double effective_radius) {
  return film_stokes_number * 6.0 * std::numbers::pi * viscosity * effective_radius * effective_radius / effective_mass;
}

// Beside the dashpots of the dry contact: kg/s, or of elastic spheres kg/(s m^1/2).
struct Dashpots {
  double along, across;
};

class ContactFilm {
public:
  static constexpr double share_across = 2.0 / 7.0;

  explicit ContactFilm(double viscosity)  // Pa s, above 0
      : viscosity_(viscosity) {}

  // closing: -v.n, m/s; critical: 2 sqrt(k m*), kg/s; stiffness: k, N/m (or both of elastic spheres, material.hpp).
  Dashpots operator()(const ContactMotion& c, double closing, double critical, double stiffness) const {
    const double mass = critical * critical / (4.0 * stiffness);  // m*
    const double speed = film_speed(viscosity_, mass, c.effective_radius);
    const double film = speed * speed, speed_squared = c.vx * c.vx + c.vy * c.vy + c.vz * c.vz;
    return {critical * (film / (film + closing * closing)), share_across * critical * (film / (film + speed_squared))};
  }

  // N, along the normal: without the film, and with its dashpot.
  static double pressed(double dry, double along, double closing) {
    const double with = dry + along * closing, least = dry < 0.0 ? dry : 0.0;
    return with > least ? with : least;
  }

private:
  double viscosity_;  // Pa s
};

// Stands in for it without a liquid.
struct NoFilm {
  explicit NoFilm(double /*viscosity*/) {}
  Dashpots operator()(const ContactMotion&, double, double, double) const { return {0.0, 0.0}; }
  static double pressed(double dry, double /*along*/, double /*closing*/) { return dry; }
};

// Numbers that the laws with springs and dashpots share. Film: ContactFilm or NoFilm.
template <typename Film>
struct SpringsAndDashpots {
  // common: of any material; time_step: s, with 0 the springs do not grow: a force without history.
  SpringsAndDashpots(const ContactParameters& common, double step)
      : film(common.film_viscosity),
        least_normal_force(common.least_normal_force()),
        share_across(common.tangential_damping),
        time_step(step) {}

  Film film;
  double least_normal_force;  // N
  double share_across;        // c: of the dry dashpot along the normal, across it
  double time_step;           // s
};

}  // namespace thalweg::dem
