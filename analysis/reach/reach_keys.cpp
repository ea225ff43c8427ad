#include "analysis/reach/reach_keys.hpp"

#include "analysis/observer/transport_scales.hpp"
#include "analysis/reach/reach.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::analysis {

std::int64_t default_sections(double length, double diameter) {
  return std::clamp<std::int64_t>(std::llround(length / diameter), 2, ReachKeys::most_sections);
}

void describe(SectionVisitor& visit, ReachKeys& keys) {
  describe_from(visit, keys.from);
  visit.real("every", keys.every, {.unit = "s", .meaning = "between observations of the grains", .above = 0.0});
  visit.real("record_every", keys.record_every,
             {.unit = "s",
              .meaning = "length of a record, over which grains are counted and a pixel of the bed must stand still; "
                         "rounded up to whole observations",
              .above = 0.0});
  visit.integer("sections", keys.sections,
                {.meaning = "planes across x at equal distances; default: one per reference diameter",
                 .at_least = 2,
                 .example = 20});
  visit.real("pixel", keys.pixel,
             {.unit = "m",
              .meaning = "side of a pixel of the side view; default: 1/25 of the reference diameter",
              .above = 0.0,
              .example = 2e-4});
  describe_moving_speed(visit, keys.moving_speed);
  if (!visit.reading()) return;
  visit.require(keys.sections.value_or(2) <= ReachKeys::most_sections, "sections",
                fmt::format("give at most {}", ReachKeys::most_sections));
  visit.require(keys.record_every >= keys.every, "record_every",
                fmt::format("a record holds at least one observation; give at least {:g} s", keys.every));
}

void check(const ReachKeys& keys, const RunContext& run) {
  require_grains(run, "count");
  if (run.box.periodic[2])
    throw KeyError("",
                   "the bed level is measured from the bottom, but z is periodic; remove the section or give "
                   "domain.boundaries a bottom and a top, for example no_slip and free_slip");
  if (!run.grains->any_free())
    throw KeyError("", "no grain is free to move, so there is no transport; remove the section");
  require_fine_pixel(run, keys.pixel);
}

std::optional<std::string> warning(const ReachKeys& keys, const RunContext& run) {
  return fast_moving_speed(ReachKeys::section, keys.moving_speed, run);
}

std::unique_ptr<Observer> make_observer(const ReachKeys& keys, const RunContext& run, const RunningSystem& system) {
  return std::make_unique<Reach>(system.communicator, run.box, transport_scales(run), keys, run.grains->disk_thickness,
                                 run.grains->recirculation, run.grains->obstacles.spheres);
}

}  // namespace thalweg::analysis
