// Walls::forces: what the walls take from the fluid in the exchange that the next sweep makes.
#include "core/base/check.hpp"
#include "lbm/lattice/face_axes.hpp"
#include "lbm/walls/walls.hpp"

#include <algorithm>

namespace thalweg::lbm {

// The axis across the other face of an edge that a population comes out of; -1: it comes out of this face alone.
template <typename Real>
int Walls<Real>::other_axis_of_edge(int face, int o, const Index3& at) const {
  const int axis = face / 2;
  for (const int other_axis : {first_axis(axis), second_axis(axis)}) {
    const int along = D3Q19::c[o][other_axis];
    if (along == 0) continue;
    const bool high = along < 0;
    const int end = high ? indexing_.size()[other_axis] - 1 : 0;
    if (at[other_axis] == end && present(other_axis, high)) return other_axis;
  }
  return -1;
}

template <typename Real>
std::array<FixedVec3, 6> Walls<Real>::forces(const Populations<Real>& populations, const CellMap& cells,
                                             double reference, std::vector<FixedVec3>* sides_by_height) const {
  std::array<FixedVec3, 6> sums{};
  const Index3& n = indexing_.size();
  CHECK(!sides_by_height || sides_by_height->size() == static_cast<std::size_t>(2 * n[2] + 1));
  for (int face = 0; face < 6; ++face) {
    if (!present_[face]) continue;
    const int axis = face / 2, inward = face % 2 == 0 ? 1 : -1;
    Index3 begin{0, 0, 0}, end = n;
    begin[axis] = inward > 0 ? 0 : n[axis] - 1;
    end[axis] = begin[axis] + 1;
    for (int o = 1; o < D3Q19::directions; ++o) {
      if (D3Q19::c[o][axis] != inward) continue;
      Index3 at;
      for (at[2] = begin[2]; at[2] < end[2]; ++at[2])
        for (at[1] = begin[1]; at[1] < end[1]; ++at[1])
          for (at[0] = begin[0]; at[0] < end[0]; ++at[0]) {
            const std::ptrdiff_t cell = indexing_.index(at[0], at[1], at[2]);
            if (!cells.is_fluid(cell)) continue;
            const std::int64_t lost = LatticeFixed::from(
                static_cast<double>(populations.post_collision(D3Q19::opposite(o), cell)) +
                static_cast<double>(populations.incoming(o, cell)) - 2.0 * D3Q19::weight(o) * reference);
            const int other = other_axis_of_edge(face, o, at);
            const auto along = [&](int a) { return a == other ? std::int64_t{0} : -D3Q19::c[o][a] * lost; };
            const FixedVec3 force{along(0), along(1), along(2)};
            sums[face] += force;
            if (sides_by_height && axis != 2)
              (*sides_by_height)[static_cast<std::size_t>(2 * at[2] + 1 - D3Q19::c[o][2])] += force;
          }
    }
  }
  return sums;
}

template class Walls<float>;
template class Walls<double>;

}  // namespace thalweg::lbm
