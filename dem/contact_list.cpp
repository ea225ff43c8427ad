#include "dem/contact_list.hpp"

#include "dem/cell_grid.hpp"
#include "dem/minimum_image.hpp"

#include <algorithm>
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

std::vector<Candidate> find_pairs(const GrainStore& store, const PeriodicBox& box, double skin, double largest_radius) {
  std::vector<Candidate> pairs;
  const CellGrid grid(box, 2.0 * largest_radius + skin, store.position);
  const MinimumImage image(box);
  const std::span<const std::uint32_t> slot = grid.order();
  std::vector<Row> spheres;
  spheres.reserve(slot.size());
  for (const std::uint32_t s : slot) spheres.push_back(row_of(store.position[s], store.radius[s]));
  grid.for_each_near_pair([&](std::uint32_t m, std::uint32_t n) {
    const Row d = image(spheres[m] - spheres[n]), square = d * d;
    const double range = spheres[m][3] + spheres[n][3] + skin;
    if (!(square[0] + square[1] + square[2] <= range * range)) return;
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

// Walks sorted contacts and sorted histories together: give(contact number, history).
template <typename Contact, typename Key, typename Give>
void merge(const std::vector<Contact>& contacts, std::span<const ContactHistory> histories, Key&& key_of, Give&& give) {
  std::size_t h = 0;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const ContactHistory key = key_of(contacts[c]);
    while (h < histories.size() && histories[h] < key) ++h;
    if (h == histories.size()) return;
    if (!(key < histories[h])) give(c, histories[h]);
  }
}

// I_r of rolling_friction.hpp.
double rolling_inertia(const GrainStore& store, std::uint32_t slot) {
  return store.inertia[slot] + store.mass[slot] * store.radius[slot] * store.radius[slot];
}

void add_rolling(ContactList& list, const GrainStore& store, std::span<const Plane> walls,
                 const MaterialTable& materials) {
  const bool on_walls =
      std::any_of(walls.begin(), walls.end(), [](const Plane& wall) { return wall.rolling_friction > 0.0; });
  if (materials.rolling_friction())
    for (const PairContact& c : list.pairs)
      list.rolling_pairs.push_back(
          {{0.0, 0.0, 0.0},
           materials.pair(store.material[c.first], store.material[c.second]).rolling_friction,
           effective_mass(rolling_inertia(store, c.first), holds_rotation(store.motion[c.first]),
                          rolling_inertia(store, c.second), holds_rotation(store.motion[c.second]))});
  if (on_walls)
    for (const WallContact& c : list.walls)
      list.rolling_walls.push_back({{0.0, 0.0, 0.0}, walls[c.wall].rolling_friction, rolling_inertia(store, c.grain)});
}

void add_history(std::vector<ContactHistory>& histories, GlobalId first, GlobalId second, const double (&spring)[3],
                 const std::vector<RollingContact>& rolling, std::size_t number) {
  ContactHistory history{first, second, {spring[0], spring[1], spring[2]}, {0.0, 0.0, 0.0}};
  if (!rolling.empty()) std::copy_n(rolling[number].spring, 3, history.rolling.begin());
  const auto some = [](double x) { return x != 0.0; };
  if (std::any_of(history.spring.begin(), history.spring.end(), some) ||
      std::any_of(history.rolling.begin(), history.rolling.end(), some))
    histories.push_back(history);
}

template <typename Contact>
void take_history(std::vector<Contact>& contacts, std::vector<RollingContact>& rolling, std::size_t number,
                  const ContactHistory& history) {
  std::copy(history.spring.begin(), history.spring.end(), contacts[number].spring);
  if (!rolling.empty()) std::copy(history.rolling.begin(), history.rolling.end(), rolling[number].spring);
}

}  // namespace

ContactList find_contacts(const GrainStore& store, const PeriodicBox& box, std::span<const Plane> walls,
                          const MaterialTable& materials, double skin, double largest_radius) {
  ContactList list;
  constexpr double near_share = 0.03;  // of the skin
  list.near = NearPairs(near_share * skin);
  const std::vector<Candidate> pairs = find_pairs(store, box, skin, largest_radius);
  list.pairs.reserve(pairs.size());
  for (const Candidate& p : pairs) {
    const double mass = effective_mass(store.mass[p.first], holds_translation(store.motion[p.first]),
                                       store.mass[p.second], holds_translation(store.motion[p.second]));
    list.pairs.push_back({p.first,
                          p.second,
                          store.radius[p.first] + store.radius[p.second],
                          {0.0, 0.0, 0.0},
                          materials.pair(store.material[p.first], store.material[p.second]).damping.coefficient(mass)});
  }
  for (std::size_t s = 0; s < store.owned; ++s)
    // From the last wall to the first: the keys -1 - wall then rise.
    for (std::size_t w = walls.size(); w-- > 0;) {
      if (!(walls[w].seen_from(store.position[s], box).distance <= store.radius[s] + skin)) continue;
      list.walls.push_back({static_cast<std::uint32_t>(s),
                            static_cast<std::uint32_t>(w),
                            materials.wall(store.material[s]).damping.coefficient(store.mass[s]),
                            {0.0, 0.0, 0.0}});
    }
  add_rolling(list, store, walls, materials);
  return list;
}

std::vector<ContactHistory> histories_of(const ContactList& list, const GrainStore& store) {
  std::vector<ContactHistory> histories;
  for (std::size_t p = 0; p < list.pairs.size(); ++p) {
    const PairContact& c = list.pairs[p];
    add_history(histories, store.id[c.first], store.id[c.second], c.spring, list.rolling_pairs, p);
  }
  for (std::size_t w = 0; w < list.walls.size(); ++w) {
    const WallContact& c = list.walls[w];
    add_history(histories, store.id[c.grain], wall_key(c.wall), c.spring, list.rolling_walls, w);
  }
  sort_histories(histories);
  return histories;
}

void restore_histories(ContactList& list, const GrainStore& store, std::span<const ContactHistory> histories) {
  merge(
      list.pairs, histories,
      [&](const PairContact& c) {
        return ContactHistory{store.id[c.first], store.id[c.second], {}, {}};
      },
      [&](std::size_t p, const ContactHistory& h) { take_history(list.pairs, list.rolling_pairs, p, h); });
  merge(
      list.walls, histories,
      [&](const WallContact& c) {
        return ContactHistory{store.id[c.grain], wall_key(c.wall), {}, {}};
      },
      [&](std::size_t w, const ContactHistory& h) { take_history(list.walls, list.rolling_walls, w, h); });
}

}  // namespace thalweg::dem
