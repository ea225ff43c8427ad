#include "io/vtk/grain_selection.hpp"

#include "core/keys/key_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <unordered_set>
#include <utility>

namespace thalweg::io {

void describe_selection(SectionVisitor& visit, GrainSelectionKeys& keys) {
  visit.integer_list("ids", keys.ids, {.meaning = "only grains with these ids; default: any", .at_least = 0});
  visit.integer("population", keys.population,
                {.meaning = "only grains of this population, by its number in grains; default: any", .at_least = 0});
  visit.section("box", keys.box, {.meaning = "only grains whose centre is in it at the time of the frame"});
}

namespace {

void check_shown_box(const BoxKeys& box, const Vec3& domain_size) {
  const Vec3 &lower = box.lower, &upper = box.upper;
  check_in_domain(box, domain_size);
  if (!(lower.array() < upper.array()).all())
    throw KeyError("box", "the box has no volume; give an upper corner in m above the lower one along every axis");
}

}  // namespace

void check(const GrainSelectionKeys& keys, const PopulationIds& ids, const Vec3& domain_size) {
  const std::vector<GlobalId>& ends = ids.ends;
  const std::int64_t grains = !ids.supplied.empty() ? std::numeric_limits<std::int64_t>::max()
                              : ends.empty()        ? 0
                                                    : ends.back();
  std::unordered_set<std::int64_t> seen;
  for (std::size_t n = 0; n < keys.ids.size(); ++n) {
    if (keys.ids[n] >= grains)
      throw KeyError(fmt::format("ids.{}", n),
                     fmt::format("there is no such grain; give ids from 0 to {}", grains - 1));
    if (!seen.insert(keys.ids[n]).second)
      throw KeyError(fmt::format("ids.{}", n), "the id is given twice; remove one of the two");
  }
  const auto populations = static_cast<std::int64_t>(ends.size());
  if (keys.population && *keys.population >= populations)
    throw KeyError("population", fmt::format("there is no such population; {}",
                                             populations == 1 ? "give 0, the only one"
                                                              : fmt::format("give one of 0 to {}", populations - 1)));
  if (keys.box) check_shown_box(*keys.box, domain_size);
}

GrainSelection::GrainSelection(GrainSelectionKeys keys, PopulationIds populations)
    : keys_(std::move(keys)), populations_(std::move(populations)) {
  std::sort(keys_.ids.begin(), keys_.ids.end());
}

bool GrainSelection::has(GlobalId id, const Vec3& position) const {
  if (!keys_.ids.empty() && !std::binary_search(keys_.ids.begin(), keys_.ids.end(), id)) return false;
  if (keys_.population && population_of(id, populations_) != *keys_.population) return false;
  return !keys_.box ||
         ((keys_.box->lower.array() <= position.array()).all() && (position.array() <= keys_.box->upper.array()).all());
}

}  // namespace thalweg::io
