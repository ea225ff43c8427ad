#include "lbm/wall_stress.hpp"

#include "core/decomposition.hpp"
#include "lbm/boundary.hpp"
#include "lbm/face_axes.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::lbm {

// The second cell is on the rank of the first, unless the box has only one.
static_assert(Decomposition::min_cells_per_rank >= 2);

template <typename Real>
WallStress<Real>::WallStress(const CellIndexing& indexing, int face, const std::array<bool, 6>& present,
                             double viscosity)
    : indexing_(indexing),
      face_(face),
      normal_(face / 2),
      u_axis_(first_axis(normal_)),
      v_axis_(second_axis(normal_)),
      nu_(indexing.size()[u_axis_]),
      nv_(indexing.size()[v_axis_]),
      depth_(indexing.size()[normal_]),
      inward_(face % 2 == 0 ? indexing.stride(normal_) : -indexing.stride(normal_)),
      present_(present),
      viscosity_(viscosity) {
  for (auto& values : state_) values.assign(static_cast<std::size_t>(nu_) * nv_, Real(0));
  resistance_.resize(static_cast<std::size_t>(indexing.size()[0]));
  for (auto& values : stress_) values.assign(static_cast<std::size_t>(nu_) * nv_, Real(0));
}

template <typename Real>
std::ptrdiff_t WallStress<Real>::cell_at_wall(int u, int v) const {
  Index3 at;
  at[normal_] = face_ % 2 == 0 ? 0 : depth_ - 1;
  at[u_axis_] = u;
  at[v_axis_] = v;
  return indexing_.index(at[0], at[1], at[2]);
}

template <typename Real>
bool WallStress<Real>::second_is_fluid(const CellMap& cells, std::ptrdiff_t at_wall) const {
  return depth_ > 1 && cells.is_fluid(at_wall + inward_);
}

template <typename Real>
bool WallStress<Real>::wants(int y, int z) const {
  const int at = normal_ == 1 ? y : z, from_face = face_ % 2 == 0 ? at : depth_ - 1 - at;
  return normal_ == 0 || from_face < 2;
}

template <typename Real>
void WallStress<Real>::take(std::size_t place, double along_u, double along_v) {
  state_[2][place] = state_[0][place];
  state_[3][place] = state_[1][place];
  state_[0][place] = static_cast<Real>(along_u);
  state_[1][place] = static_cast<Real>(along_v);
}

// T over rho u in the cells x to end of a row: (nu/distance) StressRatio. In two loops, the first of which is
// vectorised.
template <typename Real>
void WallStress<Real>::find_resistance(int x, int end, bool second, const RowMoments<Real>& moments,
                                       const Vec3& half_force) {
  static const StressRatio ratio;
  const Real* density = moments.deviation;
  const Real *along_u = moments.momentum[u_axis_], *along_v = moments.momentum[v_axis_];
  const double half_u = half_force[u_axis_], half_v = half_force[v_axis_];
  const double distance = second ? 1.5 : 0.5, scale = distance / viscosity_;
  for (int n = x; n < end; ++n) {
    const double u = along_u[n] + half_u, v = along_v[n] + half_v;
    resistance_[n] = scale * std::sqrt(u * u + v * v) / (1.0 + density[n]);  // |u| distance/nu
  }
  for (int n = x; n < end; ++n) resistance_[n] = viscosity_ / distance * ratio(resistance_[n]);
}

// Cells x to end of a row, of which the first belongs to a cell of the face and a place, and each further one to the
// next. A first cell counts where its second is solid, a second one where it is fluid: each place is taken once in a
// sweep.
template <typename Real>
void WallStress<Real>::take_cells(int x, int end, bool second, std::ptrdiff_t at_wall, std::size_t place,
                                  const RowMoments<Real>& moments, const CellMap& cells, const Vec3& half_force) {
  find_resistance(x, end, second, moments, half_force);
  const Real *along_u = moments.momentum[u_axis_], *along_v = moments.momentum[v_axis_];
  const double half_u = half_force[u_axis_], half_v = half_force[v_axis_];
  for (; x < end; ++x, ++at_wall, ++place) {
    if (second != second_is_fluid(cells, at_wall)) continue;
    const bool fluid = second || cells.is_fluid(at_wall);
    take(place, fluid ? resistance_[x] * (along_u[x] + half_u) : 0.0,
         fluid ? resistance_[x] * (along_v[x] + half_v) : 0.0);
  }
}

template <typename Real>
void WallStress<Real>::take_row(int y, int z, const RowMoments<Real>& moments, const CellMap& cells,
                                const Vec3& half_force) {
  if (normal_ == 0) {
    for (int from_face = 0; from_face < std::min(depth_, 2); ++from_face) {
      const int x = face_ % 2 == 0 ? from_face : depth_ - 1 - from_face;
      take_cells(x, x + 1, from_face == 1, cell_at_wall(y, z), place(y, z), moments, cells, half_force);
    }
    return;
  }
  const int at = normal_ == 1 ? y : z, v = normal_ == 1 ? z : y;
  const int from_face = face_ % 2 == 0 ? at : depth_ - 1 - at;
  take_cells(0, nu_, from_face == 1, cell_at_wall(0, v), place(0, v), moments, cells, half_force);
}

// A collision keeps the density and adds the force to the momentum. Cell by cell, as rows of one.
template <typename Real>
void WallStress<Real>::take_populations(const Populations<Real>& populations, const CellMap& cells,
                                        const Vec3& half_force) {
  for (int v = 0; v < nv_; ++v)
    for (int u = 0; u < nu_; ++u) {
      const std::ptrdiff_t at_wall = cell_at_wall(u, v);
      const bool second = second_is_fluid(cells, at_wall);
      const std::ptrdiff_t cell = second ? at_wall + inward_ : at_wall;
      Real deviation = 0, momentum[3] = {0, 0, 0};
      for (int i = 0; i < D3Q19::directions; ++i) {
        const Real f = populations.post_collision(i, cell);
        deviation += f;
        for (int a = 0; a < 3; ++a) momentum[a] += static_cast<Real>(D3Q19::c[i][a]) * f;
      }
      const RowMoments<Real> moments{&deviation, {&momentum[0], &momentum[1], &momentum[2]}};
      for (int collision = 0; collision < 2; ++collision)
        take_cells(0, 1, second, at_wall, place(u, v), moments, cells, -half_force);
    }
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
