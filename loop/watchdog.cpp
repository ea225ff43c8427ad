#include "loop/watchdog.hpp"

#include "core/base/error.hpp"
#include "loop/location_text.hpp"
#include "loop/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::loop {

namespace {

constexpr double growth_between_warnings = 1.5;

std::string with_unit(const Diagnostic& diagnostic, double value) {
  const bool bare = diagnostic.unit == "1" || diagnostic.unit == "diameter";
  return fmt::format("{:.3g}{}", value, bare ? "" : " " + diagnostic.unit);
}

}  // namespace

Watchdog::Watchdog(MPI_Comm communicator, const System& system, std::vector<WatchRule> rules, OutOfBounds out_of_bounds)
    : communicator_(communicator), system_(system), out_of_bounds_(out_of_bounds) {
  for (WatchRule& rule : rules) watched_.push_back({std::move(rule)});
}

std::string Watchdog::moment() const { return fmt::format("{:.6g} s (step {})", system_.time(), system_.step()); }

std::string Watchdog::location_of(const std::string& diagnostic) const {
  const std::optional<Location> location = system_.location_of(diagnostic);
  return location ? ", " + location_text(communicator_, *location, system_.snapshot()) : "";
}

std::vector<std::string> Watchdog::judge(const std::vector<Diagnostic>& diagnostics) {
  for (const Diagnostic& diagnostic : diagnostics)
    if (!std::isfinite(diagnostic.value))
      throw RunError(fmt::format(
          "The run broke down before {}: {} is not a finite number{}. Shorten the time step, or restart from "
          "an earlier checkpoint with a shorter output.series.every to see how it develops.",
          moment(), diagnostic.name, location_of(diagnostic.name)));
  std::vector<std::string> warnings;
  for (Watched& watched : watched_) {
    const WatchRule& rule = watched.rule;
    const auto diagnostic = std::find_if(diagnostics.begin(), diagnostics.end(),
                                         [&](const Diagnostic& f) { return f.name == rule.diagnostic; });
    if (diagnostic == diagnostics.end()) continue;
    const WatchLimits limits = rule.limits(diagnostics);
    const double badness = rule.badness(diagnostic->value);
    watched.value = diagnostic->value;
    watched.suspicious = badness > limits.warn;
    if (badness > limits.stop && out_of_bounds_ == OutOfBounds::stop)
      throw RunError(fmt::format("The run has gone wrong at {}: {} is {}, beyond the limit of {}{}. {}", moment(),
                                 rule.meaning, with_unit(*diagnostic, diagnostic->value),
                                 with_unit(*diagnostic, limits.stop), location_of(rule.diagnostic), rule.advice));
    if (!watched.suspicious || badness < growth_between_warnings * watched.warned) continue;
    watched.warned = badness;
    const std::string stops = std::isfinite(limits.stop) && out_of_bounds_ == OutOfBounds::stop
                                  ? fmt::format(" (the run stops at {})", with_unit(*diagnostic, limits.stop))
                                  : "";
    warnings.push_back(fmt::format("At {} {} is {}, beyond {}{}{}. {}", moment(), rule.meaning,
                                   with_unit(*diagnostic, diagnostic->value), with_unit(*diagnostic, limits.warn),
                                   stops, location_of(rule.diagnostic), rule.advice));
  }
  return warnings;
}

std::string Watchdog::notice() const {
  std::string text;
  for (const Watched& watched : watched_)
    if (watched.suspicious)
      text += fmt::format("{}{} {:.3g}", text.empty() ? "" : ", ", watched.rule.diagnostic, watched.value);
  return text;
}

}  // namespace thalweg::loop
