#include "coupling/grain_map.hpp"

#include <algorithm>
#include <tuple>

namespace thalweg::coupling {

using lbm::CellMap;

namespace {

constexpr double nowhere = -1e8;  // no grain's centre is below this

}  // namespace

GrainMap::GrainMap(const Decomposition& decomposition, const Block& block, CellMap& cells)
    : local_cells_(decomposition, block), cells_(cells), hidden_patches_(decomposition, block, cells) {}

int GrainMap::slot_of(GlobalId id) const {
  const auto found = slot_of_id_.find(id);
  return found == slot_of_id_.end() ? -1 : found->second;
}

int GrainMap::add(GlobalId id, double radius, GlobalId clump) {
  int slot;
  if (free_slots_.empty()) {
    slot = static_cast<int>(grains_.size());
    grains_.emplace_back();
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  grains_[slot] = {id, clump, radius, Vec3::Constant(2.0 * nowhere)};
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
  const Vec3 old = grain.centre;
  grain.centre = centre;
  const bool was_here = old.x() > nowhere, is_here = centre.x() > nowhere;
  if (was_here && is_here && (centre - old).squaredNorm() < 1.0) {
    turn_cells(slot, centre, grain.radius + 1.0, old, centre);
  } else {
    if (was_here) turn_cells(slot, old, grain.radius, old, centre);
    if (is_here) turn_cells(slot, centre, grain.radius, old, centre);
  }
}

// Only cells that are inside at one of the two places and not at the other can change hands; what the grain holds or
// claims of the others stays.
void GrainMap::turn_cells(int slot, const Vec3& middle, double reach, const Vec3& old, const Vec3& now) {
  const double squared_radius = grains_[slot].radius * grains_[slot].radius;
  for (int a = 0; a < 3; ++a) {
    local_cells_.along(a, middle[a], reach, old[a], 1, before_[a]);
    local_cells_.along(a, middle[a], reach, now[a], 1, after_[a]);
  }
  const auto squared = [](const LocalCell& place) { return place.offset * place.offset; };
  const std::size_t width = before_[0].size();
  squares_before_.resize(width);
  squares_after_.resize(width);
  turns_.resize(width);
  for (std::size_t k = 0; k < width; ++k) {
    squares_before_[k] = squared(before_[0][k]);
    squares_after_[k] = squared(after_[0][k]);
  }
  for (std::size_t z = 0; z < before_[2].size(); ++z)
    for (std::size_t y = 0; y < before_[1].size(); ++y) {
      const double y_before = squared(before_[1][y]), y_after = squared(after_[1][y]);
      const double z_before = squared(before_[2][z]), z_after = squared(after_[2][z]);
      if (y_before + z_before >= squared_radius && y_after + z_after >= squared_radius) continue;
      unsigned any = 0;
      for (std::size_t k = 0; k < width; ++k) {
        const bool was_inside = squares_before_[k] + y_before + z_before < squared_radius;
        const bool is_inside = squares_after_[k] + y_after + z_after < squared_radius;
        turns_[k] = was_inside != is_inside;
        any |= turns_[k];
      }
      for (std::size_t k = 0; any && k < width; ++k) {
        if (!turns_[k]) continue;
        const Index3 local{after_[0][k].local, after_[1][y].local, after_[2][z].local};
        const bool enters = squares_after_[k] + y_after + z_after < squared_radius;
        enters ? take(slot, local) : leave(slot, local);
      }
    }
}

void GrainMap::assign(const Index3& local, std::ptrdiff_t cell, std::int32_t slot) {
  changes_.push_back({local, cells_.body(cell), slot});
  hidden_patches_.cell_changes(local, slot);
  cells_.assign(local[0], local[1], local[2], slot);
}

void GrainMap::take(int slot, const Index3& local) {
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

void GrainMap::leave(int slot, const Index3& local) {
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
void GrainMap::withdraw(int slot, std::ptrdiff_t cell) {
  const auto found = claimants_.find(cell);
  std::vector<int>& waiting = found->second;
  const auto own = std::find(waiting.begin(), waiting.end(), slot);
  if (own == waiting.end()) return;
  waiting.erase(own);
  if (waiting.empty()) claimants_.erase(found);
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
  return changes_;
}

void GrainMap::begin_update() { changes_.clear(); }

}  // namespace thalweg::coupling
