// Ids of the grains of each population of a case. Those of the grains at the start are consecutive; those that come in
// later are in rounds (dem/supply/turnover.hpp).
#pragma once

#include "core/base/types.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace thalweg {

struct PopulationIds {
  std::vector<GlobalId> ends;          // of each population, the id after its last one at the start
  std::vector<std::int64_t> supplied;  // the population of each id of a round; empty: none comes in
};

// Number of the population that a grain belongs to.
inline std::int64_t population_of(GlobalId id, const PopulationIds& populations) {
  const std::vector<GlobalId>& ends = populations.ends;
  const GlobalId first_supplied = ends.empty() ? 0 : ends.back();
  if (id >= first_supplied && !populations.supplied.empty())
    return populations.supplied[static_cast<std::size_t>(id - first_supplied) % populations.supplied.size()];
  return std::upper_bound(ends.begin(), ends.end(), id) - ends.begin();
}

}  // namespace thalweg
