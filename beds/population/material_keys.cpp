#include "beds/population/material_keys.hpp"

#include "core/keys/key_error.hpp"

#include <string>

namespace thalweg::beds {

static void describe_material(SectionVisitor& visit, MaterialKeys& material, bool walls) {
  visit.real("normal_stiffness", material.normal_stiffness,
             {.unit = "N/m", .meaning = "linear law", .above = 0.0, .example = 20000.0});
  visit.real("tangential_stiffness", material.tangential_stiffness,
             {.unit = "N/m", .meaning = "linear law", .at_least = 0.0, .example = 5714.0});
  visit.real("youngs_modulus", material.youngs_modulus,
             {.unit = "Pa", .meaning = "hertz_mindlin", .above = 0.0, .example = 70e9});
  visit.real("poisson_ratio", material.poisson_ratio,
             {.meaning = "hertz_mindlin", .at_least = 0.0, .at_most = 0.5, .example = 0.3});
  visit.real("restitution", material.restitution,
             {.meaning = "where the section contact has one", .above = 0.0, .at_most = 1.0, .example = 0.93});
  visit.real("damping", material.damping,
             {.unit = "kg/s", .meaning = "where the section contact has one", .at_least = 0.0, .example = 0.09});
  if (walls) {
    visit.not_here("friction", "the friction of walls is contact.wall_friction; give it there");
    visit.not_here("rolling_friction", "the rolling friction of walls is contact.wall_rolling_friction; give it there");
    return;
  }
  visit.real("friction", material.friction, {.meaning = "between grains", .at_least = 0.0, .example = 0.5});
  visit.real("rolling_friction", material.rolling_friction,
             {.meaning = "between grains", .at_least = 0.0, .example = 0.05});
}

void describe(SectionVisitor& visit, MaterialKeys& material) { describe_material(visit, material, false); }
void describe(SectionVisitor& visit, WallMaterialKeys& walls) { describe_material(visit, walls, true); }

void describe(SectionVisitor& visit, ContactKeys& contact) {
  describe(visit, contact, contact.given);
  visit.section("walls", contact.walls,
                {.meaning = "contact of grains with walls where it differs from that between grains"});
}

void check(const MaterialKeys& material, const dem::ContactParameters& contact) {
  const auto refuse = [&](bool given, const char* key, const std::string& remedy) {
    if (given) throw KeyError(key, remedy);
  };
  switch (contact.law) {
    case dem::Law::linear: {
      const std::string remedy = "contact.law is linear, which has stiffnesses; remove it or set hertz_mindlin there";
      refuse(material.youngs_modulus.has_value(), "youngs_modulus", remedy);
      refuse(material.poisson_ratio.has_value(), "poisson_ratio", remedy);
      break;
    }
    case dem::Law::hertz_mindlin: {
      const std::string remedy = "contact.law is hertz_mindlin, which has moduli; remove it or set linear there";
      refuse(material.normal_stiffness.has_value(), "normal_stiffness", remedy);
      refuse(material.tangential_stiffness.has_value(), "tangential_stiffness", remedy);
      break;
    }
  }
  refuse(material.damping && !contact.damping, "damping",
         "the section contact gives a restitution; give restitution here, too");
  refuse(material.restitution && !contact.restitution, "restitution",
         "the section contact gives a damping; give damping in kg/s here, too");
}

dem::ContactParameters changed(dem::ContactParameters p, const MaterialKeys& material) {
  if (material.normal_stiffness) {
    p.tangential_stiffness *= *material.normal_stiffness / p.normal_stiffness;
    p.normal_stiffness = *material.normal_stiffness;
  }
  p.tangential_stiffness = material.tangential_stiffness.value_or(p.tangential_stiffness);
  p.youngs_modulus = material.youngs_modulus.value_or(p.youngs_modulus);
  p.poisson_ratio = material.poisson_ratio.value_or(p.poisson_ratio);
  if (material.restitution) p.restitution = material.restitution;
  if (material.damping) p.damping = material.damping;
  p.friction = material.friction.value_or(p.friction);
  p.rolling_friction = material.rolling_friction.value_or(p.rolling_friction);
  return p;
}

std::optional<dem::ContactParameters> wall_material_of(const ContactKeys& contact) {
  if (!contact.walls) return std::nullopt;
  return changed(contact, *contact.walls);
}

}  // namespace thalweg::beds
