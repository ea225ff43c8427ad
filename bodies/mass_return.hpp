// Return of the mass that the fluid lost at a body.
//
// Interpolated bounce-back conserves no mass: it lets some through where the pressure changes along a link, and where
// two grains come together the surface that pushes fluid away is smaller than the one that draws it in, because no cell
// holds the fluid between them. What a body's links and the cells it covers and uncovers have taken is owed to the
// fluid and comes back over the same links in the next steps, as w_i (a + b.c_i) on top of the population that comes
// back along link i. a and b give the mass r and no momentum:
//   sum w_i (a + b.c_i) = r,   sum w_i c_i (a + b.c_i) = 0.
// With S = sum w_i, A = sum w_i c_i, M = sum w_i c_i c_i over the links: b = -a x, M x = A, a = r/(S - A.x). Around a
// grain alone A = 0 and the mass comes back evenly; a grain that others occlude in part gets it back at the edge of the
// occluded patch, where the fluid would be squeezed out. Lattice units.
#pragma once

#include "bodies/map/link_table.hpp"

namespace thalweg::bodies {

// a and b.
struct MassReturn {
  double density = 0.0;
  Vec3 slope = Vec3::Zero();

  double mass(const LinkSums& links) const { return density * links.weight() + slope.dot(links.normal()); }

  // Return of `times` the mass, limited to a density of 1 %: a body with few links returns the rest later.
  MassReturn scaled(double times) const;
};

// Return of a unit of mass; links: of the body, over all ranks. Zero for a body without links.
MassReturn unit_mass_return(const LinkSums& links);

// Mass that one body owes the fluid, settled step by step. Its links return half of it, plus the expected loss of the
// next step: a mean over the last steps in which the latest counts an eighth.
struct MassDebt {
  double owed = 0.0;
  double mean_loss = 0.0;  // a step
  double wanted = 0.0;     // of the last step; the links return the mean of two

  // given: what the links and the cells that changed hands gave to the fluid in this step, came_back with it; links: of
  // the body, over all ranks. Returns what the links are to return in the next step.
  MassReturn settle(double given, double came_back, const LinkSums& links);
};

}  // namespace thalweg::bodies
