// Keys of the observer of transport along a reach.
#pragma once

#include "analysis/observer/observer_keys.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace thalweg::analysis {

struct ReachKeys {
  static constexpr const char* section = "reach";
  static constexpr const char* meaning =
      "sediment along x: transport through sections, level of the bed in x and time, entrainment and deposition, "
      "residence times; in reach/";
  static constexpr Needs needs = Needs::grains;
  static constexpr std::int64_t most_sections = 1000;
  double from = 0.0;                          // s: the means begin here
  double every = 0.01;                        // s: between looks at the grains
  double record_every = 0.5;                  // s: of a record
  std::optional<std::int64_t> sections = {};  // default: one a reference diameter
  std::optional<double> pixel = {};           // m, of the static pixels; default: 1/25 of the reference diameter
  std::optional<double> moving_speed = {};    // m/s, above which a grain moves; default: that of TransportScales
  bool operator==(const ReachKeys&) const = default;
};
void describe(SectionVisitor& visit, ReachKeys& keys);
void check(const ReachKeys& keys, const RunContext& run);
std::optional<std::string> warning(const ReachKeys& keys, const RunContext& run);
std::unique_ptr<Observer> make_observer(const ReachKeys& keys, const RunContext& run, const RunningSystem& system);
ObserverMemory memory_of(const ReachKeys& keys, const RunContext& run, const RunSize& size);

// Number of sections where none is given: one a diameter (m), at least two.
std::int64_t default_sections(double length, double diameter);

}  // namespace thalweg::analysis
