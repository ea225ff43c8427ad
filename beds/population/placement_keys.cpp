#include "beds/population/placement_keys.hpp"

#include "core/keys/key_error.hpp"
#include "dem/supply/supply.hpp"

#include <fmt/format.h>

namespace thalweg::beds {

void describe(SectionVisitor& visit, RegionKeys& region) {
  visit.vec3("lower", region.lower, {.unit = "m", .meaning = "lower corner", .required = true, .example = 0.0});
  visit.vec3("upper", region.upper, {.unit = "m", .meaning = "upper corner", .required = true, .example = 0.05});
}

void describe(SectionVisitor& visit, PlacementKeys& placement) {
  visit.text("file", placement.file,
             {.meaning = "a bed file that a run has written (bed.h5), relative to this file",
              .example = "../settled_bed/run/bed.h5"});
  const bool by_file = placement.file.has_value();
  const OnlyIf of_file{by_file || !visit.reading(), "only a placement from a file has it"};
  const OnlyIf of_none{!by_file, "the file says where the grains are; remove this key or the file"};
  visit.real("largest_overlap", placement.largest_overlap,
             {.unit = "diameters",
              .meaning = "of grains in the file; default: 0.01",
              .at_least = 0.0,
              .at_most = 0.1,
              .example = PlacementKeys::bed_overlap,
              .only_if = of_file});
  visit.choice<FileVelocities>(
      "velocities", placement.velocities,
      {{FileVelocities::kept, "kept", "the default"}, {FileVelocities::zero, "zero", "grains begin at rest"}},
      {.meaning = "of the grains of the file", .only_if = of_file});
  visit.vec3_list(
      "positions", placement.positions,
      {.unit = "m", .meaning = "centres of the grains, one by one, in place of the keys below", .only_if = of_none});
  const OnlyIf spread_out{placement.positions.empty(),
                          "the positions are given one by one; remove this key or the positions"};
  visit.choice<PlacementPattern>(
      "pattern", placement.pattern,
      {{PlacementPattern::uniform, "uniform", "evenly spread, slightly disturbed"},
       {PlacementPattern::random, "random", "at random without overlap, up to a third of the volume"},
       {PlacementPattern::dense, "dense", "at random up to 0.6 of the volume: overlapping grains are pushed apart"}},
      {.meaning = "how the grains are spread over the region", .only_if = by_file ? of_none : spread_out});
  visit.integer("seed", placement.seed,
                {.meaning = "seed of the random placement; default: 1 of the first population, 2 of the second, ...",
                 .at_least = 0,
                 .only_if = by_file ? of_none : spread_out});
  visit.section("region", placement.region,
                {.meaning = by_file ? "only the grains of the file whose centre is in it"
                                    : "where the grains are put; default: the whole box",
                 .only_if = spread_out});
}

void check(const RegionKeys& region, const Vec3& box_size, const std::string& key, bool flat) {
  if (!dem::Zone{region.lower, region.upper}.is_in(box_size) ||
      !(flat || (region.lower.array() < region.upper.array()).all()))
    throw KeyError(
        key + ".upper",
        fmt::format("the region must lie in the box with lower below upper along every axis; give corners in "
                    "m between [0, 0, 0] and [{}, {}, {}]",
                    box_size[0], box_size[1], box_size[2]));
}

}  // namespace thalweg::beds
