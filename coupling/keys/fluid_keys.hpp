// Keys of the fluid, in SI units.
#pragma once

#include "core/keys/section_visitor.hpp"
#include "lbm/collision/collision_parameters.hpp"

#include <optional>

namespace thalweg::coupling {

enum class Precision { single, double_ };

// A mean velocity of the fluid that the body force is steered to, in place of gravity along that axis. The force is
// that of a mean pressure gradient (with the fluid's weight along the axis, which it carries as well).
struct FlowTargetKeys {
  double velocity = 0.0;       // m/s, along x
  double response_time = 0.0;  // s
  bool on_grains = true;       // grains feel the pressure gradient, too; else the force acts on the fluid alone
  bool operator==(const FlowTargetKeys&) const = default;
};

struct FluidKeys {
  double density = 0.0;                            // kg/m^3
  double kinematic_viscosity = 0.0;                // m^2/s
  std::optional<lbm::SubgridModel> subgrid_model;  // read as smagorinsky with its constant, else qr
  std::optional<double> smagorinsky_constant;      // 1
  std::optional<double> time_step;                 // s; read as the longest that suits the flow
  lbm::CollisionModel collision = lbm::CollisionModel::trt_at_bodies;
  std::optional<double> magic_parameter;  // of trt and trt_at_bodies; else CollisionTraits::usual_magic_parameter
  // 1, of the trace of the stress; 0: as the shear's. Read as 1 with bgk or trt_at_bodies and a subgrid model,
  // else 0.
  std::optional<double> bulk_relaxation_time;
  Precision precision = Precision::single;
  std::optional<FlowTargetKeys> mean_velocity;
  bool operator==(const FluidKeys&) const = default;

  lbm::Subgrid subgrid() const;
  // Writes out what follows from other keys, so that a case that is kept means the same later: the subgrid model and
  // its constant, and the magic parameter.
  void fill_in_models();
  double magic() const { return magic_parameter.value_or(lbm::traits_of(collision).usual_magic_parameter); }
};

void describe(SectionVisitor& visit, FluidKeys& fluid);

}  // namespace thalweg::coupling
