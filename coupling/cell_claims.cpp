#include "coupling/cell_claims.hpp"

#include <algorithm>
#include <tuple>

namespace thalweg::coupling {

using lbm::CellMap;

int CellClaims::slot_of(GlobalId id) const {
  const auto found = slot_of_id_.find(id);
  return found == slot_of_id_.end() ? -1 : found->second;
}

int CellClaims::new_slot(const MappedGrain& grain) {
  int slot;
  if (free_slots_.empty()) {
    slot = static_cast<int>(grains_.size());
    grains_.emplace_back();
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  grains_[slot] = grain;
  slot_of_id_[grain.id] = slot;
  return slot;
}

void CellClaims::free_slot(int slot) {
  slot_of_id_.erase(grains_[slot].id);
  grains_[slot].id = -1;
  free_slots_.push_back(slot);
}

void CellClaims::assign(const Index3& local, std::ptrdiff_t cell, std::int32_t slot) {
  changes_.push_back({local, cells_.body(cell), slot});
  hidden_patches_.cell_changes(local, slot);
  cells_.assign(local[0], local[1], local[2], slot);
}

void CellClaims::claim(int slot, const Index3& local) {
  const std::ptrdiff_t cell = cells_.indexing().index(local[0], local[1], local[2]);
  const std::int32_t holder = cells_.body(cell);
  if (holder == slot) return;
  if (holder == CellMap::fluid) {
    assign(local, cell, slot);
    return;
  }
  const bool wins = grains_[slot].id < grains_[holder].id;
  const int loser = wins ? holder : slot;
  std::vector<int>& waiting = claimants_[cell];
  if (std::find(waiting.begin(), waiting.end(), loser) == waiting.end()) waiting.push_back(loser);
  if (!wins) return;
  withdraw(slot, cell);
  assign(local, cell, slot);
}

void CellClaims::give_up(int slot, const Index3& local) {
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
        *std::min_element(waiting.begin(), waiting.end(), [&](int a, int b) { return grains_[a].id < grains_[b].id; });
    withdraw(heir, cell);
  }
  assign(local, cell, heir);
}

// Ends the claim of a grain to a cell, if it has one.
void CellClaims::withdraw(int slot, std::ptrdiff_t cell) {
  const auto found = claimants_.find(cell);
  std::vector<int>& waiting = found->second;
  const auto own = std::find(waiting.begin(), waiting.end(), slot);
  if (own == waiting.end()) return;
  waiting.erase(own);
  if (waiting.empty()) claimants_.erase(found);
}

const std::vector<CellChange>& CellClaims::settle() {
  // One entry a cell: its first state before, its last now.
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

void CellClaims::begin_update() { changes_.clear(); }

}  // namespace thalweg::coupling
