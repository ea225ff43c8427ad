// The fluid cells of a row in SIMD packs of doubles, and sums over them that have the same bits in any order: of whole
// multiples of 2^-36.
#pragma once

#include "core/sums/fixed_point.hpp"
#include "lbm/collision/sweep.hpp"
#include "lbm/fluid/fluid.hpp"

#include <array>
#include <cstdint>
#include <experimental/simd>

namespace thalweg::lbm {

template <typename Real>
class FluidPacks {
public:
  using Pack = std::experimental::native_simd<double>;
  using Mask = Pack::mask_type;
  static constexpr int width = static_cast<int>(Pack::size());
  static constexpr int fraction_bits = 36;
  // Terms below 100 are whole numbers below 2^43, so that those of this many packs, below 2^52 in all, add up in double
  // precision without rounding.
  static constexpr int most_packs = 512 / width;

  explicit FluidPacks(const Fluid<Real>& fluid)
      : fluid_(fluid), lane_([](int lane) { return static_cast<double>(lane); }) {}

  const Pack& lane() const { return lane_; }  // 0, 1, ...

  // Calls visit(x of the first cell, its index, which are fluid) for every pack of a row that may hold fluid, and
  // fetches the values at `slots` ahead.
  template <std::size_t slot_count, typename Visit>
  [[gnu::always_inline]] void for_each(int y, int z, const std::array<const Real*, slot_count>& slots,
                                       Visit visit) const {
    constexpr std::ptrdiff_t ahead = prefetch_bytes / static_cast<std::ptrdiff_t>(sizeof(Real));
    const CellIndexing& indexing = fluid_.indexing();
    const std::uint8_t* fluid_in_pack = fluid_.cells().fluid_in_packs(y, z);
    const std::ptrdiff_t row = indexing.index(0, y, z);
    const int pack = indexing.pack();
    for (int p = 0; p < indexing.packs_per_row(); ++p) {
      if (fluid_in_pack[p] == 0) continue;
#pragma GCC unroll 19
      for (std::size_t i = 0; i < slot_count; ++i) __builtin_prefetch(slots[i] + row + p * pack + ahead);
      for (int x = p * pack; x < (p + 1) * pack; x += width)
        visit(x, row + x, fluid_in_pack[p] == pack ? Mask(true) : fluid_lanes(row, x));
    }
  }

  // Multiples of 2^-36 as whole numbers.
  [[gnu::always_inline]] static Pack rounded(const Pack& value) {
    using CellSum = FixedPoint<fraction_bits>;
    return ((value + CellSum::rounding_shift) - CellSum::rounding_shift) * CellSum::scale;
  }

  [[gnu::always_inline]] static Pack where_else(const Mask& mask, const Pack& value, double otherwise) {
    Pack result = otherwise;
    where(mask, result) = value;
    return result;
  }

  static std::int64_t total(const Pack& lanes) { return static_cast<std::int64_t>(reduce(lanes)); }

private:
  Mask fluid_lanes(std::ptrdiff_t row, int x) const {
    const Pack body(fluid_.cells().bodies() + row + x, std::experimental::element_aligned);
    return body == static_cast<double>(CellMap::fluid) && lane_ < static_cast<double>(fluid_.indexing().size()[0] - x);
  }

  const Fluid<Real>& fluid_;
  Pack lane_;
};

}  // namespace thalweg::lbm
