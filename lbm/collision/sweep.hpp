// The one hot loop of the lattice: stream in place and collide every pack of cells that holds fluid.
#pragma once

#include "lbm/collision/collision.hpp"
#include "lbm/lattice/cell_map.hpp"
#include "lbm/lattice/populations.hpp"

namespace thalweg::lbm {

// The 19 streams of a sweep are too many for the hardware prefetcher; prefetching each a few cache lines ahead gains a
// factor of 1.7 (measured: eight cache lines are best, four and sixteen cost up to a tenth).
constexpr std::ptrdiff_t prefetch_bytes = 512;

// Cells in a SIMD pack of this storage type on the machine compiled for.
template <typename Real>
int pack_width();

// Shear rates at the cells of one row as the collision saw them, by the axis the wall would be normal to:
// shear[a][x] = 2 sqrt(sum over the other axes b of S_ab^2). Rows of whole packs.
template <typename Real>
struct RowShear {
  Real* normal_to[3];
};

// rho - 1 and the momentum, without the half force, of the cells of one row before their collision. Rows of whole
// packs.
template <typename Real>
struct RowMoments {
  Real* deviation;
  Real* momentum[3];
};

// Output of a sweep besides the populations; null: not wanted.
template <typename Real>
struct RowOutput {
  const RowShear<Real>* shear = nullptr;
  const RowMoments<Real>* moments = nullptr;
};

// Sweeps one owned row. The arrangement is not switched: the caller does that once all rows are done.
template <typename Real>
void sweep_row(Populations<Real>& populations, const CellMap& cells, const CollisionParameters& parameters, int y,
               int z, const RowOutput<Real>& output);

}  // namespace thalweg::lbm
