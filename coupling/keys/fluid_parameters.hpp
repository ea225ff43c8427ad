// Parameters of the lattice fluid of a system, with or without grains.
#pragma once

#include "bodies/links/interpolated_bounce_back.hpp"
#include "bodies/map/hydrostatic.hpp"
#include "core/base/ramp.hpp"
#include "core/base/units.hpp"
#include "lbm/fluid/fluid.hpp"

#include <algorithm>
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
  bool target_moves_grains = false;            // the force that holds it acts on the volume of grains, too
  bodies::BodyOptions bodies;
  bool full_gravity = false;  // the force acts across walls, too: the fluid begins with its hydrostatic density
  double ramp = 0.0;          // steps in which gravity rises from zero; 0: it is there at once
  std::function<FluidInitialState(const Vec3&)> initial_fluid;  // of a position in m; empty: at rest
};

// The part of gravity that acts in a step, numbered from 1: the mean of the ramp over it. 0 for the number 0, before
// the first.
inline double gravity_factor(const FluidParameters& parameters, std::int64_t step) {
  const auto end = static_cast<double>(step);
  return ramp_mean(end - 1.0, end, parameters.ramp);
}

// Gives the fluid the force of that step; what a flow target steers stays as it is.
template <typename Real>
void set_gravity(lbm::Fluid<Real>& fluid, const FluidParameters& parameters, std::int64_t step) {
  if (parameters.ramp == 0.0) return;
  const double factor = gravity_factor(parameters, step);
  Vec3 force = factor * parameters.collision.force;
  if (parameters.flow_target) {
    const int axis = parameters.flow_target->axis;
    force[axis] = fluid.parameters().force[axis];
  }
  fluid.set_force(force);
}

// No face lets fluid in or out.
inline bool closed(const lbm::FaceConditions& faces) {
  return std::none_of(faces.begin(), faces.end(),
                      [](const lbm::FaceCondition& face) { return lbm::is_open(face.type); });
}

// The rest state of the fluid: hydrostatic with full gravity, uniform with reduced gravity.
inline bodies::Hydrostatic rest_state(const FluidParameters& parameters, const Decomposition& decomposition) {
  return parameters.full_gravity ? bodies::hydrostatic_under(parameters.collision.force, decomposition)
                                 : bodies::Hydrostatic{};
}

// Brings the fluid to the initial state of the parameters.
template <typename Real>
void initialise(lbm::Fluid<Real>& fluid, const FluidParameters& parameters, const bodies::Hydrostatic& rest) {
  fluid.initialise([&](const Vec3& cell_centre) {
    FluidInitialState s;
    if (parameters.initial_fluid) s = parameters.initial_fluid(cell_centre * parameters.units.spacing);
    return lbm::FluidState{s.density_deviation + rest.deviation(cell_centre), s.velocity / parameters.units.velocity()};
  });
}

}  // namespace thalweg::coupling
