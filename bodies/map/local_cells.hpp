// Cells of this rank's memory around a point. Near a periodic face, or in a box that one rank spans alone, a global
// cell can be in memory more than once: as an owned cell and as a ghost.
#pragma once

#include "core/parallel/decomposition.hpp"

#include <cmath>
#include <vector>

namespace thalweg::bodies {

struct LocalCell {
  int local;      // coordinate in the block: owned 0 .. n-1
  double offset;  // of the cell's centre from the reference, nearest periodic image. The same bits on every rank
};

class LocalCells {
public:
  LocalCells(const Decomposition& decomposition, const Block& block) : decomposition_(decomposition), block_(block) {}

  // Cells along an axis whose centres are within `half_width` of `middle` (and perhaps one more), in memory on this
  // rank out to `ghosts` layers; offsets are taken from `reference`. All in cells.
  void along(int axis, double middle, double half_width, double reference, int ghosts,
             std::vector<LocalCell>& found) const {
    found.clear();
    const int cells = decomposition_.cells()[axis], n = block_.size()[axis];
    const bool periodic = decomposition_.periodic()[axis];
    int first = static_cast<int>(std::floor(middle - half_width - 0.5)),
        last = static_cast<int>(std::ceil(middle + half_width - 0.5));
    if (!periodic) {
      first = first < 0 ? 0 : first;
      last = last > cells - 1 ? cells - 1 : last;
    }
    for (int image = periodic ? -1 : 0; image <= (periodic ? 1 : 0); ++image)
      for (int g = first; g <= last; ++g) {
        const int local = g + image * cells - block_.lower[axis];
        if (local < -ghosts || local >= n + ghosts) continue;
        // Uses the coordinate inside the box, so that the bits do not depend on the image.
        const int wrapped = g >= 0 && g < cells ? g : (g % cells + cells) % cells;
        double offset = wrapped + 0.5 - reference;
        if (periodic) {
          if (offset > 0.5 * cells)
            offset -= cells;
          else if (offset < -0.5 * cells)
            offset += cells;
        }
        found.push_back({local, offset});
      }
  }

private:
  const Decomposition& decomposition_;
  Block block_;
};

}  // namespace thalweg::bodies
