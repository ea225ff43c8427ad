// The loop over all contacts of a sub-step.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "core/state/snapshot.hpp"
#include "dem/contact/acting_state.hpp"
#include "dem/contact/neighbour_list.hpp"
#include "dem/laws/material.hpp"
#include "dem/motion/packed_grain_state.hpp"

#include <functional>

namespace thalweg::dem {

// Adds the contact forces and torques that follow from positions and velocities, those of rolling friction among them,
// and advances the histories of the list.
// The lever arm of a grain reaches to the middle of the overlap (to the surface of a wall), so that angular momentum is
// conserved; across a gap it reaches to the middle of that. Sums run over pairs in the order of the list, then over
// walls, then over solids. material: of every slot; time_step: s, with 0 no spring grows.
void evaluate_contacts(PackedGrainState& grains, NeighbourList& list, const Surroundings& around,
                       const MaterialTable& materials, std::span<const std::uint8_t> material, double time_step);

// Calls visit(slot, end) for every contact, touching or acting across a gap, of every owned grain, in the order of the
// list, pairs first. By the given velocities and the present positions and histories, which stay as they are. around:
// with velocities of the same moment; chosen: one entry a slot of an owned grain, 0 for those left out; empty: all.
using ContactEndVisitor = std::function<void(std::size_t slot, const ContactEnd& end)>;
void for_each_contact_end(const ActingGrains& grains, const NeighbourList& list, const Surroundings& around,
                          const MaterialTable& materials, std::span<const char> chosen, const ContactEndVisitor& visit);

// Visits the contacts with walls and solids only; the partner of solid s is -1 - (number of walls + s).
void for_each_wall_contact(const ActingGrains& grains, const NeighbourList& list, const Surroundings& around,
                           const MaterialTable& materials, const ContactEndVisitor& visit);

}  // namespace thalweg::dem
