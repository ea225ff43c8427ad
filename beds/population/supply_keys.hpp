// Keys of what brings grains into the box during a run, and takes them out of it (dem/supply).
#pragma once

#include "beds/population/placement_keys.hpp"
#include "core/base/types.hpp"
#include "core/keys/section_visitor.hpp"

#include <cstdint>
#include <optional>

namespace thalweg::beds {

// Heights of centres above the bed (dem/supply/bed_level.hpp).
struct AboveBedKeys {
  double lower = 0.0, upper = 0.0;  // m
  bool operator==(const AboveBedKeys&) const = default;
};

// Grains like those of a population, which come in during the run.
struct SupplyKeys {
  std::int64_t population = 0;
  std::optional<double> rate;             // grains/s
  std::optional<double> mass_rate;        // kg/s
  std::optional<double> transport_rate;   // q*, over the width of the box
  double from = 0.0;                      // s
  std::optional<double> until;            // s; none: to the end of the run
  RegionKeys region;                      // of their centres
  std::optional<AboveBedKeys> above_bed;  // within the region; none: all of it
  std::optional<Vec3> velocity;           // m/s; none: that of the fluid there, or at rest
  std::int64_t seed = 1;
  bool operator==(const SupplyKeys&) const = default;
};

struct RecirculationKeys {
  RegionKeys region;
  double delay = 0.0;            // s
  std::optional<Vec3> velocity;  // m/s; none: that of the fluid there, or at rest
  std::int64_t seed = 1;
  bool operator==(const RecirculationKeys&) const = default;
};

// Grains whose centre enters the region leave the box.
struct SinkKeys {
  RegionKeys region;
  std::optional<RecirculationKeys> recirculation;  // none: they are gone
  bool operator==(const SinkKeys&) const = default;
};

void describe(SectionVisitor& visit, SupplyKeys& supply);
void describe(SectionVisitor& visit, SinkKeys& sink);

}  // namespace thalweg::beds
