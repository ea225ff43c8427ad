// The pairs that may touch before the next rebuild, packed for the loop over them, with the history of each contact.
//
// Pairs are sorted by (lower id, higher id) and always seen from the lower id, so that every rank that knows a pair
// computes the same bits, and a grain's forces add up in the order of its neighbours' ids. A pair too far apart to
// act adds nothing, so it does not matter which of those a rank's list holds.
#pragma once

#include "core/periodic_box.hpp"
#include "dem/grain_batch.hpp"
#include "dem/grain_store.hpp"
#include "dem/material.hpp"
#include "dem/near_pairs.hpp"
#include "dem/walls.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::dem {

struct PairContact {
  std::uint32_t first, second;  // slots of the lower and the higher id
  double reach;                 // m, sum of the radii
  double spring[3];             // m, xi of the first against the second; zero when they do not touch
  double damping;               // of the law; right behind the spring, so that one load takes both
};

struct WallContact {
  std::uint32_t grain;  // slot
  std::uint32_t wall;
  double damping;
  double spring[3];
};

// What rolling friction adds to a contact.
struct RollingContact {
  double spring[3];  // theta of the first against the second (rolling_friction.hpp); zero when they do not touch
  double friction;
  double inertia;  // kg m^2, I_r
};

struct ContactList {
  std::vector<PairContact> pairs;
  NearPairs near;                  // of the pairs; kept by evaluate_contacts()
  std::vector<WallContact> walls;  // of owned grains, sorted by id, then from the last wall to the first

  // One each contact, in their order; empty without rolling friction.
  std::vector<RollingContact> rolling_pairs, rolling_walls;
};

// All pairs with at least one owned grain whose surfaces are closer than `skin` (m), and all owned grains closer than
// that to a wall, but no two members of one clump; springs zero. Positions must be wrapped. largest_radius: m, of all
// grains.
ContactList find_contacts(const GrainStore& store, const PeriodicBox& box, std::span<const Plane> walls,
                          const MaterialTable& materials, double skin, double largest_radius);

// The springs that are not zero, sorted by ids.
std::vector<ContactHistory> histories_of(const ContactList& list, const GrainStore& store);

// Gives the contacts of the list their springs; histories (sorted by ids) of pairs not in the list are dropped.
void restore_histories(ContactList& list, const GrainStore& store, std::span<const ContactHistory> histories);

}  // namespace thalweg::dem
