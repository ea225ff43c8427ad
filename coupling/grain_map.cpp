#include "coupling/grain_map.hpp"

#include <algorithm>
#include <tuple>

namespace thalweg::coupling {

using lbm::CellMap;

namespace {

constexpr double nowhere = -1e8;  // no grain's centre is below this

}  // namespace

GrainMap::GrainMap(const Decomposition& decomposition, const Block& block, CellMap& cells)
    : local_cells_(decomposition, block), cells_(cells) {}

int GrainMap::slot_of(GlobalId id) const {
  const auto found = slot_of_id_.find(id);
  return found == slot_of_id_.end() ? -1 : found->second;
}

int GrainMap::add(GlobalId id, double radius) {
  int slot;
  if (free_slots_.empty()) {
    slot = static_cast<int>(grains_.size());
    grains_.emplace_back();
    relink_marked_.push_back(0);
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  grains_[slot] = {id, radius, Vec3::Constant(2.0 * nowhere), {}};
  slot_of_id_[id] = slot;
  return slot;
}

void GrainMap::remove(int slot) {
  place(slot, Vec3::Constant(2.0 * nowhere));
  slot_of_id_.erase(grains_[slot].id);
  grains_[slot].id = -1;
  free_slots_.push_back(slot);
}

void GrainMap::place(int slot, const Vec3& centre) {
  MappedGrain& grain = grains_[slot];
  const double squared_radius = grain.radius * grain.radius;
  const auto sweep_around = [&](const Vec3& middle) {
    std::vector<LocalCell>* places[3] = {&xs_, &ys_, &zs_};
    for (int a = 0; a < 3; ++a) {
      local_cells_.along(a, middle[a], grain.radius, centre[a], 1, *places[a]);
      if (places[a]->empty()) return;
    }
    for (const LocalCell& z : zs_)
      for (const LocalCell& y : ys_)
        for (const LocalCell& x : xs_) {
          const bool inside = x.offset * x.offset + y.offset * y.offset + z.offset * z.offset < squared_radius;
          const std::ptrdiff_t cell = cells_.indexing().index(x.local, y.local, z.local);
          const bool held = cells_.body(cell) == slot;
          if (inside && !held)
            take(slot, {x.local, y.local, z.local}, cell);
          else if (held && !inside)
            release({x.local, y.local, z.local}, cell);
        }
  };
  const Vec3 old = grain.centre;
  grain.centre = centre;
  drop_claims(slot);
  if (centre.x() > nowhere) sweep_around(centre);
  if (old.x() > nowhere) sweep_around(old);  // cells left behind
  mark_for_relink(slot);
}

void GrainMap::assign(const Index3& local, std::ptrdiff_t cell, std::int32_t slot) {
  changes_.push_back({local, cells_.body(cell), slot});
  cells_.assign(local[0], local[1], local[2], slot);
}

void GrainMap::take(int slot, const Index3& local, std::ptrdiff_t cell) {
  const std::int32_t holder = cells_.body(cell);
  if (holder == CellMap::fluid) {
    assign(local, cell, slot);
    return;
  }
  const bool wins = grains_[slot].id < grains_[holder].id;
  const int loser = wins ? holder : slot;
  std::vector<int>& waiting = claimants_[cell];
  if (std::find(waiting.begin(), waiting.end(), loser) == waiting.end()) {
    waiting.push_back(loser);
    grains_[loser].claims.push_back(cell);
  }
  if (!wins) return;
  const auto own = std::find(waiting.begin(), waiting.end(), slot);
  if (own != waiting.end()) {
    waiting.erase(own);
    auto& claims = grains_[slot].claims;
    claims.erase(std::find(claims.begin(), claims.end(), cell));
  }
  assign(local, cell, slot);
}

void GrainMap::release(const Index3& local, std::ptrdiff_t cell) {
  std::int32_t heir = CellMap::fluid;
  const auto found = claimants_.find(cell);
  if (found != claimants_.end()) {
    std::vector<int>& waiting = found->second;
    const auto lowest =
        std::min_element(waiting.begin(), waiting.end(), [&](int a, int b) { return grains_[a].id < grains_[b].id; });
    heir = *lowest;
    auto& claims = grains_[heir].claims;
    claims.erase(std::find(claims.begin(), claims.end(), cell));
    waiting.erase(lowest);
    if (waiting.empty()) claimants_.erase(found);
  }
  assign(local, cell, heir);
}

// Claims are made again by the sweep that follows.
void GrainMap::drop_claims(int slot) {
  for (const std::ptrdiff_t cell : grains_[slot].claims) {
    const auto found = claimants_.find(cell);
    std::vector<int>& waiting = found->second;
    waiting.erase(std::find(waiting.begin(), waiting.end(), slot));
    if (waiting.empty()) claimants_.erase(found);
  }
  grains_[slot].claims.clear();
}

void GrainMap::mark_for_relink(int slot) {
  if (relink_marked_[slot]) return;
  relink_marked_[slot] = 1;
  relink_.push_back(slot);
}

// A link is told by its fluid cell, its solid cell and the cell upstream: a change is felt up to two cells away.
void GrainMap::mark_neighbours(const Index3& local) {
  const Index3& n = cells_.indexing().size();
  for (int i = 1; i < lbm::D3Q19::directions; ++i)
    for (int steps = 1; steps <= 2; ++steps) {
      Index3 at;
      bool in_memory = true;
      for (int a = 0; a < 3; ++a) {
        at[a] = local[a] + steps * lbm::D3Q19::c[i][a];
        in_memory = in_memory && at[a] >= -1 && at[a] <= n[a];
      }
      if (!in_memory) continue;
      const std::int32_t slot = cells_.body(cells_.indexing().index(at[0], at[1], at[2]));
      if (slot != CellMap::fluid) mark_for_relink(slot);
    }
}

const std::vector<GrainMap::Change>& GrainMap::settle() {
  // One entry a cell: its first state before, its last now.
  const auto order = [](const Change& a, const Change& b) {
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
  for (const Change& change : changes_) {
    if (change.before != CellMap::fluid) mark_for_relink(change.before);
    if (change.now != CellMap::fluid) mark_for_relink(change.now);
    mark_neighbours(change.cell);
  }
  std::sort(relink_.begin(), relink_.end());
  return changes_;
}

void GrainMap::begin_update() {
  changes_.clear();
  for (const int slot : relink_) relink_marked_[slot] = 0;
  relink_.clear();
}

}  // namespace thalweg::coupling
