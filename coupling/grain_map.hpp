// Which cells each grain covers, kept up to date as grains move.
//
// A cell is solid if its centre is strictly inside a grain; where two overlapping grains claim a cell, the lower global
// id has it, whatever the order of events. The map covers this rank's cells and one ghost layer. Grains live in slots
// that stay theirs as long as the grain is in reach of this rank; slots index the lattice's LinkBody table as well.
#pragma once

#include "core/decomposition.hpp"
#include "coupling/hidden_patches.hpp"
#include "coupling/local_cells.hpp"
#include "lbm/cell_map.hpp"
#include "lbm/link_table.hpp"

#include <unordered_map>
#include <vector>

namespace thalweg::coupling {

struct MappedGrain {
  GlobalId id = -1;            // -1: the slot is free
  GlobalId clump = -1;         // it is a member of; -1: none
  double radius = 0.0;         // lattice units
  Vec3 centre = Vec3::Zero();  // for which its cells stand; lattice units, global
};

class GrainMap {
public:
  // A cell whose cover changed in the present update; local coordinates, owned or ghost.
  struct Change {
    Index3 cell;
    std::int32_t before, now;  // slots; CellMap::fluid
  };

  GrainMap(const Decomposition& decomposition, const Block& block, lbm::CellMap& cells);

  const std::vector<MappedGrain>& grains() const { return grains_; }
  int slot_of(GlobalId id) const;  // -1 if the grain is not here

  int add(GlobalId id, double radius, GlobalId clump = -1);  // a new slot, covering nothing yet
  void remove(int slot);                                     // gives up the grain's cells

  void begin_update();  // forgets the changes of the last update

  // Moves a grain: its cells are those of a sphere at `centre`. Changes are collected until settle().
  void place(int slot, const Vec3& centre);

  // Ends an update: returns what changed, each cell once, sorted. Valid until begin_update().
  const std::vector<Change>& settle();
  const std::vector<Change>& changes() const { return changes_; }

  const HiddenPatches& hidden_patches() const { return hidden_patches_; }  // of the grains' present cells

private:
  void assign(const Index3& local, std::ptrdiff_t cell, std::int32_t slot);
  // Turns the cells within reach of `middle` that are inside the grain at only one of the two places of its centre.
  void turn_cells(int slot, const Vec3& middle, double reach, const Vec3& old, const Vec3& now);
  void take(int slot, const Index3& local);
  void leave(int slot, const Index3& local);
  void withdraw(int slot, std::ptrdiff_t cell);

  LocalCells local_cells_;
  lbm::CellMap& cells_;
  HiddenPatches hidden_patches_;
  std::vector<MappedGrain> grains_;
  std::vector<int> free_slots_;
  std::unordered_map<GlobalId, int> slot_of_id_;
  std::unordered_map<std::ptrdiff_t, std::vector<int>> claimants_;  // of cells that a lower id has
  std::vector<Change> changes_;
  // Scratch of turn_cells: cells along each axis from the two centres; of a row, squares of the offsets and who turns.
  std::vector<LocalCell> before_[3], after_[3];
  std::vector<double> squares_before_, squares_after_;
  std::vector<unsigned> turns_;
};

}  // namespace thalweg::coupling
