// All observers that a case can ask for, in the order of their columns in series.csv. A new one is a line here.
#pragma once

#include "analysis/observers/bed_surface.hpp"
#include "analysis/observers/entrainment.hpp"
#include "analysis/observers/fluid_statistics.hpp"
#include "analysis/observers/grain_profiles.hpp"
#include "analysis/observers/population_loads.hpp"
#include "analysis/observers/probes.hpp"
#include "analysis/observers/stress_balance.hpp"
#include "analysis/observers/tracks.hpp"
#include "analysis/observers/transport_rate.hpp"
#include "analysis/reach/reach_keys.hpp"
#include "analysis/sizes/fractional_transport.hpp"

#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace thalweg::analysis {

// The observers of a case: the keys of each; none: it is not asked for.
class RequestedObservers {
public:
  template <typename Keys>
  std::optional<Keys>& of() {
    return std::get<std::optional<Keys>>(all_);
  }
  template <typename Keys>
  const std::optional<Keys>& of() const {
    return std::get<std::optional<Keys>>(all_);
  }

  // Calls f(keys) with the optional keys of every observer there is.
  void for_each(const auto& f) {
    std::apply([&](auto&... keys) { (f(keys), ...); }, all_);
  }
  void for_each(const auto& f) const {
    std::apply([&](const auto&... keys) { (f(keys), ...); }, all_);
  }

  bool operator==(const RequestedObservers&) const = default;

private:
  template <IsObserverKeys... Keys>
  using OptionalKeys = std::tuple<std::optional<Keys>...>;
  OptionalKeys<FluidStatisticsKeys, ProbesKeys, TransportRateKeys, FractionalTransportKeys, ReachKeys, BedSurfaceKeys,
               GrainProfilesKeys, StressBalanceKeys, PopulationLoadsKeys, TracksKeys, EntrainmentKeys>
      all_;
};

// Throws KeyError, with the key from `analysis` on, where one asks for what the run does not have.
void check(const RequestedObservers& requested, const RunContext& run);

// The warnings of all requested observers, whole sentences; also of what begins (key from) after the end of the run.
std::vector<std::string> warnings(const RequestedObservers& requested, const RunContext& run);

// What the requested ones keep, as far as the run has what they look at.
ObserverMemory memory_of(const RequestedObservers& requested, const RunContext& run, const RunSize& size);

// The requested ones, as far as the run has what they look at, and those that every run has.
std::vector<std::unique_ptr<Observer>> make_observers(const RequestedObservers& requested, const RunContext& run,
                                                      const RunningSystem& system);

}  // namespace thalweg::analysis
