#include "driver/watched_grains.hpp"

#include <fmt/format.h>

#include <algorithm>

// Sections of what is recorded of single grains, and whether the grains they name exist.
namespace thalweg {

void describe(io::SectionVisitor& visit, TracksCase& tracks) {
  visit.integer_list("grains", tracks.grains,
                     {.meaning = "ids of the grains, in the order of the populations from 0; else every one_in-th",
                      .at_least = 0,
                      .example = 0});
  visit.integer("one_in", tracks.one_in,
                {.meaning = "grains 0, one_in, 2 one_in, ... where no ids are given", .at_least = 1});
  visit.real("every", tracks.every, {.unit = "s", .meaning = "between measurements", .above = 0.0});
}

namespace {

std::int64_t row_count(const Case& c) {
  std::int64_t count = 0;
  for (const PopulationCase& grains : c.grains) count += grains.row_count();
  return count;
}

void check_ids(const Case& c, const io::YamlDocument& document, const std::string& key,
               const std::vector<std::int64_t>& ids) {
  const std::int64_t count = row_count(c);
  if (count == 0) throw document.error(key, "there are no grains to watch; remove the section or add grains");
  std::vector<std::int64_t> seen;
  for (std::size_t n = 0; n < ids.size(); ++n) {
    const std::string place = fmt::format("{}.grains.{}", key, n);
    if (ids[n] >= count)
      throw document.error(place, fmt::format("there is no grain {}; give ids from 0 to {}", ids[n], count - 1));
    if (std::find(seen.begin(), seen.end(), ids[n]) != seen.end())
      throw document.error(place, fmt::format("grain {} is named twice; give each id once", ids[n]));
    seen.push_back(ids[n]);
  }
}

}  // namespace

void check_watched_grains(const Case& c, const io::YamlDocument& document) {
  if (const auto& tracks = c.analysis.tracks) {
    check_ids(c, document, "analysis.tracks", tracks->grains);
    if (!tracks->grains.empty() && tracks->one_in != 1)
      throw document.error("analysis.tracks.one_in",
                           "analysis.tracks.grains names the grains already; give one of them");
  }
}

std::vector<GlobalId> tracked_grains(const Case& c) {
  std::vector<GlobalId> ids = c.analysis.tracks->grains;
  std::sort(ids.begin(), ids.end());
  if (ids.empty())
    for (GlobalId id = 0; id < row_count(c); id += c.analysis.tracks->one_in) ids.push_back(id);
  return ids;
}

}  // namespace thalweg
