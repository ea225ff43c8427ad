// Lubrication of clumps. Where several members of a clump are near one other body, the force of each is that of a
// sphere alone, and their films may be one: a member inside another has none of its own, and of two beside each other
// one film is counted twice.
//
// In the film of a sphere of reduced radius r at the gap h the pressure falls with the distance d from the near point
// as 1/H^2, H = h + d^2/(2 r). So member e has the share
//
//   w_e = s_e^2 / sum_f s_f^2 k_ef,   k_ef = (1 + d_ef^2/(2 r_e h_e))^-2,   s = r^2/h,
//
// the sum over all members f of the two bodies whose near points, d_ef from its own, are on the surface; 0 where its
// own is inside another member. Two places of one sphere at a solid with corners are two films. N members at one place
// have 1/N each, far ones 1; the force of the nearest is continued without a jump where another comes as near.
#pragma once

#include "core/geometry/periodic_box.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::dem {

// Place where a member of one body is near a member of another.
struct NearPlace {
  std::int64_t first_body, second_body;  // any numbers, the same for all members of a body
  std::size_t first, second;             // numbers of the members; second: any of a wall
  Vec3 first_centre, second_centre;      // m, of the members
  double first_radius, second_radius;    // m; second: 0 of a wall
  Vec3 normal;                           // unit, from the second to the first
  double reduced_radius, gap;            // m; r and h, positive
};

// The share of each place, in this order; sums run in it.
std::vector<double> lubrication_shares(std::span<const NearPlace> places, const PeriodicBox& box);

}  // namespace thalweg::dem
