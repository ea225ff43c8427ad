// The stress that a law of the wall takes from the fluid at one face of the domain, cell by cell:
//   T = rho u_tau^2 u/|u|,
// where u is the velocity along the wall in the second cell from it, one and a half cells away (in the first, half a
// cell away, where the second is solid or there is none), rho the density of that cell, and u_tau what the law makes of
// |u| and the distance (StressRatio). Lattice units.
//
// The second cell: in the first the profile is steeper than the lattice resolves, and its velocity belongs to the
// lattice, not to the flow (Kawai and Larsson 2012). In a sublayer that the lattice does resolve, T is that of no slip.
//
// What a step takes is the mean of T in the last two collisions. The lattice has momenta of its own that change sign
// from cell to cell along the wall and from step to step, and that neither collisions nor walls damp (Zanetti 1989): T
// of the step before would always push them on, and quiet water would break down.
//
// Along an axis in which a body or another face is beside the cell there is no T: one of the two populations that would
// carry it bounces back whole, and T from the other alone would change the mass.
#pragma once

#include "lbm/cell_map.hpp"
#include "lbm/law_of_the_wall.hpp"
#include "lbm/populations.hpp"
#include "lbm/sweep.hpp"

#include <array>
#include <span>
#include <vector>

namespace thalweg::lbm {

template <typename Real>
class WallStress {
public:
  // present: at which faces of the box this rank's block ends; `face` is one of them. viscosity: of the fluid alone.
  WallStress(const CellIndexing& indexing, int face, const std::array<bool, 6>& present, double viscosity);

  // Whether a row has first or second cells of this face.
  bool wants(int y, int z) const;
  // Takes the stress from such a row, just swept. half_force: of that collision.
  void take_row(int y, int z, const RowMoments<Real>& moments, const CellMap& cells, const Vec3& half_force);

  // Takes it from populations that no sweep has left. half_force: of the last collision.
  void take_populations(const Populations<Real>& populations, const CellMap& cells, const Vec3& half_force);
  // Finds the stress of the coming exchange from what has been taken.
  void find(const CellMap& cells);

  // Of the coming exchange, along the first or the second axis of the face (axis 0 or 1), at the cells of a row of it.
  const Real* row(int axis, int v) const { return stress_[axis].data() + static_cast<std::size_t>(v) * nu_; }

  // The state between two steps, row by row: T along the two axes of the face in the last collision, then in the one
  // before.
  static constexpr int arrays = 4;
  std::span<Real> state(int n) { return state_[n]; }
  std::span<const Real> state(int n) const { return state_[n]; }

private:
  void find_resistance(int x, int end, bool second, const RowMoments<Real>& moments, const Vec3& half_force);
  void take(std::size_t place, double along_u, double along_v);
  void take_cells(int x, int end, bool second, std::ptrdiff_t at_wall, std::size_t place,
                  const RowMoments<Real>& moments, const CellMap& cells, const Vec3& half_force);
  bool second_is_fluid(const CellMap& cells, std::ptrdiff_t at_wall) const;
  bool has_both_neighbours(const CellMap& cells, std::ptrdiff_t cell, int axis, int along) const;
  std::ptrdiff_t cell_at_wall(int u, int v) const;
  std::size_t place(int u, int v) const { return static_cast<std::size_t>(v) * nu_ + u; }

  CellIndexing indexing_;
  int face_, normal_, u_axis_, v_axis_, nu_, nv_, depth_;
  std::ptrdiff_t inward_;
  std::array<bool, 6> present_;
  double viscosity_;
  std::array<std::vector<Real>, arrays> state_;  // at the cells of the face
  std::array<std::vector<Real>, 2> stress_;
  std::vector<double> resistance_;  // of a row
};

}  // namespace thalweg::lbm
