// The number of a body on this rank: solids first, then spheres. It indexes BodyMap::bodies() and the table of
// LinkBody, and is the number that lbm::CellMap keeps of a covered cell. A type of its own, so that no slot of a grain
// in its store can be taken for one.
#pragma once

#include <cstddef>
#include <cstdint>

namespace thalweg::bodies {

enum class BodySlot : std::int32_t { none = -1 };

constexpr std::size_t index_of(BodySlot slot) { return static_cast<std::size_t>(slot); }
constexpr BodySlot slot_at(std::size_t index) { return static_cast<BodySlot>(index); }
constexpr BodySlot slot_of_solid(int solid) { return static_cast<BodySlot>(solid); }

}  // namespace thalweg::bodies
