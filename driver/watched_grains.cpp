#include "driver/watched_grains.hpp"

#include <fmt/format.h>

#include <algorithm>

// Sections of what is recorded of single grains, and whether the grains they name exist.
namespace thalweg {

void describe(SectionVisitor& visit, TracksCase& tracks) {
  visit.integer_list("grains", tracks.grains,
                     {.meaning = "ids of the grains, in the order of the populations from 0; else every one_in-th",
                      .at_least = 0,
                      .example = 0});
  visit.integer("one_in", tracks.one_in,
                {.meaning = "grains 0, one_in, 2 one_in, ... where no ids are given", .at_least = 1});
  visit.real("every", tracks.every, {.unit = "s", .meaning = "between measurements", .above = 0.0});
}

void describe(SectionVisitor& visit, EntrainmentCase& entrainment) {
  visit.integer_list("grains", entrainment.grains,
                     {.meaning = "ids of the grains, in the order of the populations from 0; else the free ones whose "
                                 "centre is above the bed's height less one reference diameter",
                      .at_least = 0,
                      .example = 0});
  visit.real("from", entrainment.from, {.unit = "s", .meaning = "start of the watch", .at_least = 0.0});
  visit.real(
      "memory", entrainment.memory,
      {.unit = "s", .meaning = "what is kept of each grain, and goes into the file with its start", .above = 0.0});
  visit.real("every", entrainment.every,
             {.unit = "s", .meaning = "between the states that are kept; 0: every step", .at_least = 0.0});
  visit.real("refresh", entrainment.refresh,
             {.unit = "s", .meaning = "until the grains of the surface are chosen anew", .above = 0.0});
  visit.real(
      "displacement", entrainment.displacement,
      {.unit = "1", .meaning = "a grain starts that is so many of its diameters from its rest place", .above = 0.0});
  visit.real("rest_time", entrainment.rest_time,
             {.unit = "s",
              .meaning = "a grain rests that has been slower for so long than the speed from which it moves",
              .at_least = 0.0});
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
  if (const auto& entrainment = c.analysis.entrainment) {
    const std::string key = "analysis.entrainment";
    check_ids(c, document, key, entrainment->grains);
    for (const PopulationCase& grains : c.grains)
      if (grains.clumps.count > 0)
        throw document.error(key, "it knows grains that are single spheres, and there are clumps; remove the section");
    if (entrainment->grains.empty() && periodic_axes(c.domain)[2])
      throw document.error(key,
                           "a bed has a height above a bottom, and here z is periodic; name the grains, or give "
                           "domain.boundaries bottom and top");
    if (entrainment->from < c.run.ramp)
      throw document.error(key + ".from",
                           fmt::format("{} s is before gravity has its full value; give at least run.ramp, {} s",
                                       entrainment->from, c.run.ramp));
  }
}

std::vector<GlobalId> watched_grains(const Case& c) {
  std::vector<GlobalId> ids = c.analysis.entrainment->grains;
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::vector<GlobalId> tracked_grains(const Case& c) {
  std::vector<GlobalId> ids = c.analysis.tracks->grains;
  std::sort(ids.begin(), ids.end());
  if (ids.empty())
    for (GlobalId id = 0; id < row_count(c); id += c.analysis.tracks->one_in) ids.push_back(id);
  return ids;
}

}  // namespace thalweg
