#include "bodies/map/body_map.hpp"

#include "core/base/check.hpp"

#include <algorithm>
#include <tuple>

namespace thalweg::bodies {

using lbm::CellMap;

BodySlot BodyMap::slot_of(GlobalId id) const {
  const auto found = slot_of_id_.find(id);
  return found == slot_of_id_.end() ? BodySlot::none : found->second;
}

MappedBody& BodyMap::body(BodySlot slot) {
  CHECK(index_of(slot) < bodies_.size());
  return bodies_[index_of(slot)];
}

void BodyMap::assign(const Index3& local, std::ptrdiff_t cell, std::int32_t slot) {
  changes_.push_back({local, cells_.body(cell), slot});
  occluded_patches_.cell_changes(local, slot);
  cells_.assign(local[0], local[1], local[2], slot);
}

// Cells of the block and its layers, one by one.
std::ptrdiff_t BodyMap::key_beyond(const Index3& local) const {
  const Index3& n = cells_.indexing().size();
  std::ptrdiff_t key = 0;
  for (int a = 2; a >= 0; --a) key = key * (n[a] + 2 * layers) + local[a] + layers;
  return key;
}

bool BodyMap::covers(const Index3& local) const {
  const lbm::CellIndexing& indexing = cells_.indexing();
  return indexing.in_memory(local) ? !cells_.is_fluid(indexing.index(local[0], local[1], local[2]))
                                   : beyond_.contains(key_beyond(local));
}

void BodyMap::claim(BodySlot claimant, const Index3& local) {
  const auto slot = static_cast<std::int32_t>(claimant);
  if (!cells_.indexing().in_memory(local)) {
    std::vector<int>& there = beyond_[key_beyond(local)];
    if (std::find(there.begin(), there.end(), slot) == there.end()) there.push_back(slot);
    return;
  }
  const std::ptrdiff_t cell = cells_.indexing().index(local[0], local[1], local[2]);
  const std::int32_t holder = cells_.body(cell);
  if (holder == slot) return;
  if (holder == CellMap::fluid) {
    assign(local, cell, slot);
    return;
  }
  const bool wins = bodies_[slot].id < bodies_[holder].id;
  const int loser = wins ? holder : slot;
  std::vector<int>& waiting = claimants_[cell];
  if (std::find(waiting.begin(), waiting.end(), loser) == waiting.end()) waiting.push_back(loser);
  if (!wins) return;
  withdraw(slot, cell);
  assign(local, cell, slot);
}

void BodyMap::give_up(BodySlot holder, const Index3& local) {
  const auto slot = static_cast<std::int32_t>(holder);
  if (!cells_.indexing().in_memory(local)) {
    const auto there = beyond_.find(key_beyond(local));
    if (there == beyond_.end()) return;
    std::erase(there->second, slot);
    if (there->second.empty()) beyond_.erase(there);
    return;
  }
  const std::ptrdiff_t cell = cells_.indexing().index(local[0], local[1], local[2]);
  const auto found = claimants_.find(cell);
  if (cells_.body(cell) != slot) {
    if (found != claimants_.end()) withdraw(slot, cell);
    return;
  }
  std::int32_t heir = CellMap::fluid;
  if (found != claimants_.end()) {
    const std::vector<int>& waiting = found->second;
    heir =
        *std::min_element(waiting.begin(), waiting.end(), [&](int a, int b) { return bodies_[a].id < bodies_[b].id; });
    withdraw(heir, cell);
  }
  assign(local, cell, heir);
}

// Ends the claim of a grain to a cell, if it has one.
void BodyMap::withdraw(int slot, std::ptrdiff_t cell) {
  const auto found = claimants_.find(cell);
  std::vector<int>& waiting = found->second;
  const auto own = std::find(waiting.begin(), waiting.end(), slot);
  if (own == waiting.end()) return;
  waiting.erase(own);
  if (waiting.empty()) claimants_.erase(found);
}

const std::vector<CellChange>& BodyMap::settle() {
  // One change per cell: from its first state to its last.
  const auto order = [](const CellChange& a, const CellChange& b) {
    return std::tie(a.cell[2], a.cell[1], a.cell[0]) < std::tie(b.cell[2], b.cell[1], b.cell[0]);
  };
  std::stable_sort(changes_.begin(), changes_.end(), order);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < changes_.size();) {
    std::size_t last = k;
    while (last + 1 < changes_.size() && changes_[last + 1].cell == changes_[k].cell) ++last;
    if (changes_[k].before != changes_[last].now)
      changes_[kept++] = {changes_[k].cell, changes_[k].before, changes_[last].now};
    k = last + 1;
  }
  changes_.resize(kept);
  return changes_;
}

void BodyMap::begin_update() {
  changes_.clear();
  free_slots_.insert(free_slots_.end(), just_freed_.begin(), just_freed_.end());
  just_freed_.clear();
}

BodySlot BodyMap::add(GlobalId id, double radius, GlobalId clump) {
  CHECK(!slot_of_id_.contains(id));
  BodySlot slot;
  if (free_slots_.empty()) {
    slot = slot_at(bodies_.size());
    bodies_.emplace_back();
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  body(slot) = {id, clump, radius, Vec3::Constant(2.0 * nowhere)};
  slot_of_id_[id] = slot;
  return slot;
}

void BodyMap::add_solids(const std::vector<bool>& moves) {
  CHECK(bodies_.empty());
  solids_ = static_cast<int>(moves.size());
  for (int slot = 0; slot < solids_; ++slot) {
    const GlobalId first = GlobalId(moves[static_cast<std::size_t>(slot)] ? -1 : -2) * solids_ - 1;
    bodies_.push_back({first + slot, -1, 0.0, Vec3::Constant(2.0 * nowhere)});
  }
}

void BodyMap::remove(BodySlot slot) {
  CHECK(index_of(slot) >= static_cast<std::size_t>(solids_) && !body(slot).is_free());
  remap(slot, Vec3::Constant(2.0 * nowhere));
  slot_of_id_.erase(body(slot).id);
  body(slot).id = MappedBody::nobody;
  just_freed_.push_back(slot);
}

void BodyMap::remap(BodySlot slot, const Vec3& centre) {
  CHECK(index_of(slot) >= static_cast<std::size_t>(solids_) && !body(slot).is_free());
  const Vec3 reach = Vec3::Constant(body(slot).radius);
  const Vec3 old = body(slot).centre;
  body(slot).centre = centre;
  const bool was_here = old.x() > nowhere, is_here = centre.x() > nowhere;
  if (was_here && is_here && (centre - old).squaredNorm() < 1.0) {
    // The margin finds all cells near the edge of both spheres.
    toggle_cells(slot, centre, reach + (centre - old).cwiseAbs() + Vec3::Constant(1e-6), old, centre);
  } else {
    if (was_here) toggle_cells(slot, old, reach, old, centre);
    if (is_here) toggle_cells(slot, centre, reach, old, centre);
  }
}

// Only cells that are inside at one of the two places and not at the other can change hands; what the grain holds or
// claims of the others stays.
void BodyMap::toggle_cells(BodySlot slot, const Vec3& middle, const Vec3& half_width, const Vec3& old,
                           const Vec3& now) {
  for (int a = 0; a < 3; ++a) {
    local_cells_.along(a, middle[a], half_width[a], old[a], layers, before_[a]);
    local_cells_.along(a, middle[a], half_width[a], now[a], layers, after_[a]);
  }
  const auto offset = [](const LocalCell& cell) { return cell.offset; };
  x_before_.resize(before_[0].size());
  x_after_.resize(after_[0].size());
  std::transform(before_[0].begin(), before_[0].end(), x_before_.begin(), offset);
  std::transform(after_[0].begin(), after_[0].end(), x_after_.begin(), offset);
  const Sphere sphere{body(slot).radius};
  for (std::size_t z = 0; z < after_[2].size(); ++z)
    for (std::size_t y = 0; y < after_[1].size(); ++y) {
      const Sphere::Chord before = sphere.chord(before_[1][y].offset, before_[2][z].offset),
                          after = sphere.chord(after_[1][y].offset, after_[2][z].offset);
      if (!before.missed() || !after.missed()) toggle_row(slot, after_[1][y].local, after_[2][z].local, before, after);
    }
}

void BodyMap::toggle_row(BodySlot slot, int y, int z, const Sphere::Chord& before, const Sphere::Chord& after) {
  const std::size_t width = x_after_.size();
  turns_.resize(width);
  unsigned any = 0;
  for (std::size_t k = 0; k < width; ++k) {
    turns_[k] = before.holds(x_before_[k]) != after.holds(x_after_[k]);
    any |= turns_[k];
  }
  for (std::size_t k = 0; any && k < width; ++k) {
    if (!turns_[k]) continue;
    const Index3 local{after_[0][k].local, y, z};
    after.holds(x_after_[k]) ? claim(slot, local) : give_up(slot, local);
  }
}

}  // namespace thalweg::bodies
