// What observers and writers may look at: views of a system's state in SI units, never a handle to change it.
#pragma once

#include "core/decomposition.hpp"
#include "core/types.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace thalweg {

// The grains this rank owns, in no particular order. Every span has one entry a grain.
struct GrainView {
  std::int64_t global_count = 0;  // over all ranks
  double disk_thickness = 0.0;    // m; 0: spheres
  std::span<const GlobalId> id;
  std::span<const double> radius;          // m
  std::span<const double> mass;            // kg
  std::span<const Vec3> position;          // m, inside the box
  std::span<const Vec3> velocity;          // m/s
  std::span<const Vec3> angular_velocity;  // rad/s
  std::span<const Vec3> fluid_force;       // N, as applied during the last step; empty without a fluid
  std::span<const Vec3> fluid_torque;      // N m
  std::span<const Vec3> contact_force;     // N, sum over contacts at the end of the step
  std::span<const Vec3> contact_torque;    // N m, about the grain's centre
};

enum class FluidField { velocity, pressure, grain_id, density, shear_rate, eddy_viscosity, vorticity, q_criterion };

// Fluid fields of this rank's block, x fastest, sampled on request; empty where not asked for. Zero in solid cells.
struct FluidFields {
  Block block;
  std::vector<float> velocity;         // m/s, three values a cell (x, y, z together)
  std::vector<float> pressure;         // Pa above the reference (without the hydrostatic part in reduced gravity)
  std::vector<std::int32_t> grain_id;  // id of the covering grain; -1 fluid; -2, -3, ... static solids
  std::vector<float> density;          // kg/m^3
  std::vector<float> shear_rate;       // 1/s, sqrt(2 S_ab S_ab) of the subgrid model
  std::vector<float> eddy_viscosity;   // m^2/s
  std::vector<float> vorticity;        // 1/s, three values a cell
  std::vector<float> q_criterion;      // 1/s^2
};

constexpr int components_of(FluidField field) {
  return field == FluidField::velocity || field == FluidField::vorticity ? 3 : 1;
}

// The values of any field but grain_id. Throws std::logic_error for that one.
std::vector<float>& values_of(FluidFields& fields, FluidField field);
const std::vector<float>& values_of(const FluidFields& fields, FluidField field);

class FluidSource {
public:
  virtual ~FluidSource() = default;
  virtual FluidFields sample(const std::vector<FluidField>& wanted) const = 0;  // collective

  // Calls visit(cell, velocity) for every fluid cell this rank owns: global cell, m/s in full precision.
  using VelocityVisitor = std::function<void(const Index3&, const Vec3&)>;
  virtual void for_each_velocity(const VelocityVisitor& visit) const = 0;
};

struct Snapshot {
  double time = 0.0;  // s
  std::int64_t step = 0;
  const Decomposition* decomposition = nullptr;
  GrainView grains;                    // global_count 0: no grains
  const FluidSource* fluid = nullptr;  // null: no fluid
};

}  // namespace thalweg
