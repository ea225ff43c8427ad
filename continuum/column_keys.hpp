// Keys of a two-phase column in a case (system: continuum): the sections fluid, grains, column, closures and creep.
#pragma once

#include "continuum/continuum_system.hpp"
#include "core/keys/section_visitor.hpp"

#include <cstdint>
#include <optional>

namespace thalweg::continuum {

struct FluidPhaseKeys {
  double density = 0.0;              // kg/m^3
  double kinematic_viscosity = 0.0;  // m^2/s
  bool operator==(const FluidPhaseKeys&) const = default;
};
void describe(SectionVisitor& visit, FluidPhaseKeys& fluid);

struct GrainPhaseKeys {
  double diameter = 0.0;  // m
  double density = 0.0;   // kg/m^3
  bool operator==(const GrainPhaseKeys&) const = default;
};
void describe(SectionVisitor& visit, GrainPhaseKeys& grains);

struct HeightKeys {
  std::optional<double> shields_number;  // 1, or
  std::optional<double> depth;           // m, of clear water over the bed at the start
  double bed = 5.0;                      // diameters, at the start
  std::int64_t cells_per_diameter = 10;  // wanted
  ColumnStart start = ColumnStart::flow;
  bool operator==(const HeightKeys&) const = default;
};
void describe(SectionVisitor& visit, HeightKeys& height);

// The closures, with what in them follows from grains and gravity unless it is given.
struct ClosureKeys {
  Closures closures;
  std::optional<double> elastic_modulus = {};  // Pa; else 2633 (rho_s - rho_f) g d
  std::optional<double> creeping_rate = {};    // 1/s; else 3.63e-5 v/d, v the shear_speed() of the mixture
  bool operator==(const ClosureKeys&) const = default;
};
void describe(SectionVisitor& visit, ClosureKeys& keys);
void describe(SectionVisitor& visit, CreepParameters& creep);

struct ContinuumKeys {
  FluidPhaseKeys fluid;
  GrainPhaseKeys grains;
  HeightKeys column;
  ClosureKeys closures;
  std::optional<CreepParameters> creep;
  bool operator==(const ContinuumKeys&) const = default;
};

// Parameters that follow from keys that pass check() and gravity (m/s^2: along the bed, downwards into it). The height
// of a cell is rounded so that a whole number of cells fills the water. tau* = rho_f g_x h/((rho_s - rho_f) g d), g the
// magnitude of gravity.
SystemParameters system_parameters(const ContinuumKeys& keys, double gravity_x, double gravity_z);

// Throws KeyError where the keys do not fit together.
void check(const ContinuumKeys& keys, double gravity_x, double gravity_z);

}  // namespace thalweg::continuum
