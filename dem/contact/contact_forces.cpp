#include "dem/contact/contact_forces.hpp"

#include "dem/contact/contact_kernel.hpp"
#include "dem/contact/contact_motion.hpp"
#include "dem/contact/wall_touches.hpp"
#include "dem/laws/contact_laws.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>
#include <type_traits>

namespace thalweg::dem {

namespace {

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
  const std::span<const NearPair> near(list.near.pairs());
  const bool stays = near.size() * bytes_a_pair + grains.size() * sizeof(PackedGrain) <= cached;
  constexpr std::size_t size = ContactKernel<ContactLaw>::capacity, ahead = 24;
  for (std::size_t n = 0; n < near.size(); n += size)
    batch.evaluate(near.subspan(n, std::min(size, near.size() - n)),
                   near.subspan(stays ? near.size() : std::min(n + ahead, near.size())));
}

// A contact law for one contact at a time: one function a law, where a loop for each of them takes the compiler far
// longer.
class SingleContacts {
public:
  virtual ~SingleContacts() = default;
  virtual double range() const = 0;
  // The load on the first body; brings the history in the row to the end of the step. friction: of a wall.
  virtual ContactLoad advance(const ContactMotion& motion, const MaterialTable::Entry& entry,
                              std::optional<double> friction, double* row) const = 0;
  // The load with the history as it is; goes_on: false if the one in the row is not its own.
  virtual ContactLoad present(const ContactMotion& motion, const MaterialTable::Entry& entry,
                              std::optional<double> friction, const double* row, bool goes_on) const = 0;
};

template <IsContactLaw ContactLaw>
class SingleContactsOf final : public SingleContacts {
public:
  explicit SingleContactsOf(const ContactLaw& law) : law_(law) {}

  double range() const override { return law_.range(); }
  ContactLoad advance(const ContactMotion& motion, const MaterialTable::Entry& entry, std::optional<double> friction,
                      double* row) const override {
    History history = history_of(row);
    const ContactLoad load = load_with(motion, entry, friction, row, history);
    std::copy(history.begin(), history.end(), row);
    return load;
  }
  ContactLoad present(const ContactMotion& motion, const MaterialTable::Entry& entry, std::optional<double> friction,
                      const double* row, bool goes_on) const override {
    History history = goes_on ? history_of(row) : History{};
    return load_with(motion, entry, friction, row, history);
  }

private:
  using History = typename ContactLaw::History;

  static History history_of(const double* row) {
    History history;
    std::copy_n(row, history.size(), history.begin());
    return history;
  }
  ContactLoad load_with(const ContactMotion& motion, const MaterialTable::Entry& entry, std::optional<double> friction,
                        const double* row, History& history) const {
    auto coefficients = coefficients_of<typename ContactLaw::Coefficients>(entry);
    if (friction) coefficients.friction = *friction;
    typename ContactLaw::Constants constants;
    std::memcpy(&constants, row + history.size(), sizeof(constants));
    return law_(motion, coefficients, constants, history);
  }

  ContactLaw law_;
};

// time_step: s, with 0 no spring grows.
std::unique_ptr<const SingleContacts> single_contacts(const ContactRows& rows, double time_step) {
  const auto single = [](const auto& law) -> std::unique_ptr<const SingleContacts> {
    return std::make_unique<const SingleContactsOf<std::decay_t<decltype(law)>>>(law);
  };
  return with_either_law(rows.law(), time_step, single);
}

// Adds the load of a wall or a solid to a grain, and advances the history in the rows of contacts of its kind.
void evaluate(const SingleContacts& law, const ContactMotion& motion, const WallTouch& touch, PackedGrain& grain,
              ContactRows& rows, const MaterialTable::Entry& entry) {
  const ContactLoad f = law.advance(motion, entry, touch.friction, rows[touch.row]);
  const Vec3 tangential(f.tx, f.ty, f.tz);
  grain.force += double4(f.normal * touch.view.normal + tangential);
  grain.torque += double4(touch.view.distance * tangential.cross(touch.view.normal));
  grain.torque += Double4{f.mx, f.my, f.mz, 0.0};
}

void evaluate_walls(const SingleContacts& law, PackedGrainState& grains, NeighbourList& list,
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

void evaluate_solids(const SingleContacts& law, PackedGrainState& grains, NeighbourList& list,
                     const Surroundings& around, const MaterialTable& materials,
                     std::span<const std::uint8_t> material) {
  const auto visit = [&](const WallTouch& touch) {
    if (!touch.goes_on) list.solid_rows.forget(touch.row);
    evaluate(law, motion_of(body_of(grains, touch.slot), touch), touch, grains[touch.slot], list.solid_rows,
             materials.wall(material[touch.slot]));
  };
  for_each_solid_touch(grains, list, around, law.range(), visit, [&](std::size_t row) { list.solid_rows.forget(row); });
}

// Force on the first body for observers, with the history unchanged; none if the bodies neither touch nor act across
// the gap.
std::optional<Vec3> force_of(const SingleContacts& law, const ContactMotion& motion, const MaterialTable::Entry& entry,
                             std::optional<double> friction, const double* row, bool goes_on = true) {
  if (!(motion.overlap > -law.range())) return std::nullopt;
  const ContactLoad f = law.present(motion, entry, friction, row, goes_on);
  const Vec3 force = f.normal * normal_of(motion) + Vec3(f.tx, f.ty, f.tz);
  if (!(motion.overlap > 0.0) && force.isZero(0.0)) return std::nullopt;
  return force;
}

// Calls visit(contact number, motion, separation, force on the first) for every acting pair with a wanted grain.
template <typename Wanted, typename Visitor>
void visit_pairs(const ActingGrains& grains, const NeighbourList& list, const PeriodicBox& box,
                 const MaterialTable& materials, const Wanted& wanted, Visitor&& visit) {
  const auto law = single_contacts(list.pair_rows, 0.0);
  for (std::size_t number = 0; number < list.pairs.size(); ++number) {
    const PairContact& c = list.pairs[number];
    if (!wanted(c.first) && !wanted(c.second)) continue;
    const GrainStore& store = grains.store;
    const Vec3 separation = box.difference(store.position[c.first], store.position[c.second]);
    const ContactMotion motion = motion_of(body_of(grains, c.first), body_of(grains, c.second), separation);
    const MaterialTable::Entry& entry = materials.pair(store.material[c.first], store.material[c.second]);
    if (const std::optional<Vec3> force = force_of(*law, motion, entry, std::nullopt, list.pair_rows[number]))
      visit(number, motion, separation, *force);
  }
}

}  // namespace

void evaluate_contacts(PackedGrainState& grains, NeighbourList& list, const Surroundings& around,
                       const MaterialTable& materials, std::span<const std::uint8_t> material, double time_step) {
  with_law(list.pair_rows.law(), time_step,
           [&](const auto& law) { evaluate_pairs(law, grains, list, around.box, materials, material); });
  if (!list.walls.empty())
    evaluate_walls(*single_contacts(list.wall_rows, time_step), grains, list, around, materials, material);
  if (list.solids.empty()) return;
  evaluate_solids(*single_contacts(list.solid_rows, time_step), grains, list, around, materials, material);
}

void for_each_contact_end(const ActingGrains& grains, const NeighbourList& list, const Surroundings& around,
                          const MaterialTable& materials, std::span<const char> chosen,
                          const ContactEndVisitor& visit) {
  const GrainStore& store = grains.store;
  const auto wanted = [&](std::size_t slot) { return !store.is_ghost(slot) && (chosen.empty() || chosen[slot] != 0); };
  visit_pairs(grains, list, around.box, materials, wanted,
              [&](std::size_t number, const ContactMotion& motion, const Vec3& separation, const Vec3& force) {
                const auto [first, second, reach] = list.pairs[number];
                const Vec3 n = normal_of(motion);
                const double half = 0.5 * motion.overlap;
                if (wanted(first))
                  visit(first, {-(store.radius[first] - half) * n, force, store.id[second], -separation});
                if (wanted(second))
                  visit(second, {(store.radius[second] - half) * n, -force, store.id[first], separation});
              });
  for_each_wall_contact(grains, list, around, materials, [&](std::size_t slot, const ContactEnd& end) {
    if (wanted(slot)) visit(slot, end);
  });
}

void for_each_wall_contact(const ActingGrains& grains, const NeighbourList& list, const Surroundings& around,
                           const MaterialTable& materials, const ContactEndVisitor& visit) {
  const GrainStore& store = grains.store;
  const auto visit_acting = [&](const SingleContacts& law, const ContactRows& rows, const WallTouch& touch) {
    const ContactMotion motion = motion_of(body_of(grains, touch.slot), touch);
    const MaterialTable::Entry& entry = materials.wall(store.material[touch.slot]);
    const std::optional<Vec3> force = force_of(law, motion, entry, touch.friction, rows[touch.row], touch.goes_on);
    if (!force || store.is_ghost(touch.slot)) return;
    const Vec3 arm = (motion.overlap - store.radius[touch.slot]) * normal_of(motion);
    visit(touch.slot, {arm, *force, touch.partner(), arm});
  };
  const auto with_walls = single_contacts(list.wall_rows, 0.0);
  for_each_wall_touch(grains, list, around, [&](const WallTouch& t) { visit_acting(*with_walls, list.wall_rows, t); });
  if (list.solids.empty()) return;
  const auto with_solids = single_contacts(list.solid_rows, 0.0);
  for_each_solid_touch(grains, list, around, with_solids->range(),
                       [&](const WallTouch& t) { visit_acting(*with_solids, list.solid_rows, t); });
}

}  // namespace thalweg::dem
