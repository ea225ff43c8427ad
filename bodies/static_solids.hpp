// Solids that stand still in the fluid: the cells they cover, their cut links, and the force on each.
//
// A cell is solid if its centre is inside a solid; where solids overlap, the first one has it. On an axis that is
// periodic a solid that reaches beyond one end comes in again at the other. A link runs from a fluid cell to a solid
// neighbour; its distance is that to the first surface it meets. What is thinner than a cell may be missed.
// Cells, distances and forces are the same on any ranks.
#pragma once

#include "bodies/link_table.hpp"
#include "bodies/solid_shape.hpp"
#include "core/archive.hpp"
#include "core/decomposition.hpp"
#include "lbm/cell_map.hpp"
#include "lbm/row_tiles.hpp"

#include <mpi.h>

#include <unordered_map>
#include <vector>

namespace thalweg::bodies {

class StaticSolids {
public:
  // Marks the cells in the map with the number of their solid. Throws InputError where a solid covers no cell.
  // Collective.
  StaticSolids(const Decomposition& decomposition, MPI_Comm communicator, lbm::CellMap& cells,
               const lbm::RowTiles& tiles, const std::vector<SolidShape>& shapes);

  int count() const { return static_cast<int>(bodies_.size()); }
  const LinkTable& links() const { return links_; }

  // What the links of a step work on: begin_step() forgets the sums of the last one.
  std::vector<LinkBody>& begin_step();
  const std::vector<LinkBody>& bodies() const { return bodies_; }

  // The force of the last step on each solid (lattice units), over all ranks. Collective.
  std::vector<Vec3> forces() const;

  void save(ArchiveWriter& archive) const;
  // Throws InputError where the archive does not hold as many solids.
  void load(ArchiveReader& archive);

private:
  using Distances = std::array<double, lbm::D3Q19::directions>;  // of the links of a fluid cell; 2: not met yet

  struct SolidLinks {  // of one solid in one tile
    std::vector<Link> links;
    std::vector<LinkCrossing> crossings;
  };

  void cover(int solid, const SolidSphere& sphere);
  void cover(int solid, const TriangleMesh& mesh);
  void claim(int solid, const Index3& local);
  void find_cut_cells();
  void measure(const SolidSphere& sphere);
  void measure(const TriangleMesh& mesh);
  void build_links(const lbm::RowTiles& tiles);
  void add_links_of_cell(const Index3& local, std::vector<SolidLinks>& links) const;
  template <typename Visit>
  void for_each_image(const Extent& extent, Visit visit) const;
  template <typename Meets>
  void measure_near(const Extent& extent, Meets meets);
  std::vector<std::int64_t> summed() const;

  const Decomposition& decomposition_;
  MPI_Comm communicator_;
  Block block_;
  lbm::CellMap& cells_;
  // Where the cells of a coordinate inside the box are in memory, along each axis: owned, and ghosts of periodic axes.
  std::array<std::vector<std::vector<int>>, 3> places_;
  std::unordered_map<std::ptrdiff_t, Distances> cut_;  // of owned fluid cells beside solid ones
  LinkTable links_;
  std::vector<LinkBody> bodies_;
  std::vector<std::int64_t> covered_;  // owned cells of each
  std::vector<std::int64_t> loaded_;   // force sums of the checkpoint until a step is done
};

}  // namespace thalweg::bodies
