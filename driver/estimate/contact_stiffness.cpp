#include "driver/estimate/contact_stiffness.hpp"

#include "beds/population_seeds.hpp"
#include "dem/laws/material.hpp"
#include "driver/estimate/contact_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace thalweg::driver {

namespace {

constexpr double tangential_share = 2.0 / 7.0;

// Indices of the free populations without a normal stiffness of their own; of all free ones where each has one.
std::vector<std::size_t> populations_of_common_stiffness(const Case& c) {
  const std::vector<std::size_t> free = free_populations(c);
  std::vector<std::size_t> common;
  std::copy_if(free.begin(), free.end(), std::back_inserter(common),
               [&c](std::size_t p) { return !c.grains[p].contact || !c.grains[p].contact->normal_stiffness; });
  return common.empty() ? free : common;
}

double default_steps(const Case& c, const beds::Population& grains) {
  return fluid_steps_per_cell * grains.narrowest() / c.domain.spacing;
}

// N/m, with which the shortest contact lasts as long as `duration` (s) says of each population.
template <typename Duration>
double stiffness_by(const Case& c, const Duration& duration) {
  const std::vector<dem::ContactParameters> materials = beds::materials_of(c.contact, c.grains);
  double softest = std::numeric_limits<double>::infinity();
  for (const std::size_t p : populations_of_common_stiffness(c)) {
    const dem::ContactParameters& material = materials[static_cast<std::size_t>(beds::material_of(c.grains, p))];
    softest =
        std::min(softest, dem::stiffness_lasting(duration(c.grains[p]), material, 0.5 * c.grains[p].lightest_mass()));
  }
  return softest;
}

double stiffness_of(const Case& c) {
  const std::optional<dem::ContactDuration>& given = c.contact.given.duration;
  const bool in_steps = given ? given->fluid_steps.has_value() : c.system == SystemKind::resolved;
  if (c.grains.empty() || (!given && !in_steps) || (in_steps && !has_fluid(c)))
    return beds::ContactKeys::default_stiffness;
  if (given) {
    const double duration = in_steps ? *given->fluid_steps * fluid_time_step(c) : *given->seconds;
    return stiffness_by(c, [duration](const beds::Population&) { return duration; });
  }
  const double longest =
      stiffness_by(c, [&c](const beds::Population& grains) { return default_steps(c, grains) * fluid_time_step(c); });
  return std::max(longest, least_stiffness(c));
}

}  // namespace

double default_contact_steps(const Case& c) {
  double fewest = std::numeric_limits<double>::infinity();
  for (const std::size_t p : populations_of_common_stiffness(c))
    fewest = std::min(fewest, default_steps(c, c.grains[p]));
  return fewest;
}

bool has_default_duration(const Case& c) {
  return c.system == SystemKind::resolved && !c.grains.empty() && c.contact.law == dem::Law::linear &&
         c.filled_in.stiffness && !c.contact.given.duration;
}

bool goes_by_duration(const Case& c) { return c.contact.given.duration || has_default_duration(c); }

// k_n = A/t^2 + B of each population.
double contact_duration(const Case& c) {
  const std::vector<dem::ContactParameters> materials = beds::materials_of(c.contact, c.grains);
  double shortest = std::numeric_limits<double>::infinity();
  for (const std::size_t p : populations_of_common_stiffness(c)) {
    const dem::ContactParameters& material = materials[static_cast<std::size_t>(beds::material_of(c.grains, p))];
    const double mass = 0.5 * c.grains[p].lightest_mass();
    const double damped = dem::stiffness_lasting(std::numeric_limits<double>::infinity(), material, mass);
    const double elastic = dem::stiffness_lasting(1.0, material, mass) - damped,
                 left = c.contact.normal_stiffness - damped;
    if (left > 0.0) shortest = std::min(shortest, std::sqrt(elastic / left));
  }
  return shortest;
}

void take_over_contacts(Case& c) {
  const dem::StiffnessKeys& given = c.contact.given;
  c.filled_in.stiffness = !given.normal;
  c.filled_in.tangential_stiffness = !given.tangential;
  c.filled_in.grain_steps = c.coupling.grain_steps_per_fluid_step == coupling::CouplingKeys::as_many_as_needed;
  if (given.normal) c.contact.normal_stiffness = *given.normal;
  if (given.tangential) c.contact.tangential_stiffness = *given.tangential;
}

void fill_in_contacts(Case& c) {
  if (has_grains(c.system) && c.contact.law == dem::Law::linear) {
    beds::ContactKeys& contact = c.contact;
    if (c.filled_in.stiffness) contact.normal_stiffness = stiffness_of(c);
    if (c.filled_in.tangential_stiffness)
      contact.tangential_stiffness = contact.normal_stiffness == beds::ContactKeys::default_stiffness
                                         ? beds::ContactKeys::default_tangential_stiffness
                                         : tangential_share * contact.normal_stiffness;
  }
  if (c.filled_in.grain_steps) c.coupling.grain_steps_per_fluid_step = has_fluid(c) ? sub_steps_needed(c) : 1;
}

Case with_stiffnesses(Case c) {
  c.contact.given = {c.contact.normal_stiffness, c.contact.tangential_stiffness, std::nullopt};
  return c;
}

}  // namespace thalweg::driver
