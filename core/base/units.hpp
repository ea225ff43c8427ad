// Conversion between SI and lattice units.
//
// The lattice unit of length is the spacing dx, of time the fluid step dt, and of density the fluid's rho; every other
// unit follows: velocity dx/dt, force rho dx^4/dt^2, torque rho dx^5/dt^2, stress rho dx^2/dt^2.
#pragma once

namespace thalweg {

struct Units {
  double spacing;    // m
  double time_step;  // s
  double density;    // kg/m^3

  double velocity() const { return spacing / time_step; }                       // m/s per lattice unit
  double acceleration() const { return spacing / (time_step * time_step); }     // m/s^2 per lattice unit
  double kinematic_viscosity() const { return spacing * spacing / time_step; }  // m^2/s per lattice unit
  double stress() const { return density * velocity() * velocity(); }           // Pa per lattice unit
  double force() const { return stress() * spacing * spacing; }                 // N per lattice unit
  double torque() const { return force() * spacing; }                           // N m per lattice unit

  // BGK relaxation time of a fluid of kinematic viscosity nu (m^2/s): tau = 1/2 + 3 nu dt/dx^2.
  double relaxation_time(double nu) const { return 0.5 + 3.0 * nu / kinematic_viscosity(); }
};

}  // namespace thalweg
