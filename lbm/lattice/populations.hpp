// The lattice in memory: one copy of the populations, streamed in place (the AA pattern of Bailey et al. 2009).
//
// Structure of arrays: a plane of cells per direction, x contiguous, rows padded to whole SIMD packs, one ghost cell
// around the block. Real is the storage type of f_i - w_i. With S[i][x] the storage, f^c the post-collision populations
// and i' the opposite of i, the state between two steps is one of
//   swapped:  S[i'][x]     = f_i^c(x)      (after an even step of the pattern, which stays in its own cells)
//   moved:    S[i][x + c_i] = f_i^c(x)     (after an odd step, which pulls from and pushes to the neighbours)
// Either way the next sweep reads and writes exactly the 19 slots that belong to a cell, so cells may be swept in any
// order, and solid cells may be swept or skipped at will: their output is never read.
#pragma once

#include "core/base/huge_pages.hpp"
#include "core/base/types.hpp"
#include "core/parallel/decomposition.hpp"
#include "lbm/lattice/d3q19.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace thalweg::lbm {

enum class Arrangement { swapped, moved };  // after an even or an odd step

// Indices of the cells of a block in memory, shared by all arrays parallel to the populations.
class CellIndexing {
public:
  // pack: SIMD width in cells; rows start on a pack boundary.
  CellIndexing(const Index3& size, int pack);

  const Index3& size() const { return size_; }  // owned cells
  int pack() const { return pack_; }
  int packs_per_row() const { return (size_[0] + pack_ - 1) / pack_; }
  std::ptrdiff_t row_stride() const { return row_stride_; }
  // Distance from a cell to the next along an axis.
  std::ptrdiff_t stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? row_stride_ : plane_stride_; }
  std::ptrdiff_t plane_stride() const { return plane_stride_; }
  std::size_t count() const {
    return static_cast<std::size_t>(plane_stride_) * (size_[2] + 2);
  }  // with ghosts, padding

  // Local coordinates: owned 0 .. size-1, ghosts -1 and size.
  std::ptrdiff_t index(int x, int y, int z) const {
    return (z + 1) * plane_stride_ + (y + 1) * row_stride_ + (x + pack_);
  }
  std::ptrdiff_t offset(int direction) const { return offset_[direction]; }  // index(x + c) - index(x)
  bool owned(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < size_[0] && y < size_[1] && z < size_[2];
  }
  bool in_memory(const Index3& cell) const {  // owned or ghost
    for (int a = 0; a < 3; ++a)
      if (cell[a] < -1 || cell[a] > size_[a]) return false;
    return true;
  }

private:
  Index3 size_;
  int pack_;
  std::ptrdiff_t row_stride_, plane_stride_;
  std::ptrdiff_t offset_[D3Q19::directions];
};

template <typename Real>
class Populations {
public:
  explicit Populations(const CellIndexing& indexing);  // all deviations zero: fluid at rest, density 1

  const CellIndexing& indexing() const { return indexing_; }
  Arrangement arrangement() const { return arrangement_; }
  void set_arrangement(Arrangement a) { arrangement_ = a; }

  Real* plane(int direction) { return planes_[direction]; }
  const Real* plane(int direction) const { return planes_[direction]; }

  // The slot that holds f_i^c of a cell, in the present arrangement. The cell's neighbours must be in memory.
  Real& post_collision(int i, std::ptrdiff_t cell) { return *slot_of(i, cell); }
  Real post_collision(int i, std::ptrdiff_t cell) const { return *const_cast<Populations*>(this)->slot_of(i, cell); }

  // Slots of f_i^c of the cell with index 0, by direction, to which passes over many cells add the index of a cell.
  // Valid until the arrangement changes.
  std::array<const Real*, D3Q19::directions> sent() const {
    std::array<const Real*, D3Q19::directions> slots;
    for (int i = 0; i < D3Q19::directions; ++i)
      slots[static_cast<std::size_t>(i)] = const_cast<Populations*>(this)->slot_of(i, 0);
    return slots;
  }

  // The slot from which the next sweep will take f_i of a cell.
  Real& incoming(int i, std::ptrdiff_t cell) {
    const int opposite = D3Q19::opposite(i);
    return arrangement_ == Arrangement::swapped ? planes_[opposite][cell + indexing_.offset(opposite)]
                                                : planes_[i][cell];
  }

  Real incoming(int i, std::ptrdiff_t cell) const { return const_cast<Populations*>(this)->incoming(i, cell); }

  // rho - 1 of a cell from its post-collision populations (collisions conserve it); summed in double.
  double density_deviation(std::ptrdiff_t cell) const {
    double sum = 0.0;
    for (int i = 0; i < D3Q19::directions; ++i) sum += static_cast<double>(post_collision(i, cell));
    return sum;
  }

private:
  Real* slot_of(int i, std::ptrdiff_t cell) {
    return arrangement_ == Arrangement::swapped ? planes_[D3Q19::opposite(i)] + cell
                                                : planes_[i] + cell + indexing_.offset(i);
  }

  CellIndexing indexing_;
  Arrangement arrangement_ = Arrangement::swapped;
  HugePages<Real> memory_;
  Real* planes_[D3Q19::directions];
};

}  // namespace thalweg::lbm
