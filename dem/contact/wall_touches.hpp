// The passes over all contacts of a list with walls and with solids: for the sub-steps, whose grains are packed, and
// for observers, who read the store; for contact laws and for lubrication.
#pragma once

#include "dem/contact/contact_motion.hpp"
#include "dem/contact/neighbour_list.hpp"

#include <optional>

namespace thalweg::dem {

// Contact of a grain with a wall, or with a place of a solid.
struct WallTouch {
  std::uint32_t slot;
  std::size_t wall;  // its number; of solid s the number of walls + s
  WallView view;
  Vec3 velocity;            // m/s, of the surface there
  Vec3 spin;                // rad/s, of the wall: zero; of the solid
  double effective_radius;  // m
  double friction;
  std::size_t row;  // among the rows of the list's walls or solids
  bool goes_on;     // false: the history of that row is not its own

  GlobalId partner() const { return -1 - static_cast<GlobalId>(wall); }
};

inline ContactMotion motion_of(const ContactBody& grain, const WallTouch& touch) {
  ContactMotion motion = motion_of(grain, touch.view, touch.velocity, touch.spin);
  motion.effective_radius = touch.effective_radius;
  return motion;
}

// Calls visit(touch) for every wall contact of the list, near or not. Grains: with position_of() and radius_of().
template <typename Grains, typename Visit>
void for_each_wall_touch(const Grains& grains, const NeighbourList& list, const Surroundings& around, Visit visit) {
  for (std::size_t row = 0; row < list.walls.size(); ++row) {
    const auto [slot, number] = list.walls[row];
    const Plane& wall = around.walls[number];
    visit(WallTouch{slot, number, wall.seen_from(position_of(grains, slot), around.box), wall.velocity, Vec3::Zero(),
                    radius_of(grains, slot), wall.friction, row, true});
  }
}

// Calls visit(touch) for every place of a solid that is within a range (m) of the surface of a grain of the list, after
// without_touch(row) for each row of that grain that belongs to none of its touches.
template <typename Grains, typename Visit, typename WithoutTouch>
void for_each_solid_touch(const Grains& grains, const NeighbourList& list, const Surroundings& around, double range,
                          Visit visit, WithoutTouch without_touch) {
  SolidTouches touches(around.box, around.placed, around.solids);
  SolidTouches::for_each_grain(list.solids, [&](std::size_t first, std::size_t last) {
    const std::uint32_t slot = list.solids[first].grain;
    const auto found =
        touches_of(touches, list, first, last, position_of(grains, slot), radius_of(grains, slot), range);
    for (std::size_t near = first; near < last; ++near)
      for (std::size_t row = 0; row < touches_per_solid; ++row)
        if (!touches.taken(first, near, row)) without_touch(near * touches_per_solid + row);
    for (const SolidTouch& touch : found) {
      const std::size_t solid = list.solids[touch.near].solid;
      visit(WallTouch{slot, around.walls.size() + solid, touch.view, touch.velocity, touch.spin, touch.effective_radius,
                      around.solids[solid].friction, row_of(touch), touch.goes_on});
    }
  });
}
template <typename Grains, typename Visit>
void for_each_solid_touch(const Grains& grains, const NeighbourList& list, const Surroundings& around, double range,
                          Visit visit) {
  for_each_solid_touch(grains, list, around, range, visit, [](std::size_t) {});
}

}  // namespace thalweg::dem
