// Values at the cells of a block and in layers of ghost cells around it, for occasional use (an observer's gradients);
// the lattice's own halo is lbm/fluid/halo.hpp.
#pragma once

#include "core/parallel/decomposition.hpp"

#include <mpi.h>

#include <cstddef>
#include <vector>

namespace thalweg {

class GhostedField {
public:
  // All values start at zero. components: values a cell; width: layers of ghosts, at most
  // Decomposition::min_cells_per_rank. The decomposition must outlive the field.
  GhostedField(const Decomposition& decomposition, MPI_Comm communicator, int components, int width);

  const Index3& size() const { return size_; }  // owned cells

  // The components of a cell; local coordinates, owned 0 .. size-1, ghosts from -width to size-1+width.
  double* at(int x, int y, int z) { return values_.data() + place(x, y, z); }
  const double* at(int x, int y, int z) const { return values_.data() + place(x, y, z); }

  // Fills the ghosts from their owners, across edges and corners too. Ghosts beyond a face that is not periodic stay as
  // they are. Collective.
  void exchange();

private:
  std::size_t place(int x, int y, int z) const {
    const std::size_t row = static_cast<std::size_t>(z + width_) * (size_[1] + 2 * width_) + (y + width_);
    return (row * (size_[0] + 2 * width_) + (x + width_)) * components_;
  }
  Block slab(int axis, int from, int to) const;
  std::vector<double> packed(const Block& slab) const;
  void unpack(const Block& slab, const std::vector<double>& values);

  const Decomposition& decomposition_;
  MPI_Comm communicator_;
  int components_, width_;
  Index3 size_;
  std::vector<double> values_;
};

}  // namespace thalweg
