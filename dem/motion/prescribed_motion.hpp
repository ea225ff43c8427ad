// A motion that is given as a function of time, of a wall or of a rigid assembly of grains (a bumpy wall, a plate, a
// drum): it moves, swings and turns about an axis that moves along.
//
//   x(t) = s(t) + c + Rot(a, w t) (x(0) - c),   s(t) = u t + A [sin(2 pi f t + phi) - sin(phi)]
//
// A place follows from the time and the place at the start alone: nothing adds up over the steps, and a restart goes on
// with the same bits. SI units.
#pragma once

#include "core/base/types.hpp"

namespace thalweg::dem {

struct Oscillation {
  Vec3 amplitude = Vec3::Zero();  // m
  double frequency = 0.0;         // Hz
  double phase = 0.0;             // rad; pi/2 begins at rest

  bool swings() const { return frequency > 0.0 && !amplitude.isZero(0.0); }
  bool operator==(const Oscillation&) const = default;
};

struct PrescribedMotion {
  Vec3 velocity = Vec3::Zero();  // u, m/s
  Oscillation oscillation;
  Vec3 centre = Vec3::Zero();     // c, m: any point of the axis at the start
  Vec3 axis = Vec3::UnitZ();      // a, unit
  double angular_velocity = 0.0;  // w, rad/s

  bool moves() const;  // false if it is at rest for ever
  bool turns() const { return angular_velocity != 0.0; }
  Mat3 turn(double time) const;                               // Rot(a, w t)
  Vec3 displacement(double time) const;                       // s, m
  Vec3 place(const Vec3& at_start, double time) const;        // m
  Vec3 velocity_of(const Vec3& at_start, double time) const;  // m/s
  Vec3 spin() const { return angular_velocity * axis; }       // rad/s

  // Upper bounds of the speed (m/s): of a point at this distance (m) from the axis; of a plane along this unit vector.
  double largest_speed(double distance) const;
  double largest_speed_along(const Vec3& direction) const;
};

// Throws InputError unless all numbers are finite, the axis is a unit vector and the frequency is not negative.
void check(const PrescribedMotion& motion);

}  // namespace thalweg::dem
