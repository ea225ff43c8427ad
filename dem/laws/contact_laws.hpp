// All contact laws, and the one place that chooses among them: with_law(choice, time_step, visit) calls visit(law).
#pragma once

#include "dem/laws/hertz_mindlin.hpp"
#include "dem/laws/kinetic_friction.hpp"
#include "dem/laws/liquid_bridge.hpp"
#include "dem/laws/rolling_friction.hpp"
#include "dem/laws/spring_dashpot.hpp"
#include "dem/laws/surface_law.hpp"

#include <type_traits>
#include <utility>
#include <vector>

namespace thalweg::dem {

// The law of all contacts of a kind.
struct LawChoice {
  ContactParameters common;       // of any material
  bool rolling_friction = false;  // true if any of the contacts may have it
  bool at_surface = false;        // with solids, whose law keeps the normal
};

// Calls visit(std::type_identity<Springs>()) with the properties that a law has with and without a liquid.
template <typename Visitor>
decltype(auto) with_spring_law(Law law, Visitor&& visit) {
  switch (law) {
    case Law::linear:
      return visit(std::type_identity<SpringDashpot>());
    case Law::hertz_mindlin:
      return visit(std::type_identity<HertzMindlin>());
  }
  __builtin_unreachable();
}

// time_step: s, with 0 no spring grows.
template <typename Visitor>
decltype(auto) with_law(const LawChoice& choice, double time_step, Visitor&& visit) {
  const ContactParameters& common = choice.common;
  const auto and_bridge = [&](const auto& law) -> decltype(auto) {
    return common.liquid_bridge ? visit(WithLiquidBridge(law, *common.liquid_bridge)) : visit(law);
  };
  const auto and_rolling = [&](const auto& law) -> decltype(auto) {
    return choice.rolling_friction ? and_bridge(WithRollingFriction(law, common)) : and_bridge(law);
  };
  const auto and_kinetic = [&](const auto& law) -> decltype(auto) {
    return common.kinetic_friction_ratio < 1.0 ? and_rolling(WithKineticFriction(law, common)) : and_rolling(law);
  };
  const auto in = [&](auto film) -> decltype(auto) {
    using Film = typename decltype(film)::type;
    switch (common.law) {
      case Law::linear:
        return and_kinetic(SpringDashpotFriction<Film>(common, time_step));
      case Law::hertz_mindlin:
        return and_kinetic(HertzMindlinFriction<Film>(common, time_step));
    }
    __builtin_unreachable();
  };
  return common.film_viscosity > 0.0 ? in(std::type_identity<ContactFilm>()) : in(std::type_identity<NoFilm>());
}

// with_law() for contacts with solids.
template <typename Visitor>
decltype(auto) with_surface_law(const LawChoice& choice, double time_step, Visitor&& visit) {
  return with_law(choice, time_step, [&](const auto& law) -> decltype(auto) { return visit(AtSurface(law)); });
}

// with_law() or with_surface_law(), as the choice says.
template <typename Visitor>
decltype(auto) with_either_law(const LawChoice& choice, double time_step, Visitor&& visit) {
  return choice.at_surface ? with_surface_law(choice, time_step, visit) : with_law(choice, time_step, visit);
}

// Names and numbers of the doubles that a contact keeps.
inline std::vector<HistoryPart> history_parts_of(const LawChoice& choice) {
  return with_either_law(choice, 0.0, [](const auto& law) {
    return std::vector<HistoryPart>(law.history_parts.begin(), law.history_parts.end());
  });
}

// m, the gap up to which the law may act.
inline double range_of(const LawChoice& choice) {
  return with_law(choice, 0.0, [](const auto& law) { return law.range(); });
}

}  // namespace thalweg::dem
