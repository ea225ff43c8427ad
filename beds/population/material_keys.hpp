// Keys of contacts: the section `contact`, and the material of a population, or of the walls, where it differs.
#pragma once

#include "core/keys/section_visitor.hpp"
#include "dem/laws/contact_parameters.hpp"

#include <optional>

namespace thalweg::beds {

struct MaterialKeys {
  std::optional<double> normal_stiffness;      // N/m
  std::optional<double> tangential_stiffness;  // N/m
  std::optional<double> youngs_modulus;        // Pa
  std::optional<double> poisson_ratio;         // 1
  std::optional<double> restitution;           // 1
  std::optional<double> damping;               // kg/s
  std::optional<double> friction;              // 1; not of walls, whose friction is contact.wall_friction
  std::optional<double> rolling_friction;      // 1; likewise
  bool operator==(const MaterialKeys&) const = default;
};

struct WallMaterialKeys : MaterialKeys {
  bool operator==(const WallMaterialKeys&) const = default;
};

// The section `contact`: of grains, and of walls as far as nothing else is said.
struct ContactKeys : dem::ContactParameters {
  static constexpr double default_stiffness = 20000.0, default_tangential_stiffness = 5714.0;  // N/m

  ContactKeys() {
    normal_stiffness = default_stiffness;
    tangential_stiffness = default_tangential_stiffness;
    poisson_ratio = 0.3;
    friction = 0.5;
    wall_friction = 0.45;
    attraction = true;
  }
  std::optional<WallMaterialKeys> walls;  // contact of grains with walls, where it differs
  dem::StiffnessKeys given;               // the keys from which the stiffnesses follow

  // Whatever the stiffnesses follow from.
  bool operator==(const ContactKeys& other) const {
    return static_cast<const dem::ContactParameters&>(*this) == other && walls == other.walls;
  }
};

void describe(SectionVisitor& visit, ContactKeys& contact);
void describe(SectionVisitor& visit, MaterialKeys& material);
void describe(SectionVisitor& visit, WallMaterialKeys& walls);

// Throws KeyError unless it fits the law of `contact` and gives the loss, restitution or damping, as that does.
void check(const MaterialKeys& material, const dem::ContactParameters& contact);

// The contact with what the material changes. A material with a normal stiffness alone has the tangential stiffness
// that is the same share of it as in `contact`.
dem::ContactParameters changed(dem::ContactParameters contact, const MaterialKeys& material);

// Material of the walls; empty: each grain's own material.
std::optional<dem::ContactParameters> wall_material_of(const ContactKeys& contact);

}  // namespace thalweg::beds
