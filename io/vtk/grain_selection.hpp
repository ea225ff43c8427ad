// The grains that an output shows: all, or those with certain ids, of a population, or in a box.
#pragma once

#include "core/base/types.hpp"
#include "core/keys/section_visitor.hpp"
#include "core/state/population_ids.hpp"
#include "io/text/box_keys.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace thalweg::io {

// Grains that meet every condition given. Members of clumps count one by one.
struct GrainSelectionKeys {
  std::vector<std::int64_t> ids;           // empty: any
  std::optional<std::int64_t> population;  // none: any
  std::optional<BoxKeys> box;              // none: anywhere
  bool operator==(const GrainSelectionKeys&) const = default;
};
void describe_selection(SectionVisitor& visit, GrainSelectionKeys& keys);

// Throws KeyError where there is no such grain or population, the box is empty, or it reaches out of a domain of this
// size (m).
void check(const GrainSelectionKeys& keys, const PopulationIds& ids, const Vec3& domain_size);

class GrainSelection {
public:
  GrainSelection(GrainSelectionKeys keys, PopulationIds populations);

  // True if the grain with this id and centre (m) is shown.
  bool has(GlobalId id, const Vec3& position) const;

  bool takes_all() const { return keys_ == GrainSelectionKeys{}; }

private:
  GrainSelectionKeys keys_;  // ids in their order
  PopulationIds populations_;
};

}  // namespace thalweg::io
