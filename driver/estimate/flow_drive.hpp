// What drives a flow along the bed or a bare floor: gravity, the pressures of outlets, an inlet.
#pragma once

#include "driver/case/case.hpp"

namespace thalweg::driver {

// The face across x where the water comes in; null: there is none.
const coupling::FaceKeys* inlet_of(const Case& c);

// m/s^2, of gravity along the bed, as far as it drives a flow: walls carry what goes across them, an inlet sets how
// much flows whatever the slope, as does a mean velocity along x, and balanced gravity drives nothing.
Vec3 driving_gravity(const Case& c);

// m/s^2, of different pressures of two outlets opposite each other: (p_low - p_high)/(rho L).
Vec3 driving_pressure(const Case& c);

// m/s^2, of both.
Vec3 driving_acceleration(const Case& c);

// m/s, that fluid gains which enters at an outlet from rest (Bernoulli), sqrt(2 a L); infinite where it passes a
// periodic face.
double speed_through_outlets(const Case& c);

}  // namespace thalweg::driver
