#include "coupling/link_builder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace thalweg::coupling {

using lbm::D3Q19;

namespace {

constexpr double longest_link = 1.4142135623730951;

// The directions of the lattice in whole vectors, the last ones going nowhere.
struct Directions {
  static constexpr int padded = 24;
  double c[3][padded] = {}, length_squared[padded] = {};

  constexpr Directions() {
    for (int i = 0; i < padded; ++i) {
      length_squared[i] = 1e30;
      if (i == 0 || i >= D3Q19::directions) continue;
      for (int a = 0; a < 3; ++a) c[a][i] = D3Q19::c[i][a];
      length_squared[i] = D3Q19::length_squared(i);
    }
  }
};
constexpr Directions directions;

}  // namespace

void LinkBuilder::Candidates::clear() {
  cell.clear();
  direction.clear();
  tile.clear();
  for (std::vector<double>* numbers : {&d[0], &d[1], &d[2], &a, &b, &q}) numbers->clear();
}

void LinkBuilder::build(int slot, const MappedGrain& grain, lbm::LinkTable& table, lbm::LinkBody& body) {
  const double reach = grain.radius + longest_link;
  body.centre = grain.centre;
  local_cells_.along(0, grain.centre.x(), reach, grain.centre.x(), 0, xs_);
  local_cells_.along(1, grain.centre.y(), reach, grain.centre.y(), 0, ys_);
  local_cells_.along(2, grain.centre.z(), reach, grain.centre.z(), 0, zs_);
  const auto by_place = [](const LocalCell& p, const LocalCell& q) { return p.local < q.local; };
  std::sort(ys_.begin(), ys_.end(), by_place);
  std::sort(zs_.begin(), zs_.end(), by_place);
  found_.clear();
  // In the order of the tiles: block of rows, plane, row.
  for (std::size_t block = 0; block < ys_.size();) {
    std::size_t end = block;
    while (end < ys_.size() && tiles_.tile_of(ys_[end].local, 0) == tiles_.tile_of(ys_[block].local, 0)) ++end;
    for (const LocalCell& z : zs_)
      for (std::size_t y = block; y < end; ++y) find_in_row(slot, grain, ys_[y], z);
    block = end;
  }
  measure_distances();
  hand_over(slot, table);
}

void LinkBuilder::ask_for(const MappedGrain& grain) {
  const double reach = grain.radius + longest_link;
  std::vector<LocalCell>* places[3] = {&xs_, &ys_, &zs_};
  for (int a = 0; a < 3; ++a) {
    local_cells_.along(a, grain.centre[a], reach, grain.centre[a], 0, *places[a]);
    if (places[a]->empty()) return;
  }
  const std::int32_t* bodies = cells_.bodies();
  for (const LocalCell& z : zs_)
    for (const LocalCell& y : ys_) {
      const std::ptrdiff_t row = cells_.indexing().index(0, y.local, z.local);
      __builtin_prefetch(bodies + row + xs_.front().local);
      __builtin_prefetch(bodies + row + xs_.back().local);
    }
}

void LinkBuilder::find_in_row(int slot, const MappedGrain& grain, const LocalCell& y, const LocalCell& z) {
  const double reach = grain.radius + longest_link, from_axis = y.offset * y.offset + z.offset * z.offset;
  if (from_axis >= reach * reach) return;
  for (const LocalCell& x : xs_) {
    const double squared = x.offset * x.offset + from_axis, q = squared - grain.radius * grain.radius;
    if (q >= 0.0 && squared < reach * reach) find_at_cell(slot, x, y, z, q);
  }
}

void LinkBuilder::find_at_cell(int slot, const LocalCell& x, const LocalCell& y, const LocalCell& z, double q) {
  const lbm::CellIndexing& indexing = cells_.indexing();
  const std::ptrdiff_t cell = indexing.index(x.local, y.local, z.local);
  if (!cells_.is_fluid(cell)) return;
  // The neighbour along i is inside the grain if q + 2 b + a < 0; in doubt the map is asked, which is right to the bit.
  constexpr double doubt = 1e-6;
  alignas(64) double b[Directions::padded];
  std::uint32_t inside = 0;
  for (int i = 0; i < Directions::padded; ++i)
    b[i] = directions.c[0][i] * x.offset + directions.c[1][i] * y.offset + directions.c[2][i] * z.offset;
  for (int i = 0; i < Directions::padded; ++i)
    inside |= static_cast<std::uint32_t>(q + 2.0 * b[i] + directions.length_squared[i] < doubt) << i;
  for (; inside != 0; inside &= inside - 1) {
    const int i = std::countr_zero(inside);
    // In a box hardly wider than the grain the solid cell may belong to its other periodic image, met elsewhere.
    if (cells_.body(cell + indexing.offset(i)) != slot || b[i] >= 0.0) continue;
    found_.cell.push_back(static_cast<std::uint32_t>(cell));
    found_.direction.push_back(i);
    found_.tile.push_back(tiles_.tile_of(y.local, z.local));
    found_.d[0].push_back(x.offset);
    found_.d[1].push_back(y.offset);
    found_.d[2].push_back(z.offset);
    found_.a.push_back(directions.length_squared[i]);
    found_.b.push_back(b[i]);
    found_.q.push_back(q);
  }
}

void LinkBuilder::measure_distances() {
  found_.resize_distance();
  const double *a = found_.a.data(), *b = found_.b.data(), *q = found_.q.data();
  double* distance = found_.distance.data();
  const std::size_t n = found_.size();
  for (std::size_t k = 0; k < n; ++k) {
    const double discriminant = b[k] * b[k] - a[k] * q[k];
    distance[k] = (-b[k] - std::sqrt(std::max(discriminant, 0.0))) / a[k];
  }
}

void LinkBuilder::hand_over(int slot, lbm::LinkTable& table) {
  const lbm::CellIndexing& indexing = cells_.indexing();
  links_.clear();
  tile_of_.clear();
  for (std::size_t k = 0; k < found_.size(); ++k) {
    const double delta = found_.distance[k];
    if (delta > 1.0 + 1e-9) continue;  // the far image again
    const int i = found_.direction[k];
    lbm::Link link;
    link.cell = found_.cell[k];
    link.direction = i;
    link.upstream_body = cells_.body(static_cast<std::ptrdiff_t>(link.cell) - indexing.offset(i));
    link.distance = static_cast<float>(std::clamp(delta, 0.0, 1.0));
    for (int axis = 0; axis < 3; ++axis) link.arm[axis] = found_.d[axis][k] + delta * D3Q19::c[i][axis];
    links_.push_back(link);
    tile_of_.push_back(found_.tile[k]);
  }
  table.replace(slot, links_, tile_of_);
}

}  // namespace thalweg::coupling
