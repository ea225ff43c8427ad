#include "bodies/links/link_builder.hpp"

#include <algorithm>
#include <bit>

namespace thalweg::bodies {

using lbm::CellMap;
using lbm::D3Q19;

namespace {

constexpr double longest_link = 1.4142135623730951;

}  // namespace

LinkBuilder::LinkBuilder(const Decomposition& decomposition, const Block& block, const CellMap& cells,
                         const lbm::RowTiles& tiles, const Solids* solids)
    : local_cells_(decomposition, block), cells_(cells), tiles_(tiles), solids_(solids), enclosed_(cells) {}

void LinkBuilder::update(const BodyMap& map, LinkTable& table) {
  stale_tiles_.resize(map.bodies().size());
  for (const CellChange& change : map.changes()) mark_around(change);
  for (const Index3& cell : enclosed_.update(map)) mark_links_of(cell);
  if (solids_) mark_shortened();
  std::sort(stale_.begin(), stale_.end());
  for (const int slot : stale_) {
    if (map.bodies()[slot].is_free())
      table.remove(slot);
    else if (!solids_ || slot >= solids_->count())
      rebuild(slot, map.bodies()[slot], table);
    else if (!solids_->moves(slot))
      rebuild_solid(slot, stale_tiles_[slot], table);
    stale_tiles_[slot].clear();
  }
  stale_.clear();
  for (int solid = 0; solids_ && solid < solids_->count(); ++solid) {
    if (!solids_->moves(solid)) continue;
    table.remove(solid);
    rebuild_solid(solid, solids_->tiles(solid), table);
  }
}

void LinkBuilder::mark(std::int32_t slot, int tile) {
  std::vector<int>& tiles = stale_tiles_[slot];
  if (std::find(tiles.rbegin(), tiles.rend(), tile) != tiles.rend()) return;
  if (tiles.empty()) stale_.push_back(slot);
  tiles.push_back(tile);
}

// A link is identified by its fluid cell, its solid cell and the cell upstream, and a changed cell may be any of them.
// The neighbours may have changed in the same update, so what they are now does not matter.
void LinkBuilder::mark_around(const CellChange& change) {
  const lbm::CellIndexing& indexing = cells_.indexing();
  const Index3& at = change.cell;
  const std::ptrdiff_t cell = indexing.index(at[0], at[1], at[2]);
  const bool owned = indexing.owned(at[0], at[1], at[2]);
  for (int i = 1; i < D3Q19::directions; ++i) {
    const Index3 next{at[0] + D3Q19::c[i][0], at[1] + D3Q19::c[i][1], at[2] + D3Q19::c[i][2]};
    if (!indexing.in_memory(next)) continue;
    const std::int32_t beside = cells_.body(cell + indexing.offset(i));
    if (owned && beside != CellMap::fluid) mark(beside, tiles_.tile_of(at[1], at[2]));
    if (!indexing.owned(next[0], next[1], next[2])) continue;
    const int tile = tiles_.tile_of(next[1], next[2]);
    if (change.before != CellMap::fluid) mark(change.before, tile);
    if (change.now != CellMap::fluid) mark(change.now, tile);
    const std::int32_t beyond = cells_.body(cell + 2 * indexing.offset(i));
    if (beyond != CellMap::fluid) mark(beyond, tile);
  }
}

// The tags of all links of a cell say whether it is enclosed, so they all change with that.
void LinkBuilder::mark_links_of(const Index3& at) {
  const lbm::CellIndexing& indexing = cells_.indexing();
  const std::ptrdiff_t cell = indexing.index(at[0], at[1], at[2]);
  for (int i = 1; i < D3Q19::directions; ++i) {
    const std::int32_t body = cells_.body(cell + indexing.offset(i));
    if (body != CellMap::fluid) mark(body, tiles_.tile_of(at[1], at[2]));
  }
}

// Where a solid that moves enters one that stands still, it shortens links of the latter, although no cell changes
// hands.
void LinkBuilder::mark_shortened() {
  for (const auto& [solid, tile] : shortened_) mark(solid, tile);
  shortened_.clear();
  for (int solid = 0; solid < solids_->count(); ++solid) {
    if (!solids_->moves(solid)) continue;
    for (const auto& [standing, tile] : solids_->shortened_by(solid)) {
      mark(standing, tile);
      shortened_.emplace_back(standing, tile);
    }
  }
}

void LinkBuilder::rebuild_solid(int slot, const std::vector<int>& tiles, LinkTable& table) {
  for (const int tile : tiles) {
    links_.clear();
    crossings_.clear();
    solids_->find_links(slot, tile, enclosed_, links_, crossings_);
    table.replace(slot, tile, links_, crossings_);
  }
}

void LinkBuilder::rebuild(int slot, const MappedBody& sphere, LinkTable& table) {
  const double half_width = sphere.radius + longest_link;
  std::vector<LocalCell>* cells_along[2] = {&xs_, &ys_};
  const auto before = [](const LocalCell& p, const LocalCell& q) { return p.local < q.local; };
  const auto same = [](const LocalCell& p, const LocalCell& q) { return p.local == q.local; };
  for (int a = 0; a < 2; ++a) {
    std::vector<LocalCell>& cells = *cells_along[a];
    local_cells_.along(a, sphere.centre[a], half_width, sphere.centre[a], 0, cells);
    std::sort(cells.begin(), cells.end(), before);
    cells.erase(std::unique(cells.begin(), cells.end(), same), cells.end());
  }
  for (const int tile : stale_tiles_[slot]) {
    const int z = tiles_.plane_of(tile), block = tiles_.block_of(tile);
    links_.clear();
    for (const LocalCell& y : ys_)
      if (y.local >= tiles_.first_row(block) && y.local < tiles_.end_row(block)) find_in_row(slot, y.local, z);
    table.replace(slot, tile, links_);
  }
}

// The map alone determines where links are: all neighbours of as many cells as a vector holds are compared with the
// grain at once.
void LinkBuilder::find_in_row(int slot, int y, int z) {
  constexpr int width = static_cast<int>(Cells::size());
  for (std::size_t begin = 0; begin < xs_.size();) {
    std::size_t end = begin + 1;  // of a run of neighbouring cells
    while (end < xs_.size() && xs_[end].local == xs_[end - 1].local + 1) ++end;
    const int last = xs_[end - 1].local;
    for (int x = xs_[begin].local; x <= last; x += width) find_in_cells(slot, x, std::min(width, last + 1 - x), y, z);
    begin = end;
  }
}

// Finds the links of `count` cells from x on, at most one vector.
void LinkBuilder::find_in_cells(int slot, int x, int count, int y, int z) {
  constexpr auto unaligned = std::experimental::element_aligned;
  static_assert(Cells::size() <= CellMap::read_beyond);
  const lbm::CellIndexing& indexing = cells_.indexing();
  const std::int32_t* row = cells_.bodies() + indexing.index(x, y, z);
  Cells hits = 0;  // the directions that end in the grain, as bits
  for (int i = 1; i < D3Q19::directions; i += 2) {
    const Cells there(row + indexing.offset(i), unaligned), behind(row - indexing.offset(i), unaligned);
    where(there == slot, hits) = hits | (1 << i);
    where(behind == slot, hits) = hits | (2 << i);
  }
  where(Cells(row, unaligned) != CellMap::fluid, hits) = 0;
  if (none_of(hits != 0)) return;
  std::int32_t hit[Cells::size()];
  hits.copy_to(hit, unaligned);
  for (int k = 0; k < count; ++k) {
    const std::uint32_t xy = LinkXY::of(x + k, y);
    if (hit[k] == 0) continue;
    const bool enclosed = enclosed_.contains({x + k, y, z});
    for (auto left = static_cast<std::uint32_t>(hit[k]); left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      links_.push_back({xy, LinkTag::of(i, row[k - indexing.offset(i)], enclosed)});
    }
  }
}

}  // namespace thalweg::bodies
