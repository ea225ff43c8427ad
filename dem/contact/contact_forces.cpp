#include "dem/contact/contact_forces.hpp"

#include "dem/contact/contact_kernel.hpp"
#include "dem/contact/contact_motion.hpp"
#include "dem/contact/wall_touches.hpp"
#include "dem/laws/contact_laws.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

namespace thalweg::dem {

namespace {

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
  // Pairs beyond the range of the law have no history.
  if (list.near.stale())
    look_for_near_pairs(grains, list.pairs, law.range(), box, list.near,
                        [&](std::size_t pair) { list.pair_rows.forget(pair); });
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

// Adds the load of a wall or a solid to a grain, and advances the history in the rows of contacts of its kind.
template <typename ContactLaw>
void evaluate(const ContactLaw& law, const ContactMotion& motion, const WallTouch& touch, PackedGrain& grain,
              ContactRows& rows, const MaterialTable::Entry& entry) {
  typename ContactLaw::History history;
  const ContactLoad f = averaged_load(law, motion, entry, touch.friction, rows[touch.row], history);
  std::copy(history.begin(), history.end(), rows[touch.row]);
  const Vec3 tangential(f.tx, f.ty, f.tz);
  grain.force += double4(f.normal * touch.view.normal + tangential);
  grain.torque += double4(touch.view.distance * tangential.cross(touch.view.normal));
  if constexpr (ContactLaw::rolls) grain.torque += Double4{f.mx, f.my, f.mz, 0.0};
}

template <typename ContactLaw>
[[gnu::flatten]] void evaluate_walls(const ContactLaw& law, PackedGrainState& grains, NeighbourList& list,
                                     const Surroundings& around, const MaterialTable& materials,
                                     std::span<const std::uint8_t> material) {
  for_each_wall_touch(grains, list, around, [&](const WallTouch& touch) {
    const ContactMotion motion = motion_of(body_of(grains, touch.slot), touch);
    if (motion.overlap > -law.range())
      evaluate(law, motion, touch, grains[touch.slot], list.wall_rows, materials.wall(material[touch.slot]));
    else
      list.wall_rows.forget(touch.row);
  });
}

template <typename ContactLaw>
void evaluate_solids(const ContactLaw& law, PackedGrainState& grains, NeighbourList& list, const Surroundings& around,
                     const MaterialTable& materials, std::span<const std::uint8_t> material) {
  const auto visit = [&](const WallTouch& touch) {
    if (!touch.goes_on) list.solid_rows.forget(touch.row);
    evaluate(law, motion_of(body_of(grains, touch.slot), touch), touch, grains[touch.slot], list.solid_rows,
             materials.wall(material[touch.slot]));
  };
  for_each_solid_touch(grains, list, around, law.range(), visit, [&](std::size_t row) { list.solid_rows.forget(row); });
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
  with_law(list.wall_rows.law(), time_step,
           [&](const auto& law) { evaluate_walls(law, grains, list, around, materials, material); });
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
  const auto visit_acting = [&](const auto& law, const ContactRows& rows, const WallTouch& touch) {
    using ContactLaw = std::decay_t<decltype(law)>;
    std::array<double, ContactRows::width_of<ContactLaw>> row;
    std::copy_n(rows[touch.row], row.size(), row.begin());
    if (!touch.goes_on) std::fill_n(row.begin(), std::tuple_size_v<typename ContactLaw::History>, 0.0);
    const ContactMotion motion = motion_of(body_of(store, touch.slot), touch);
    const std::optional<Vec3> force =
        force_of(law, motion, materials.wall(store.material[touch.slot]), touch.friction, row.data());
    if (!force || store.is_ghost(touch.slot)) return;
    const Vec3 arm = (motion.overlap - store.radius[touch.slot]) * normal_of(motion);
    visit(touch.slot, {arm, *force, touch.partner(), arm});
  };
  with_law(list.wall_rows.law(), 0.0, [&](const auto& law) {
    for_each_wall_touch(store, list, around, [&](const WallTouch& t) { visit_acting(law, list.wall_rows, t); });
  });
  if (list.solids.empty()) return;
  with_surface_law(list.solid_rows.law(), 0.0, [&](const auto& law) {
    for_each_solid_touch(store, list, around, law.range(),
                         [&](const WallTouch& t) { visit_acting(law, list.solid_rows, t); });
  });
}

}  // namespace thalweg::dem
