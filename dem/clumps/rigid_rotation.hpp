// Rotation of a free rigid body in one time step.
//
// The state is the orientation Q (a unit quaternion, from the frame of the principal axes to space) and the angular
// momentum L in space, which is constant in free motion. The kinetic energy is split into its parts L_k^2/(2 I_k), each
// of which alone turns the body about its principal axis k by the angle dt l_k/I_k, l = Q^-1 L; the symmetric sequence
// 3, 2, 1, 2, 3 of half, half, whole, half and half steps is symplectic, reversible and of second order: the energy
// oscillates about its value by a fraction of order (w dt)^2 and does not drift, and L does not change. Dullweber,
// Leimkuhler & McLachlan, J. Chem. Phys. 107 (1997) 5840; with quaternions it is NO_SQUISH of Miller et al., J. Chem.
// Phys. 116 (2002) 8649. SI units.
#pragma once

#include "core/base/types.hpp"

#include <Eigen/Core>

namespace thalweg::dem {

struct Quaternion {
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
};

Quaternion product(const Quaternion& a, const Quaternion& b);  // first b, then a
Quaternion normalised(const Quaternion& q);

// Turns a vector of the body's frame into space; its transpose turns it back.
Eigen::Matrix3d rotation_matrix(const Quaternion& q);

// w = Q I^-1 Q^-1 L, rad/s. moments: kg m^2, about the principal axes.
Vec3 angular_velocity_of(const Quaternion& q, const Vec3& angular_momentum, const Vec3& moments);
// L = Q I Q^-1 w, kg m^2/s.
Vec3 angular_momentum_of(const Quaternion& q, const Vec3& angular_velocity, const Vec3& moments);

// The orientation after a time step (s) of free rotation.
Quaternion freely_turned(const Quaternion& q, const Vec3& angular_momentum, const Vec3& moments, double time_step);

// The orientation after a time step at a given angular velocity (rad/s).
Quaternion turned(const Quaternion& q, const Vec3& angular_velocity, double time_step);

}  // namespace thalweg::dem
