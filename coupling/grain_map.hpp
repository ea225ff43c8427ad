// Which cells each grain covers, kept up to date as grains move. A cell is solid if its centre is strictly inside a
// grain.
#pragma once

#include "core/shape.hpp"
#include "core/sphere.hpp"
#include "coupling/cell_claims.hpp"
#include "coupling/local_cells.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace thalweg::coupling {

template <Shape S = Sphere>
class GrainMap : public CellClaims {
public:
  GrainMap(const Decomposition& decomposition, const Block& block, lbm::CellMap& cells)
      : CellClaims(decomposition, block, cells), local_cells_(decomposition, block) {}

  // A new slot, covering nothing yet. shape: in cells.
  int add(GlobalId id, const S& shape, GlobalId clump = -1);
  void remove(int slot);  // gives up the grain's cells

  // Moves a grain: its cells are those inside its shape at `centre`. Changes are collected until settle().
  void place(int slot, const Vec3& centre);

  std::span<const S> shapes() const { return shapes_; }  // by slot

private:
  static constexpr double nowhere = -1e8;  // no grain's centre is below this

  // Claims or gives up the cells within `half_width` of `middle` that are inside the grain at only one of the two
  // places of its centre.
  void turn_cells(int slot, const Vec3& middle, double half_width, const Vec3& old, const Vec3& now);
  using Chord = decltype(std::declval<const S&>().chord(0.0, 0.0));
  void turn_row(int slot, int y, int z, const Chord& before, const Chord& after);

  LocalCells local_cells_;
  std::vector<S> shapes_;
  // Scratch of turn_cells: cells along each axis from the two centres; of a row, who turns.
  std::vector<LocalCell> before_[3], after_[3];
  std::vector<double> x_before_, x_after_;
  std::vector<unsigned> turns_;
};

template <Shape S>
int GrainMap<S>::add(GlobalId id, const S& shape, GlobalId clump) {
  const int slot = new_slot({id, clump, shape.reach(), Vec3::Constant(2.0 * nowhere)});
  shapes_.resize(grains().size());
  shapes_[static_cast<std::size_t>(slot)] = shape;
  return slot;
}

template <Shape S>
void GrainMap<S>::remove(int slot) {
  place(slot, Vec3::Constant(2.0 * nowhere));
  free_slot(slot);
}

template <Shape S>
void GrainMap<S>::place(int slot, const Vec3& centre) {
  const double reach = grain(slot).reach;
  const Vec3 old = grain(slot).centre;
  grain(slot).centre = centre;
  const bool was_here = old.x() > nowhere, is_here = centre.x() > nowhere;
  if (was_here && is_here && (centre - old).squaredNorm() < 1.0) {
    turn_cells(slot, centre, reach + 1.0, old, centre);
  } else {
    if (was_here) turn_cells(slot, old, reach, old, centre);
    if (is_here) turn_cells(slot, centre, reach, old, centre);
  }
}

// Only cells that are inside at one of the two places and not at the other can change hands; what the grain holds or
// claims of the others stays.
template <Shape S>
void GrainMap<S>::turn_cells(int slot, const Vec3& middle, double half_width, const Vec3& old, const Vec3& now) {
  for (int a = 0; a < 3; ++a) {
    local_cells_.along(a, middle[a], half_width, old[a], 1, before_[a]);
    local_cells_.along(a, middle[a], half_width, now[a], 1, after_[a]);
  }
  const auto offset = [](const LocalCell& place) { return place.offset; };
  x_before_.resize(before_[0].size());
  x_after_.resize(after_[0].size());
  std::transform(before_[0].begin(), before_[0].end(), x_before_.begin(), offset);
  std::transform(after_[0].begin(), after_[0].end(), x_after_.begin(), offset);
  const S& shape = shapes_[static_cast<std::size_t>(slot)];
  for (std::size_t z = 0; z < after_[2].size(); ++z)
    for (std::size_t y = 0; y < after_[1].size(); ++y) {
      const Chord before = shape.chord(before_[1][y].offset, before_[2][z].offset),
                  after = shape.chord(after_[1][y].offset, after_[2][z].offset);
      if (!before.missed() || !after.missed()) turn_row(slot, after_[1][y].local, after_[2][z].local, before, after);
    }
}

template <Shape S>
void GrainMap<S>::turn_row(int slot, int y, int z, const Chord& before, const Chord& after) {
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

}  // namespace thalweg::coupling
