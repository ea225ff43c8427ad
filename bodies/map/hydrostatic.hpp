// The density of a lattice fluid at rest under the full force: along axes that end in walls it varies linearly,
//   rho = 1 + 3 F.(x - x_m),   x_m the middle of the box,
// which is the exact rest state of the lattice with a force density that does not depend on rho, halfway walls
// included. Lattice units.
#pragma once

#include "bodies/map/body_options.hpp"
#include "core/base/types.hpp"
#include "core/parallel/decomposition.hpp"

namespace thalweg::bodies {

struct Hydrostatic {
  Vec3 gradient = Vec3::Zero();  // of rho a cell; zero: no hydrostatic pressure in the fluid
  Vec3 middle = Vec3::Zero();    // cells

  double deviation(const Vec3& position) const {
    return gradient.dot(position - middle);
  }  // rho - 1; position in cells
  bool none() const { return gradient.isZero(0.0); }
};

// force: density of the body force on the fluid.
inline Hydrostatic hydrostatic_under(const Vec3& force, const Decomposition& decomposition) {
  Hydrostatic h;
  for (int a = 0; a < 3; ++a) {
    h.gradient[a] = decomposition.periodic()[a] ? 0.0 : 3.0 * force[a];
    h.middle[a] = 0.5 * decomposition.cells()[a];
  }
  return h;
}

// Tells the links.
inline void set_rest(LinkOptions& links, const Hydrostatic& rest) {
  links.rest_gradient = rest.gradient;
  links.rest_middle = rest.middle;
}

}  // namespace thalweg::bodies
