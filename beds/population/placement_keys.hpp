// Keys of the placement of a population of grains.
#pragma once

#include "core/base/types.hpp"
#include "core/keys/section_visitor.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::beds {

enum class PlacementPattern { uniform, random, dense };

struct RegionKeys {
  Vec3 lower = Vec3::Zero();  // m
  Vec3 upper = Vec3::Zero();  // m
  bool operator==(const RegionKeys&) const = default;
};

enum class FileVelocities { kept, zero };

struct PlacementKeys {
  static constexpr double bed_overlap = 0.01;

  PlacementPattern pattern = PlacementPattern::uniform;  // unless there are positions or a file
  std::int64_t seed = 1;
  std::optional<RegionKeys> region;          // none: the whole box; of a file: the grains with their centre in it
  std::vector<Vec3> positions;               // m; as many as the population counts, or none
  std::optional<std::string> file;           // a bed file; relative to the case file, absolute once read
  std::optional<double> largest_overlap;     // diameters the grains of the file may overlap by; else bed_overlap
  std::optional<FileVelocities> velocities;  // of the file; else kept
  bool operator==(const PlacementKeys&) const = default;
};

void describe(SectionVisitor& visit, RegionKeys& region);
void describe(SectionVisitor& visit, PlacementKeys& placement);

// Throws KeyError where the region with this key is not in a box of this size (m), or its lower corner is above the
// upper one; flat: it may be a face, a line or a point.
void check(const RegionKeys& region, const Vec3& box_size, const std::string& key, bool flat);

}  // namespace thalweg::beds
