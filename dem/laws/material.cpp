#include "dem/laws/material.hpp"

#include "core/base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::dem {

void check(const ContactParameters& p) {
  with_spring_law(p.law, [&](auto spring) { decltype(spring)::type::check(p); });
  require_not_negative("tangential_damping", p.tangential_damping, "");
  require_not_negative("friction", p.friction, "");
  require_not_negative("wall_friction", p.wall_friction, "");
  require(p.kinetic_friction_ratio > 0.0 && p.kinetic_friction_ratio <= 1.0, "kinetic_friction_ratio",
          p.kinetic_friction_ratio, "", "greater than 0 and at most 1");
  require_not_negative("rolling_friction", p.rolling_friction, "");
  require_not_negative("wall_rolling_friction", p.wall_rolling_friction, "");
  require_not_negative("rolling_damping", p.rolling_damping, "");
  if (p.restitution.has_value() == p.damping.has_value())
    throw InputError(p.restitution ? "Contact parameters restitution and damping are both given; give exactly one."
                                   : "Contact parameters restitution and damping are both missing; give exactly one.");
  if (p.restitution)
    require(*p.restitution > 0.0 && *p.restitution <= 1.0, "restitution", *p.restitution, "",
            "greater than 0 and at most 1");
  if (p.damping) require_not_negative("damping", *p.damping, " kg/s");
  if (p.liquid_bridge) check(*p.liquid_bridge);
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

namespace {

std::vector<double> as_doubles(const auto& coefficients) {
  std::vector<double> values(doubles_in<std::decay_t<decltype(coefficients)>>);
  std::memcpy(values.data(), &coefficients, sizeof(coefficients));
  return values;
}

double damping_stiffness(const ContactParameters& p) {
  return with_spring_law(p.law, [&](auto spring) {
    using Spring = typename decltype(spring)::type;
    return Spring::damping_stiffness(Spring::between(p, p));
  });
}

}  // namespace

Damping::Damping(const ContactParameters& p) : Damping(damping_stiffness(p), p) {}

Damping::Damping(double stiffness, const ContactParameters& p) : stiffness_(stiffness) {
  if (p.damping)
    constant_ = *p.damping;
  else
    damping_ratio_ = damping_ratio_of_restitution(*p.restitution, p.attraction);
}

double Damping::critical(double effective_mass) const { return 2.0 * std::sqrt(stiffness_ * effective_mass); }

double harmonic_mean(double a, double b) { return a == b ? a : a > 0.0 && b > 0.0 ? 2.0 * a * b / (a + b) : 0.0; }
double geometric_mean(double a, double b) { return a == b ? a : std::sqrt(a * b); }

ContactParameters mixed(const ContactParameters& a, const ContactParameters& b) {
  if (a.law != b.law || a.attraction != b.attraction || a.tangential_damping != b.tangential_damping ||
      a.rolling_damping != b.rolling_damping || a.kinetic_friction_ratio != b.kinetic_friction_ratio)
    throw InputError(
        "Two materials differ in contact law, attraction, tangential or rolling damping or in kinetic_friction_ratio; "
        "give all the same.");
  if (a.liquid_bridge != b.liquid_bridge)
    throw InputError("Two materials differ in their liquid bridges; give all the same.");
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

MaterialTable::MaterialTable(std::span<const ContactParameters> materials,
                             const std::optional<ContactParameters>& walls)
    : count_(static_cast<int>(materials.size())), common_(materials.front()) {
  for (const ContactParameters& material : materials) check(material);
  if (walls) check(*walls);
  with_spring_law(common_.law, [&](auto spring) {
    using Spring = typename decltype(spring)::type;
    const auto entry = [](typename Spring::Coefficients k, const ContactParameters& both, double rolling) {
      const Damping damping(Spring::damping_stiffness(k), both);
      damping.write_into(k);
      return Entry{as_doubles(k), damping, rolling};
    };
    for (const ContactParameters& a : materials) {
      for (const ContactParameters& b : materials) {
        const ContactParameters both = mixed(a, b);
        pairs_.push_back(entry(Spring::between(a, b), both, both.rolling_friction));
        rolling_friction_ = rolling_friction_ || both.rolling_friction > 0.0;
      }
      if (walls) mixed(a, *walls);
      const ContactParameters& wall = walls ? *walls : a;
      walls_.push_back(entry(Spring::against_wall(a, wall), wall, 0.0));  // the plane's, as its friction
    }
  });
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

double stiffness_lasting(double duration, const ContactParameters& p, double effective_mass) {
  const double omega = std::numbers::pi / duration;
  if (p.damping) {
    const double beta = *p.damping / (2.0 * effective_mass);
    return effective_mass * (omega * omega + beta * beta);
  }
  const double zeta = damping_ratio_of_restitution(*p.restitution, p.attraction);
  const double swing = (1.0 - zeta) * (1.0 + zeta);
  return effective_mass * omega * omega / (p.attraction ? swing : std::max(swing, zeta * zeta));
}

namespace {

// The times in which a contact must be resolved, s.
struct ContactTimes {
  double normal;  // along the normal
  double across;  // twice that of sliding and rolling, which are to be stable and need not be accurate
  double shortest() const { return std::min(normal, across); }
};

// Sliding moves a sphere with 2/7 of its mass, m(1 + m R^2/I)^-1, against k_t; rolling turns it against a wall, which
// is the faster of rolling_friction.hpp, with I_r = 7/5 m R^2 against 2.25 k_n (mu_r R)^2.
template <typename Spring>
ContactTimes contact_times_of(const typename Spring::Coefficients& k, const ContactParameters& p, double rolling,
                              double mass, double radius) {
  const Damping damping(Spring::damping_stiffness(k), p);
  const double gamma = damping.coefficient(mass), zeta = gamma / damping.critical(mass);
  const double sliding = std::max(std::sqrt(3.5 * Spring::stiffness_ratio(k)), 3.5 * p.tangential_damping * zeta);
  const double turning = std::sqrt(2.25 / 1.4) * rolling * std::max(1.0, p.rolling_damping);
  return {Spring::contact_time(k, gamma, mass, radius),
          2.0 * Spring::contact_time(k, 0.0, mass, radius) / std::max(sliding, turning)};
}

void refuse_longer(double time_step, const ContactTimes& times, const ContactParameters& grain,
                   const ContactParameters& other) {
  const double longest = times.shortest() / fewest_steps_per_contact;
  if (!(time_step > 0.0))
    throw InputError(fmt::format("The time step of the grains is {:g} s; it must be positive.", time_step));
  if (time_step <= longest * (1.0 + rounding_of_a_step)) return;
  const std::string softer =
      times.across < times.normal
          ? "tangential stiffness, tangential damping or rolling friction"
          : with_spring_law(grain.law, [&](auto spring) { return decltype(spring)::type::softer(grain, other); });
  throw InputError(
      fmt::format("The time step of the grains, {:g} s, is too long for their contacts: it must be at "
                  "most {:g} s, a {:g}th of the shortest contact time; use more sub-steps or a lower {}.",
                  time_step, longest, fewest_steps_per_contact, softer));
}

ContactTimes contact_times(const ContactParameters& p, double effective_mass, double effective_radius) {
  return with_spring_law(p.law, [&](auto spring) {
    using Spring = typename decltype(spring)::type;
    return contact_times_of<Spring>(Spring::between(p, p), p, p.rolling_friction, effective_mass, effective_radius);
  });
}

ContactTimes wall_contact_times(const ContactParameters& grain, const ContactParameters& wall, double mass,
                                double radius) {
  return with_spring_law(grain.law, [&](auto spring) {
    using Spring = typename decltype(spring)::type;
    return contact_times_of<Spring>(Spring::against_wall(grain, wall), wall, wall.wall_rolling_friction, mass, radius);
  });
}

}  // namespace

double contact_time(const ContactParameters& parameters, double effective_mass, double effective_radius) {
  return contact_times(parameters, effective_mass, effective_radius).normal;
}

double wall_contact_time(const ContactParameters& parameters, const ContactParameters& wall, double mass,
                         double radius) {
  return wall_contact_times(parameters, wall, mass, radius).normal;
}

double longest_step(const ContactParameters& parameters, double effective_mass, double effective_radius) {
  return contact_times(parameters, effective_mass, effective_radius).shortest() / fewest_steps_per_contact;
}

double longest_wall_step(const ContactParameters& parameters, const ContactParameters& wall, double mass,
                         double radius) {
  return wall_contact_times(parameters, wall, mass, radius).shortest() / fewest_steps_per_contact;
}

void check_time_step(const ContactParameters& parameters, double effective_mass, double effective_radius,
                     double time_step) {
  refuse_longer(time_step, contact_times(parameters, effective_mass, effective_radius), parameters, parameters);
}

void check_wall_time_step(const ContactParameters& parameters, const ContactParameters& wall, double mass,
                          double radius, double time_step) {
  refuse_longer(time_step, wall_contact_times(parameters, wall, mass, radius), parameters, wall);
}

}  // namespace thalweg::dem
