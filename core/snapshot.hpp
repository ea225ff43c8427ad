// What observers and writers may look at: views of a system's state in SI units, never a handle to change it.
#pragma once

#include "core/decomposition.hpp"
#include "core/types.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg {

// The grains this rank owns, in no particular order. Every span has one entry a grain.
struct GrainView {
  std::int64_t global_count = 0;  // over all ranks
  std::span<const GlobalId> id;
  std::span<const double> radius;          // m
  std::span<const double> mass;            // kg
  std::span<const Vec3> position;          // m, inside the box
  std::span<const Vec3> velocity;          // m/s
  std::span<const Vec3> angular_velocity;  // rad/s
  std::span<const Vec3> fluid_force;       // N, as applied during the last step; empty without a fluid
  std::span<const Vec3> fluid_torque;      // N m
  std::span<const Vec3> contact_force;     // N, sum over contacts at the end of the step
};

// Fluid fields of this rank's block, x fastest, sampled on request.
struct FluidFields {
  Block block;
  std::vector<float> velocity;         // m/s, three values a cell (x, y, z together); zero in solid cells
  std::vector<float> pressure;         // Pa above the reference (without the hydrostatic part in reduced gravity)
  std::vector<std::int32_t> grain_id;  // id of the covering grain; -1 fluid
};

class FluidSource {
public:
  virtual ~FluidSource() = default;
  virtual FluidFields sample() const = 0;  // local; call on every rank for a consistent picture
};

struct Snapshot {
  double time = 0.0;  // s
  std::int64_t step = 0;
  const Decomposition* decomposition = nullptr;
  GrainView grains;                    // global_count 0: no grains
  const FluidSource* fluid = nullptr;  // null: no fluid
};

}  // namespace thalweg
