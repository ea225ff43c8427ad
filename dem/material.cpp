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
  if (p.law == Law::linear) {
    require(std::isfinite(p.normal_stiffness) && p.normal_stiffness > 0.0, "normal_stiffness", p.normal_stiffness,
            " N/m", "positive");
    require(finite_not_negative(p.tangential_stiffness), "tangential_stiffness", p.tangential_stiffness, " N/m",
            "zero or positive");
  } else {
    require(std::isfinite(p.youngs_modulus) && p.youngs_modulus > 0.0, "youngs_modulus", p.youngs_modulus, " Pa",
            "positive");
    require(p.poisson_ratio > -1.0 && p.poisson_ratio <= 0.5, "poisson_ratio", p.poisson_ratio, "",
            "greater than -1 and at most 0.5");
    if (p.damping) throw InputError("Contact parameter damping is for the linear law; give restitution instead.");
  }
  require(finite_not_negative(p.tangential_damping), "tangential_damping", p.tangential_damping, "",
          "zero or positive");
  require(finite_not_negative(p.friction), "friction", p.friction, "", "zero or positive");
  require(finite_not_negative(p.wall_friction), "wall_friction", p.wall_friction, "", "zero or positive");
  require(finite_not_negative(p.rolling_friction), "rolling_friction", p.rolling_friction, "", "zero or positive");
  require(finite_not_negative(p.wall_rolling_friction), "wall_rolling_friction", p.wall_rolling_friction, "",
          "zero or positive");
  require(finite_not_negative(p.rolling_damping), "rolling_damping", p.rolling_damping, "", "zero or positive");
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

Damping::Damping(const ContactParameters& p) : Damping(coefficients_of(p, p), p) {}

Damping::Damping(const ContactCoefficients& coefficients, const ContactParameters& p)
    : stiffness_(p.law == Law::linear ? coefficients.normal : 1.25 * coefficients.normal) {
  if (p.damping)
    constant_ = *p.damping;
  else
    damping_ratio_ = damping_ratio_of_restitution(*p.restitution, p.attraction);
}

double Damping::coefficient(double effective_mass) const {
  return constant_ + 2.0 * damping_ratio_ * std::sqrt(stiffness_ * effective_mass);
}

namespace {

double harmonic_mean(double a, double b) { return a == b ? a : a > 0.0 && b > 0.0 ? 2.0 * a * b / (a + b) : 0.0; }
double geometric_mean(double a, double b) { return a == b ? a : std::sqrt(a * b); }

double shear_modulus(const ContactParameters& p) { return 0.5 * p.youngs_modulus / (1.0 + p.poisson_ratio); }

}  // namespace

ContactParameters mixed(const ContactParameters& a, const ContactParameters& b) {
  if (a.law != b.law || a.attraction != b.attraction || a.tangential_damping != b.tangential_damping ||
      a.rolling_damping != b.rolling_damping)
    throw InputError(
        "Two materials differ in contact law, attraction, tangential or rolling damping; give all the same.");
  if (a.restitution.has_value() != b.restitution.has_value())
    throw InputError("One material has a restitution and another a damping; give all materials the same of the two.");
  ContactParameters m = a;
  m.normal_stiffness = harmonic_mean(a.normal_stiffness, b.normal_stiffness);
  m.tangential_stiffness = harmonic_mean(a.tangential_stiffness, b.tangential_stiffness);
  if (a.damping) m.damping = harmonic_mean(*a.damping, *b.damping);
  if (a.restitution) m.restitution = geometric_mean(*a.restitution, *b.restitution);
  m.friction = geometric_mean(a.friction, b.friction);
  m.rolling_friction = geometric_mean(a.rolling_friction, b.rolling_friction);
  return m;
}

ContactCoefficients coefficients_of(const ContactParameters& a, const ContactParameters& b) {
  const double friction = geometric_mean(a.friction, b.friction);
  if (a.law == Law::linear)
    return {harmonic_mean(a.normal_stiffness, b.normal_stiffness),
            harmonic_mean(a.tangential_stiffness, b.tangential_stiffness), friction};
  const auto give = [](const ContactParameters& p) {
    return (1.0 - p.poisson_ratio * p.poisson_ratio) / p.youngs_modulus;
  };
  const auto shear_give = [](const ContactParameters& p) { return (2.0 - p.poisson_ratio) / shear_modulus(p); };
  return {4.0 / 3.0 / (give(a) + give(b)), 8.0 / (shear_give(a) + shear_give(b)), friction};
}

MaterialTable::MaterialTable(std::span<const ContactParameters> materials,
                             const std::optional<ContactParameters>& walls)
    : count_(static_cast<int>(materials.size())),
      law_(materials.front().law),
      manner_{materials.front().attraction, materials.front().tangential_damping, 0.0},
      rolling_damping_(materials.front().rolling_damping) {
  for (const ContactParameters& material : materials) check(material);
  if (walls) check(*walls);
  for (const ContactParameters& a : materials) {
    for (const ContactParameters& b : materials) {
      const ContactCoefficients coefficients = coefficients_of(a, b);
      const ContactParameters both = mixed(a, b);
      pairs_.push_back({coefficients, Damping(coefficients, both), both.rolling_friction});
      rolling_friction_ = rolling_friction_ || both.rolling_friction > 0.0;
    }
    // Linear stiffnesses are those of the contact with the wall; moduli those of the wall's material.
    if (walls) mixed(a, *walls);
    const ContactParameters& wall = walls ? *walls : a;
    const ContactCoefficients coefficients =
        law_ == Law::linear ? coefficients_of(wall, wall) : coefficients_of(a, wall);
    walls_.push_back({coefficients, Damping(coefficients, wall), 0.0});  // the plane's, as its friction
  }
}

ContactManner MaterialTable::manner(double time_step) const {
  ContactManner manner = manner_;
  manner.time_step = time_step;
  return manner;
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

double contact_time(const ContactParameters& parameters, double effective_mass, double effective_radius) {
  if (parameters.law == Law::linear)
    return contact_time(parameters.normal_stiffness, effective_mass, Damping(parameters).coefficient(effective_mass));
  return elastic_contact_time(coefficients_of(parameters, parameters), effective_mass, effective_radius);
}

double elastic_contact_time(const ContactCoefficients& coefficients, double effective_mass, double effective_radius) {
  const double modulus = 0.75 * coefficients.normal;
  return 2.868 *
         std::pow(effective_mass * effective_mass / (effective_radius * modulus * modulus * elastic_contact_speed),
                  0.2);
}

namespace {

void refuse_longer(double time_step, double contact_time, const ContactParameters& parameters) {
  const double longest = contact_time / fewest_steps_per_contact;
  if (!(time_step > 0.0))
    throw InputError(fmt::format("The time step of the grains is {:g} s; it must be positive.", time_step));
  if (time_step <= longest) return;
  const std::string softer = parameters.law == Law::linear
                                 ? fmt::format("normal stiffness than {:g} N/m", parameters.normal_stiffness)
                                 : fmt::format("Young's modulus than {:g} Pa", parameters.youngs_modulus);
  throw InputError(
      fmt::format("The time step of the grains, {:g} s, is too long for their contacts: it must be at "
                  "most {:g} s, a {:g}th of the shortest contact time; use more sub-steps or a lower {}.",
                  time_step, longest, fewest_steps_per_contact, softer));
}

}  // namespace

void check_time_step(const ContactParameters& parameters, double effective_mass, double effective_radius,
                     double time_step) {
  refuse_longer(time_step, contact_time(parameters, effective_mass, effective_radius), parameters);
}

void check_wall_time_step(const ContactParameters& parameters, const ContactParameters& wall, double mass,
                          double radius, double time_step) {
  if (parameters.law == Law::linear)
    refuse_longer(time_step, contact_time(wall, mass, radius), wall);
  else
    refuse_longer(time_step, elastic_contact_time(coefficients_of(parameters, wall), mass, radius), parameters);
}

}  // namespace thalweg::dem
