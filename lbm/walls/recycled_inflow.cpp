#include "lbm/walls/recycled_inflow.hpp"

#include "core/base/error.hpp"
#include "core/sums/fixed_point.hpp"
#include "lbm/lattice/face_axes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace thalweg::lbm {

namespace {

constexpr int message_tag = 61;
constexpr double from_body = std::numeric_limits<double>::quiet_NaN();

}  // namespace

template <typename Real>
RecycledInflow<Real>::RecycledInflow(const Decomposition& decomposition, int rank, const CellIndexing& indexing,
                                     int face, int plane, double speed)
    : indexing_(indexing),
      axis_(face / 2),
      inward_(face % 2 == 0 ? 1 : -1),
      nu_(indexing.size()[first_axis(axis_)]),
      nv_(indexing.size()[second_axis(axis_)]) {
  const Index3& cells = decomposition.cells();
  if (plane < 0 || plane >= cells[axis_])
    throw InputError(
        fmt::format("The recycling plane is at cell {} across {} cells; give one of the box.", plane, cells[axis_]));
  if (plane == (inward_ > 0 ? 0 : cells[axis_] - 1))
    throw InputError("The recycling plane lies in the cells of the inlet itself; give one farther from the face.");
  mass_ = speed * cells[first_axis(axis_)] * cells[second_axis(axis_)];
  int found = 0;
  for (int o = 1; o < D3Q19::directions; ++o)
    if (D3Q19::c[o][axis_] == inward_) directions_.at(static_cast<std::size_t>(found++)) = o;

  const Index3 here = decomposition.coordinates_of(rank);
  recycled_.resize(static_cast<std::size_t>(nu_) * static_cast<std::size_t>(nv_));
  const auto in_slab = [&](int slab) {
    Index3 at = here;
    at[axis_] = slab;
    return decomposition.rank_at(at);
  };
  const int inlet_slab = inward_ > 0 ? 0 : decomposition.layout()[axis_] - 1;
  int plane_slab = 0;
  while (decomposition.block_of(in_slab(plane_slab)).upper[axis_] <= plane) ++plane_slab;
  if (here[axis_] == plane_slab) {
    plane_ = plane - decomposition.block_of(rank).lower[axis_];
    inlet_rank_ = in_slab(inlet_slab);
  }
  if (here[axis_] == inlet_slab) {
    inlet_ = inward_ > 0 ? 0 : indexing.size()[axis_] - 1;
    plane_rank_ = in_slab(plane_slab);
  }
}

// Does action(number in the layer, cell) for all cells of this rank in a layer.
template <typename Real>
template <typename Action>
void RecycledInflow<Real>::for_cells(int layer, const Action& action) const {
  Index3 at{0, 0, 0};
  at[axis_] = layer;
  for (int v = 0; v < nv_; ++v)
    for (int u = 0; u < nu_; ++u) {
      at[first_axis(axis_)] = u;
      at[second_axis(axis_)] = v;
      action(static_cast<std::size_t>(v) * nu_ + u, at);
    }
}

template <typename Real>
void RecycledInflow<Real>::take_from_plane(const Populations<Real>& populations, const CellMap& cells) {
  for_cells(plane_, [&](std::size_t n, const Index3& at) {
    const std::ptrdiff_t cell = indexing_.index(at[0], at[1], at[2]);
    recycled_[n].fill(from_body);
    if (!cells.is_fluid(cell)) return;
    for (int k = 0; k < entering; ++k) {
      const int o = directions_[static_cast<std::size_t>(k)], back = D3Q19::opposite(o);
      const Index3 before{at[0] + D3Q19::c[back][0], at[1] + D3Q19::c[back][1], at[2] + D3Q19::c[back][2]};
      if (cells.is_fluid(cell + indexing_.offset(back)) || cells.is_beyond_wall(before))
        recycled_[n][static_cast<std::size_t>(k)] = static_cast<double>(populations.incoming(o, cell));
    }
  });
}

// Moves them from the ranks of the plane to those of the inlet.
template <typename Real>
void RecycledInflow<Real>::send_to_inlet(MPI_Comm communicator) {
  if (plane_ >= 0 && inlet_ >= 0) return;
  const int count = entering * nu_ * nv_;
  if (plane_ >= 0) MPI_Send(recycled_.data(), count, MPI_DOUBLE, inlet_rank_, message_tag, communicator);
  if (inlet_ >= 0)
    MPI_Recv(recycled_.data(), count, MPI_DOUBLE, plane_rank_, message_tag, communicator, MPI_STATUS_IGNORE);
}

template <typename Real>
void RecycledInflow<Real>::apply(Populations<Real>& populations, const CellMap& cells, MPI_Comm communicator) {
  if (plane_ >= 0) take_from_plane(populations, cells);
  send_to_inlet(communicator);

  // Sums of integers, so that they do not depend on the ranks.
  std::array<std::int64_t, 2> sums{};  // of the mass that the populations bring, and N
  if (inlet_ >= 0)
    for_cells(inlet_, [&](std::size_t n, const Index3& at) {
      const std::ptrdiff_t cell = indexing_.index(at[0], at[1], at[2]);
      if (!cells.is_fluid(cell)) return;
      for (int k = 0; k < entering; ++k) {
        const double leaving = static_cast<double>(
            populations.post_collision(D3Q19::opposite(directions_[static_cast<std::size_t>(k)]), cell));
        double& entered = recycled_[n][static_cast<std::size_t>(k)];
        if (std::isnan(entered)) entered = leaving;
        sums[0] = exact_sum(sums[0], LatticeFixed::from(entered - leaving));
      }
      ++sums[1];
    });
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_INT64_T, MPI_SUM, communicator);
  if (inlet_ < 0 || sums[1] == 0) return;
  const double missing = (mass_ - LatticeFixed::to_double(sums[0])) / static_cast<double>(sums[1]);
  for_cells(inlet_, [&](std::size_t n, const Index3& at) {
    const std::ptrdiff_t cell = indexing_.index(at[0], at[1], at[2]);
    if (!cells.is_fluid(cell)) return;
    for (int k = 0; k < entering; ++k) {
      const int o = directions_[static_cast<std::size_t>(k)];
      populations.incoming(o, cell) =
          static_cast<Real>(recycled_[n][static_cast<std::size_t>(k)] + 6.0 * D3Q19::weight(o) * missing);
    }
  });
}

template class RecycledInflow<float>;
template class RecycledInflow<double>;

}  // namespace thalweg::lbm
