// The stress that a law of the wall takes from the fluid at one face of the domain, cell by cell:
//   T = rho u_tau^2 u/|u|,
// where u is the velocity along the wall in the fifth cell from it, four and a half cells away, rho the density of that
// cell, and u_tau what the law makes of |u| and the distance (StressRatio). Where a body covers one of these cells, it
// is the last one before the body; in a box of less than nine cells the last one before the middle. Where this cell
// lies in the viscous sublayer, the lattice resolves it, and T is that of no slip, 2 nu rho u of the first cell.
// Lattice units.
//
// The fifth cell: the eddies of the first few are as large as their distance from the wall, which the lattice does not
// resolve, so that their velocity belongs to the lattice and not to the flow. With cells of a fifth of the distance it
// does (Kawai and Larsson 2012).
//
// What a step takes is the mean of T in the last two collisions. The lattice has momenta of its own that change sign
// from cell to cell along the wall and from step to step, and that neither collisions nor walls damp (Zanetti 1989): T
// of the step before would always push them on, and quiet water would break down.
//
// Along an axis in which a body or another face is beside the cell there is no T: one of the two populations that would
// carry it bounces back whole, and T from the other alone would change the mass.
#pragma once

#include "lbm/collision/sweep.hpp"
#include "lbm/lattice/cell_map.hpp"
#include "lbm/lattice/populations.hpp"
#include "lbm/walls/law_of_the_wall.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::lbm {

template <typename Real>
class WallStress {
public:
  // The cells from the wall to the one whose velocity counts, that one included.
  static constexpr int layers = 5;

  // present: at which faces of the box this rank's block ends; `face` is one of them. cells_across: of the box, from
  // this face to the other. viscosity: of the fluid alone.
  WallStress(const CellIndexing& indexing, int face, const std::array<bool, 6>& present, int cells_across,
             double viscosity);

  // Finds the cells whose velocities count: before what follows, and again where the map has changed.
  void find_layers(const CellMap& cells);

  // True if a row has such cells.
  bool wants(int y, int z) const;
  // Takes the velocities of such a row, just swept. half_force: of that collision.
  void take_row(int y, int z, const RowMoments<Real>& moments, const CellMap& cells, const Vec3& half_force);

  // All rows have been swept.
  void end_sweep();

  // Takes the velocities, and the stress of the last two collisions, from populations that no sweep has left.
  // half_force: of the last collision.
  void take_populations(const Populations<Real>& populations, const CellMap& cells, const Vec3& half_force);
  // Finds the stress of the coming exchange from what has been taken.
  void find(const CellMap& cells);

  // Stress of the coming exchange along the first or second axis of the face (axis 0 or 1), at the cells of a row of
  // it.
  const Real* row(int axis, int v) const { return stress_[axis].data() + static_cast<std::size_t>(v) * nu_; }

  // The state between two steps, row by row: T along the two axes of the face in the last collision, then in the one
  // before.
  static constexpr int arrays = 4;
  std::span<Real> state(int n) { return state_[n]; }
  std::span<const Real> state(int n) const { return state_[n]; }

private:
  // Cells of one layer, from x to the end in a row of moments, with the first one's place on the face; the others
  // follow it.
  struct Piece {
    int layer, x, end;
    std::size_t place;
  };

  void take_first(const Piece& piece, const RowMoments<Real>& moments, const CellMap& cells, const Vec3& half_force);
  void take_far(const Piece& piece, const RowMoments<Real>& moments, const Vec3& half_force);
  void find_reynolds(const Piece& piece, const RowMoments<Real>& moments, const Vec3& half_force);
  bool has_layer(int layer, int v) const { return layers_in_row_[static_cast<std::size_t>(layer) * nv_ + v] != 0; }
  int from_face(int at) const { return face_ % 2 == 0 ? at : depth_ - 1 - at; }
  bool has_both_neighbours(const CellMap& cells, std::ptrdiff_t cell, int axis, int along) const;
  std::ptrdiff_t cell_at_wall(int u, int v) const;
  std::size_t place(int u, int v) const { return static_cast<std::size_t>(v) * nu_ + u; }

  CellIndexing indexing_;
  int face_, normal_, u_axis_, v_axis_, nu_, nv_, depth_, farthest_;
  std::ptrdiff_t inward_;
  std::array<bool, 6> present_;
  double viscosity_;
  std::array<std::vector<Real>, arrays> state_;  // at the cells of the face
  std::array<std::vector<Real>, 2> stress_;
  std::array<std::vector<Real>, 2> no_slip_, law_;  // T of the last rows by the first cell, and by the far one
  std::vector<char> in_sublayer_;                   // true where the far cell is in the viscous sublayer
  std::vector<std::int32_t> layer_;  // at the cells of the face: of the cell whose velocity counts, from 0
  std::vector<char> layers_in_row_;  // true if a row of layer_ has a layer: all rows for layer 0, then for 1, ...
  std::vector<double> reynolds_;     // of a row
};

}  // namespace thalweg::lbm
