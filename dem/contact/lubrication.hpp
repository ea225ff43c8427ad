// The part of the lubrication force that a lattice cannot resolve: a force between near surfaces with a viscosity.
//
// Two spheres of radii a1, a2 with a gap h between them (n from the second to the first, r = a1 a2/(a1 + a2),
// q = a1/a2; a wall has q = 0) move with the velocities v1, v2 of their centres and the spins w1, w2. With
//   u  = n n.(v1 - v2),  s = the tangential part of (v1 + w1 x l1) - (v2 + w2 x l2) at the middle of the gap,
//   w  = the tangential part of w1 - w2,
// the leading terms of the resistance for h -> 0 are (viscosity eta)
//   F1 = -N u - A s + E w x n,   M1 = E n x s - G w,   F2 = -F1,  M2 = -M1,
//   N = 6 pi eta r^2/h,
//   (A, E, G) = pi eta ln(1/h) (8/5 r (2 + q + 2 q^2)/(1 + q)^2, 12/5 r^2 (q - 1)/(q + 1), 24/5 r^3),
// and the force acts in the middle of the gap: T1 = l1 x F1 + M1. This is Jeffrey and Onishi 1984 (J. Fluid Mech. 139,
// 261: X11A, Y11A, Y11B, Y11C, Y12C) written in a form that vanishes in a rigid motion of the pair, and that conserves
// angular momentum whatever h is; for a wall it is Goldman, Cox and Brenner 1967. The twist about n has no
// singular term. The lattice resolves these flows down to a gap of about 2/3 cell for N and 1/2 cell for the others
// (Simeonov and Calantoni 2012, Int. J. Multiphase Flow 46, 38; Rettinger and Ruede 2022, J. Comput. Phys. 453,
// 110870). What is added here is the rest: 1/h - 1/h_c in place of 1/h, ln(h_c/h) in place of ln(1/h), nothing beyond
// h_c.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "core/state/snapshot.hpp"
#include "dem/contact/acting_state.hpp"
#include "dem/contact/neighbour_list.hpp"
#include "dem/motion/packed_grain_state.hpp"
#include "dem/motion/walls.hpp"

#include <functional>
#include <span>
#include <vector>

namespace thalweg::dem {

struct LubricationParameters {
  double viscosity = 0.0;           // Pa s
  double normal_cut_off = 0.0;      // m, the gap h_c below which N is not resolved
  double tangential_cut_off = 0.0;  // m, the same of A, E, G
  double minimum_gap = 1e-3;        // radii of the smaller body: gaps count as at least this wide (roughness)
  std::vector<bool> walls;          // true where the fluid sticks to the wall, one for each plane

  double reach() const { return normal_cut_off > tangential_cut_off ? normal_cut_off : tangential_cut_off; }  // m
};

// N, A (kg/s), E (kg m/s) and G (kg m^2/s) less what is resolved.
struct LubricationResistance {
  double normal = 0.0, sliding = 0.0, mixed = 0.0, rolling = 0.0;
};

// radius: m, of the first body; ratio: q, its radius over the second's, 0 at a wall; gap: m, positive.
LubricationResistance lubrication_resistance(const LubricationParameters& parameters, double radius, double ratio,
                                             double gap);

// The longest step (s) that can follow, explicitly, the damping of a free grain near a wall: 6 pi eta a/(minimum_gap m)
// times the step must not exceed 1/2. Twelve neighbours damp no more than a wall does, because each has a quarter of
// its resistance. radius_per_mass: m/kg, the largest of free grains with the mass their contacts feel; 0: no free
// grains, whose step may be infinite.
double longest_lubrication_step(const LubricationParameters& parameters, double radius_per_mass);

// Throws InputError for impossible parameters, or where the step (s) is longer than longest_lubrication_step(). A
// periodic axis must be two diameters and twice the reach long, so that no pair is near across both of its ends.
// largest_radius: m, of all grains.
void check(const LubricationParameters& parameters, double largest_radius, double radius_per_mass,
           const PeriodicBox& box, double time_step);

// Adds these forces and torques for all pairs, walls and solids of the list whose gap is below the cut-offs. Surfaces
// that touch feel their contact law alone. Members of a clump that are near one body share as lubrication_shares.hpp
// says; clump: the id of each slot's clump, as in GrainStore; empty: there are no clumps. The edge of a solid counts as
// the plane across the line from it to the grain. Sums run in the order of the list, of whose pairs only the near ones
// are looked at (inner_neighbour_list.hpp).
void add_lubrication(PackedGrainState& grains, NeighbourList& list, const Surroundings& around,
                     std::span<const GlobalId> clump, const LubricationParameters& parameters);

// Calls visit(slot, arm, force) for every such force on every owned grain, in the order of the list, pairs first: m
// from its centre to the middle of the gap (to a wall's surface), N. By the present positions and the given velocities.
using LubricationVisitor = std::function<void(std::size_t slot, const Vec3& arm, const Vec3& force)>;
void for_each_lubrication_end(const ActingGrains& grains, const NeighbourList& list, const Surroundings& around,
                              const LubricationParameters& parameters, const LubricationVisitor& visit);

// Visits the forces of walls and solids only, with the partner as for_each_wall_contact() gives it.
void for_each_wall_lubrication(const ActingGrains& grains, const NeighbourList& list, const Surroundings& around,
                               const LubricationParameters& parameters, const ContactSource::ContactEndVisitor& visit);

}  // namespace thalweg::dem
