#include "driver/grain_materials.hpp"

namespace thalweg {
namespace {

dem::ContactParameters changed(dem::ContactParameters p, const MaterialCase& material) {
  p.normal_stiffness = material.normal_stiffness.value_or(p.normal_stiffness);
  p.tangential_stiffness = material.tangential_stiffness.value_or(p.tangential_stiffness);
  p.youngs_modulus = material.youngs_modulus.value_or(p.youngs_modulus);
  p.poisson_ratio = material.poisson_ratio.value_or(p.poisson_ratio);
  if (material.restitution) p.restitution = material.restitution;
  if (material.damping) p.damping = material.damping;
  p.friction = material.friction.value_or(p.friction);
  p.rolling_friction = material.rolling_friction.value_or(p.rolling_friction);
  return p;
}

}  // namespace

std::vector<dem::ContactParameters> materials_of(const Case& c) {
  std::vector<dem::ContactParameters> materials{c.contact};
  for (const PopulationCase& population : c.grains)
    if (population.contact) materials.push_back(changed(materials.front(), *population.contact));
  return materials;
}

int material_of(const Case& c, std::size_t population) {
  if (!c.grains[population].contact) return 0;
  int number = 0;
  for (std::size_t p = 0; p <= population; ++p) number += c.grains[p].contact.has_value();
  return number;
}

std::optional<dem::ContactParameters> wall_material_of(const ContactCase& contact) {
  if (!contact.walls) return std::nullopt;
  return changed(contact, *contact.walls);
}

}  // namespace thalweg
