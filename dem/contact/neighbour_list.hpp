// The pairs that may touch before the next rebuild, packed for the loop over them, with the history of each contact.
//
// Pairs are sorted by (lower id, higher id) and always seen from the lower id, so that every rank that knows a pair
// computes the same bits, and a grain's forces add up in the order of its neighbours' ids. A pair too far apart to
// act adds nothing, so it does not matter which of those a rank's list holds.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "dem/contact/inner_neighbour_list.hpp"
#include "dem/contact/solid_contacts.hpp"
#include "dem/laws/contact_history.hpp"
#include "dem/laws/material.hpp"
#include "dem/motion/grain_store.hpp"
#include "dem/motion/minimum_image.hpp"
#include "dem/motion/packed_grain_state.hpp"
#include "dem/motion/walls.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::dem {

struct PairContact {
  std::uint32_t first, second;  // slots of the lower and the higher id
  double reach;                 // m, sum of the radii
};

struct WallContact {
  std::uint32_t grain;  // slot
  std::uint32_t wall;
};

// Data of the contacts of one kind (pairs, walls or solids) for their law, one row of doubles per contact: its history,
// its constants (contact_law.hpp), then zeros up to whole vectors.
class ContactRows {
public:
  ContactRows() : ContactRows({}, {}) {}
  // Rows of new contacts between these bodies, without history.
  ContactRows(const LawChoice& law, std::span<const ContactBodies> bodies);

  const LawChoice& law() const { return law_; }
  double* data() { return reinterpret_cast<double*>(values_.data()); }
  double* operator[](std::size_t contact) { return data() + contact * width_; }
  const double* operator[](std::size_t contact) const {
    return reinterpret_cast<const double*>(values_.data()) + contact * width_;
  }
  std::span<const double> history_of(std::size_t contact) const { return {(*this)[contact], history_}; }

  void forget(std::size_t contact) { std::fill_n((*this)[contact], history_, 0.0); }

  // Doubles of a row of one law.
  template <typename ContactLaw>
  static constexpr std::size_t width_of = (std::tuple_size_v<typename ContactLaw::History> +
                                           doubles_in<typename ContactLaw::Constants> + 3) /
                                          4 * 4;

private:
  LawChoice law_;
  std::size_t history_ = 0, width_ = 0;
  std::vector<Double4> values_;  // for its alignment
};

struct NeighbourList {
  std::vector<PairContact> pairs;
  ContactRows pair_rows;
  InnerNeighbourList near;           // of the pairs; kept by evaluate_contacts()
  InnerNeighbourList near_surfaces;  // the same for lubrication; kept by add_lubrication()
  std::vector<WallContact> walls;    // of owned grains, sorted by id, then from the last wall to the first
  ContactRows wall_rows;
  std::vector<NearSolid> solids;
  ContactRows solid_rows;  // touches_per_solid for each of these

  void grains_moved(double distance) {  // m, at most, since the last call
    near.grains_moved(distance);
    near_surfaces.grains_moved(distance);
  }
};

// Keys of contacts among the ids of partners: -1 - w for wall w, then -1 - (walls + touches_per_solid s + n) for touch
// n with solid s.
GlobalId solid_key(std::size_t walls, std::size_t solid, std::size_t row);

// Touches of a grain at a position (m) with entries first to last - 1 of the list's solids, its own, each with the row
// of its history. range: of the law, m.
std::span<const SolidTouch> touches_of(SolidTouches& touches, const NeighbourList& list, std::size_t first,
                                       std::size_t last, const Vec3& position, double radius, double range);

// Row of a touch among those of the list.
inline std::size_t row_of(const SolidTouch& touch) { return touch.near * touches_per_solid + touch.row; }

// Parts of the histories of all contacts of the list; pairs and walls may have different ones.
std::vector<HistoryPart> history_parts_of(const NeighbourList& list);

// Searches the pairs again for those that may come within a range (m); calls beyond(pair number) for every other.
template <typename Beyond>
void look_for_near_pairs(const PackedGrainState& grains, const std::vector<PairContact>& pairs, double range,
                         const PeriodicBox& box, InnerNeighbourList& near, Beyond beyond) {
  near.begin();
  const MinimumImage image(box);
  range += near.margin();
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const PairContact& c = pairs[p];
    const Double4 d = image(grains[c.first].position - grains[c.second].position), square = d * d;
    const double limit = c.reach + range;
    if (square[0] + square[1] + square[2] < limit * limit)
      near.add({c.first, c.second, static_cast<std::uint32_t>(p)});
    else
      beyond(p);
  }
}

// Surroundings of the grains: everything that they may touch besides each other.
struct Surroundings {
  PeriodicBox box;
  std::span<const Plane> walls;         // where they are now
  std::span<const PlacedSolid> placed;  // solids where they are now
  std::span<const Solid> solids;
};

// All pairs with at least one owned grain whose surfaces are closer than `range` (m), and all owned grains closer than
// that to a wall or a solid, but no two members of one clump; without history. Positions must be wrapped.
// largest_radius: m, of all grains.
NeighbourList find_contacts(const GrainStore& store, const Surroundings& around, const MaterialTable& materials,
                            double range, double largest_radius);

// Histories that are not zero, sorted by ids, with the doubles of history_parts_of(). walls: their number.
ContactHistories histories_of(const NeighbourList& list, const GrainStore& store, std::size_t walls);

// Gives the contacts of the list their histories; those (sorted by ids) of pairs not in the list are dropped.
void restore_histories(NeighbourList& list, const GrainStore& store, std::size_t walls,
                       const ContactHistories& histories);

}  // namespace thalweg::dem
