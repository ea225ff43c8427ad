// Keys of the coupling between the fluid and grains or solids.
#pragma once

#include "bodies/map/body_options.hpp"
#include "core/keys/section_visitor.hpp"
#include "coupling/loads/load_averaging.hpp"

#include <cstdint>
#include <optional>

namespace thalweg::coupling {

enum class CoveredMomentum { lost, to_grain };

// The part of the lubrication force between near surfaces that the cells cannot resolve.
struct LubricationKeys {
  double normal_cut_off = 2.0 / 3.0;  // cells, the gap below which the squeezing flow is not resolved
  double tangential_cut_off = 0.5;    // cells, the same of sliding and rolling
  double minimum_gap = 1e-3;          // radii: gaps count as at least this wide
  bool operator==(const LubricationKeys&) const = default;
};

struct CouplingKeys {
  // The word auto; once a case is read, it has sub_steps_needed() in its place.
  static constexpr std::int64_t as_many_as_needed = 0;
  std::int64_t grain_steps_per_fluid_step = as_many_as_needed;
  double fewest_cells_per_diameter = 6.0;  // of the narrowest grain, without a warning
  bodies::MomentumExchange momentum_exchange = bodies::MomentumExchange::galilean_invariant;
  bodies::LinkRule links = bodies::LinkRule::bouzidi;
  CoveredMomentum covered_momentum = CoveredMomentum::lost;
  LoadAveraging load = LoadAveraging::extrapolated;
  std::optional<LubricationKeys> lubrication;
  bool operator==(const CouplingKeys&) const = default;
};

// with_grains: whether the case has grains, and so the keys that concern them.
void describe(SectionVisitor& visit, CouplingKeys& coupling, bool with_grains);

}  // namespace thalweg::coupling
