#include "dem/contact/neighbour_list.hpp"

#include "dem/motion/cell_grid.hpp"
#include "dem/motion/minimum_image.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>

namespace thalweg::dem {

namespace {

struct Candidate {
  GlobalId first_id, second_id;
  std::uint32_t first, second;

  bool operator<(const Candidate& other) const {
    return first_id != other.first_id ? first_id < other.first_id : second_id < other.second_id;
  }
};

std::vector<Candidate> find_pairs(const GrainStore& store, const PeriodicBox& box, double range,
                                  double largest_radius) {
  std::vector<Candidate> pairs;
  const CellGrid grid(box, 2.0 * largest_radius + range, store.position);
  const MinimumImage image(box);
  const std::span<const std::uint32_t> slot = grid.order();
  std::vector<Double4> spheres;
  spheres.reserve(slot.size());
  for (const std::uint32_t s : slot) spheres.push_back(double4(store.position[s], store.radius[s]));
  grid.for_each_near_pair([&](std::uint32_t m, std::uint32_t n) {
    const Double4 d = image(spheres[m] - spheres[n]), square = d * d;
    const double limit = spheres[m][3] + spheres[n][3] + range;
    if (!(square[0] + square[1] + square[2] <= limit * limit)) return;
    std::uint32_t first = slot[m], second = slot[n];
    if (store.is_ghost(first) && store.is_ghost(second)) return;
    if (store.clump[first] >= 0 && store.clump[first] == store.clump[second]) return;
    if (store.id[first] > store.id[second]) std::swap(first, second);
    pairs.push_back({store.id[first], store.id[second], first, second});
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

GlobalId wall_key(std::uint32_t wall) { return -1 - static_cast<GlobalId>(wall); }

// I_r of rolling_friction.hpp.
double rolling_inertia(const GrainStore& store, std::uint32_t slot) {
  return store.inertia[slot] + store.mass[slot] * store.radius[slot] * store.radius[slot];
}

ContactBodies contact_bodies(const PairContact& c, const GrainStore& store, const MaterialTable& materials) {
  const MaterialTable::Entry& pair = materials.pair(store.material[c.first], store.material[c.second]);
  const double mass = effective_mass(store.mass[c.first], holds_translation(store.motion[c.first]),
                                     store.mass[c.second], holds_translation(store.motion[c.second]));
  const double inertia = effective_mass(rolling_inertia(store, c.first), holds_rotation(store.motion[c.first]),
                                        rolling_inertia(store, c.second), holds_rotation(store.motion[c.second]));
  return {pair.damping.critical(mass), pair.rolling_friction, inertia};
}

// Bodies of a contact of a grain with a wall or a solid, which has this rolling friction.
ContactBodies contact_bodies(std::size_t slot, double rolling_friction, const GrainStore& store,
                             const MaterialTable& materials) {
  return {materials.wall(store.material[slot]).damping.critical(store.mass[slot]), rolling_friction,
          rolling_inertia(store, static_cast<std::uint32_t>(slot))};
}

// Key of contact n.
ContactKey key_of(const std::vector<PairContact>& contacts, std::size_t n, const GrainStore& store, std::size_t) {
  return {store.id[contacts[n].first], store.id[contacts[n].second]};
}
ContactKey key_of(const std::vector<WallContact>& contacts, std::size_t n, const GrainStore& store, std::size_t) {
  return {store.id[contacts[n].grain], wall_key(contacts[n].wall)};
}
ContactKey key_of(const std::vector<NearSolid>& contacts, std::size_t n, const GrainStore& store, std::size_t walls) {
  const NearSolid& near = contacts[n / touches_per_solid];
  return {store.id[near.grain], solid_key(walls, near.solid, n % touches_per_solid)};
}

template <typename Contact>
std::size_t rows_of(const std::vector<Contact>& contacts) {
  return contacts.size() * (std::is_same_v<Contact, NearSolid> ? touches_per_solid : 1);
}

// Columns of the doubles of these contacts among those of all contacts.
std::vector<std::size_t> columns_of(const ContactRows& rows, std::span<const HistoryPart> all) {
  std::vector<std::size_t> columns;
  for (const HistoryPart& part : history_parts_of(rows.law())) {
    const auto same = std::find_if(all.begin(), all.end(), [&part](const HistoryPart& other) {
      return std::string_view(other.name) == part.name;
    });
    const std::size_t first = doubles_of({all.begin(), same});
    for (std::size_t n = 0; n < part.size; ++n) columns.push_back(first + n);
  }
  return columns;
}

template <typename Contact>
void add_histories(ContactHistories& histories, const std::vector<Contact>& contacts, const ContactRows& rows,
                   std::span<const HistoryPart> all, const GrainStore& store, std::size_t walls) {
  const std::vector<std::size_t> columns = columns_of(rows, all);
  std::vector<double> values(histories.width(), 0.0);
  for (std::size_t c = 0; c < rows_of(contacts); ++c) {
    const std::span<const double> history = rows.history_of(c);
    if (std::all_of(history.begin(), history.end(), [](double x) { return x == 0.0; })) continue;
    for (std::size_t n = 0; n < columns.size(); ++n) values[columns[n]] = history[n];
    histories.add(key_of(contacts, c, store, walls), values);
  }
}

// Walks sorted contacts and sorted histories together.
template <typename Contact>
void take_histories(const std::vector<Contact>& contacts, ContactRows& rows, std::span<const HistoryPart> all,
                    const GrainStore& store, std::size_t walls, const ContactHistories& histories) {
  const std::vector<std::size_t> columns = columns_of(rows, all);
  std::size_t h = 0;
  for (std::size_t c = 0; c < rows_of(contacts); ++c) {
    const ContactKey key = key_of(contacts, c, store, walls);
    while (h < histories.size() && histories.key(h) < key) ++h;
    if (h == histories.size()) return;
    if (histories.key(h) != key) continue;
    for (std::size_t n = 0; n < columns.size(); ++n) rows[c][n] = histories.values(h)[columns[n]];
  }
}

}  // namespace

ContactRows::ContactRows(const LawChoice& law, std::span<const ContactBodies> bodies) : law_(law) {
  with_either_law(law_, 0.0, [&](const auto& chosen) {
    using ContactLaw = std::decay_t<decltype(chosen)>;
    history_ = std::tuple_size_v<typename ContactLaw::History>;
    width_ = width_of<ContactLaw>;
    values_.assign(width_ / 4 * bodies.size(), Double4{});
    for (std::size_t c = 0; c < bodies.size(); ++c) {
      const typename ContactLaw::Constants constants = ContactLaw::constants_of(bodies[c]);
      std::memcpy((*this)[c] + history_, &constants, sizeof(constants));
    }
  });
}

std::vector<HistoryPart> history_parts_of(const NeighbourList& list) {
  LawChoice law = list.pair_rows.law();
  for (const ContactRows* rows : {&list.wall_rows, &list.solid_rows}) {
    law.rolling_friction = law.rolling_friction || rows->law().rolling_friction;
    law.at_surface = law.at_surface || rows->law().at_surface;
  }
  return history_parts_of(law);
}

std::span<const SolidTouch> touches_of(SolidTouches& touches, const NeighbourList& list, std::size_t first,
                                       std::size_t last, const Vec3& position, double radius, double range) {
  // The normal of the last evaluation is the last part of the history (surface_law.hpp).
  return touches.of(list.solids, first, last, position, radius, range, [&list](std::size_t near, std::size_t row) {
    return Vec3::Map(list.solid_rows.history_of(near * touches_per_solid + row).last<3>().data());
  });
}

// Touches are numbered from the last to the first, so that keys ascend.
GlobalId solid_key(std::size_t walls, std::size_t solid, std::size_t row) {
  return wall_key(static_cast<std::uint32_t>(walls + touches_per_solid * solid + (touches_per_solid - 1 - row)));
}

NeighbourList find_contacts(const GrainStore& store, const Surroundings& around, const MaterialTable& materials,
                            double range, double largest_radius) {
  NeighbourList list;
  constexpr double near_share = 0.03;  // of the range
  list.near = list.near_surfaces = InnerNeighbourList(near_share * range);
  std::vector<ContactBodies> bodies;
  for (const Candidate& p : find_pairs(store, around.box, range, largest_radius)) {
    list.pairs.push_back({p.first, p.second, store.radius[p.first] + store.radius[p.second]});
    bodies.push_back(contact_bodies(list.pairs.back(), store, materials));
  }
  list.pair_rows = ContactRows({materials.common(), materials.rolling_friction()}, bodies);
  bodies.clear();
  const std::span<const Plane> walls = around.walls;
  for (std::size_t s = 0; s < store.owned; ++s)
    // The walls are taken from the last to the first, so that the keys -1 - wall ascend.
    for (std::size_t w = walls.size(); w-- > 0;) {
      if (!(walls[w].seen_from(store.position[s], around.box).distance <= store.radius[s] + range)) continue;
      list.walls.push_back({static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(w)});
      bodies.push_back(contact_bodies(s, walls[w].rolling_friction, store, materials));
    }
  const auto rolls = [](const auto& partner) { return partner.rolling_friction > 0.0; };
  list.wall_rows = ContactRows({materials.common(), std::any_of(walls.begin(), walls.end(), rolls)}, bodies);
  if (around.solids.empty()) return list;

  bodies.clear();
  list.solids = find_near_solids(store, around.box, around.placed, around.solids, range);
  for (const NearSolid& near : list.solids)
    bodies.insert(bodies.end(), touches_per_solid,
                  contact_bodies(near.grain, around.solids[near.solid].rolling_friction, store, materials));
  const bool rolling = std::any_of(around.solids.begin(), around.solids.end(), rolls);
  list.solid_rows = ContactRows({materials.common(), rolling, true}, bodies);
  return list;
}

ContactHistories histories_of(const NeighbourList& list, const GrainStore& store, std::size_t walls) {
  const std::vector<HistoryPart> all = history_parts_of(list);
  ContactHistories histories(doubles_of(all));
  add_histories(histories, list.pairs, list.pair_rows, all, store, walls);
  add_histories(histories, list.walls, list.wall_rows, all, store, walls);
  add_histories(histories, list.solids, list.solid_rows, all, store, walls);
  histories.sort();
  return histories;
}

void restore_histories(NeighbourList& list, const GrainStore& store, std::size_t walls,
                       const ContactHistories& histories) {
  const std::vector<HistoryPart> all = history_parts_of(list);
  take_histories(list.pairs, list.pair_rows, all, store, walls, histories);
  take_histories(list.walls, list.wall_rows, all, store, walls, histories);
  take_histories(list.solids, list.solid_rows, all, store, walls, histories);
}

}  // namespace thalweg::dem
