// The parameters of a contact (material.hpp has the equations).
#pragma once

#include "core/keys/named_choice.hpp"

#include <limits>
#include <optional>
#include <vector>

namespace thalweg {
class SectionVisitor;
}

namespace thalweg::dem {

enum class Law { linear, hertz_mindlin };
std::vector<NamedChoice<Law>> choices_of(Law);  // its words in a case file

// Parameters of liquid_bridge.hpp, the same for all materials of a run.
struct LiquidBridgeParameters {
  double surface_tension = 0.0;  // N/m, >= 0
  double contact_angle = 0.0;    // rad, from 0 to below pi/2
  double volume = 0.0;           // m^3, > 0, of each bridge
  bool operator==(const LiquidBridgeParameters&) const = default;
};

// One material, in contact with itself.
struct ContactParameters {
  Law law = Law::linear;                // the same for all materials of a run, as are the last six
  double normal_stiffness = 0.0;        // N/m, > 0; linear law
  double tangential_stiffness = 0.0;    // N/m, >= 0; linear law
  double youngs_modulus = 0.0;          // Pa, > 0; Hertz and Mindlin
  double poisson_ratio = 0.0;           // > -1, at most 1/2; Hertz and Mindlin
  std::optional<double> restitution;    // 0 < e <= 1; exactly one of restitution and damping is given
  std::optional<double> damping;        // kg/s, >= 0, of every contact; linear law
  double friction = 0.0;                // between grains, >= 0
  double wall_friction = 0.0;           // between a grain and a wall, >= 0: the default of the planes in walls.hpp
  double rolling_friction = 0.0;        // between grains, >= 0; 0: none (rolling_friction.hpp)
  double wall_rolling_friction = 0.0;   // between a grain and a wall, >= 0: the default of the planes
  double kinetic_friction_ratio = 1.0;  // friction of contacts that slide over that of those that stick, > 0, <= 1
  double rolling_damping = 0.3;         // over the critical one, >= 0
  bool attraction = false;              // true if the dashpot may pull at the end of the contact
  double tangential_damping = 0.0;      // dashpot across the contact over the one along the normal, >= 0
  std::optional<LiquidBridgeParameters> liquid_bridge;  // none: dry
  double film_viscosity = 0.0;  // Pa s, of the liquid around all grains (contact_film.hpp); 0: none
  bool operator==(const ContactParameters&) const = default;

  double least_normal_force() const { return attraction ? -std::numeric_limits<double>::infinity() : 0.0; }  // N
};

// Duration of a collision, half a period of the spring with its dashpot; exactly one of the two is given.
struct ContactDuration {
  std::optional<double> seconds;
  std::optional<double> fluid_steps;
  bool operator==(const ContactDuration&) const = default;
};

// Keys of the stiffness of a linear contact, from which that of ContactParameters follows.
struct StiffnessKeys {
  std::optional<double> normal, tangential;  // N/m
  std::optional<ContactDuration> duration;   // in place of `normal`
};

// The keys of a case's section `contact`.
void describe(SectionVisitor& visit, ContactParameters& contact, StiffnessKeys& stiffness);

// Throws InputError naming the first parameter that is impossible.
void check(const ContactParameters& parameters);

// Checks for laws: throw InputError with name, value and remedy unless the parameter is good.
void require(bool good, const char* name, double value, const char* unit, const char* remedy);
void require_not_negative(const char* name, double value, const char* unit);

}  // namespace thalweg::dem
