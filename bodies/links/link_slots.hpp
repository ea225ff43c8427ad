// Memory locations of the populations of a link: offsets in 32 bits from one base, computed for a batch of links at a
// time. A table of pointers by direction would cost two more loads for each value.
//
// With A the slot in the plane of direction i of the cell x_f in the moved arrangement (of i' in the swapped one), B
// that in the plane of the opposite, and c the step in memory along c_i (populations.hpp):
//               f_i^c(x_f)   f_i^c(x_ff)   f_i'^c(x_f)   incoming f_i'(x_f)
//   swapped     A            A - c         B             B + c
//   moved       A + c        A             B - c         B
// In place of f_i^c(x_ff), which is where the sweep takes f_i of x_f from, a wall may have put what it returned.
#pragma once

#include "bodies/map/link_table.hpp"
#include "core/base/error.hpp"
#include "lbm/lattice/populations.hpp"

#include <fmt/format.h>

#include <experimental/simd>
#include <limits>

namespace thalweg::bodies {

class LinkSlots {
public:
  // The direction whose plane begins at the base, in the middle so that offsets reach both ways.
  static constexpr int middle = lbm::D3Q19::directions / 2;

  LinkSlots() = default;
  // The populations may not be too many for 32 bits; see check().
  template <typename Real>
  explicit LinkSlots(const lbm::Populations<Real>& populations)
      : moved_(populations.arrangement() == lbm::Arrangement::moved),
        row_(static_cast<int>(populations.indexing().row_stride())),
        plane_(static_cast<int>(populations.indexing().plane_stride())),
        first_(static_cast<int>(populations.indexing().index(0, 0, 0))),
        stride_(static_cast<int>(stride_of(populations))) {}

  // Throws InputError where the populations of a rank are too many for 32 bits.
  template <typename Real>
  static void check(const lbm::Populations<Real>& populations) {
    constexpr std::ptrdiff_t most = std::numeric_limits<int>::max() / (middle + 1);
    if (stride_of(populations) > most)
      throw InputError(fmt::format("A rank would hold {} cells around bodies, more than {}; use more ranks.",
                                   stride_of(populations), most));
  }

  // Finds, for links [0, count) in the plane z (owned local coordinate), count a multiple of links_at_a_time: the index
  // of x_f within its plane of cells; the slots of f_i^c(x_f), of f_i^c(x_ff) where delta < 1/2 or else f_i'^c(x_f),
  // and of the incoming f_i'.
  template <typename Real>
  void find(int z, const std::uint32_t* __restrict xy, const std::uint32_t* __restrict tags, int count,
            const Real* __restrict distance, std::int32_t* __restrict cells, std::int32_t* __restrict incident,
            std::int32_t* __restrict second, std::int32_t* __restrict reflected) const {
    using Pack = std::experimental::native_simd<Real>;
    using Ints = std::experimental::rebind_simd_t<std::int32_t, Pack>;
    constexpr auto unaligned = std::experimental::element_aligned;
    const int start = (z + 1) * plane_, corner = first_ - plane_;
    for (int k = 0; k < count; k += static_cast<int>(Pack::size())) {
      const Ints word(xy + k, unaligned), tag(tags + k, unaligned);
      const Ints cell = corner + (word >> LinkXY::y_shift & static_cast<int>(LinkXY::x_mask)) * row_ +
                        (word & static_cast<int>(LinkXY::x_mask));
      const Ints i = tag & static_cast<int>(LinkTag::direction_mask), opposite = ((i - 1) ^ 1) + 1;
      const Ints along = along_link(tag);
      // Planes count from the middle one: products beyond 9 strides would not fit into 32 bits.
      const Ints a = start + cell + ((moved_ ? i : opposite) - middle) * stride_ + (moved_ ? along : Ints(0));
      const Ints b = start + cell + ((moved_ ? opposite : i) - middle) * stride_ - (moved_ ? along : Ints(0));
      // 1 where the link is cut before its middle: as numbers, because masks of integers and of Real do not mix.
      Pack before_middle = 0;
      where(Pack(distance + k, unaligned) < Pack(Real(0.5)), before_middle) = Real(1);
      Ints other = b;
      where(std::experimental::static_simd_cast<Ints>(before_middle) != 0, other) = a - along;
      cell.copy_to(cells + k, unaligned);
      a.copy_to(incident + k, unaligned);
      other.copy_to(second + k, unaligned);
      (b + along).copy_to(reflected + k, unaligned);
    }
  }

  // The slot one link back, wherever the link is cut: from f_i^c(x_f) that of f_i^c(x_ff), from the incoming f_i' that
  // of f_i'^c(x_f).
  int one_back(int slot, std::uint32_t tag) const { return slot - along_link(static_cast<int>(tag)); }

private:
  template <typename Real>
  static std::ptrdiff_t stride_of(const lbm::Populations<Real>& populations) {
    return populations.plane(1) - populations.plane(0);
  }
  // The step in memory along a link: of one tag or of a pack of them.
  template <typename Tag>
  [[gnu::always_inline]] Tag along_link(const Tag& tag) const {
    return LinkTag::velocity(tag, 0) + LinkTag::velocity(tag, 1) * row_ + LinkTag::velocity(tag, 2) * plane_;
  }

  bool moved_ = false;
  int row_ = 0, plane_ = 0, first_ = 0, stride_ = 0;
};

}  // namespace thalweg::bodies
