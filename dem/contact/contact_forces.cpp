#include "dem/contact/contact_forces.hpp"

#include "dem/contact/contact_kernel.hpp"
#include "dem/contact/contact_motion.hpp"
#include "dem/laws/contact_laws.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

namespace thalweg::dem {

namespace {

// Finds the near pairs; the others are beyond the range of the law (m) and have no history.
void look_for_near_pairs(const PackedGrainState& grains, NeighbourList& list, double range_of_law,
                         const MinimumImage& image) {
  list.near.begin();
  const double range = range_of_law + list.near.margin();
  for (std::size_t p = 0; p < list.pairs.size(); ++p) {
    const PairContact& c = list.pairs[p];
    const Double4 d = image(grains[c.first].position - grains[c.second].position), square = d * d;
    const double squared = square[0] + square[1] + square[2], limit = c.reach + range;
    if (squared < limit * limit)
      list.near.add({c.first, c.second, static_cast<std::uint32_t>(p)});
    else
      list.pair_rows.forget(p);
  }
}

template <bool fetch, typename Batch>
void evaluate_near_pairs(const std::vector<NearPair>& near, Batch& batch) {
  const std::span<const NearPair> all(near);
  constexpr std::size_t size = Batch::capacity, ahead = 24;
  for (std::size_t n = 0; n < all.size(); n += size)
    batch.template evaluate<fetch>(all.subspan(n, std::min(size, all.size() - n)),
                                   all.subspan(std::min(n + ahead, all.size())));
}

template <typename ContactLaw>
void evaluate_pairs(const ContactLaw& law, PackedGrainState& grains, NeighbourList& list, const PeriodicBox& box,
                    const MaterialTable& materials, std::span<const std::uint8_t> material) {
  if (list.near.stale()) look_for_near_pairs(grains, list, law.range(), MinimumImage(box));
  ContactKernel<ContactLaw> batch(law, grains, list.pair_rows.data(), box, materials, material);
  // Data that do not stay in the cache from one sub-step to the next are prefetched.
  constexpr std::size_t cached = 2 << 20;  // bytes
  constexpr std::size_t bytes_a_pair = sizeof(NearPair) + sizeof(double) * ContactRows::width_of<ContactLaw>;
  const std::vector<NearPair>& near = list.near.pairs();
  if (near.size() * bytes_a_pair + grains.size() * sizeof(PackedGrain) > cached)
    evaluate_near_pairs<true>(near, batch);
  else
    evaluate_near_pairs<false>(near, batch);
}

// Load by the law on the first body of a contact, whose history it updates; friction: of a wall.
template <typename ContactLaw>
ContactLoad averaged_load(const ContactLaw& law, const ContactMotion& motion, const MaterialTable::Entry& entry,
                          std::optional<double> friction, const double* row, typename ContactLaw::History& history) {
  auto coefficients = coefficients_of<typename ContactLaw::Coefficients>(entry);
  if (friction) coefficients.friction = *friction;
  typename ContactLaw::Constants constants;
  std::memcpy(history.data(), row, sizeof(history));
  std::memcpy(&constants, row + history.size(), sizeof(constants));
  return law(motion, coefficients, constants, history);
}

// Adds the load of a wall or a solid to a grain.
template <bool rolls>
void add_wall_load(const ContactLoad& f, const WallView& view, PackedGrain& grain) {
  const Vec3 tangential(f.tx, f.ty, f.tz);
  grain.force += double4(f.normal * view.normal + tangential);
  grain.torque += double4(view.distance * tangential.cross(view.normal));
  if constexpr (rolls) grain.torque += Double4{f.mx, f.my, f.mz, 0.0};
}

template <typename ContactLaw>
[[gnu::flatten]] void evaluate_walls(const ContactLaw& law, PackedGrainState& grains,
                                     std::vector<WallContact>& contacts, ContactRows& rows, const PeriodicBox& box,
                                     std::span<const Plane> walls, const MaterialTable& materials,
                                     std::span<const std::uint8_t> material) {
  for (std::size_t number = 0; number < contacts.size(); ++number) {
    const WallContact& c = contacts[number];
    PackedGrain& grain = grains[c.grain];
    const Plane& wall = walls[c.wall];
    const WallView view = wall.seen_from(vector_of(grain.position), box);
    const ContactMotion motion = motion_of(body_of(grain), view, wall.velocity);
    if (!(motion.overlap > -law.range())) {
      rows.forget(number);
      continue;
    }
    typename ContactLaw::History history;
    const ContactLoad f =
        averaged_load(law, motion, materials.wall(material[c.grain]), wall.friction, rows[number], history);
    std::copy(history.begin(), history.end(), rows[number]);
    add_wall_load<ContactLaw::rolls>(f, view, grain);
  }
}

ContactMotion motion_of(const ContactBody& grain, const SolidTouch& touch) {
  ContactMotion motion = motion_of(grain, touch.view, touch.velocity);
  motion.effective_radius = touch.effective_radius;
  return motion;
}

double friction_of(const SolidTouch& touch, const NeighbourList& list, const Surroundings& around) {
  return around.solids[list.solids[touch.near].solid].friction;
}

template <typename ContactLaw>
void evaluate_solids(const ContactLaw& law, PackedGrainState& grains, NeighbourList& list, const Surroundings& around,
                     const MaterialTable& materials, std::span<const std::uint8_t> material) {
  SolidTouches touches(around.box, around.placed, around.solids);
  SolidTouches::for_each_grain(list.solids, [&](std::size_t first, std::size_t last) {
    const std::uint32_t slot = list.solids[first].grain;
    PackedGrain& grain = grains[slot];
    const auto found =
        touches_of(touches, list, first, last, vector_of(grain.position), grain.position[3], law.range());
    for (std::size_t near = first; near < last; ++near)
      for (std::size_t row = 0; row < touches_per_solid; ++row)
        if (!touches.taken(first, near, row)) list.solid_rows.forget(near * touches_per_solid + row);
    for (const SolidTouch& touch : found) {
      const std::size_t number = row_of(touch);
      if (!touch.goes_on) list.solid_rows.forget(number);
      const ContactMotion motion = motion_of(body_of(grain), touch);
      typename ContactLaw::History history;
      const ContactLoad f = averaged_load(law, motion, materials.wall(material[slot]), friction_of(touch, list, around),
                                          list.solid_rows[number], history);
      std::copy(history.begin(), history.end(), list.solid_rows[number]);
      add_wall_load<ContactLaw::rolls>(f, touch.view, grain);
    }
  });
}

// Force on the first body for observers, with the history unchanged; none if the bodies neither touch nor act across
// the gap.
template <typename ContactLaw>
std::optional<Vec3> force_of(const ContactLaw& law, const ContactMotion& motion, const MaterialTable::Entry& entry,
                             std::optional<double> friction, const double* row) {
  if (!(motion.overlap > -law.range())) return std::nullopt;
  typename ContactLaw::History history;
  const ContactLoad f = averaged_load(law, motion, entry, friction, row, history);
  const Vec3 force = f.normal * normal_of(motion) + Vec3(f.tx, f.ty, f.tz);
  if (!(motion.overlap > 0.0) && force.isZero(0.0)) return std::nullopt;
  return force;
}

// Calls visit(contact number, motion, force on the grain) for every wall contact of the list that acts.
template <typename Visitor>
void visit_walls(const GrainStore& store, const NeighbourList& list, const Surroundings& around,
                 const MaterialTable& materials, Visitor&& visit) {
  with_law(list.wall_rows.law(), 0.0, [&](const auto& law) {
    for (std::size_t number = 0; number < list.walls.size(); ++number) {
      const WallContact& c = list.walls[number];
      const Plane& wall = around.walls[c.wall];
      const ContactMotion motion =
          motion_of(body_of(store, c.grain), wall.seen_from(store.position[c.grain], around.box), wall.velocity);
      if (const std::optional<Vec3> force =
              force_of(law, motion, materials.wall(store.material[c.grain]), wall.friction, list.wall_rows[number]))
        visit(number, motion, *force);
    }
  });
}

// Calls visit(touch, motion, force on the grain) for every touch with a solid that acts.
template <typename Visitor>
void visit_solids(const GrainStore& store, const NeighbourList& list, const Surroundings& around,
                  const MaterialTable& materials, Visitor&& visit) {
  if (list.solids.empty()) return;
  SolidTouches touches(around.box, around.placed, around.solids);
  with_surface_law(list.solid_rows.law(), 0.0, [&](const auto& law) {
    SolidTouches::for_each_grain(list.solids, [&](std::size_t first, std::size_t last) {
      const std::uint32_t slot = list.solids[first].grain;
      const auto found = touches_of(touches, list, first, last, store.position[slot], store.radius[slot], law.range());
      for (const SolidTouch& touch : found) {
        const ContactMotion motion = motion_of(body_of(store, slot), touch);
        using ContactLaw = std::decay_t<decltype(law)>;
        std::array<double, ContactRows::width_of<ContactLaw>> row;
        std::copy_n(list.solid_rows[row_of(touch)], row.size(), row.begin());
        if (!touch.goes_on) std::fill_n(row.begin(), std::tuple_size_v<typename ContactLaw::History>, 0.0);
        if (const std::optional<Vec3> force = force_of(law, motion, materials.wall(store.material[slot]),
                                                       friction_of(touch, list, around), row.data()))
          visit(touch, motion, *force);
      }
    });
  });
}

// Calls visit(contact number, motion, separation, force on the first) for every acting pair with a wanted grain.
template <typename Wanted, typename Visitor>
void visit_pairs(const GrainStore& store, const NeighbourList& list, const PeriodicBox& box,
                 const MaterialTable& materials, const Wanted& wanted, Visitor&& visit) {
  with_law(list.pair_rows.law(), 0.0, [&](const auto& law) {
    for (std::size_t number = 0; number < list.pairs.size(); ++number) {
      const PairContact& c = list.pairs[number];
      if (!wanted(c.first) && !wanted(c.second)) continue;
      const Vec3 separation = box.difference(store.position[c.first], store.position[c.second]);
      const ContactMotion motion = motion_of(body_of(store, c.first), body_of(store, c.second), separation);
      const MaterialTable::Entry& entry = materials.pair(store.material[c.first], store.material[c.second]);
      if (const std::optional<Vec3> force = force_of(law, motion, entry, std::nullopt, list.pair_rows[number]))
        visit(number, motion, separation, *force);
    }
  });
}

}  // namespace

void evaluate_contacts(PackedGrainState& grains, NeighbourList& list, const Surroundings& around,
                       const MaterialTable& materials, std::span<const std::uint8_t> material, double time_step) {
  with_law(list.pair_rows.law(), time_step,
           [&](const auto& law) { evaluate_pairs(law, grains, list, around.box, materials, material); });
  with_law(list.wall_rows.law(), time_step, [&](const auto& law) {
    evaluate_walls(law, grains, list.walls, list.wall_rows, around.box, around.walls, materials, material);
  });
  if (list.solids.empty()) return;
  with_surface_law(list.solid_rows.law(), time_step,
                   [&](const auto& law) { evaluate_solids(law, grains, list, around, materials, material); });
}

void for_each_contact_end(const GrainStore& store, const NeighbourList& list, const Surroundings& around,
                          const MaterialTable& materials, std::span<const char> chosen,
                          const ContactEndVisitor& visit) {
  const auto wanted = [&](std::size_t slot) { return !store.is_ghost(slot) && (chosen.empty() || chosen[slot] != 0); };
  visit_pairs(store, list, around.box, materials, wanted,
              [&](std::size_t number, const ContactMotion& motion, const Vec3& separation, const Vec3& force) {
                const auto [first, second, reach] = list.pairs[number];
                const Vec3 n = normal_of(motion);
                const double half = 0.5 * motion.overlap;
                if (wanted(first))
                  visit(first, {-(store.radius[first] - half) * n, force, store.id[second], -separation});
                if (wanted(second))
                  visit(second, {(store.radius[second] - half) * n, -force, store.id[first], separation});
              });
  for_each_wall_contact(store, list, around, materials, [&](std::size_t slot, const ContactEnd& end) {
    if (wanted(slot)) visit(slot, end);
  });
}

void for_each_wall_contact(const GrainStore& store, const NeighbourList& list, const Surroundings& around,
                           const MaterialTable& materials, const ContactEndVisitor& visit) {
  const auto visit_end = [&](std::size_t slot, std::size_t partner, const ContactMotion& motion, const Vec3& force) {
    if (store.is_ghost(slot)) return;
    const Vec3 arm = (motion.overlap - store.radius[slot]) * normal_of(motion);
    visit(slot, {arm, force, -1 - static_cast<GlobalId>(partner), arm});
  };
  visit_walls(store, list, around, materials, [&](std::size_t number, const ContactMotion& motion, const Vec3& force) {
    visit_end(list.walls[number].grain, list.walls[number].wall, motion, force);
  });
  visit_solids(store, list, around, materials,
               [&](const SolidTouch& touch, const ContactMotion& motion, const Vec3& force) {
                 const NearSolid& near = list.solids[touch.near];
                 visit_end(near.grain, around.walls.size() + near.solid, motion, force);
               });
}

}  // namespace thalweg::dem
