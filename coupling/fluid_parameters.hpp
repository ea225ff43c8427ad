// What the lattice fluid of a system is made of: shared by the fluid alone and the fluid with grains.
#pragma once

#include "core/units.hpp"
#include "coupling/hydrostatic.hpp"
#include "lbm/bouzidi.hpp"
#include "lbm/fluid.hpp"

#include <functional>
#include <optional>

namespace thalweg::coupling {

struct FluidInitialState {
  double density_deviation = 0.0;  // relative: rho/rho_0 - 1
  Vec3 velocity = Vec3::Zero();    // m/s
};

struct FluidParameters {
  Units units;                         // of the lattice
  lbm::CollisionParameters collision;  // lattice units; force included
  lbm::FaceConditions faces;
  std::optional<lbm::FlowTarget> flow_target;  // a mean velocity to hold, in place of the force along its axis
  lbm::LinkOptions links;
  bool full_gravity = false;  // the force acts across walls, too: the fluid begins with its hydrostatic density
  std::function<FluidInitialState(const Vec3&)> initial_fluid;  // of a position in m; empty: at rest
};

// The rest state of the fluid; no density of its own in reduced gravity.
inline Hydrostatic rest_state(const FluidParameters& parameters, const Decomposition& decomposition) {
  const double(&f)[3] = parameters.collision.force;
  return parameters.full_gravity ? hydrostatic_under(Vec3(f[0], f[1], f[2]), decomposition) : Hydrostatic{};
}

// Brings the fluid to the initial state of the parameters. With full gravity the populations get the half force that a
// collision leaves in them, so that a fluid at rest stays so to round-off.
template <typename Real>
void initialise(lbm::Fluid<Real>& fluid, const FluidParameters& parameters, const Hydrostatic& rest) {
  if (!parameters.initial_fluid && rest.none()) return;
  const double(&f)[3] = parameters.collision.force;
  const Vec3 force = rest.none() ? Vec3(Vec3::Zero()) : Vec3(f[0], f[1], f[2]);
  fluid.initialise(
      [&](const Vec3& cell_centre) {
        FluidInitialState s;
        if (parameters.initial_fluid) s = parameters.initial_fluid(cell_centre * parameters.units.spacing);
        return lbm::FluidState{s.density_deviation + rest.deviation(cell_centre),
                               s.velocity / parameters.units.velocity()};
      },
      force);
}

}  // namespace thalweg::coupling
