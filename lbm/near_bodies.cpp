#include "lbm/near_bodies.hpp"

#include <cassert>
#include <experimental/simd>

namespace thalweg::lbm {

namespace stdx = std::experimental;

NearBodies::NearBodies(const CellIndexing& indexing, int radius_squared)
    : indexing_(indexing), layers_(layers_within(radius_squared)) {
  // Such a ball has at most 251 cells, so that a count fits in its 8 bits, and 7 of them in a row.
  assert(layers_ <= 3);
  for (int z = -layers_; z <= layers_; ++z)
    for (int y = -layers_; y <= layers_; ++y) {
      const int rest = radius_squared - y * y - z * z;
      if (rest < 0) continue;
      Run run{y, z, layers_within(rest), {}};
      for (int k = 0; k <= 2 * run.half_width; ++k) run.one[static_cast<std::size_t>(k)] = 1;
      runs_.push_back(run);
    }
  const Index3& n = indexing.size();
  const std::size_t rows = static_cast<std::size_t>(n[1]) * n[2];
  row_stride_ = static_cast<std::size_t>(n[0]) + 3 * layers_ + cells_at_once;
  counts_.resize(rows * row_stride_);
  bits_.resize(rows * indexing.packs_per_row());
  cells_in_row_.resize(rows);
}

void NearBodies::cell_changes(int x, int y, int z, int change) {
  using Vector = stdx::fixed_size_simd<std::uint8_t, cells_at_once>;
  const Index3& n = indexing_.size();
  const Vector turning = change > 0 ? 1 : 0;  // the count of a cell whose bit turns
  for (const Run& run : runs_) {
    const int row_y = y + run.y, row_z = z + run.z;
    if (row_y < 0 || row_z < 0 || row_y >= n[1] || row_z >= n[2]) continue;
    std::uint8_t* counts = counts_.data() + row_of(row_y, row_z) * row_stride_ + 2 * layers_ + x - run.half_width;
    const Vector one(run.one.data(), stdx::element_aligned), before(counts, stdx::element_aligned);
    const Vector now = change > 0 ? Vector(before + one) : Vector(before - one);
    now.copy_to(counts, stdx::element_aligned);
    if (any_of(now == turning && one == Vector(1))) turn_bits(run, x - run.half_width, row_y, row_z, counts, change);
  }
}

// Of the cells from x on, to which `counts` belong.
void NearBodies::turn_bits(const Run& run, int x, int y, int z, const std::uint8_t* counts, int change) {
  const int pack = indexing_.pack();
  std::uint16_t* row = bits_.data() + row_of(y, z) * indexing_.packs_per_row();
  for (int k = 0; k <= 2 * run.half_width; ++k) {
    if (counts[k] != (change > 0 ? 1 : 0) || !indexing_.owned(x + k, y, z)) continue;
    std::uint16_t& bits = row[(x + k) / pack];
    bits = static_cast<std::uint16_t>(bits ^ 1u << (x + k) % pack);
    cells_in_row_[row_of(y, z)] += change;
  }
}

void NearBodies::claims_change(int x, int y, int z, int change) {
  const auto [found, fresh] = claims_.try_emplace(place_of(x, y, z), 0);
  found->second += change;
  if (fresh || found->second == 0) cell_changes(x, y, z, change);
  if (found->second == 0) claims_.erase(found);
}

std::int64_t NearBodies::place_of(int x, int y, int z) const {
  const Index3& n = indexing_.size();
  const std::int64_t row = static_cast<std::int64_t>(z + layers_) * (n[1] + 2 * layers_) + (y + layers_);
  return row * (n[0] + 2 * layers_) + (x + layers_);
}

}  // namespace thalweg::lbm
