// Keys of an observer: a section of `analysis`, as a struct of plain values with their defaults and
//
//   static constexpr const char* section;   its key in the case file, and the observer's name
//   static constexpr const char* meaning;   for the documentation
//   static constexpr Needs needs;           the systems that have it
//
// and in the namespace of the observer
//
//   void describe(SectionVisitor& visit, Keys& keys);                             (core/keys/section_visitor.hpp)
//   std::unique_ptr<Observer> make_observer(const Keys& keys, const RunContext& run, const RunningSystem& system);
//   ObserverMemory memory_of(const Keys& keys, const RunContext& run, const RunSize& size);    (observer_memory.hpp)
//
// and, if some values are refused or questionable,
//
//   void check(const Keys& keys, const RunContext& run);                            throws KeyError
//   std::optional<std::string> warning(const Keys& keys, const RunContext& run);    a sentence
//
// A new observer becomes known to the program by a line in observer_list.hpp.
#pragma once

#include "analysis/observer/observer.hpp"
#include "analysis/observer/observer_memory.hpp"
#include "analysis/observer/run_context.hpp"
#include "core/keys/key_error.hpp"
#include "core/keys/section_visitor.hpp"

#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::analysis {

enum class Needs { grains, fluid, both };

// The form of the keys of an observer.
template <typename Keys>
concept IsObserverKeys = std::default_initializable<Keys> && std::equality_comparable<Keys> &&
    requires(Keys& keys, SectionVisitor& visit, const RunContext& run, const RunningSystem& system,
             const RunSize& size) {
  { Keys::section } -> std::convertible_to<std::string>;
  { Keys::meaning } -> std::convertible_to<std::string>;
  requires std::same_as<decltype(Keys::needs), const Needs>;
  describe(visit, keys);
  { make_observer(keys, run, system) } -> std::same_as<std::unique_ptr<Observer>>;
  { memory_of(keys, run, size) } -> std::same_as<ObserverMemory>;
};

// The keys of means.
void describe_from(SectionVisitor& visit, double& from);
void describe_every(SectionVisitor& visit, double& every);

// Throw KeyError with a remedy. what: a verb for the message, "measure".
void require_grains(const RunContext& run, const std::string& what);
void require_ids(const RunContext& run, const std::vector<GlobalId>& ids);  // key grains: each is there, and named once
void require_full_gravity_from(const RunContext& run, double from);         // run.ramp is over then
void require_layer_in_box(const RunContext& run, const std::optional<double>& layer);  // m; key layer
void require_fine_pixel(const RunContext& run, const std::optional<double>& pixel);    // m; key pixel, of a side view

}  // namespace thalweg::analysis
