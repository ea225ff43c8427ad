// Keeps the cut links of all bodies: every lattice line from an owned fluid cell into a cell that a body covers. Those
// of spheres and of solids that stand still depend on the map of the cells alone, so only those around cells that
// changed hands are found anew: the links of a body in one tile at a time. Those of solids that move are all found
// anew, and so are those of solids that stand still where one that moves shortens them or did so before.
#pragma once

#include "bodies/links/solids.hpp"
#include "bodies/map/body_map.hpp"
#include "bodies/map/enclosed_cells.hpp"
#include "bodies/map/link_table.hpp"
#include "bodies/map/local_cells.hpp"
#include "lbm/lattice/cell_map.hpp"
#include "lbm/lattice/row_tiles.hpp"

#include <cstddef>
#include <cstdint>
#include <experimental/simd>
#include <utility>
#include <vector>

namespace thalweg::bodies {

class LinkBuilder {
public:
  // solids: those in the slots 0, 1, ...; null: none.
  LinkBuilder(const Decomposition& decomposition, const Block& block, const lbm::CellMap& cells,
              const lbm::RowTiles& tiles, const Solids* solids = nullptr);

  // Brings the table up to date with the map's changes since the last call.
  void update(const BodyMap& map, LinkTable& table);

private:
  using Cells = std::experimental::native_simd<std::int32_t>;

  void mark_around(const CellChange& change);
  void mark_links_of(const Index3& cell);
  void mark_shortened();
  void mark(std::int32_t slot, int tile);
  void rebuild(int slot, const MappedBody& sphere, LinkTable& table);
  void rebuild_solid(int slot, const std::vector<int>& tiles, LinkTable& table);
  void find_in_row(int slot, int y, int z);
  void find_in_cells(int slot, int x, int count, int y, int z);

  LocalCells local_cells_;
  const lbm::CellMap& cells_;
  const lbm::RowTiles& tiles_;
  const Solids* solids_;  // null: none
  EnclosedCells enclosed_;
  std::vector<std::vector<int>> stale_tiles_;   // of each slot
  std::vector<int> stale_;                      // slots that have any
  std::vector<std::pair<int, int>> shortened_;  // what Solids::shortened_by() said in the last update
  std::vector<LocalCell> xs_, ys_;              // scratch from here on
  std::vector<Link> links_;
  std::vector<LinkCrossing> crossings_;
};

}  // namespace thalweg::bodies
