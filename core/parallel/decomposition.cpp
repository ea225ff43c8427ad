#include "core/parallel/decomposition.hpp"

#include "core/base/check.hpp"
#include "core/base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace thalweg {

namespace {

bool fits(const Index3& cells, const Index3& layout, const Index3& least) {
  for (int a = 0; a < 3; ++a)
    if (layout[a] > 1 && cells[a] / layout[a] < least[a]) return false;
  return true;
}

// Cells on the faces between blocks. A cut in z counts many times over because it separates bed from water; one in x
// because every value on its faces lies on a cache line of its own, while the faces of the others are whole rows.
double cost_of(const Index3& cells, const Index3& layout) {
  constexpr double vertical_cut_penalty = 32.0, split_row_penalty = 4.0;
  const double nx = cells[0], ny = cells[1], nz = cells[2];
  return split_row_penalty * (layout[0] - 1) * ny * nz + (layout[1] - 1) * nx * nz +
         vertical_cut_penalty * (layout[2] - 1) * nx * ny;
}

}  // namespace

Index3 Decomposition::best_layout(const Index3& cells, int ranks, const Index3& least) {
  Index3 best{0, 0, 0};
  double best_cost = std::numeric_limits<double>::infinity();
  for (int px = 1; px <= ranks; ++px) {
    if (ranks % px != 0) continue;
    for (int py = 1; py <= ranks / px; ++py) {
      if ((ranks / px) % py != 0) continue;
      const Index3 layout{px, py, ranks / px / py};
      if (!fits(cells, layout, least)) continue;
      const double cost = cost_of(cells, layout);
      if (cost < best_cost) {
        best_cost = cost;
        best = layout;
      }
    }
  }
  if (best[0] == 0)
    throw InputError(
        fmt::format("{} x {} x {} cells cannot be shared by {} ranks with at least {}, {} and {} cells a rank along "
                    "x, y and z where it is cut; use fewer ranks or a larger domain.",
                    cells[0], cells[1], cells[2], ranks, least[0], least[1], least[2]));
  return best;
}

Block intersection(Block a, const Block& b) {
  for (int axis = 0; axis < 3; ++axis) {
    a.lower[axis] = std::max(a.lower[axis], b.lower[axis]);
    a.upper[axis] = std::max(a.lower[axis], std::min(a.upper[axis], b.upper[axis]));
  }
  return a;
}

Decomposition::Decomposition(const Index3& cells, double spacing, const std::array<bool, 3>& periodic,
                             const Index3& layout, const Index3& least)
    : cells_(cells), spacing_(spacing), periodic_(periodic), layout_(layout), least_(least) {
  for (int a = 0; a < 3; ++a) CHECK(least[a] >= min_cells_per_rank);
  if (!(spacing > 0.0) || *std::min_element(cells.begin(), cells.end()) < 1)
    throw InputError(fmt::format("A box of {} x {} x {} cells of {} m has no volume; give at least one cell an axis.",
                                 cells[0], cells[1], cells[2], spacing));
  if (!fits(cells, layout, least))
    throw InputError(fmt::format(
        "Layout {},{},{} of {} x {} x {} cells leaves some rank too few along a cut axis: it needs {} along "
        "x, {} along y and {} along z; use fewer ranks there.",
        layout[0], layout[1], layout[2], cells[0], cells[1], cells[2], least[0], least[1], least[2]));
  for (int a = 0; a < 3; ++a)
    for (int slab = 0; slab <= layout[a]; ++slab)
      cuts_[a].push_back(static_cast<int>(static_cast<std::int64_t>(cells[a]) * slab / layout[a]));
}

Decomposition Decomposition::balanced(const std::array<std::vector<std::int64_t>, 3>& weights) const {
  for (std::size_t a = 0; a < 3; ++a) CHECK(weights[a].size() == static_cast<std::size_t>(cells_[static_cast<int>(a)]));
  Decomposition result = *this;
  for (int a = 0; a < 3; ++a) {
    const int slabs = layout_[a];
    std::vector<int>& cuts = result.cuts_[a];
    std::int64_t total = 0, sum = 0;
    for (const std::int64_t weight : weights[a]) total += weight;
    // Bits to drop so that products with the number of slabs fit.
    const int spare = std::max(0, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(total))) - 40);
    std::vector<std::int64_t> of_plane = weights[a];
    total = 0;
    for (std::int64_t& weight : of_plane) total += weight >>= spare;
    for (int slab = 1, k = 0; slab < slabs; ++slab) {
      // Before the cell that reaches the share, or behind it, whichever is nearer.
      while (k < cells_[a] && (sum + of_plane[k]) * slabs <= total * slab) sum += of_plane[k++];
      const bool behind = k < cells_[a] && (2 * sum + of_plane[k]) * slabs < 2 * total * slab;
      cuts[slab] = behind ? k + 1 : k;
    }
    for (int slab = 1; slab < slabs; ++slab) cuts[slab] = std::max(cuts[slab], cuts[slab - 1] + least_[a]);
    for (int slab = slabs - 1; slab > 0; --slab) cuts[slab] = std::min(cuts[slab], cuts[slab + 1] - least_[a]);
  }
  return result;
}

PeriodicBox Decomposition::box() const {
  return {Vec3(cells_[0] * spacing_, cells_[1] * spacing_, cells_[2] * spacing_), periodic_};
}

PeriodicBox Decomposition::cell_box() const { return {Vec3(cells_[0], cells_[1], cells_[2]), periodic_}; }

Index3 Decomposition::coordinates_of(int rank) const {
  CHECK(rank >= 0 && rank < ranks());
  return {rank % layout_[0], rank / layout_[0] % layout_[1], rank / (layout_[0] * layout_[1])};
}

int Decomposition::rank_at(const Index3& coordinates) const {
  Index3 c = coordinates;
  for (int a = 0; a < 3; ++a) {
    if (c[a] >= 0 && c[a] < layout_[a]) continue;
    if (!periodic_[a]) return -1;
    c[a] = (c[a] % layout_[a] + layout_[a]) % layout_[a];
  }
  return (c[2] * layout_[1] + c[1]) * layout_[0] + c[0];
}

Block Decomposition::block_of(int rank) const {
  const Index3 c = coordinates_of(rank);
  Block block;
  for (int a = 0; a < 3; ++a) {
    block.lower[a] = cuts_[a][c[a]];
    block.upper[a] = cuts_[a][c[a] + 1];
  }
  return block;
}

int Decomposition::owner_of(const Vec3& position) const {
  Index3 c;
  for (int a = 0; a < 3; ++a) {
    c[a] = 0;
    while (c[a] + 1 < layout_[a] && position[a] >= cuts_[a][c[a] + 1] * spacing_) ++c[a];
  }
  return rank_at(c);
}

bool Decomposition::slab_reaches(int axis, int slab, double x, double distance) const {
  const int first = cuts_[axis][slab], end = cuts_[axis][slab + 1];
  const double lower = first * spacing_ - distance, upper = end * spacing_ + distance;
  const double length = cells_[axis] * spacing_;
  if (x >= lower && x <= upper) return true;
  if (periodic_[axis])
    return (x - length >= lower && x - length <= upper) || (x + length >= lower && x + length <= upper);
  // Beyond an outer wall the outermost block still answers for the position.
  return (x < lower && first == 0) || (x > upper && end == cells_[axis]);
}

bool Decomposition::reaches(int rank, const Vec3& position, double distance) const {
  const Index3 c = coordinates_of(rank);
  for (int a = 0; a < 3; ++a)
    if (!slab_reaches(a, c[a], position[a], distance)) return false;
  return true;
}

std::vector<int> Decomposition::ranks_reached(const Vec3& position, double distance) const {
  std::array<std::vector<int>, 3> slabs;
  for (int a = 0; a < 3; ++a)
    for (int slab = 0; slab < layout_[a]; ++slab)
      if (slab_reaches(a, slab, position[a], distance)) slabs[a].push_back(slab);
  std::vector<int> ranks;
  for (const int k : slabs[2])
    for (const int j : slabs[1])
      for (const int i : slabs[0]) ranks.push_back(rank_at({i, j, k}));
  return ranks;
}

}  // namespace thalweg
