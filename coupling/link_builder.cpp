#include "coupling/link_builder.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::coupling {

using lbm::D3Q19;

namespace {

constexpr double longest_link = 1.4142135623730951;

}  // namespace

void LinkBuilder::build(int slot, const MappedGrain& grain, lbm::LinkTable& table, lbm::LinkBody& body) {
  const double reach = grain.radius + longest_link;
  links_.clear();
  tile_of_.clear();
  body.centre = grain.centre;

  local_cells_.along(0, grain.centre.x(), reach, grain.centre.x(), 0, xs_);
  local_cells_.along(1, grain.centre.y(), reach, grain.centre.y(), 0, ys_);
  local_cells_.along(2, grain.centre.z(), reach, grain.centre.z(), 0, zs_);
  const auto by_place = [](const LocalCell& p, const LocalCell& q) { return p.local < q.local; };
  std::sort(ys_.begin(), ys_.end(), by_place);
  std::sort(zs_.begin(), zs_.end(), by_place);
  // In the order of the tiles: block of rows, plane, row.
  for (std::size_t block = 0; block < ys_.size();) {
    std::size_t end = block;
    while (end < ys_.size() && tiles_.tile_of(ys_[end].local, 0) == tiles_.tile_of(ys_[block].local, 0)) ++end;
    for (const LocalCell& z : zs_)
      for (std::size_t y = block; y < end; ++y) add_links_of_row(slot, grain, ys_[y], z);
    block = end;
  }
  table.replace(slot, links_, tile_of_);
}

void LinkBuilder::add_links_of_row(int slot, const MappedGrain& grain, const LocalCell& y, const LocalCell& z) {
  const double reach = grain.radius + longest_link, from_axis = y.offset * y.offset + z.offset * z.offset;
  if (from_axis >= reach * reach) return;
  for (const LocalCell& x : xs_) {
    const double squared = x.offset * x.offset + from_axis;
    if (squared >= grain.radius * grain.radius && squared < reach * reach) add_links_of_cell(slot, grain, x, y, z);
  }
}

void LinkBuilder::add_links_of_cell(int slot, const MappedGrain& grain, const LocalCell& x, const LocalCell& y,
                                    const LocalCell& z) {
  const lbm::CellIndexing& indexing = cells_.indexing();
  const std::ptrdiff_t cell = indexing.index(x.local, y.local, z.local);
  if (!cells_.is_fluid(cell)) return;
  const double distance_squared = x.offset * x.offset + y.offset * y.offset + z.offset * z.offset;
  const double q = distance_squared - grain.radius * grain.radius;
  for (int i = 1; i < D3Q19::directions; ++i) {
    if (cells_.body(cell + indexing.offset(i)) != slot) continue;
    const double a = D3Q19::length_squared(i);
    const double b = D3Q19::c[i][0] * x.offset + D3Q19::c[i][1] * y.offset + D3Q19::c[i][2] * z.offset;
    const double discriminant = b * b - a * q;
    // In a box hardly wider than the grain the solid cell may belong to its other periodic image, met elsewhere.
    if (b >= 0.0 || discriminant < 0.0) continue;
    const double delta = (-b - std::sqrt(discriminant)) / a;
    if (delta > 1.0 + 1e-9) continue;
    lbm::Link link;
    link.cell = static_cast<std::uint32_t>(cell);
    link.direction = i;
    link.upstream_body = cells_.body(cell - indexing.offset(i));
    link.distance = static_cast<float>(std::clamp(delta, 0.0, 1.0));
    link.arm =
        Vec3(x.offset + delta * D3Q19::c[i][0], y.offset + delta * D3Q19::c[i][1], z.offset + delta * D3Q19::c[i][2]);
    links_.push_back(link);
    tile_of_.push_back(tiles_.tile_of(y.local, z.local));
  }
}

}  // namespace thalweg::coupling
