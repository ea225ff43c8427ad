// Map from lattice cells to bodies, updated as bodies move. A body claims the cells whose centres are strictly inside
// its sphere; of several that claim a cell the lowest global id holds it, regardless of the order of events. The map
// covers the cells of this rank and one ghost layer; for a second layer it records only which bodies claim a cell. A
// body keeps its slot as long as it is in reach of this rank; slots also index the table of LinkBody.
#pragma once

#include "bodies/map/body_slot.hpp"
#include "bodies/map/local_cells.hpp"
#include "bodies/map/mapped_body.hpp"
#include "bodies/map/occluded_patches.hpp"
#include "core/geometry/sphere.hpp"
#include "core/parallel/decomposition.hpp"
#include "lbm/lattice/cell_map.hpp"

#include <unordered_map>
#include <vector>

namespace thalweg::bodies {

// A cell whose cover changed in the present update; local coordinates, owned or ghost.
struct CellChange {
  Index3 cell;
  std::int32_t before, now;  // slots, or CellMap::fluid
};

class BodyMap {
public:
  BodyMap(const Decomposition& decomposition, const Block& block, lbm::CellMap& cells)
      : cells_(cells), local_cells_(decomposition, block), occluded_patches_(decomposition, block, cells) {}

  const std::vector<MappedBody>& bodies() const { return bodies_; }  // by slot; a free one has the id -1
  BodySlot slot_of(GlobalId id) const;                               // none if the body is not here

  // A new slot, covering nothing yet, for a body that has none. radius: in cells.
  BodySlot add(GlobalId id, double radius, GlobalId clump = -1);
  void remove(BodySlot slot);  // removes a sphere and gives up its cells

  // Slots 0, 1, ... for solids, before any other body; their cells are those that they claim and do not give up again.
  // Their ids are below those of all others, and rise with the slot: first those that stand still, then those that
  // move.
  void add_solids(const std::vector<bool>& moves);
  int solids() const { return solids_; }
  void claim(BodySlot slot, const Index3& local);
  void give_up(BodySlot slot, const Index3& local);

  void begin_update();  // forgets the changes of the last update
  // Moves a body: its cells are those inside its sphere at `centre`. Changes are collected until settle().
  void remap(BodySlot slot, const Vec3& centre);
  // Ends an update: returns what changed, each cell once, sorted. Valid until begin_update().
  const std::vector<CellChange>& settle();
  const std::vector<CellChange>& changes() const { return changes_; }

  // True if a body covers a cell, which is in memory or in the layer around it.
  bool covers(const Index3& local) const;

  const OccludedPatches& occluded_patches() const { return occluded_patches_; }  // those of the bodies' present cells

private:
  static constexpr double nowhere = -1e8;  // no body's centre is below this
  static constexpr int layers = 2;         // around the block

  MappedBody& body(BodySlot slot);
  // Claims or gives up the cells within `half_width` of `middle` along each axis that are inside the body at only one
  // of the two places of its centre.
  void toggle_cells(BodySlot slot, const Vec3& middle, const Vec3& half_width, const Vec3& old, const Vec3& now);
  void toggle_row(BodySlot slot, int y, int z, const Sphere::Chord& before, const Sphere::Chord& after);
  void assign(const Index3& local, std::ptrdiff_t cell, std::int32_t slot);
  void withdraw(int slot, std::ptrdiff_t cell);
  std::ptrdiff_t key_beyond(const Index3& local) const;

  lbm::CellMap& cells_;
  LocalCells local_cells_;
  OccludedPatches occluded_patches_;
  std::vector<MappedBody> bodies_;
  int solids_ = 0;
  std::vector<BodySlot> free_slots_;
  std::vector<BodySlot> just_freed_;  // in this update: their cells are still to be refilled, with their motion
  std::unordered_map<GlobalId, BodySlot> slot_of_id_;
  std::unordered_map<std::ptrdiff_t, std::vector<int>> claimants_;  // bodies that claim a cell in vain, by cell
  std::unordered_map<std::ptrdiff_t, std::vector<int>> beyond_;     // bodies that claim a cell of the second layer
  std::vector<CellChange> changes_;
  // Scratch of toggle_cells(): cells along each axis from the two centres; the cells of a row that change.
  std::vector<LocalCell> before_[3], after_[3];
  std::vector<double> x_before_, x_after_;
  std::vector<unsigned> turns_;
};

}  // namespace thalweg::bodies
