#include "dem/laws/spring_dashpot.hpp"

#include "dem/laws/material.hpp"

#include <fmt/format.h>

#include <cmath>

namespace thalweg::dem {

SpringDashpot::Coefficients SpringDashpot::between(const ContactParameters& a, const ContactParameters& b) {
  return {harmonic_mean(a.normal_stiffness, b.normal_stiffness),
          harmonic_mean(a.tangential_stiffness, b.tangential_stiffness), 0.0, 0.0,
          geometric_mean(a.friction, b.friction)};
}

SpringDashpot::Coefficients SpringDashpot::against_wall(const ContactParameters& /*grain*/,
                                                        const ContactParameters& wall) {
  return between(wall, wall);
}

double SpringDashpot::contact_time(const Coefficients& k, double damping, double effective_mass,
                                   double /*effective_radius*/) {
  return dem::contact_time(k.stiffness, effective_mass, damping);
}

double SpringDashpot::overlap_under(const ContactParameters& material, double force, double /*diameter*/) {
  return force / material.normal_stiffness;
}

double SpringDashpot::overlap_in_impact(const ContactParameters& material, double effective_mass, double speed,
                                        double /*diameter*/) {
  return speed * std::sqrt(effective_mass / material.normal_stiffness);
}

void SpringDashpot::check(const ContactParameters& p) {
  require(std::isfinite(p.normal_stiffness) && p.normal_stiffness > 0.0, "normal_stiffness", p.normal_stiffness, " N/m",
          "positive");
  require_not_negative("tangential_stiffness", p.tangential_stiffness, " N/m");
}

std::string SpringDashpot::softer(const ContactParameters& /*grain*/, const ContactParameters& p) {
  return fmt::format("normal stiffness than {:g} N/m", p.normal_stiffness);
}

}  // namespace thalweg::dem
