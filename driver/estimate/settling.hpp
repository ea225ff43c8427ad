// Speeds at which single grains fall through fluid at rest: estimates from the case alone.
#pragma once

#include "driver/case/case.hpp"

namespace thalweg::driver {

// m/s, of one sphere in fluid at rest: weight less buoyancy against the drag of Schiller and Naumann (1933), with a
// drag coefficient of 0.44 above a Reynolds number of 1000. gravity: m/s^2; viscosity: m^2/s. 0 for density ratio 1.
double settling_velocity(double diameter, double density_ratio, double gravity, double viscosity);

// m/s, of the fastest single grain free to move in the fluid at rest; 0 without any.
double settling_velocity(const Case& c);

// m/s, of the largest grain of a population, which falls from rest, and no farther than from one face of the box to
// another: at most what such a fall gives without drag and added mass.
double falling_speed(const Case& c, const beds::Population& grains);

// m/s, of the fastest population free to move; 0 without any.
double falling_speed(const Case& c);

}  // namespace thalweg::driver
