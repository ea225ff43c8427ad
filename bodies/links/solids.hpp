// Solids in the fluid, which stand still or move as they are told: which cells are inside them, and where lattice links
// meet their surfaces.
//
// A cell is solid if its centre is inside a solid. On an axis that is periodic a solid that reaches beyond one end
// comes in again at the other. A link runs from a fluid cell to a solid neighbour; its distance is that to the first
// surface it meets. What is thinner than a cell may be missed. Cells and distances are the same on any ranks. Lattice
// units.
#pragma once

#include "bodies/map/enclosed_cells.hpp"
#include "bodies/map/link_table.hpp"
#include "bodies/map/solid_shape.hpp"
#include "core/geometry/periodic_box.hpp"
#include "core/parallel/decomposition.hpp"
#include "lbm/lattice/cell_map.hpp"
#include "lbm/lattice/row_tiles.hpp"

#include <functional>
#include <utility>
#include <vector>

namespace thalweg::bodies {

// A solid as it is given.
struct Solid {
  SolidShape shape;  // where it is at the start
  bool moves = false;
};

// A cell of the block or the two layers around it whose centre is inside solids, and the first of them. In memory
// order, and one cell in the order of solids.
struct InsideCell {
  Index3 local;
  int solid;

  bool operator<(const InsideCell& other) const {
    for (int a = 2; a >= 0; --a)
      if (local[a] != other.local[a]) return local[a] < other.local[a];
    return solid < other.solid;
  }
};

class Solids {
public:
  // All of these must outlive it.
  Solids(const Decomposition& decomposition, const Block& block, const lbm::CellMap& cells, const lbm::RowTiles& tiles,
         std::vector<Solid> solids);

  int count() const { return static_cast<int>(present_.size()); }
  bool moves(int solid) const { return group_of_[static_cast<std::size_t>(solid)] != standing; }
  // Reference point of arms and motion: the middle of the extent of a solid at rest, the centre of the transform of a
  // moving one, or its image inside the box, from which arms are taken to the nearest image however far it travels.
  const Vec3& centre(int solid) const { return centres_[static_cast<std::size_t>(solid)]; }

  // Middle of its extent, where it is given or has moved to, not brought into the box.
  Vec3 middle(int solid) const;
  // A point of the axis through a point from which arms to the solid can be taken to the nearest image: this one, or
  // where the axis is oblique to one that is periodic the one nearest to the middle. axis: unit.
  Vec3 reference_on_axis(int solid, const Vec3& point, const Vec3& axis) const;

  // Moves a solid that moves, with its cells and distances, to a place.
  void move_to(int solid, const RigidTransform& transform);

  // Calls claim(cell) for every cell inside the solids at the start: once where several that stand still have it, and
  // again for each that moves. Those of solids that stand still are then forgotten.
  template <typename Claim>
  void hand_over(Claim claim) {
    for (const Group& group : groups_)
      for (const InsideCell& cell : group.inside) claim(cell);
    groups_[standing].inside = {};
  }
  // The cells of a solid that moves, each once, in memory order.
  const std::vector<InsideCell>& inside(int solid) const { return group(solid).inside; }
  // The tiles with cells beside a solid that moves, each once.
  std::vector<int> tiles(int solid) const;

  // The solids that stand still and have links which a solid that moves shortens at its present place, each with the
  // tile of these links, as (solid, tile), in no order, once or more.
  std::vector<std::pair<int, int>> shortened_by(int moving_solid) const;

  // The links of a solid in a tile and where they meet it or another solid before, from the cells that are fluid now.
  void find_links(int solid, int tile, const EnclosedCells& enclosed, std::vector<Link>& links,
                  std::vector<LinkCrossing>& crossings) const;

private:
  static constexpr std::size_t standing = 0;                     // the group of all solids that stand still
  using Distances = std::array<double, lbm::D3Q19::directions>;  // of the links of a cell; 2: not met
  struct CutCell {                                               // an owned cell outside, beside one inside
    std::ptrdiff_t cell;
    Index3 local;
    Distances distances;
  };
  // Solids whose cells and links are found together: all that stand still, or one that moves.
  struct Group {
    std::vector<int> solids;
    std::vector<InsideCell> inside;  // each once, in memory order
    std::vector<CutCell> cut;        // in memory order
  };

  const Group& group(int solid) const { return groups_[group_of_[static_cast<std::size_t>(solid)]]; }
  std::ptrdiff_t index(const Index3& local) const { return cells_.indexing().index(local[0], local[1], local[2]); }
  bool is_inside(std::ptrdiff_t cell) const { return inside_[static_cast<std::size_t>(cell)] != 0; }  // scratch

  using VisitCell = std::function<void(const Index3& local)>;
  void visit_inside(const SolidSphere& sphere, const VisitCell& visit) const;
  void visit_inside(const TriangleMesh& mesh, const VisitCell& visit) const;
  void update(Group& group);
  void mark_inside(const Group& group, std::uint8_t mark);
  void find_inside(Group& group) const;
  void find_cut_cells(Group& group) const;
  void measure(const SolidSphere& sphere, Group& group) const;
  void measure(const TriangleMesh& mesh, Group& group) const;
  template <typename Visit>
  void for_each_image(const Extent& extent, Visit visit) const;
  template <typename Meets>
  void measure_near(const Extent& extent, Group& group, Meets meets) const;
  static double distance(const Group& group, std::ptrdiff_t cell, int direction);

  const Decomposition& decomposition_;
  Block block_;
  const lbm::CellMap& cells_;
  const lbm::RowTiles& tiles_;
  PeriodicBox box_;                   // cells
  std::vector<SolidShape> at_start_;  // shapes of those that move
  std::vector<SolidShape> present_;
  std::vector<Vec3> centres_;
  std::vector<Group> groups_;
  std::vector<std::size_t> group_of_;
  // Local coordinates of each coordinate inside the box, along each axis: owned, and in the layers of periodic axes.
  std::array<std::vector<std::vector<int>>, 3> locals_;
  std::vector<std::uint8_t> inside_;  // scratch: of every cell in memory, whether it is inside the group at hand
};

}  // namespace thalweg::bodies
