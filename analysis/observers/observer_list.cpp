#include "analysis/observers/observer_list.hpp"

#include "analysis/observers/grain_energy.hpp"

#include <fmt/format.h>

namespace thalweg::analysis {

namespace {

// from, until: s.
std::string begins_too_late(const char* section, double from, double until) {
  return fmt::format(
      "The measurement analysis.{0} begins at {1} s, after the end of the run at {2} s, and measures nothing: consider "
      "analysis.{0}.from: {3:.2g}.",
      section, from, until, 0.5 * until);
}

// every: s, 0: with the rows of the series. until: s.
std::string measures_too_rarely(const char* section, double every, double until) {
  return fmt::format(
      "The measurement analysis.{} is made {}, but the run ends after {} s, before the first: consider "
      "analysis.{}.every: {:.2g}.",
      section, every > 0.0 ? fmt::format("every {} s", every) : "with the rows of the series", until, section,
      0.01 * until);
}

// True if the run has what the observer of these keys looks at.
template <typename Keys>
bool is_possible(const RunContext& run) {
  return (Keys::needs == Needs::fluid || run.grains) && (Keys::needs == Needs::grains || run.fluid);
}

}  // namespace

void check(const RequestedObservers& requested, const RunContext& run) {
  requested.for_each([&](const auto& keys) {
    using Keys = std::decay_t<decltype(*keys)>;
    if constexpr (requires { check(*keys, run); }) {
      if (!keys) return;
      try {
        check(*keys, run);
      } catch (const KeyError& error) {
        throw KeyError(Keys::section + (error.key.empty() ? "" : "." + error.key), error.what());
      }
    }
  });
}

std::vector<std::string> warnings(const RequestedObservers& requested, const RunContext& run) {
  std::vector<std::string> found;
  requested.for_each([&](const auto& keys) {
    using Keys = std::decay_t<decltype(*keys)>;
    if constexpr (requires { keys->from; })
      if (keys && keys->from >= run.until) found.push_back(begins_too_late(Keys::section, keys->from, run.until));
    if constexpr (requires { keys->every; })
      if (keys && (keys->every > run.until || (keys->every == 0.0 && !run.has_rows)))
        found.push_back(measures_too_rarely(Keys::section, keys->every, run.until));
    if constexpr (requires { warning(*keys, run); }) {
      const std::optional<std::string> sentence = keys ? warning(*keys, run) : std::nullopt;
      if (sentence) found.push_back(*sentence);
    }
  });
  return found;
}

ObserverMemory memory_of(const RequestedObservers& requested, const RunContext& run, const RunSize& size) {
  ObserverMemory memory;
  requested.for_each([&](const auto& keys) {
    if (keys && is_possible<std::decay_t<decltype(*keys)>>(run)) memory += memory_of(*keys, run, size);
  });
  return memory;
}

std::vector<std::unique_ptr<Observer>> make_observers(const RequestedObservers& requested, const RunContext& run,
                                                      const RunningSystem& system) {
  std::vector<std::unique_ptr<Observer>> observers;
  requested.for_each([&](const auto& keys) {
    if (keys && is_possible<std::decay_t<decltype(*keys)>>(run)) observers.push_back(make_observer(*keys, run, system));
  });
  if (run.grains) observers.push_back(std::make_unique<GrainEnergy>(system.communicator));
  return observers;
}

}  // namespace thalweg::analysis
