// The grains of this rank that an observer watches. The homes of the ids know it (distribution_by_id.hpp), a rank asks
// them for the grains that have come to it since it last looked, so that no rank knows of more grains than its own.
#pragma once

#include "analysis/tools/distribution_by_id.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace thalweg::analysis {

class WatchedHere {
public:
  // flags: 1 for each of these grains, which are all that are here, that is watched from now on.
  void set(std::span<const GlobalId> ids, std::vector<char> flags) {
    ids_.assign(ids.begin(), ids.end());
    flags_ = std::move(flags);
  }

  // The flags of the grains that are here now, in the order of ids. is_watched(id): what the home of an id knows.
  // Collective.
  template <typename AtHome>
  const std::vector<char>& flags(MPI_Comm communicator, std::span<const GlobalId> ids, const DistributionById& homes,
                                 const AtHome& is_watched) {
    if (!any_rank(communicator, !std::ranges::equal(ids, ids_))) return flags_;
    std::vector<std::pair<GlobalId, char>> known;
    for (std::size_t n = 0; n < ids_.size(); ++n) known.emplace_back(ids_[n], flags_[n]);
    std::sort(known.begin(), known.end());
    std::vector<char> now(ids.size(), 0);
    std::vector<GlobalId> new_ids;
    std::vector<std::size_t> new_places;
    for (std::size_t n = 0; n < ids.size(); ++n) {
      const auto found = std::lower_bound(known.begin(), known.end(), std::pair<GlobalId, char>(ids[n], 0));
      if (found != known.end() && found->first == ids[n]) {
        now[n] = found->second;
      } else {
        new_ids.push_back(ids[n]);
        new_places.push_back(n);
      }
    }
    const std::vector<char> told = homes.ask(new_ids, [&](GlobalId id) -> char { return is_watched(id) ? 1 : 0; });
    for (std::size_t n = 0; n < told.size(); ++n) now[new_places[n]] = told[n];
    set(ids, std::move(now));
    return flags_;
  }

private:
  std::vector<GlobalId> ids_;  // of the grains that were here
  std::vector<char> flags_;
};

}  // namespace thalweg::analysis
