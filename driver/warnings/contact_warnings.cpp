#include "driver/warnings/contact_warnings.hpp"

#include "dem/laws/contact_laws.hpp"
#include "driver/case/limit_text.hpp"
#include "driver/estimate/contact_estimate.hpp"
#include "driver/estimate/contact_stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::driver {

namespace {

constexpr int digits_kept = 6;  // of what is scaled along

// The least factor of the stiffness that keeps the overlaps small.
double least_factor(const Case& c) {
  const Overlaps overlaps = expected_overlaps(c);
  return dem::with_spring_law(c.contact.law, [&](auto spring) {
    using Spring = typename decltype(spring)::type;
    return std::max(std::pow(overlaps.under_weight / deep_under_weight, Spring::overlaps_per_stiffness),
                    std::pow(overlaps.in_impact / deep_in_impact, Spring::impacts_per_stiffness));
  });
}

// The largest that keeps contacts long enough for a rebound.
double most_factor(const Case& c) {
  const std::optional<ReboundTimes> times = rebound_times(c);
  if (!times) return std::numeric_limits<double>::infinity();
  return dem::with_spring_law(c.contact.law, [&](auto spring) {
    return std::pow(times->contact / times->around, decltype(spring)::type::impacts_per_stiffness);
  });
}

// A stiffness with which the grains overlap little enough and rebound, with a shorter step where there is none.
Remedy suitable_contact(const Case& c) {
  const double least = stiffness_margin * least_factor(c), most = most_factor(c);
  if (has_default_duration(c) && most < 1.0) {  // it is as short as overlaps ask for
    const ReboundTimes times = *rebound_times(c);
    return {fluid_step_change(fluid_time_step(c) * times.contact / times.around, 3, Rounding::down)};
  }
  if (least <= most)
    return most < 1.0 ? stiffness_changes(c, most, 4, Rounding::down) : stiffness_changes(c, least, 2, Rounding::up);
  const Remedy contact = stiffness_changes(c, least, 3, Rounding::up);
  const Case after = changed(c, contact);
  const ReboundTimes times = *rebound_times(after);
  return joined(contact, {fluid_step_change(fluid_time_step(after) * times.contact / times.around, 3, Rounding::down)});
}

using Material = std::function<beds::MaterialKeys&(Case&)>;

// The keys of a material that are given.
void scale_material(Case c, const std::string& section, const Material& material, double factor, Remedy& changes) {
  const auto scale = [&](const char* key, std::optional<double> beds::MaterialKeys::*value, double by) {
    if (const std::optional<double> given = material(c).*value)
      changes.push_back(exact_change(section + "." + key, by * *given, digits_kept,
                                     [material, value](Case& other, double to) { material(other).*value = to; }));
  };
  scale("normal_stiffness", &beds::MaterialKeys::normal_stiffness, factor);
  scale("tangential_stiffness", &beds::MaterialKeys::tangential_stiffness, factor);
  scale("youngs_modulus", &beds::MaterialKeys::youngs_modulus, factor);
  scale("damping", &beds::MaterialKeys::damping, std::sqrt(factor));
}

// Change of contact stiffness, or of the duration it follows from, by a factor; on return the factor as rounded.
Change main_stiffness_change(const Case& c, double& factor, int digits, Rounding rounding) {
  if (goes_by_duration(c)) {
    const double lasts = contact_duration(c);
    const Change change =
        number_change("contact.duration", lasts / std::sqrt(factor), digits,
                      rounding == Rounding::up ? Rounding::down : Rounding::up, [](Case& other, double to) {
                        other.contact.given.duration = dem::ContactDuration{to, std::nullopt};
                      });
    factor = std::pow(lasts / std::stod(change.value), 2);
    return change;
  }
  return dem::with_spring_law(c.contact.law, [&](auto spring) {
    using Spring = typename decltype(spring)::type;
    const Change change =
        number_change(fmt::format("contact.{}", Spring::stiffness_key), factor * c.contact.*Spring::stiffness, digits,
                      rounding, [](Case& other, double to) {
                        other.contact.*Spring::stiffness = to;
                        other.filled_in.stiffness = false;
                      });
    factor = changed(c, {change}).contact.*Spring::stiffness / c.contact.*Spring::stiffness;
    return change;
  });
}

}  // namespace

Remedy stiffness_changes(const Case& c, double factor, int digits, Rounding rounding) {
  double rounded = factor;
  Remedy changes{main_stiffness_change(c, rounded, digits, rounding)};
  if (c.contact.law == dem::Law::linear && c.contact.tangential_stiffness > 0.0 && !c.filled_in.tangential_stiffness)
    changes.push_back(exact_change("contact.tangential_stiffness", rounded * c.contact.tangential_stiffness,
                                   digits_kept,
                                   [](Case& other, double to) { other.contact.tangential_stiffness = to; }));
  // The dashpot 2 zeta sqrt(k m*) keeps zeta, and with it the restitution of grains of any mass.
  if (c.contact.damping.value_or(0.0) > 0.0)
    changes.push_back(exact_change("contact.damping", std::sqrt(rounded) * *c.contact.damping, digits_kept,
                                   [](Case& other, double to) { other.contact.damping = to; }));
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    if (c.grains[n].contact)
      scale_material(
          c, fmt::format("grains.{}.contact", n),
          [n](Case& other) -> beds::MaterialKeys& { return *other.grains[n].contact; }, rounded, changes);
  if (c.contact.walls)
    scale_material(
        c, "contact.walls", [](Case& other) -> beds::MaterialKeys& { return *other.contact.walls; }, rounded, changes);
  return changes;
}

Warnings overlap_warnings(const Case& c) {
  if (c.system != SystemKind::grains && c.system != SystemKind::resolved) return {};
  const Overlaps overlaps = expected_overlaps(c);
  if (overlaps.under_weight <= deep_under_weight && overlaps.in_impact <= deep_in_impact) return {};
  return {{fmt::format("Grains would overlap by {:.2g} % of a diameter under the weight of the bed and {:.2g} % in an "
                       "impact at {:.2g} m/s",
                       100.0 * overlaps.under_weight, 100.0 * overlaps.in_impact, overlaps.speed),
           {{suitable_contact(c), {}}},
           "a stiffer contact with a shorter step"}};
}

Warnings rebound_warnings(const Case& c) {
  const std::optional<ReboundTimes> times = rebound_times(c);
  if (!times || times->contact >= times->around) return {};
  return {{fmt::format(
               "Grains rebound too weakly: a contact lasts {} fluid steps, less than the {} that sound takes around a "
               "grain",
               at_most_text(times->contact, 3), at_least_text(times->around, 3)),
           {{suitable_contact(c), {}}},
           "finer cells with a shorter step, and a softer contact"}};
}

}  // namespace thalweg::driver
