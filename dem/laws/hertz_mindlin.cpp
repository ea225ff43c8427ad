#include "dem/laws/hertz_mindlin.hpp"

#include "core/base/error.hpp"
#include "dem/laws/material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::dem {

namespace {

double shear_modulus(const ContactParameters& p) { return 0.5 * p.youngs_modulus / (1.0 + p.poisson_ratio); }

// Pa, of two bodies of the same material (Hertz).
double effective_modulus(const ContactParameters& p) {
  return p.youngs_modulus / (2.0 * (1.0 - p.poisson_ratio * p.poisson_ratio));
}

}  // namespace

HertzMindlin::Coefficients HertzMindlin::between(const ContactParameters& a, const ContactParameters& b) {
  const auto give = [](const ContactParameters& p) {
    return (1.0 - p.poisson_ratio * p.poisson_ratio) / p.youngs_modulus;
  };
  const auto shear_give = [](const ContactParameters& p) { return (2.0 - p.poisson_ratio) / shear_modulus(p); };
  return {4.0 / 3.0 / (give(a) + give(b)), 8.0 / (shear_give(a) + shear_give(b)), 0.0, 0.0,
          geometric_mean(a.friction, b.friction)};
}

double HertzMindlin::contact_time(const Coefficients& k, double damping, double effective_mass,
                                  double effective_radius) {
  const double modulus = 0.75 * k.normal, zeta = 0.5 * damping / std::sqrt(damping_stiffness(k) * effective_mass);
  const double elastic =
      std::pow(effective_mass * effective_mass / (effective_radius * modulus * modulus * elastic_contact_speed), 0.2);
  return 2.868 * elastic / std::max(1.0, zeta);
}

double HertzMindlin::overlap_under(const ContactParameters& material, double force, double diameter) {
  return std::pow(0.75 * force / (effective_modulus(material) * std::sqrt(0.25 * diameter)), 2.0 / 3.0);
}

double HertzMindlin::overlap_in_impact(const ContactParameters& material, double effective_mass, double speed,
                                       double diameter) {
  return std::pow(
      15.0 * effective_mass * speed * speed / (16.0 * effective_modulus(material) * std::sqrt(0.25 * diameter)), 0.4);
}

void HertzMindlin::check(const ContactParameters& p) {
  require(std::isfinite(p.youngs_modulus) && p.youngs_modulus > 0.0, "youngs_modulus", p.youngs_modulus, " Pa",
          "positive");
  require(p.poisson_ratio > -1.0 && p.poisson_ratio <= 0.5, "poisson_ratio", p.poisson_ratio, "",
          "greater than -1 and at most 0.5");
  if (p.damping) throw InputError("Contact parameter damping is for the linear law; give restitution instead.");
}

std::string HertzMindlin::softer(const ContactParameters& p, const ContactParameters& /*other*/) {
  return fmt::format("Young's modulus than {:g} Pa", p.youngs_modulus);
}

}  // namespace thalweg::dem
