// Keys of the fluid at the start, and the state that follows from them.
#pragma once

#include "core/base/types.hpp"
#include "core/keys/section_visitor.hpp"
#include "coupling/keys/fluid_parameters.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

namespace thalweg::coupling {

// Random eddies without divergence on top of a profile.
struct PerturbationKeys {
  double amplitude = 1.0;  // root mean square of a component over the shear velocity, away from walls
  std::int64_t seed = 1;
  bool operator==(const PerturbationKeys&) const = default;
};

// u(z) = (shear_velocity / 0.41) ln((z - bed_height) / roughness) along x above the bed, zero below. A case may leave
// out any of the three; what reads it fills them in before initial_fluid() is called.
struct LogProfileKeys {
  std::optional<double> bed_height;      // m above the bottom
  std::optional<double> shear_velocity;  // m/s, negative towards -x
  std::optional<double> roughness;       // m, the height where the velocity is zero
  std::optional<PerturbationKeys> perturbation;
  bool operator==(const LogProfileKeys&) const = default;
};

// Velocity profile: zero up to `lower`, linear up to `velocity` at `upper`, constant above.
struct LinearProfileKeys {
  double lower = 0.0, upper = 0.0;  // m above the bottom
  Vec3 velocity = Vec3::Zero();     // m/s
  bool operator==(const LinearProfileKeys&) const = default;
};

// Initial states, of which a case has at most one; none: at rest.
struct InitialFluidKeys {
  std::optional<Vec3> uniform;  // m/s
  std::optional<LinearProfileKeys> linear_profile;
  std::optional<LogProfileKeys> log_profile;
  int count() const { return (uniform ? 1 : 0) + (linear_profile ? 1 : 0) + (log_profile ? 1 : 0); }
  bool operator==(const InitialFluidKeys&) const = default;
};

void describe(SectionVisitor& visit, InitialFluidKeys& fluid);

// The state at a position (m); empty: at rest. spacing: m, of the cells.
std::function<FluidInitialState(const Vec3&)> initial_fluid(const InitialFluidKeys& fluid, const Index3& cells,
                                                            const std::array<bool, 3>& periodic, double spacing);

}  // namespace thalweg::coupling
