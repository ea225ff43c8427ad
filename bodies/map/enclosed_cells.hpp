// Fluid cells that are shut in, alone or two together: no other fluid is beside them, only bodies and walls. Nothing
// flows out of them, so what their links add would pile up; the links of such cells let it go
// (interpolated_bounce_back.hpp).
#pragma once

#include "bodies/map/body_map.hpp"
#include "lbm/lattice/cell_map.hpp"

#include <map>
#include <set>
#include <vector>

namespace thalweg::bodies {

class EnclosedCells {
public:
  explicit EnclosedCells(const lbm::CellMap& cells) : cells_(cells) {}

  bool contains(const Index3& owned) const { return cells_now_.contains(owned); }

  // Follows the map's changes since the last call; returns the owned cells that became enclosed or no longer are.
  std::vector<Index3> update(const BodyMap& map);

private:
  static constexpr int none = 0, several = -1;

  bool is_open(const BodyMap& map, const Index3& cell, int direction) const;
  int opening(const BodyMap& map, const Index3& cell) const;

  const lbm::CellMap& cells_;
  // Owned fluid cells with at most one fluid cell beside them, and in which direction that is. The second cell may be a
  // ghost, and what lies beyond may change without any change in memory; there are few of them, so each is looked at
  // in every update.
  std::map<Index3, int> pockets_;
  std::set<Index3> cells_now_;
};

}  // namespace thalweg::bodies
