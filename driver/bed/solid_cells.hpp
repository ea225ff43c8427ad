// Which points of a grid lie within the solids of a case at the start: centres of cells, or of boxes of several cells
// where the lattice is large. Solids of the lattice cover the cells whose centres are inside (bodies/map/body_map.hpp).
#pragma once

#include "core/base/types.hpp"
#include "driver/case/case.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace thalweg::driver {

class SolidCells {
public:
  explicit SolidCells(const Case& c);

  Index3 size() const { return size_; }
  bool covered(const Index3& cell) const { return covered_[index(cell)]; }
  bool any_open() const;
  double height(int k) const { return (k + 0.5) * step_.z(); }  // m, of a layer

  // Height (m) of the lowest point between these corners (m) that lies in no solid, down to a layer of cells; infinite
  // where there is none.
  double lowest_opening(const Vec3& lower, const Vec3& upper) const;

  // True if some way through the cells that are not covered and lie above this height (m) leads along x from one end
  // of the box to the other.
  bool opens_along_x(double height) const;

private:
  std::size_t index(const Index3& cell) const;
  // The plane across x with the fewest covered cells.
  int most_open_plane() const;
  // The neighbour of a cell, none beyond the faces, or through the lower face of the cut, a plane across x.
  std::optional<Index3> neighbour(const Index3& cell, int direction, int cut) const;

  Index3 size_;
  Vec3 step_;  // m
  std::array<bool, 3> periodic_;
  std::vector<bool> covered_;
};

// True if every point of a grid that lies in the inner solid lies in the outer one, too, and there is one.
bool lies_within(const Case& c, const SolidCase& inner, const SolidCase& outer);

// True if the solid covers the centre of a cell of the box.
bool covers_a_cell(const Case& c, const SolidCase& solid);

}  // namespace thalweg::driver
