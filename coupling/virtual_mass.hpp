// Virtual mass of light grains: keeps the exchange with the fluid, which is explicit, stable where a grain weighs
// little against the fluid that it has to move along.
//
// The force of the fluid lags behind and contains the reaction -m_a a to the grain's own acceleration, m_a = 1/2 rho_f
// V for a sphere. Where m_a/m is large, that alone would be unstable. With a virtual mass m_v on both sides of the law,
//   (m + m_v) a(n) = L(n) + m_v a(n-1),   L: load of the fluid and body forces,
// the old acceleration stands in for the reaction (Schwarzmeier, Rettinger and Ruede 2023, J. Comput. Phys. 477,
// 111958). With A = m a, the load that the grain is given, this is
//   A(n) = A(n-1) + s [L(n) - A(n-1)],   s = m/(m + m_v):
// a filter that passes every impulse in full, only later, and a steady load unchanged. With the mean of two exchanges
// and m_v = m_a an error in a decays at least by half every two steps, however light the grain. Contacts act on m
// alone, outside the filter, so that a grain at rest on others weighs what it weighs.
#pragma once

#include "core/types.hpp"

#include <numbers>

namespace thalweg::coupling {

struct VirtualMass {
  double coefficient = 0.5;    // m_v over the mass of the displaced fluid
  double fluid_density = 0.0;  // kg/m^3

  // s of a sphere; kg, m. Its moment of inertia against that of the displaced fluid gives the same s.
  double share(double mass, double radius) const {
    return mass / (mass + coefficient * fluid_density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius);
  }

  // A(n) from A(n-1) and L(n).
  static Vec3 filtered(const Vec3& before, const Vec3& load, double share) { return before + share * (load - before); }
};

}  // namespace thalweg::coupling
