// What the lattice fluid of a system is made of: shared by the fluid alone and the fluid with grains.
#pragma once

#include "core/units.hpp"
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
  std::function<FluidInitialState(const Vec3&)> initial_fluid;  // of a position in m; empty: at rest
};

// Brings the fluid to the initial state of the parameters.
template <typename Real>
void initialise(lbm::Fluid<Real>& fluid, const FluidParameters& parameters) {
  if (!parameters.initial_fluid) return;
  fluid.initialise([&](const Vec3& cell_centre) {
    const FluidInitialState s = parameters.initial_fluid(cell_centre * parameters.units.spacing);
    return lbm::FluidState{s.density_deviation, s.velocity / parameters.units.velocity()};
  });
}

}  // namespace thalweg::coupling
