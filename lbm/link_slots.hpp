// Where the populations of a link are in memory: offsets in 32 bits from one base, computed for a batch of links at a
// time. A table of pointers by direction would cost two more loads for each value.
//
// With A the slot in the plane of direction i of the cell x_f in the moved arrangement (of i' in the swapped one), B
// that in the plane of the opposite, and c the step in memory along c_i (populations.hpp):
//               f_i^c(x_f)   f_i^c(x_ff)   f_i'^c(x_f)   incoming f_i'(x_f)
//   swapped     A            A - c         B             B + c
//   moved       A + c        A             B - c         B
// In place of f_i^c(x_ff), which is where the sweep takes f_i of x_f from, a wall may have put what it returned.
#pragma once

#include "core/error.hpp"
#include "lbm/link_table.hpp"
#include "lbm/populations.hpp"

#include <fmt/format.h>

#include <limits>

namespace thalweg::lbm {

class LinkSlots {
public:
  // The direction whose plane begins at the base, in the middle so that offsets reach both ways.
  static constexpr int middle = D3Q19::directions / 2;

  LinkSlots() = default;
  // Throws InputError where the populations of a rank are too many for 32 bits.
  template <typename Real>
  explicit LinkSlots(const Populations<Real>& populations)
      : moved_(populations.arrangement() == Arrangement::moved),
        row_(static_cast<int>(populations.indexing().row_stride())),
        plane_(static_cast<int>(populations.indexing().plane_stride())),
        first_(static_cast<int>(populations.indexing().index(0, 0, 0))) {
    const std::ptrdiff_t stride = populations.plane(1) - populations.plane(0);
    if (stride > std::numeric_limits<int>::max() / (middle + 1))
      throw InputError(fmt::format("A rank would hold {} cells around grains, more than {}; use more ranks.", stride,
                                   std::numeric_limits<int>::max() / (middle + 1)));
    stride_ = static_cast<int>(stride);
  }

  // Of links [0, count) in the plane z (owned local coordinate), count a multiple of LinkTable::slack: the index of x_f
  // within its plane of cells; the slots of f_i^c(x_f), of f_i^c(x_ff) where delta < 1/2 or else f_i'^c(x_f), and of
  // the incoming f_i'.
  template <typename Real>
  void find(int z, const std::uint32_t* __restrict places, const std::uint32_t* __restrict tags, int count,
            const Real* __restrict distance, std::int32_t* __restrict cells, std::int32_t* __restrict incident,
            std::int32_t* __restrict second, std::int32_t* __restrict reflected) const {
    const int row = row_, plane = plane_, stride = stride_, corner = first_ - plane;
    const bool moved = moved_;
    const int start = (z + 1) * plane - middle * stride;
    constexpr int whole = static_cast<int>(LinkTable::slack);
    for (int first = 0; first < count; first += whole)
      for (int k = first; k < first + whole; ++k) {
        const int place = static_cast<int>(places[k]), tag = static_cast<int>(tags[k]);
        const int cell = corner + (place >> LinkPlace::y_shift & static_cast<int>(LinkPlace::x_mask)) * row +
                         (place & static_cast<int>(LinkPlace::x_mask));
        const int i = tag & static_cast<int>(LinkTag::direction_mask), opposite = ((i - 1) ^ 1) + 1;
        const int along = along_link(tag, row, plane);
        const int a = start + cell + (moved ? i : opposite) * stride,
                  b = start + cell + (moved ? opposite : i) * stride;
        const int shift = moved ? along : 0;
        cells[k] = cell;
        incident[k] = a + shift;
        second[k] = distance[k] < Real(0.5) ? a + shift - along : b - shift;
        reflected[k] = b - shift + along;
      }
  }

  // The slot one link back, wherever the link is cut: from f_i^c(x_f) that of f_i^c(x_ff), from the incoming f_i' that
  // of f_i'^c(x_f).
  int one_back(int slot, std::uint32_t tag) const { return slot - along_link(static_cast<int>(tag), row_, plane_); }

private:
  static int along_link(int tag, int row, int plane) {
    return LinkTag::velocity(tag, 0) + LinkTag::velocity(tag, 1) * row + LinkTag::velocity(tag, 2) * plane;
  }

  bool moved_ = false;
  int row_ = 0, plane_ = 0, first_ = 0, stride_ = 0;
};

}  // namespace thalweg::lbm
