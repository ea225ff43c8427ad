// Fields of the grains in frames.
#pragma once

#include "core/keys/named_choice.hpp"
#include "core/state/snapshot.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace thalweg::io {

// Fields in the order of the arrays in a frame.
enum class GrainField {
  id,
  clump,
  radius,
  speed,
  velocity,
  angular_velocity,
  contact_force,
  contact_stress,
  fluid_force,
  fluid_stress,
  population,
  held,
  density,
  orientation
};

// Fields with the names of their arrays, their units and meanings.
const std::vector<NamedChoice<GrainField>>& grain_fields();

int components_of(GrainField field);

// Properties of the grains of a case that decide which fields exist.
struct GrainFieldFacts {
  bool clumps = false;
  bool fluid_force = false;   // the fluid, or what stands for it, acts on the grains
  bool fluid_stress = false;  // it is resolved around them, and its stress on them can be measured
};
// True if grains with these properties have the field.
bool there_is(GrainField field, const GrainFieldFacts& facts);

// kg/m^3, of grain number n of the view; of a clump's member the density of the clump.
double density_of(const GrainView& grains, std::size_t n);

// Unit quaternion w, x, y, z of grain number n of the view: of a clump's member that of the clump's principal axes; of
// other grains, whose orientation is not known, 1, 0, 0, 0.
std::array<double, 4> orientation_of(const GrainView& grains, std::size_t n);

}  // namespace thalweg::io
