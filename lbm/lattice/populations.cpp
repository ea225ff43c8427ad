#include "lbm/lattice/populations.hpp"

#include "core/base/check.hpp"

namespace thalweg::lbm {

CellIndexing::CellIndexing(const Index3& size, int pack) : size_(size), pack_(pack) {
  CHECK(pack > 0 && size[0] > 0 && size[1] > 0 && size[2] > 0);
  // A row is one pack (its last cell is the ghost), the owned cells in whole packs, and one pack for the neighbours
  // that the last one reaches.
  row_stride_ = static_cast<std::ptrdiff_t>(packs_per_row() + 2) * pack;
  plane_stride_ = row_stride_ * (size[1] + 2);
  for (int i = 0; i < D3Q19::directions; ++i)
    offset_[i] = D3Q19::c[i][0] + D3Q19::c[i][1] * row_stride_ + D3Q19::c[i][2] * plane_stride_;
}

template <typename Real>
Populations<Real>::Populations(const CellIndexing& indexing) : indexing_(indexing) {
  constexpr std::size_t line = 64;                          // bytes in a cache line
  constexpr std::size_t stagger = 9 * line / sizeof(Real);  // keeps the 19 streams out of each other's cache sets
  const std::size_t per_line = line / sizeof(Real);
  const std::size_t stride = (indexing.count() + per_line - 1) / per_line * per_line + stagger;  // Reals
  // 38 streams over as many distant pages: huge pages keep them all in the TLB.
  memory_ = in_huge_pages(stride * D3Q19::directions, Real(0));
  for (int i = 0; i < D3Q19::directions; ++i) planes_[i] = memory_.get() + stride * i;
}

template class Populations<float>;
template class Populations<double>;

}  // namespace thalweg::lbm
