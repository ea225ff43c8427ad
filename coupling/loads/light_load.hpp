// The load of light grains, which weigh little against the fluid that moves along with them.
//
// The exchange is explicit: a grain that begins to move feels the resistance of the fluid only one or two steps later.
// The links summed, that is in one step, over the displaced mass, 3.3 dx/d with bouzidi and 4.3 dx/d with cli, and for
// the spin, over its moment of inertia, 3.5 and 4.6 dx/d. A grain of little mass would be thrown back farther than it
// came: its spin, then its velocity would change sign from step to step and grow. With m_C = 5 dx/d rho_f V added on
// both sides of the law,
//   (m + m_C) a(n) = L(n) + m_C a(n-1),   L: body forces and the mean of two exchanges,
// the old acceleration stands in for what has not come yet (Schwarz, Kempe and Froehlich 2015; Schwarzmeier, Rettinger
// and Ruede 2023, with the m_C of a sphere in an ideal fluid, 1/2 rho_f V, which is too little with few cells and too
// much with many). With A = m a, the load that the grain is given, this is
//   A(n) = A(n-1) + s [L(n) - A(n-1)],   s = m/(m + m_C):
// a filter that passes every impulse in full, only later, by m_C/m steps, and a steady load unchanged. Contacts act on
// m alone, outside the filter, so that a grain at rest on others weighs what it weighs.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/sphere.hpp"

namespace thalweg::coupling {

struct LightLoad {
  double fluid_density;  // kg/m^3
  double spacing;        // m

  // A sphere, or a clump: its mass (kg), the radius of its volume (m), and its width (m), the diameter or the shortest
  // axis of a clump. A rod turns about its long axis as its spheres do, whose resistance goes with dx over their
  // diameter.
  struct Grain {
    double mass, volume_radius, width;
  };

  // m_C, kg. With 4.2 dx/d a sphere of a tenth of the fluid's density broke down at tau = 1.
  double added_mass(const Grain& grain) const {
    return 5.0 * spacing / grain.width * fluid_density * Sphere{grain.volume_radius}.volume();
  }

  // True if a grain needs the filter: without it, the lightest stable grain had 7.2 dx/d of the displaced mass
  // (docs/theory.md, section 3, "Light grains").
  bool concerns(const Grain& grain) const { return grain.mass < 1.6 * added_mass(grain); }

  double share(const Grain& grain) const { return grain.mass / (grain.mass + added_mass(grain)); }  // s

  // A(n) from A(n-1) and L(n).
  static Vec3 filtered(const Vec3& before, const Vec3& load, double share) { return before + share * (load - before); }
};

}  // namespace thalweg::coupling
