// Solids that stand still in the fluid: which cells are inside them, and where lattice links meet their surfaces.
//
// A cell is solid if its centre is inside a solid. On an axis that is periodic a solid that reaches beyond one end
// comes in again at the other. A link runs from a fluid cell to a solid neighbour; its distance is that to the first
// surface it meets. What is thinner than a cell may be missed. Cells and distances are the same on any ranks. Lattice
// units.
#pragma once

#include "bodies/link_table.hpp"
#include "bodies/solid_shape.hpp"
#include "core/decomposition.hpp"
#include "core/periodic_box.hpp"
#include "lbm/cell_map.hpp"
#include "lbm/row_tiles.hpp"

#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace thalweg::bodies {

class StaticSolids {
public:
  // All of these must outlive it.
  StaticSolids(const Decomposition& decomposition, const Block& block, const lbm::CellMap& cells,
               const lbm::RowTiles& tiles, std::vector<SolidShape> shapes);

  int count() const { return static_cast<int>(shapes_.size()); }
  Vec3 centre(int solid) const;  // the middle of its extent

  // Calls claim(solid, cell) for every cell in memory (local coordinates, owned or ghost) that is inside a solid, solid
  // by solid.
  void visit_cells(const std::function<void(int solid, const Index3& local)>& claim);

  // To be called once the solids have their cells in the map, in the slots 0, 1, ... in their order: finds where links
  // from the cells beside them meet the surfaces.
  void measure();

  // The links of a solid in a tile and where they meet it, from the cells that are fluid now.
  void find_links(int solid, int tile, std::vector<Link>& links, std::vector<LinkCrossing>& crossings) const;

private:
  using Distances = std::array<double, lbm::D3Q19::directions>;  // of the links of a cell; 2: not met yet
  struct CutCell {
    Index3 local;
    Distances distances;
  };

  void visit_inside(int solid, const SolidSphere& sphere, const std::function<void(int, const Index3&)>& claim);
  void visit_inside(int solid, const TriangleMesh& mesh, const std::function<void(int, const Index3&)>& claim);
  void measure(const SolidSphere& sphere);
  void measure(const TriangleMesh& mesh);
  bool is_solid(std::ptrdiff_t cell) const { return cells_.body(cell) >= 0 && cells_.body(cell) < count(); }
  template <typename Visit>
  void for_each_image(const Extent& extent, Visit visit) const;
  template <typename Meets>
  void measure_near(const Extent& extent, Meets meets);

  const Decomposition& decomposition_;
  Block block_;
  const lbm::CellMap& cells_;
  const lbm::RowTiles& tiles_;
  PeriodicBox box_;  // cells
  std::vector<SolidShape> shapes_;
  // Where the cells of a coordinate inside the box are in memory, along each axis: owned, and ghosts of periodic axes.
  std::array<std::vector<std::vector<int>>, 3> places_;
  std::vector<std::vector<CutCell>> cut_;  // by tile, in memory order: owned cells beside solid ones
  std::unordered_map<std::ptrdiff_t, Distances*> distances_of_;  // the same cells; empty once measured
};

}  // namespace thalweg::bodies
