// Boundary conditions on the six faces of the domain. Lattice units; the rules are in walls.hpp.
#pragma once

#include "core/base/types.hpp"
#include "lbm/walls/law_of_the_wall.hpp"

#include <array>
#include <optional>

namespace thalweg::lbm {

enum class FaceType {
  periodic,
  no_slip,               // half-link bounce-back: the wall is half a cell beyond the last cell centre
  free_slip,             // half-link specular reflection: no tangential stress, mass conserving
  moving,                // no slip on a wall that moves in its own plane
  navier_slip,           // slip velocity = slip length times shear rate
  law_of_the_wall,       // takes the stress that the law of the wall gives for the velocity near it: wall_stress.hpp
  slip_law_of_the_wall,  // Navier slip whose slip velocity follows the local friction velocity (Zhang et al. 2022)
  velocity_inlet,        // fluid of a given velocity enters (or leaves)
  pressure_outlet        // fluid leaves (or enters) at a given density
};

// Rule by which a face reflects the populations that reach it.
enum class Reflection {
  bounce_back,          // reversed
  specular,             // mirrored
  specular_less_shear,  // mirrored, less the stress of the law of the wall
  mixed                 // a fraction reversed, the rest mirrored: Navier's slip
};

// Properties of a type of face, all in one place.
struct FaceTraits {
  int precedence = 3;                                   // at an edge of two faces, the rule of the higher one applies
  bool is_open = false;                                 // lets fluid in or out
  std::optional<Reflection> reflection = std::nullopt;  // none: other populations enter than those that came
  bool has_velocity = false;                            // FaceCondition::velocity
  bool drags = false;                                   // exerts shear on a flow along it
  bool is_smooth = false;                               // carries a boundary layer that follows the law of the wall

  constexpr bool slips() const { return reflection == Reflection::mixed; }
};

constexpr FaceTraits traits_of(FaceType type) {
  switch (type) {
    case FaceType::periodic:
      return {};
    case FaceType::no_slip:
      return {.reflection = Reflection::bounce_back, .drags = true};
    case FaceType::free_slip:
      return {.precedence = 0, .reflection = Reflection::specular};
    case FaceType::moving:
      return {.has_velocity = true, .drags = true};
    case FaceType::navier_slip:
      return {.reflection = Reflection::mixed, .drags = true};
    case FaceType::law_of_the_wall:
      return {.reflection = Reflection::specular_less_shear, .drags = true, .is_smooth = true};
    case FaceType::slip_law_of_the_wall:
      return {.reflection = Reflection::mixed, .drags = true, .is_smooth = true};
    case FaceType::velocity_inlet:
      return {.precedence = 2, .is_open = true, .has_velocity = true};
    case FaceType::pressure_outlet:
      return {.precedence = 1, .is_open = true};
  }
  __builtin_unreachable();
}

constexpr bool is_open(FaceType type) { return traits_of(type).is_open; }

// Slip velocity over friction velocity of a slip_law_of_the_wall. Zhang et al. (2022) print 2.35; their own recipe, the
// tangent of u+ = ln(y+)/0.41 + 5 at y+ = 10.8 taken to the wall, gives 8.36.
constexpr double derived_slip_coefficient = 8.36;

// Coefficient from the tangent at the centre of the first cell, y_plus away from the wall in wall units, if that is
// beyond 10.8, where the profile is flatter.
inline double slip_coefficient_at(double y_plus) {
  return y_plus > 10.8 ? logarithmic_law(y_plus) - 1.0 / karman_constant : derived_slip_coefficient;
}

struct FaceCondition {
  FaceType type = FaceType::periodic;
  double slip_coefficient = derived_slip_coefficient;  // slip_law_of_the_wall
  bool slip_of_first_cell = false;  // slip_law_of_the_wall: slip_coefficient_at the first cell instead
  double slip_length = 0.0;         // navier_slip, cells
  Vec3 velocity = Vec3::Zero();     // moving (in the plane of the face), velocity_inlet
  // velocity_inlet: coordinate of the plane of cells, along the normal of the face, whose flow enters again; none: the
  // velocity is uniform.
  std::optional<int> recycling_plane = std::nullopt;
  double density_deviation = 0.0;  // pressure_outlet: rho - 1
};

// Faces in the order x low, x high, y low, y high, z low, z high.
using FaceConditions = std::array<FaceCondition, 6>;

constexpr int face_of(int axis, bool high) { return 2 * axis + (high ? 1 : 0); }

}  // namespace thalweg::lbm
