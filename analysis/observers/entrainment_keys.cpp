// Keys of Entrainment, and the settings that follow from them.
#include "analysis/observers/entrainment.hpp"
#include "analysis/observers/transport_rate.hpp"
#include "core/base/schedule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

namespace thalweg::analysis {

namespace {

// Of a deque of libstdc++: as many as fit into 512 bytes.
constexpr std::size_t samples_a_block = 512 / sizeof(GrainSample);

}  // namespace

void describe(SectionVisitor& visit, EntrainmentKeys& keys) {
  visit.integer_list(
      "grains", keys.grains,
      {.meaning = "ids of the grains, numbered through the populations from 0 (of a clump that of its first member); "
                  "default: the free grains whose centre is above the bed height less one reference diameter",
       .at_least = 0,
       .example = 0});
  visit.real("from", keys.from, {.unit = "s", .meaning = "start of the observation", .at_least = 0.0});
  visit.real("memory", keys.memory,
             {.unit = "s", .meaning = "time before entrainment that is recorded for each grain", .above = 0.0});
  visit.real("every", keys.every, {.unit = "s", .meaning = "between recorded states; 0: every step", .at_least = 0.0});
  visit.real("refresh", keys.refresh,
             {.unit = "s", .meaning = "between two selections of the surface grains", .above = 0.0});
  visit.real("displacement", keys.displacement,
             {.unit = "1",
              .meaning = "a grain counts as entrained this many of its diameters away from its rest position",
              .above = 0.0});
  visit.real(
      "rest_time", keys.rest_time,
      {.unit = "s",
       .meaning =
           "a grain is at rest after it has been slower than the default moving speed of transport_rate for this long",
       .at_least = 0.0});
}

void check(const EntrainmentKeys& keys, const RunContext& run) {
  require_ids(run, keys.grains);
  for (const GlobalId id : keys.grains)
    if (const GlobalId clump = run.grains->first_member(id); clump != id)
      throw KeyError("grains",
                     fmt::format("grain {} is a member of clump {}; give the number of the clump", id, clump));
  if (keys.grains.empty() && run.box.periodic[2])
    throw KeyError("",
                   "the bed height is measured from the bottom, but z is periodic; name the grains, or give "
                   "domain.boundaries bottom and top");
  require_full_gravity_from(run, keys.from);
}

std::unique_ptr<Observer> make_observer(const EntrainmentKeys& keys, const RunContext& run,
                                        const RunningSystem& system) {
  EntrainmentSettings settings;
  static_cast<EntrainmentKeys&>(settings) = keys;
  std::sort(settings.grains.begin(), settings.grains.end());
  settings.interval = std::max(keys.every, system.time_step);
  settings.refresh_steps = Schedule(keys.refresh, system.time_step).interval();
  settings.window = settings.diameter = run.grains->reference_diameter;
  settings.moving_speed = transport_scales(run).moving_speed();
  settings.held = run.grains->held();
  settings.clumps = run.grains->any_clumps();
  settings.recirculation = run.grains->recirculation;
  settings.obstacles = run.grains->obstacles;
  settings.weight = run.grains->submerged_weight;
  settings.buoyancy = run.grains->buoyancy;
  return std::make_unique<Entrainment>(system.communicator, run.box, std::move(settings));
}

double Entrainment::bytes_per_id() {
  // A ring that is empty has a table of eight pointers and room for some samples (libstdc++).
  constexpr double table = 8 * sizeof(void*), room = samples_a_block * sizeof(GrainSample);
  return sizeof(Memory) + table + room + 2.0 * bytes_of_allocation + sizeof(GlobalId) + sizeof(char);  // WatchedHere
}

double Entrainment::bytes_per_sample(double touches) {
  return sizeof(GrainSample) + (bytes_of_allocation + sizeof(void*)) / samples_a_block + touches * sizeof(Touch) +
         (touches > 0.0 ? bytes_of_allocation : 0.0);
}

// Of a bed the grains of its upper diameter, at a solid fraction of 0.6, are watched; they have four contacts.
ObserverMemory memory_of(const EntrainmentKeys& keys, const RunContext& run, const RunSize& size) {
  const double d = run.grains->reference_diameter, width = run.grains->disk_thickness;
  const double plan = run.box.size.x() * (width > 0.0 ? width : run.box.size.y());
  const double grain = width > 0.0 ? std::numbers::pi / 4.0 * d * d * width : std::numbers::pi / 6.0 * d * d * d;
  const double watched =
      keys.grains.empty() ? std::min(size.ids, 0.6 * plan * d / grain) : static_cast<double>(keys.grains.size());
  const double samples = keys.memory / std::max(keys.every, size.step) + 1.0;
  constexpr double touches = 4.0;
  return {.of_ids =
              size.ids * Entrainment::bytes_per_id() + watched * samples * Entrainment::bytes_per_sample(touches)};
}

}  // namespace thalweg::analysis
