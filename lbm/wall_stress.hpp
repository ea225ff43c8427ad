// The stress that a law of the wall takes from the fluid at one face of the domain, cell by cell:
//   T = rho u_tau^2 u/|u|,
// where u is the velocity along the wall in the second cell from it, one and a half cells away (in the first, half a
// cell away, where the second is solid or there is none), rho the density of that cell, and u_tau what
// friction_velocity() makes of |u| and the distance. Lattice units.
//
// The second cell: in the first the profile is steeper than the lattice resolves, and its velocity belongs to the
// lattice, not to the flow (Kawai and Larsson 2012). In a sublayer that the lattice does resolve, T is that of no slip.
//
// Along an axis in which a body or another face is beside the cell there is no T: one of the two populations that would
// carry it bounces back whole, and T from the other alone would change the mass.
#pragma once

#include "lbm/cell_map.hpp"
#include "lbm/populations.hpp"

#include <array>
#include <vector>

namespace thalweg::lbm {

template <typename Real>
class WallStress {
public:
  // present: at which faces of the box this rank's block ends; `face` is one of them. viscosity: of the fluid alone.
  WallStress(const CellIndexing& indexing, int face, const std::array<bool, 6>& present, double viscosity);

  // Finds the stress of the coming exchange from the populations after the last collision, which it leaves alone.
  // half_force: of that collision.
  void find(const Populations<Real>& populations, const CellMap& cells, const Vec3& half_force);

  // Along the first or the second axis of the face (axis 0 or 1), at the cells of a row of the face.
  const Real* row(int axis, int v) const { return stress_[axis].data() + static_cast<std::size_t>(v) * nu_; }

private:
  // Of the cells of a row: rho, and rho u along the two axes of the face.
  struct Moments {
    std::vector<Real> density, along[2];
  };

  void find_row(const Populations<Real>& populations, const CellMap& cells, const Vec3& half_force, int v);
  void take_moments(const Populations<Real>& populations, std::ptrdiff_t first, const Vec3& half_force,
                    Moments& moments) const;
  std::array<double, 2> stress_of(const Moments& moments, int u, double distance) const;
  bool has_both_neighbours(const CellMap& cells, std::ptrdiff_t cell, int axis, int along) const;

  CellIndexing indexing_;
  int face_, u_axis_, v_axis_, nu_, nv_;
  std::array<bool, 6> present_;
  double viscosity_;
  std::array<std::vector<Real>, 2> stress_;  // at the cells of the face, along its two axes
  Moments at_wall_, second_;                 // of one row
};

}  // namespace thalweg::lbm
