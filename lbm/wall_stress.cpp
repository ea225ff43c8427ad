#include "lbm/wall_stress.hpp"

#include "core/decomposition.hpp"
#include "lbm/boundary.hpp"
#include "lbm/face_axes.hpp"
#include "lbm/law_of_the_wall.hpp"

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
      u_axis_(first_axis(face / 2)),
      v_axis_(second_axis(face / 2)),
      nu_(indexing.size()[u_axis_]),
      nv_(indexing.size()[v_axis_]),
      present_(present),
      viscosity_(viscosity) {
  for (auto& component : stress_) component.assign(static_cast<std::size_t>(nu_) * nv_, Real(0));
  for (Moments* of_row : {&at_wall_, &second_})
    for (auto* values : {&of_row->density, &of_row->along[0], &of_row->along[1]}) values->resize(nu_);
}

template <typename Real>
void WallStress<Real>::find(const Populations<Real>& populations, const CellMap& cells, const Vec3& half_force) {
  for (int v = 0; v < nv_; ++v) find_row(populations, cells, half_force, v);
}

template <typename Real>
void WallStress<Real>::take_moments(const Populations<Real>& populations, std::ptrdiff_t first, const Vec3& half_force,
                                    Moments& moments) const {
  const std::ptrdiff_t stride = indexing_.stride(u_axis_);
  const auto slots = populations.sent();
  std::fill(moments.density.begin(), moments.density.end(), Real(0));
  std::fill(moments.along[0].begin(), moments.along[0].end(), static_cast<Real>(-half_force[u_axis_]));
  std::fill(moments.along[1].begin(), moments.along[1].end(), static_cast<Real>(-half_force[v_axis_]));
  for (int i = 0; i < D3Q19::directions; ++i) {
    const Real* f = slots[static_cast<std::size_t>(i)] + first;
    const auto cu = static_cast<Real>(D3Q19::c[i][u_axis_]), cv = static_cast<Real>(D3Q19::c[i][v_axis_]);
    for (int u = 0; u < nu_; ++u) {
      moments.density[u] += f[u * stride];
      moments.along[0][u] += cu * f[u * stride];
      moments.along[1][u] += cv * f[u * stride];
    }
  }
  for (Real& density : moments.density) density += Real(1);
}

template <typename Real>
bool WallStress<Real>::has_both_neighbours(const CellMap& cells, std::ptrdiff_t cell, int axis, int along) const {
  const std::ptrdiff_t stride = indexing_.stride(axis);
  const bool at_low = along == 0 && present_[face_of(axis, false)];
  const bool at_high = along == indexing_.size()[axis] - 1 && present_[face_of(axis, true)];
  return !at_low && !at_high && cells.is_fluid(cell - stride) && cells.is_fluid(cell + stride);
}

template <typename Real>
std::array<double, 2> WallStress<Real>::stress_of(const Moments& moments, int u, double distance) const {
  const double density = moments.density[u];
  const double along_u = moments.along[0][u] / density, along_v = moments.along[1][u] / density;
  const double speed = std::sqrt(along_u * along_u + along_v * along_v);
  if (speed == 0.0) return {0.0, 0.0};
  const double friction = friction_velocity(speed, distance, viscosity_);
  const double over_velocity = density * friction * friction / speed;
  return {over_velocity * along_u, over_velocity * along_v};
}

template <typename Real>
void WallStress<Real>::find_row(const Populations<Real>& populations, const CellMap& cells, const Vec3& half_force,
                                int v) {
  const int axis = face_ / 2, depth = indexing_.size()[axis];
  const bool low = face_ % 2 == 0;
  const std::ptrdiff_t stride = indexing_.stride(u_axis_);
  const std::ptrdiff_t inward = low ? indexing_.stride(axis) : -indexing_.stride(axis);
  Index3 at{0, 0, 0};
  at[axis] = low ? 0 : depth - 1;
  at[v_axis_] = v;
  const std::ptrdiff_t first = indexing_.index(at[0], at[1], at[2]);
  const auto knows_second = [&](int u) { return depth > 1 && cells.is_fluid(first + inward + u * stride); };
  bool second = false, at_wall = false;  // whether any fluid cell at the wall looks there
  for (int u = 0; u < nu_; ++u)
    if (cells.is_fluid(first + u * stride)) (knows_second(u) ? second : at_wall) = true;
  if (second) take_moments(populations, first + inward, half_force, second_);
  if (at_wall) take_moments(populations, first, half_force, at_wall_);
  for (int u = 0; u < nu_; ++u) {
    const std::ptrdiff_t cell = first + u * stride;
    const bool from_second = knows_second(u);
    std::array<double, 2> stress{};
    if (cells.is_fluid(cell)) stress = stress_of(from_second ? second_ : at_wall_, u, from_second ? 1.5 : 0.5);
    const std::size_t place = static_cast<std::size_t>(v) * nu_ + u;
    stress_[0][place] = has_both_neighbours(cells, cell, u_axis_, u) ? static_cast<Real>(stress[0]) : Real(0);
    stress_[1][place] = has_both_neighbours(cells, cell, v_axis_, v) ? static_cast<Real>(stress[1]) : Real(0);
  }
}

template class WallStress<float>;
template class WallStress<double>;

}  // namespace thalweg::lbm
