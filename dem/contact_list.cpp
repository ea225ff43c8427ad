#include "dem/contact_list.hpp"

#include "dem/cell_grid.hpp"

#include <algorithm>

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
  for (std::size_t a = 0; a < store.owned; ++a)
    grid.for_each_near(store.position[a], [&](std::uint32_t b) {
      const bool mine_to_list = store.is_ghost(b) || store.id[a] < store.id[b];
      if (b == a || !mine_to_list || (store.clump[a] >= 0 && store.clump[a] == store.clump[b])) return;
      const double range = store.radius[a] + store.radius[b] + skin;
      if (!(box.difference(store.position[a], store.position[b]).squaredNorm() <= range * range)) return;
      const auto slot = static_cast<std::uint32_t>(a);
      if (store.id[a] < store.id[b])
        pairs.push_back({store.id[a], store.id[b], slot, b});
      else
        pairs.push_back({store.id[b], store.id[a], b, slot});
    });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

bool is_zero(const double (&spring)[3]) { return spring[0] == 0.0 && spring[1] == 0.0 && spring[2] == 0.0; }

GlobalId wall_key(std::uint32_t wall) { return -1 - static_cast<GlobalId>(wall); }

// Walks sorted contacts and sorted histories together.
template <typename Contact, typename Key>
void merge(std::vector<Contact>& contacts, std::span<const ContactHistory> histories, Key&& key_of) {
  std::size_t h = 0;
  for (Contact& contact : contacts) {
    const ContactHistory key = key_of(contact);
    while (h < histories.size() && histories[h] < key) ++h;
    if (h == histories.size()) return;
    if (!(key < histories[h])) std::copy(histories[h].spring.begin(), histories[h].spring.end(), contact.spring);
  }
}

}  // namespace

ContactList find_contacts(const GrainStore& store, const PeriodicBox& box, std::span<const Plane> walls,
                          const MaterialTable& materials, double skin, double largest_radius) {
  ContactList list;
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
      const double height = (store.position[s] - walls[w].point).dot(walls[w].normal);
      if (!(height <= store.radius[s] + skin)) continue;
      list.walls.push_back({static_cast<std::uint32_t>(s),
                            static_cast<std::uint32_t>(w),
                            materials.wall(store.material[s]).damping.coefficient(store.mass[s]),
                            {0.0, 0.0, 0.0}});
    }
  return list;
}

std::vector<ContactHistory> histories_of(const ContactList& list, const GrainStore& store) {
  std::vector<ContactHistory> histories;
  for (const PairContact& c : list.pairs)
    if (!is_zero(c.spring))
      histories.push_back({store.id[c.first], store.id[c.second], {c.spring[0], c.spring[1], c.spring[2]}});
  for (const WallContact& c : list.walls)
    if (!is_zero(c.spring))
      histories.push_back({store.id[c.grain], wall_key(c.wall), {c.spring[0], c.spring[1], c.spring[2]}});
  sort_histories(histories);
  return histories;
}

void restore_histories(ContactList& list, const GrainStore& store, std::span<const ContactHistory> histories) {
  merge(list.pairs, histories, [&](const PairContact& c) {
    return ContactHistory{store.id[c.first], store.id[c.second], {}};
  });
  merge(list.walls, histories, [&](const WallContact& c) {
    return ContactHistory{store.id[c.grain], wall_key(c.wall), {}};
  });
}

}  // namespace thalweg::dem
