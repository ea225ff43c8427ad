// The loop over all contacts of a sub-step.
#pragma once

#include "core/periodic_box.hpp"
#include "dem/contact_law.hpp"
#include "dem/contact_list.hpp"
#include "dem/moving_grains.hpp"

namespace thalweg::dem {

// Adds the contact forces and torques that follow from positions and velocities, and advances the springs of the list.
// The lever arm of a grain reaches to the middle of the overlap (to the plane of a wall), so that angular momentum is
// conserved. Sums run over pairs in the order of the list, then over walls.
void evaluate_contacts(MovingGrains& grains, ContactList& list, const PeriodicBox& box, std::span<const Plane> walls,
                       const SpringDashpotFriction& law, double friction);

}  // namespace thalweg::dem
