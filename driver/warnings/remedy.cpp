#include "driver/warnings/remedy.hpp"

#include "core/geometry/periodic_box.hpp"
#include "driver/case/limit_text.hpp"
#include "driver/estimate/filled_in.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::driver {

namespace {

constexpr double dry_steps_per_contact = 50.0;

std::string rounded_text(double limit, int digits, Rounding rounding) {
  return rounding == Rounding::down ? at_most_text(limit, digits) : at_least_text(limit, digits);
}

// Written out up to nine digits, 320 for 3.2e+02.
Change set_by_text(std::string key, const std::string& text, const Setter& set) {
  const double value = std::stod(text);
  return {std::move(key), fmt::format("{:.9g}", value), [set, value](Case& c) { set(c, value); }};
}

}  // namespace

std::string text_of(const Remedy& remedy) {
  std::string text;
  for (std::size_t n = 0; n < remedy.size(); ++n)
    text += fmt::format("{}{}: {}",
                        n == 0                   ? ""
                        : n + 1 == remedy.size() ? " and "
                                                 : ", ",
                        remedy[n].key, remedy[n].value);
  return text;
}

Case changed(Case c, const Remedy& remedy) {
  for (const Change& change : remedy) change.apply(c);
  fill_in(c);
  return c;
}

Remedy joined(Remedy first, const Remedy& second) {
  for (const Change& change : second) {
    std::erase_if(first, [&](const Change& other) { return other.key == change.key; });
    first.push_back(change);
  }
  return first;
}

Change number_change(std::string key, double limit, int digits, Rounding rounding, const Setter& set) {
  return set_by_text(std::move(key), rounded_text(limit, digits, rounding), set);
}

Change exact_change(std::string key, double value, int digits, const Setter& set) {
  return set_by_text(std::move(key), fmt::format("{:.{}g}", value, digits), set);
}

Change word_change(std::string key, std::string word, std::function<void(Case&)> apply) {
  return {std::move(key), std::move(word), std::move(apply)};
}

Change fluid_step_change(double limit, int digits, Rounding rounding) {
  return number_change("fluid.time_step", limit, digits, rounding, [](Case& other, double step) {
    other.fluid.time_step = step;
    other.filled_in.time_step = false;
  });
}

Change spacing_change(const Case& c, double most) {
  constexpr int digits = 9;  // so that a side is whole to a millionth
  return exact_change("domain.spacing", spacing_below(c, most), digits, [](Case& other, double spacing) {
    other.domain.spacing = spacing;
    double& height = other.domain.size.z();
    if (other.filled_in.flow.height) height = spacing * std::ceil(height / spacing * (1.0 - whole_number_tolerance));
  });
}

double steepest_slope(double steepest, const std::function<bool(double slope)>& holds) {
  double low = 1e-3 * steepest, high = steepest;
  if (!holds(low)) return 0.0;
  constexpr int halvings = 20;
  for (int n = 0; n < halvings; ++n) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

Remedy with_grain_steps(const Case& c, Remedy remedy) {
  const Case after = changed(c, remedy);
  if (after.grains.empty()) return remedy;
  if (!has_fluid(after)) {
    if (grain_time_step(after) > longest_contact_step(after))
      remedy.push_back(number_change(
          "run.time_step", std::min(shortest_contact(after) / dry_steps_per_contact, longest_contact_step(after)), 3,
          Rounding::down, [](Case& other, double step) { other.run.time_step = step; }));
  } else if (grain_steps(after) < sub_steps_needed(after)) {
    remedy.push_back(word_change("coupling.grain_steps_per_fluid_step", "auto",
                                 [](Case& other) { other.filled_in.grain_steps = true; }));
  }
  return remedy;
}

}  // namespace thalweg::driver
