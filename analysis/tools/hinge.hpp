// The hinge about which a grain rolls out of its place, and the torques about it.
//
// A grain in a pocket touches several others. As it starts to roll it leaves some of them, and turns about the line
// through two contact points that stay: the hinge (Zhang et al. 2022, Figure 4). With e the unit vector
// along it, so that a positive turn takes the grain the way it went, and r the arm from the hinge to the grain's
// centre,
//
//   T_F = e . (r x F + C)     of the fluid's force F and its couple C about the centre
//   T_C = e . C               the couple's part of it
//   T_c = -e . (r x W)        critical: what the fluid must exceed against the submerged weight W
//
// A clump is one grain: its contacts are those of all its members, F, C and W act on the whole, about its centre.
//
// Zhang et al. found T_C / T_F of about a quarter.
#pragma once

#include "analysis/tools/grain_ring.hpp"

#include <array>
#include <optional>

namespace thalweg::analysis {

// The last sample at rest before the grain left its place: the latest that is no faster than a speed (m/s); none if the
// motion began before the first of all.
std::optional<std::size_t> onset_of(const GrainRing& ring, double moving_speed);

struct Hinge {
  std::array<GlobalId, 2> partners;  // as in Touch
  std::array<Vec3, 2> points;        // m, the contact points at the onset
  Vec3 axis;                         // unit vector, e
};

// Hinge of the contacts loaded at the onset (or at the latest sample before with two of them) that are still loaded in
// the latest sample in which two are; of more than two the ones furthest along x in the direction in which the grain
// went. way: m, from the rest place to the latest position. None if the grain never had two loaded contacts.
std::optional<Hinge> hinge_of(const GrainRing& ring, std::size_t onset, const Vec3& way);

struct HingeTorques {
  double fluid, couple, critical;  // N m: T_F, T_C, T_c
};

// weight: N, submerged. buoyancy: N, what of it the fluid's force already has (zero in reduced gravity).
HingeTorques torques_about(const Hinge& hinge, const GrainSample& sample, const Vec3& weight, const Vec3& buoyancy);

}  // namespace thalweg::analysis
