// Remedies of `thalweg check`: changes of keys, printed ready to paste, that keep all other keys.
#pragma once

#include "driver/case/case.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::driver {

struct Change {
  std::string key;                   // "fluid.time_step"
  std::string value;                 // as YAML, "5e-05"
  std::function<void(Case&)> apply;  // makes the same change in a case that has been read
};

// Changes that belong together, no key twice, in the order in which they are made.
using Remedy = std::vector<Change>;

// "a: 1", "a: 1 and b: 2", "a: 1, b: 2 and c: 3".
std::string text_of(const Remedy& remedy);

// The changed case, with its omitted keys derived again (filled_in.hpp).
Case changed(Case c, const Remedy& remedy);

// The first with the changes of the second, which come later and replace those of the same keys.
Remedy joined(Remedy first, const Remedy& second);

// One of several remedies of a warning.
struct Advice {
  Remedy remedy;
  std::string lead;  // before its text, as "accept it with "; else "consider " before the first
};

// A warning with its remedies, the best first. They need not be consistent with the rest of the case: one may lead to
// another warning, whose remedy is then to be added (consistent_remedy.hpp).
struct Warning {
  // NOLINTNEXTLINE(google-explicit-constructor): a sentence whose remedy is in its words, or none
  Warning(std::string text) : sentence(std::move(text)) {}
  // without: what is advised where none of the remedies is consistent; empty: nothing.
  Warning(std::string text, std::vector<Advice> remedies, std::string without = {})
      : sentence(std::move(text)), advice(std::move(remedies)), otherwise(std::move(without)) {}

  std::string sentence;  // with advice or `otherwise` without its period
  std::vector<Advice> advice;
  std::string otherwise;
};
using Warnings = std::vector<Warning>;

// A number with so many digits: at most or at least the limit, or the nearest. The setter gets what is printed.
enum class Rounding { down, up };
using Setter = std::function<void(Case&, double)>;
Change number_change(std::string key, double limit, int digits, Rounding rounding, const Setter& set);
Change exact_change(std::string key, double value, int digits, const Setter& set);
Change word_change(std::string key, std::string word, std::function<void(Case&)> apply);

// A step of the fluid (s) at most or at least this.
Change fluid_step_change(double limit, int digits, Rounding rounding);

// The largest spacing (m) of at most `most` of which every side of the domain is a whole number.
Change spacing_change(const Case& c, double most);

// The steepest slope (a tangent) from a thousandth of `steepest`, which does not hold, to it that holds, by bisection;
// 0: there is none.
double steepest_slope(double steepest, const std::function<bool(double slope)>& holds);

// The remedy, and as many sub-steps or as short a step of the grains as it makes necessary.
Remedy with_grain_steps(const Case& c, Remedy remedy);

}  // namespace thalweg::driver
