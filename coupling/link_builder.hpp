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

  // Asks the memory for what build() will read of the cells around a grain.
  void ask_for(const MappedGrain& grain);

private:
  // A link on its way: its cell, direction and tile, c_i.c_i, and of d = x_f - centre the vector, b = c_i.d and q.
  struct Candidates {
    std::vector<std::uint32_t> cell;
    std::vector<int> direction, tile;
    std::vector<double> d[3], a, b, q, distance;

    void clear();
    void resize_distance() { distance.resize(cell.size()); }
    std::size_t size() const { return cell.size(); }
  };

  void find_in_row(int slot, const MappedGrain& grain, const LocalCell& y, const LocalCell& z);
  void find_at_cell(int slot, const LocalCell& x, const LocalCell& y, const LocalCell& z, double q);
  void measure_distances();
  void hand_over(int slot, lbm::LinkTable& table);

  LocalCells local_cells_;
  const lbm::CellMap& cells_;
  const lbm::RowTiles& tiles_;
  std::vector<LocalCell> xs_, ys_, zs_;  // scratch from here on
  Candidates found_;
  std::vector<lbm::Link> links_;
  std::vector<int> tile_of_;
};

}  // namespace thalweg::coupling
