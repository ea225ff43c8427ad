// What brings grains into the box and takes them out of it: supplies, sinks, and sinks whose grains come back. SI
// units.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"
#include "dem/clumps/clump_seed.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace thalweg::dem {

// Part of the box with its faces along the axes.
struct Zone {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();  // m
  bool holds(const Vec3& point) const {
    return (point.array() >= lower.array()).all() && (point.array() <= upper.array()).all();
  }
  // True if it lies in a box of this size (m) with its lower corner nowhere above the upper one.
  bool is_in(const Vec3& box_size) const {
    return (lower.array() >= 0.0).all() && lies_in_box(upper, box_size) && (lower.array() <= upper.array()).all();
  }
};

// Heights above the bed (bed_level.hpp), m.
struct HeightRange {
  double lower = 0.0, upper = 0.0;
};

// Place where grains and clumps come in: each at a random point of the zone where it touches nothing.
struct Entrance {
  Zone zone;  // of their centres
  // m/s; none: that with which a body left the box, if it comes in again at the height at which it left; else that of
  // the fluid there, or at rest
  std::optional<Vec3> velocity;
  std::int64_t seed = 1;
  std::optional<HeightRange> above_bed = std::nullopt;  // of their centres, within the zone; none: all of the zone
};

struct Supply {
  Entrance entrance;
  double rate = 0.0;                                                   // grains/s or kg/s; a clump is one grain
  bool by_mass = false;                                                // true: kg/s
  double from = 0.0, until = std::numeric_limits<double>::infinity();  // s
  int members = 1;                                                     // ids that each takes: of a clump its members
  // The grain or clump of this number (0, 1, ...), at the origin and with the id 0: the same at every call.
  std::function<GrainSeeds(std::int64_t number)> make;
};

// Zone in which every free grain or clump whose centre enters it leaves the box.
struct Sink {
  struct Recirculation {
    Entrance entrance;
    double delay = 0.0;  // s, until it comes in again
  };
  Zone zone;
  std::optional<Recirculation> recirculation;  // none: it is gone
};

}  // namespace thalweg::dem
