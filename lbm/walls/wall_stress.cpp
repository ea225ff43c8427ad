#include "lbm/walls/wall_stress.hpp"

#include "lbm/lattice/face_axes.hpp"
#include "lbm/walls/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg::lbm {

namespace {

double stress_ratio(double reynolds) {
  static const StressRatio ratio;
  return ratio(reynolds);
}

}  // namespace

template <typename Real>
WallStress<Real>::WallStress(const CellIndexing& indexing, int face, const std::array<bool, 6>& present,
                             int cells_across, double viscosity)
    : indexing_(indexing),
      face_(face),
      normal_(face / 2),
      u_axis_(first_axis(normal_)),
      v_axis_(second_axis(normal_)),
      nu_(indexing.size()[u_axis_]),
      nv_(indexing.size()[v_axis_]),
      depth_(indexing.size()[normal_]),
      farthest_(std::min(layers, (cells_across + 1) / 2) - 1),
      inward_(face % 2 == 0 ? indexing.stride(normal_) : -indexing.stride(normal_)),
      present_(present),
      viscosity_(viscosity) {
  const std::size_t cells = static_cast<std::size_t>(nu_) * nv_;
  for (auto& values : state_) values.assign(cells, Real(0));
  for (auto* arrays : {&stress_, &no_slip_, &law_})
    for (auto& values : *arrays) values.assign(cells, Real(0));
  in_sublayer_.assign(cells, 0);
  layer_.resize(cells);
  layers_in_row_.assign(static_cast<std::size_t>(layers) * nv_, 0);
  reynolds_.resize(static_cast<std::size_t>(indexing.size()[0]));
}

template <typename Real>
std::ptrdiff_t WallStress<Real>::cell_at_wall(int u, int v) const {
  Index3 at;
  at[normal_] = face_ % 2 == 0 ? 0 : depth_ - 1;
  at[u_axis_] = u;
  at[v_axis_] = v;
  return indexing_.index(at[0], at[1], at[2]);
}

// Counts, from the farthest cell to the wall, the cells that follow each other without a body between. The loops are
// vectorised where cells of the face's rows are contiguous in memory.
template <typename Real>
void WallStress<Real>::find_layers(const CellMap& cells) {
  const std::ptrdiff_t stride = indexing_.stride(u_axis_);
  const int nu = nu_;
  for (int v = 0; v < nv_; ++v) {
    std::int32_t* __restrict layer = layer_.data() + place(0, v);
    std::fill(layer, layer + nu, 0);
    for (int far = farthest_; far > 0; --far) {
      const std::int32_t* __restrict body = cells.bodies() + cell_at_wall(0, v) + far * inward_;
      if (stride == 1)
        for (int u = 0; u < nu; ++u) layer[u] = body[u] == CellMap::fluid ? layer[u] + 1 : 0;
      else
        for (int u = 0; u < nu; ++u) layer[u] = body[u * stride] == CellMap::fluid ? layer[u] + 1 : 0;
    }
    std::int32_t present = 0;  // a bit for each layer
    for (int u = 0; u < nu; ++u) present |= 1 << layer[u];
    for (int far = 0; far < layers; ++far)
      layers_in_row_[static_cast<std::size_t>(far) * nv_ + v] = (present >> far & 1) != 0;
  }
}

// Across x a row has cells of several rows of the face.
template <typename Real>
bool WallStress<Real>::wants(int y, int z) const {
  if (normal_ == 0) return true;
  const int layer = from_face(normal_ == 1 ? y : z), v = normal_ == 1 ? z : y;
  return layer == 0 || (layer <= farthest_ && has_layer(layer, v));
}

// |u| distance/nu, in a loop that is vectorised.
template <typename Real>
void WallStress<Real>::find_reynolds(const Piece& piece, const RowMoments<Real>& moments, const Vec3& half_force) {
  const Real* density = moments.deviation;
  const Real *along_u = moments.momentum[u_axis_], *along_v = moments.momentum[v_axis_];
  const double half_u = half_force[u_axis_], half_v = half_force[v_axis_];
  const double scale = (piece.layer + 0.5) / viscosity_;
  for (int x = piece.x; x < piece.end; ++x) {
    const double u = along_u[x] + half_u, v = along_v[x] + half_v;
    reynolds_[x] = scale * std::sqrt(u * u + v * v) / (1.0 + density[x]);
  }
}

// T of no slip, and that of the law where nothing but the first cell is before a body. Moments of a solid cell may be
// anything.
template <typename Real>
void WallStress<Real>::take_first(const Piece& piece, const RowMoments<Real>& moments, const CellMap& cells,
                                  const Vec3& half_force) {
  const int u = static_cast<int>(piece.place % nu_), v = static_cast<int>(piece.place / nu_);
  if (has_layer(0, v)) find_reynolds(piece, moments, half_force);
  const Real *along_u = moments.momentum[u_axis_], *along_v = moments.momentum[v_axis_];
  const std::ptrdiff_t stride = indexing_.stride(u_axis_);
  std::size_t here = piece.place;
  std::ptrdiff_t cell = cell_at_wall(u, v);
  for (int x = piece.x; x < piece.end; ++x, ++here, cell += stride) {
    const bool fluid = cells.is_fluid(cell);
    no_slip_[0][here] = fluid ? static_cast<Real>(2.0 * viscosity_ * (along_u[x] + half_force[u_axis_])) : Real(0);
    no_slip_[1][here] = fluid ? static_cast<Real>(2.0 * viscosity_ * (along_v[x] + half_force[v_axis_])) : Real(0);
    if (layer_[here] != 0) continue;
    const Real ratio = fluid ? static_cast<Real>(stress_ratio(reynolds_[x])) : Real(0);
    law_[0][here] = ratio * no_slip_[0][here];
    law_[1][here] = ratio * no_slip_[1][here];
    in_sublayer_[here] = 0;
  }
}

// Each place is taken once in a sweep, from the cell of its layer. T over rho u is (nu/distance) StressRatio.
template <typename Real>
void WallStress<Real>::take_far(const Piece& piece, const RowMoments<Real>& moments, const Vec3& half_force) {
  find_reynolds(piece, moments, half_force);
  const Real *along_u = moments.momentum[u_axis_], *along_v = moments.momentum[v_axis_];
  const double laminar = viscosity_ / (piece.layer + 0.5);
  std::size_t here = piece.place;
  for (int x = piece.x; x < piece.end; ++x, ++here) {
    if (layer_[here] != piece.layer) continue;
    const double resistance = laminar * stress_ratio(reynolds_[x]);
    law_[0][here] = static_cast<Real>(resistance * (along_u[x] + half_force[u_axis_]));
    law_[1][here] = static_cast<Real>(resistance * (along_v[x] + half_force[v_axis_]));
    in_sublayer_[here] = reynolds_[x] <= edge_of_viscous_sublayer * edge_of_viscous_sublayer;
  }
}

template <typename Real>
void WallStress<Real>::take_row(int y, int z, const RowMoments<Real>& moments, const CellMap& cells,
                                const Vec3& half_force) {
  if (normal_ == 0) {
    const std::size_t here = place(y, z);
    const int first = from_face(0), far = from_face(layer_[here]);
    take_first({0, first, first + 1, here}, moments, cells, half_force);
    if (far != first) take_far({layer_[here], far, far + 1, here}, moments, half_force);
    return;
  }
  const Piece piece{from_face(normal_ == 1 ? y : z), 0, nu_, place(0, normal_ == 1 ? z : y)};
  if (piece.layer == 0)
    take_first(piece, moments, cells, half_force);
  else
    take_far(piece, moments, half_force);
}

template <typename Real>
void WallStress<Real>::end_sweep() {
  for (int axis = 0; axis < 2; ++axis) {
    std::swap(state_[axis], state_[2 + axis]);
    for (std::size_t here = 0; here < in_sublayer_.size(); ++here)
      state_[axis][here] = in_sublayer_[here] ? no_slip_[axis][here] : law_[axis][here];
  }
}

// A collision keeps the density and adds the force to the momentum. Cell by cell, as rows of one.
template <typename Real>
void WallStress<Real>::take_populations(const Populations<Real>& populations, const CellMap& cells,
                                        const Vec3& half_force) {
  for (int v = 0; v < nv_; ++v)
    for (int u = 0; u < nu_; ++u) {
      const std::size_t here = place(u, v);
      const auto in_layer = [&](int layer, const auto& take) {
        Real deviation = 0, momentum[3] = {0, 0, 0};
        for (int i = 0; i < D3Q19::directions; ++i) {
          const Real f = populations.post_collision(i, cell_at_wall(u, v) + layer * inward_);
          deviation += f;
          for (int a = 0; a < 3; ++a) momentum[a] += static_cast<Real>(D3Q19::c[i][a]) * f;
        }
        take(Piece{layer, 0, 1, here}, RowMoments<Real>{&deviation, {&momentum[0], &momentum[1], &momentum[2]}});
      };
      in_layer(0, [&](const Piece& piece, const RowMoments<Real>& moments) {
        take_first(piece, moments, cells, -half_force);
      });
      if (layer_[here] > 0)
        in_layer(layer_[here],
                 [&](const Piece& piece, const RowMoments<Real>& moments) { take_far(piece, moments, -half_force); });
    }
  end_sweep();
  end_sweep();
}

template <typename Real>
bool WallStress<Real>::has_both_neighbours(const CellMap& cells, std::ptrdiff_t cell, int axis, int along) const {
  const std::ptrdiff_t stride = indexing_.stride(axis);
  const bool at_low = along == 0 && present_[face_of(axis, false)];
  const bool at_high = along == indexing_.size()[axis] - 1 && present_[face_of(axis, true)];
  return !at_low && !at_high && cells.is_fluid(cell - stride) && cells.is_fluid(cell + stride);
}

template <typename Real>
void WallStress<Real>::find(const CellMap& cells) {
  for (int v = 0; v < nv_; ++v)
    for (int u = 0; u < nu_; ++u) {
      const std::ptrdiff_t cell = cell_at_wall(u, v);
      const std::size_t here = place(u, v);
      const auto mean = [&](std::size_t axis) { return Real(0.5) * (state_[axis][here] + state_[2 + axis][here]); };
      stress_[0][here] = has_both_neighbours(cells, cell, u_axis_, u) ? mean(0) : Real(0);
      stress_[1][here] = has_both_neighbours(cells, cell, v_axis_, v) ? mean(1) : Real(0);
    }
}

template class WallStress<float>;
template class WallStress<double>;

}  // namespace thalweg::lbm
