// The pass over all contacts of a sub-step that adds rolling friction, where there is any.
#pragma once

#include "core/periodic_box.hpp"
#include "dem/contact_list.hpp"
#include "dem/material.hpp"
#include "dem/moving_grains.hpp"

namespace thalweg::dem {

// Adds the moments of rolling friction and advances its springs; arguments as those of evaluate_contacts(). Does
// nothing where the list has no rolling contacts.
void evaluate_rolling(MovingGrains& grains, ContactList& list, const PeriodicBox& box, std::span<const Plane> walls,
                      const MaterialTable& materials, std::span<const std::uint8_t> material, double time_step);

}  // namespace thalweg::dem
