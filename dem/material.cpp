#include "dem/material.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::dem {

namespace {

void require(bool good, const char* name, double value, const char* unit, const char* remedy) {
  if (!good) throw InputError(fmt::format("Contact parameter {} is {:g}{}; it must be {}.", name, value, unit, remedy));
}

bool finite_not_negative(double value) { return std::isfinite(value) && value >= 0.0; }

}  // namespace

void check(const ContactParameters& p) {
  require(std::isfinite(p.normal_stiffness) && p.normal_stiffness > 0.0, "normal_stiffness", p.normal_stiffness, " N/m",
          "positive");
  require(finite_not_negative(p.tangential_stiffness), "tangential_stiffness", p.tangential_stiffness, " N/m",
          "zero or positive");
  require(finite_not_negative(p.friction), "friction", p.friction, "", "zero or positive");
  require(finite_not_negative(p.wall_friction), "wall_friction", p.wall_friction, "", "zero or positive");
  if (p.restitution.has_value() == p.damping.has_value())
    throw InputError(p.restitution ? "Contact parameters restitution and damping are both given; give exactly one."
                                   : "Contact parameters restitution and damping are both missing; give exactly one.");
  if (p.restitution)
    require(*p.restitution > 0.0 && *p.restitution <= 1.0, "restitution", *p.restitution, "",
            "greater than 0 and at most 1");
  if (p.damping) require(finite_not_negative(*p.damping), "damping", *p.damping, " kg/s", "zero or positive");
}

double restitution_of_damping_ratio(double zeta, bool attraction) {
  if (attraction) return zeta < 1.0 ? std::exp(-std::numbers::pi * zeta / std::sqrt(1.0 - zeta * zeta)) : 0.0;
  if (zeta < 1.0) {
    const double omega = std::sqrt((1.0 - zeta) * (1.0 + zeta));
    const double phase = std::atan2(2.0 * zeta * omega, (omega - zeta) * (omega + zeta));
    return std::exp(-zeta / omega * (std::numbers::pi - phase));
  }
  if (zeta == 1.0) return std::exp(-2.0);
  const double capital_omega = std::sqrt((zeta - 1.0) * (zeta + 1.0));
  // (beta + Omega)/(beta - Omega) = (beta + Omega)^2 because beta^2 - Omega^2 = 1 in units of omega_0.
  return std::exp(-zeta / capital_omega * 2.0 * std::log(zeta + capital_omega));
}

double damping_ratio_of_restitution(double restitution, bool attraction) {
  if (restitution == 1.0) return 0.0;
  if (attraction) {
    const double loss = -std::log(restitution);
    return loss / std::hypot(std::numbers::pi, loss);
  }
  double lower = 0.0, upper = 1.0;
  while (restitution_of_damping_ratio(upper, false) > restitution) upper *= 2.0;
  for (;;) {
    const double middle = 0.5 * (lower + upper);
    if (middle <= lower || middle >= upper) return middle;
    (restitution_of_damping_ratio(middle, false) > restitution ? lower : upper) = middle;
  }
}

Damping::Damping(const ContactParameters& parameters) : normal_stiffness_(parameters.normal_stiffness) {
  if (parameters.damping)
    constant_ = *parameters.damping;
  else
    damping_ratio_ = damping_ratio_of_restitution(*parameters.restitution, parameters.attraction);
}

double Damping::coefficient(double effective_mass) const {
  return constant_ + 2.0 * damping_ratio_ * std::sqrt(normal_stiffness_ * effective_mass);
}

double effective_mass(double mass_1, bool held_1, double mass_2, bool held_2) {
  if (held_1 == held_2) return mass_1 * mass_2 / (mass_1 + mass_2);
  return held_1 ? mass_2 : mass_1;
}

double contact_time(double normal_stiffness, double effective_mass, double damping) {
  const double omega_0 = std::sqrt(normal_stiffness / effective_mass);
  const double zeta = damping / (2.0 * std::sqrt(normal_stiffness * effective_mass));
  const double omega = zeta < 1.0 ? std::sqrt(1.0 - zeta * zeta) : 0.0;
  return std::numbers::pi / (omega_0 * std::max(omega, zeta));
}

void check_time_step(const ContactParameters& parameters, double effective_mass, double time_step) {
  const double damping = Damping(parameters).coefficient(effective_mass);
  const double longest = contact_time(parameters.normal_stiffness, effective_mass, damping) / fewest_steps_per_contact;
  if (!(time_step > 0.0))
    throw InputError(fmt::format("The time step of the grains is {:g} s; it must be positive.", time_step));
  if (time_step > longest)
    throw InputError(fmt::format("The time step of the grains, {:g} s, is too long for their contacts: it must be at "
                                 "most {:g} s, a {:g}th of the shortest contact time; use more sub-steps or a lower "
                                 "normal stiffness than {:g} N/m.",
                                 time_step, longest, fewest_steps_per_contact, parameters.normal_stiffness));
}

}  // namespace thalweg::dem
