// Which cells each grain covers, kept up to date as grains move. A cell is solid if its centre is strictly inside a
// grain.
#pragma once

#include "core/sphere.hpp"
#include "coupling/cell_claims.hpp"
#include "coupling/local_cells.hpp"

#include <vector>

namespace thalweg::coupling {

class GrainMap : public CellClaims {
public:
  GrainMap(const Decomposition& decomposition, const Block& block, lbm::CellMap& cells)
      : CellClaims(decomposition, block, cells), local_cells_(decomposition, block) {}

  // A new slot, covering nothing yet. radius: in cells.
  int add(GlobalId id, double radius, GlobalId clump = -1);
  void remove(int slot);  // gives up the grain's cells

  // Moves a grain: its cells are those inside its shape at `centre`. Changes are collected until settle().
  void place(int slot, const Vec3& centre);

private:
  static constexpr double nowhere = -1e8;  // no grain's centre is below this

  // Claims or gives up the cells within `half_width` of `middle` that are inside the grain at only one of the two
  // places of its centre.
  void turn_cells(int slot, const Vec3& middle, double half_width, const Vec3& old, const Vec3& now);
  void turn_row(int slot, int y, int z, const Sphere::Chord& before, const Sphere::Chord& after);

  LocalCells local_cells_;
  // Scratch of turn_cells: cells along each axis from the two centres; of a row, who turns.
  std::vector<LocalCell> before_[3], after_[3];
  std::vector<double> x_before_, x_after_;
  std::vector<unsigned> turns_;
};

}  // namespace thalweg::coupling
