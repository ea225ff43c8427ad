#include "core/parallel/ghosted_field.hpp"

#include "core/base/check.hpp"
#include "core/parallel/mpi_count.hpp"
#include "core/parallel/mpi_session.hpp"

#include <algorithm>

namespace thalweg {

namespace {

template <typename Visit>
void for_each_cell(const Block& block, Visit visit) {
  for (int z = block.lower[2]; z < block.upper[2]; ++z)
    for (int y = block.lower[1]; y < block.upper[1]; ++y)
      for (int x = block.lower[0]; x < block.upper[0]; ++x) visit(x, y, z);
}

}  // namespace

GhostedField::GhostedField(const Decomposition& decomposition, MPI_Comm communicator, int components, int width)
    : decomposition_(decomposition),
      communicator_(communicator),
      components_(components),
      width_(width),
      size_(decomposition.block_of(rank_of(communicator)).size()),
      values_(place(size_[0] + width - 1, size_[1] + width - 1, size_[2] + width - 1) + components, 0.0) {
  CHECK(components > 0 && width >= 0 && width <= Decomposition::min_cells_per_rank);
}

// Layers [from, to) along an axis: with ghosts along the axes that are done already, so that edges and corners come
// along.
Block GhostedField::slab(int axis, int from, int to) const {
  Block slab{{0, 0, 0}, size_};
  for (int done = 0; done < axis; ++done) {
    slab.lower[done] = -width_;
    slab.upper[done] = size_[done] + width_;
  }
  slab.lower[axis] = from;
  slab.upper[axis] = to;
  return slab;
}

std::vector<double> GhostedField::packed(const Block& slab) const {
  std::vector<double> values;
  for_each_cell(slab,
                [&](int x, int y, int z) { values.insert(values.end(), at(x, y, z), at(x, y, z) + components_); });
  return values;
}

void GhostedField::unpack(const Block& slab, const std::vector<double>& values) {
  const double* next = values.data();
  for_each_cell(slab, [&](int x, int y, int z) {
    std::copy_n(next, components_, at(x, y, z));
    next += components_;
  });
}

void GhostedField::exchange() {
  const Index3 here = decomposition_.coordinates_of(rank_of(communicator_));
  for (int axis = 0; axis < 3; ++axis) {
    const int n = size_[axis];
    if (decomposition_.layout()[axis] == 1) {  // its own neighbour, in a box that may be thinner than the ghosts
      if (!decomposition_.periodic()[axis]) continue;
      for (int layer = 0; layer < width_; ++layer) {
        unpack(slab(axis, n + layer, n + layer + 1), packed(slab(axis, layer % n, layer % n + 1)));
        const int from = n - 1 - layer % n;
        unpack(slab(axis, -1 - layer, -layer), packed(slab(axis, from, from + 1)));
      }
      continue;
    }
    for (const int side : {-1, 1}) {  // towards which the layers go
      Index3 to = here, from = here;
      to[axis] += side;
      from[axis] -= side;
      const int receiver = decomposition_.rank_at(to), sender = decomposition_.rank_at(from);
      const std::vector<double> sent = packed(side < 0 ? slab(axis, 0, width_) : slab(axis, n - width_, n));
      std::vector<double> received(sent.size());
      MPI_Sendrecv(sent.data(), mpi_count(sent.size()), MPI_DOUBLE, receiver < 0 ? MPI_PROC_NULL : receiver, 0,
                   received.data(), mpi_count(received.size()), MPI_DOUBLE, sender < 0 ? MPI_PROC_NULL : sender, 0,
                   communicator_, MPI_STATUS_IGNORE);
      if (sender >= 0) unpack(side < 0 ? slab(axis, n, n + width_) : slab(axis, -width_, 0), received);
    }
  }
}

}  // namespace thalweg
