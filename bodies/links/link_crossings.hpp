// Crossings of links with the surface of a sphere. With d = x_f - centre and delta in [0, 1] the fraction of the link
// at which it enters: arm = d + delta c_i (cells). Cells may have been assigned when the body was up to a small
// tolerance away; a crossing just beyond an end of its link is then put at that end.
#pragma once

#include "bodies/map/link_table.hpp"
#include "core/geometry/periodic_box.hpp"
#include "core/geometry/sphere.hpp"

#include <cmath>
#include <limits>

namespace thalweg::bodies {

// The cells of a block as integers, with the nearest periodic image.
struct BlockFrame {
  int lower[3];   // of the block in the domain
  int period[3];  // cells of the domain; 0: not periodic
  int half[3];

  BlockFrame(const PeriodicBox& box, const Index3& block_lower) {
    for (int a = 0; a < 3; ++a) {
      lower[a] = block_lower[a];
      period[a] = box.periodic[a] ? static_cast<int>(box.size[a]) : 0;
      half[a] = box.periodic[a] ? period[a] / 2 : std::numeric_limits<int>::max();
    }
  }

  // True if a solid cell of a body at `centre` can lie beyond a periodic face.
  bool may_wrap(const Vec3& centre, double reach) const {
    constexpr double margin = 1.0;  // cells are assigned where the body was up to a small tolerance ago
    bool wraps = false;
    for (int a = 0; a < 3; ++a)
      wraps |= period[a] > 0 && (centre[a] < reach + margin || centre[a] > period[a] - reach - margin);
    return wraps;
  }
};

namespace detail {

// Body of find_crossings(). `wraps`: a link may be nearer to another image of the centre.
template <bool wraps, typename Real>
[[gnu::always_inline]] inline void cross_links(Sphere sphere, const Vec3& centre, const BlockFrame& block, int z,
                                               const std::uint32_t* __restrict xy, const std::uint32_t* __restrict tags,
                                               int count, Real* __restrict distance, Real* __restrict arm_x,
                                               Real* __restrict arm_y, Real* __restrict arm_z) {
  int from[3];
  Real rest[3];
  for (int a = 0; a < 3; ++a) {
    const double whole = std::floor(centre[a]);
    from[a] = block.lower[a] - static_cast<int>(whole);
    rest[a] = static_cast<Real>(0.5 - (centre[a] - whole));
  }
  const int from_x = from[0], from_y = from[1], from_z = from[2] + z;
  const int half_x = block.half[0], half_y = block.half[1], half_z = block.half[2];
  const int period_x = block.period[0], period_y = block.period[1], period_z = block.period[2];
  const auto nearest = [](int cell, int half, int period) {
    if constexpr (wraps)
      return cell - (cell > half ? period : 0) + (cell < -half ? period : 0);
    else
      return cell;
  };
  for (int first = 0; first < count; first += links_at_a_time) {
    const int end = first + links_at_a_time;
    for (int k = first; k < end; ++k) {
      const int tag = static_cast<int>(tags[k]), word = static_cast<int>(xy[k]);
      const int cx = LinkTag::velocity(tag, 0), cy = LinkTag::velocity(tag, 1), cz = LinkTag::velocity(tag, 2);
      const int x = static_cast<int>(word & static_cast<int>(LinkXY::x_mask)),
                y = word >> LinkXY::y_shift & static_cast<int>(LinkXY::x_mask);
      const Real dx = Real(nearest(x + from_x + cx, half_x, period_x) - cx) + rest[0];
      const Real dy = Real(nearest(y + from_y + cy, half_y, period_y) - cy) + rest[1];
      const Real dz = Real(nearest(from_z + cz, half_z, period_z) - cz) + rest[2];
      const Real delta = sphere.link_crossing(dx, dy, dz, Real(cx), Real(cy), Real(cz));
      distance[k] = delta > Real(0) ? delta : Real(0);
      arm_x[k] = dx;
      arm_y[k] = dy;
      arm_z[k] = dz;
    }
    // A separate loop: in one loop the compiler would triple everything that depends on the distance.
    for (int k = first; k < end; ++k) {
      const int tag = static_cast<int>(tags[k]);
      const Real inside = distance[k] < Real(1) ? distance[k] : Real(1);
      distance[k] = inside;
      arm_x[k] += inside * Real(LinkTag::velocity(tag, 0));
      arm_y[k] += inside * Real(LinkTag::velocity(tag, 1));
      arm_z[k] += inside * Real(LinkTag::velocity(tag, 2));
    }
  }
}

}  // namespace detail

// Finds the crossings of links [0, count) of one body (centre: global) in the plane z (owned local coordinate), count a
// multiple of links_at_a_time, in the arithmetic of Real, which is the same for every link whatever its place in the
// arrays. Coordinates are relative to a whole number near the centre, so that no digits are lost far from the origin;
// the nearest image is that of the solid cell, which is inside.
template <typename Real>
inline void find_crossings(const Sphere& sphere, const Vec3& centre, const BlockFrame& block, int z,
                           const std::uint32_t* xy, const std::uint32_t* tags, int count, Real* distance, Real* arm_x,
                           Real* arm_y, Real* arm_z) {
  if (block.may_wrap(centre, sphere.radius))
    detail::cross_links<true>(sphere, centre, block, z, xy, tags, count, distance, arm_x, arm_y, arm_z);
  else
    detail::cross_links<false>(sphere, centre, block, z, xy, tags, count, distance, arm_x, arm_y, arm_z);
}

}  // namespace thalweg::bodies
