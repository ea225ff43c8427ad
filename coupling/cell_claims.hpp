// Which grain holds which cell of the lattice: grains claim cells and give them up, and of several that claim one the
// lowest global id holds it, whatever the order of events. The cells are this rank's and one ghost layer. A grain keeps
// its slot as long as it is in reach of this rank; slots also index the lattice's LinkBody table. Which cells a grain
// claims follows from its sphere (grain_map.hpp).
#pragma once

#include "core/decomposition.hpp"
#include "coupling/hidden_patches.hpp"
#include "coupling/mapped_grain.hpp"
#include "lbm/cell_map.hpp"

#include <unordered_map>
#include <vector>

namespace thalweg::coupling {

// A cell whose cover changed in the present update; local coordinates, owned or ghost.
struct CellChange {
  Index3 cell;
  std::int32_t before, now;  // slots, or CellMap::fluid
};

class CellClaims {
public:
  CellClaims(const Decomposition& decomposition, const Block& block, lbm::CellMap& cells)
      : cells_(cells), hidden_patches_(decomposition, block, cells) {}

  const std::vector<MappedGrain>& grains() const { return grains_; }
  int slot_of(GlobalId id) const;  // -1 if the grain is not here

  void begin_update();  // forgets the changes of the last update

  // Ends an update: returns what changed, each cell once, sorted. Valid until begin_update().
  const std::vector<CellChange>& settle();
  const std::vector<CellChange>& changes() const { return changes_; }

  const HiddenPatches& hidden_patches() const { return hidden_patches_; }  // of the grains' present cells

protected:
  int new_slot(const MappedGrain& grain);
  void free_slot(int slot);
  MappedGrain& grain(int slot) { return grains_[static_cast<std::size_t>(slot)]; }

  // A grain claims a cell, or gives up what claim it has.
  void claim(int slot, const Index3& local);
  void give_up(int slot, const Index3& local);

private:
  void assign(const Index3& local, std::ptrdiff_t cell, std::int32_t slot);
  void withdraw(int slot, std::ptrdiff_t cell);

  lbm::CellMap& cells_;
  HiddenPatches hidden_patches_;
  std::vector<MappedGrain> grains_;
  std::vector<int> free_slots_;
  std::unordered_map<GlobalId, int> slot_of_id_;
  std::unordered_map<std::ptrdiff_t, std::vector<int>> claimants_;  // of cells that a lower id has
  std::vector<CellChange> changes_;
};

}  // namespace thalweg::coupling
