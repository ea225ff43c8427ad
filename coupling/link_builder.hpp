// Builds the cut links of one grain: every lattice line from an owned fluid cell into a cell the grain covers, with the
// exact distance to the sphere. With d = x_f - centre, a = c_i.c_i, b = c_i.d, q = d.d - R^2:
//   delta = [-b - sqrt(b^2 - a q)] / a,  in [0, 1], a fraction of the link.
#pragma once

#include "coupling/grain_map.hpp"
#include "coupling/local_cells.hpp"
#include "lbm/cell_map.hpp"
#include "lbm/link_table.hpp"
#include "lbm/row_tiles.hpp"

#include <vector>

namespace thalweg::coupling {

class LinkBuilder {
public:
  LinkBuilder(const Decomposition& decomposition, const Block& block, const lbm::CellMap& cells,
              const lbm::RowTiles& tiles)
      : local_cells_(decomposition, block), cells_(cells), tiles_(tiles) {}

  // Replaces the grain's links in the table and sets the centre of its body.
  void build(int slot, const MappedGrain& grain, lbm::LinkTable& table, lbm::LinkBody& body);

private:
  void add_links_of_row(int slot, const MappedGrain& grain, const LocalCell& y, const LocalCell& z);
  void add_links_of_cell(int slot, const MappedGrain& grain, const LocalCell& x, const LocalCell& y,
                         const LocalCell& z);

  LocalCells local_cells_;
  const lbm::CellMap& cells_;
  const lbm::RowTiles& tiles_;
  std::vector<LocalCell> xs_, ys_, zs_;  // scratch
  std::vector<lbm::Link> links_;
  std::vector<int> tile_of_;
};

}  // namespace thalweg::coupling
