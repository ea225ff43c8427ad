#include "bodies/links/solids.hpp"

#include "bodies/map/lattice_vectors.hpp"
#include "core/base/check.hpp"
#include "core/geometry/sphere.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace thalweg::bodies {

using lbm::CellMap;
using lbm::D3Q19;

namespace {

constexpr double not_met = 2.0;

Corners corners_of(const TriangleMesh& mesh, const std::array<int, 3>& triangle, const Vec3& shift) {
  return {mesh.points[triangle[0]] + shift, mesh.points[triangle[1]] + shift, mesh.points[triangle[2]] + shift};
}

Extent extent_of(const Corners& t) { return {t[0].cwiseMin(t[1]).cwiseMin(t[2]), t[0].cwiseMax(t[1]).cwiseMax(t[2])}; }

// Cells along an axis whose centres lie in [lower - margin, upper + margin], of those in [begin, end).
std::pair<int, int> range(double lower, double upper, double margin, int begin, int end) {
  const double first = std::max(std::ceil(lower - margin - 0.5), static_cast<double>(begin));
  const double last = std::min(std::floor(upper + margin - 0.5) + 1.0, static_cast<double>(end));
  return first < last ? std::pair(static_cast<int>(first), static_cast<int>(last)) : std::pair(0, 0);
}

constexpr double round_off = 1e-4;  // more than that of any crossing, cells

}  // namespace

Solids::Solids(const Decomposition& decomposition, const Block& block, const CellMap& cells, const lbm::RowTiles& tiles,
               std::vector<Solid> solids)
    : decomposition_(decomposition),
      block_(block),
      cells_(cells),
      tiles_(tiles),
      box_(decomposition.cell_box()),
      groups_(1) {
  for (int a = 0; a < 3; ++a) {
    const int all = decomposition.cells()[a], layers = 2;
    locals_[a].resize(all);
    for (int local = -layers; local < block_.size()[a] + layers; ++local) {
      const int global = block_.lower[a] + local;
      if (decomposition.periodic()[a])
        locals_[a][(global % all + all) % all].push_back(local);
      else if (global >= 0 && global < all)
        locals_[a][global].push_back(local);
    }
  }
  if (!solids.empty()) inside_.resize(cells.indexing().count());
  for (Solid& solid : solids) {
    group_of_.push_back(solid.moves ? groups_.size() : standing);
    if (solid.moves) groups_.emplace_back();
    groups_[group_of_.back()].solids.push_back(count());
    at_start_.push_back(solid.moves ? solid.shape : SolidShape());
    present_.push_back(std::move(solid.shape));
    centres_.push_back(box_.wrapped_from_afar(middle(count() - 1)));
  }
  for (Group& group : groups_) update(group);
}

Vec3 Solids::middle(int solid) const {
  const Extent extent = extent_of(present_[static_cast<std::size_t>(solid)]);
  return 0.5 * (extent.lower + extent.upper);
}

Vec3 Solids::reference_on_axis(int solid, const Vec3& point, const Vec3& axis) const {
  bool is_oblique = false;
  for (int a = 0; a < 3; ++a)
    is_oblique = is_oblique || (box_.periodic[a] && axis[a] != 0.0 && std::abs(axis[a]) != 1.0);
  return is_oblique ? Vec3(point + axis.dot(middle(solid) - point) * axis) : point;
}

void Solids::move_to(int solid, const RigidTransform& transform) {
  CHECK(solid >= 0 && solid < count() && moves(solid));
  const auto s = static_cast<std::size_t>(solid);
  move(at_start_[s], transform, present_[s]);
  centres_[s] = box_.wrapped_from_afar(transform.centre);
  update(groups_[group_of_[s]]);
}

std::vector<int> Solids::tiles(int solid) const {
  std::vector<int> tiles;
  for (const CutCell& cut : group(solid).cut) {
    const int tile = tiles_.tile_of(cut.local[1], cut.local[2]);
    if (tiles.empty() || tiles.back() != tile) tiles.push_back(tile);
  }
  return tiles;
}

// The images of something on the periodic axes that reach the box, each by its shift.
template <typename Visit>
void Solids::for_each_image(const Extent& extent, Visit visit) const {
  int first[3], last[3];
  for (int a = 0; a < 3; ++a) {
    const double n = decomposition_.cells()[a];
    const bool periodic = decomposition_.periodic()[a];
    // A cell more on both sides: a link may meet the surface beyond the end.
    first[a] = periodic ? static_cast<int>(std::ceil((-2.0 - extent.upper[a]) / n)) : 0;
    last[a] = periodic ? static_cast<int>(std::floor((n + 2.0 - extent.lower[a]) / n)) : 0;
  }
  for (int k = first[2]; k <= last[2]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i)
        visit(Vec3(i * decomposition_.cells()[0], j * decomposition_.cells()[1], k * decomposition_.cells()[2]));
}

void Solids::visit_inside(const SolidSphere& sphere, const VisitCell& visit) const {
  const Extent whole = extent_of(sphere);
  for_each_image(whole, [&](const Vec3& shift) {
    const Vec3 centre = sphere.centre + shift;
    std::pair<int, int> cells[3];
    for (int a = 0; a < 3; ++a)
      cells[a] = range(whole.lower[a] + shift[a], whole.upper[a] + shift[a], round_off, 0, decomposition_.cells()[a]);
    for (int z = cells[2].first; z < cells[2].second; ++z)
      for (int y = cells[1].first; y < cells[1].second; ++y)
        for (int x = cells[0].first; x < cells[0].second; ++x) {
          if (!Sphere{sphere.radius}.holds(centre_of({x, y, z}) - centre)) continue;
          for (const int lz : locals_[2][z])
            for (const int ly : locals_[1][y])
              for (const int lx : locals_[0][x]) visit({lx, ly, lz});
        }
  });
}

// Row by row: the line of a row's centres is inside where it has entered more often than left. Rows are those of
// coordinates inside the box, so that owned cells and their ghosts elsewhere are judged by the same arithmetic.
void Solids::visit_inside(const TriangleMesh& mesh, const VisitCell& visit) const {
  const Index3& n = decomposition_.cells();
  std::unordered_map<std::int64_t, std::vector<Crossing>> rows;
  for_each_image(extent_of(mesh), [&](const Vec3& shift) {
    for (const auto& triangle : mesh.triangles) {
      const Corners corners = corners_of(mesh, triangle, shift);
      const Extent extent = extent_of(corners);
      const auto [y_begin, y_end] = range(extent.lower[1], extent.upper[1], round_off, 0, n[1]);
      const auto [z_begin, z_end] = range(extent.lower[2], extent.upper[2], round_off, 0, n[2]);
      for (int z = z_begin; z < z_end; ++z)
        for (int y = y_begin; y < y_end; ++y) {
          if (locals_[1][y].empty() || locals_[2][z].empty()) continue;
          if (const auto hit = crossing(corners, y + 0.5, z + 0.5))
            rows[static_cast<std::int64_t>(z) * n[1] + y].push_back(*hit);
        }
    }
  });
  for (const auto& [row, hits] : rows) {
    const int y = static_cast<int>(row % n[1]), z = static_cast<int>(row / n[1]);
    const auto by_x = [](const Crossing& a, const Crossing& b) { return a.x < b.x; };
    const auto [first, last] = std::minmax_element(hits.begin(), hits.end(), by_x);
    const auto [x_begin, x_end] = range(first->x, last->x, round_off, 0, n[0]);
    for (int x = x_begin; x < x_end; ++x) {
      if (locals_[0][x].empty()) continue;
      int winding = 0;
      for (const Crossing& hit : hits) winding += hit.x < x + 0.5 ? hit.winding : 0;
      if (winding <= 0) continue;
      for (const int lz : locals_[2][z])
        for (const int ly : locals_[1][y])
          for (const int lx : locals_[0][x]) visit({lx, ly, lz});
    }
  }
}

void Solids::update(Group& group) {
  find_inside(group);
  mark_inside(group, 1);
  find_cut_cells(group);
  for (const int solid : group.solids)
    std::visit([&](const auto& shape) { measure(shape, group); }, present_[static_cast<std::size_t>(solid)]);
  mark_inside(group, 0);
}

void Solids::mark_inside(const Group& group, std::uint8_t mark) {
  for (const InsideCell& cell : group.inside)
    if (cells_.indexing().in_memory(cell.local)) inside_[static_cast<std::size_t>(index(cell.local))] = mark;
}

void Solids::find_inside(Group& group) const {
  std::vector<InsideCell>& inside = group.inside;
  inside.clear();
  for (const int solid : group.solids) {
    const auto take = [&](const Index3& local) { inside.push_back({local, solid}); };
    std::visit([&](const auto& shape) { visit_inside(shape, take); }, present_[static_cast<std::size_t>(solid)]);
  }
  std::sort(inside.begin(), inside.end());
  const auto same = [](const InsideCell& a, const InsideCell& b) { return a.local == b.local; };
  inside.erase(std::unique(inside.begin(), inside.end(), same), inside.end());
}

// Cells beside solid ones are measured whether they are fluid or covered by something else.
void Solids::find_cut_cells(Group& group) const {
  const lbm::CellIndexing& indexing = cells_.indexing();
  std::vector<Index3> beside;
  for (const InsideCell& cell : group.inside)
    for (int i = 1; i < D3Q19::directions; ++i) {
      const Index3 next{cell.local[0] + D3Q19::c[i][0], cell.local[1] + D3Q19::c[i][1], cell.local[2] + D3Q19::c[i][2]};
      if (indexing.owned(next[0], next[1], next[2]) && !is_inside(index(next))) beside.push_back(next);
    }
  std::sort(beside.begin(), beside.end(), [&](const Index3& a, const Index3& b) { return index(a) < index(b); });
  beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
  group.cut.resize(beside.size());
  for (std::size_t k = 0; k < beside.size(); ++k) {
    group.cut[k] = {index(beside[k]), beside[k], {}};
    group.cut[k].distances.fill(not_met);
  }
}

// Shortens the links of the cut cells in and around an extent to where meets(from, along) says.
template <typename Meets>
void Solids::measure_near(const Extent& extent, Group& group, Meets meets) const {
  const lbm::CellIndexing& indexing = cells_.indexing();
  std::pair<int, int> cells[3];
  for (int a = 0; a < 3; ++a)
    cells[a] = range(extent.lower[a], extent.upper[a], 1.0 + round_off, block_.lower[a], block_.upper[a]);
  for (int z = cells[2].first; z < cells[2].second; ++z)
    for (int y = cells[1].first; y < cells[1].second; ++y) {
      const std::ptrdiff_t row = indexing.index(-block_.lower[0], y - block_.lower[1], z - block_.lower[2]);
      auto cut = std::lower_bound(group.cut.begin(), group.cut.end(), row + cells[0].first,
                                  [](const CutCell& c, std::ptrdiff_t cell) { return c.cell < cell; });
      for (; cut != group.cut.end() && cut->cell < row + cells[0].second; ++cut)
        for (int i = 1; i < D3Q19::directions; ++i) {
          if (!is_inside(cut->cell + indexing.offset(i))) continue;
          const std::optional<double> way = meets(centre_of({static_cast<int>(cut->cell - row), y, z}), velocity_of(i));
          double& distance = cut->distances[static_cast<std::size_t>(i)];
          if (way) distance = std::min(distance, *way);
        }
    }
}

void Solids::measure(const SolidSphere& sphere, Group& group) const {
  const Extent whole = extent_of(sphere);
  for_each_image(whole, [&](const Vec3& shift) {
    const SolidSphere image{sphere.centre + shift, sphere.radius};
    measure_near({whole.lower + shift, whole.upper + shift}, group,
                 [&](const Vec3& from, const Vec3& along) { return meets(image, from, along); });
  });
}

void Solids::measure(const TriangleMesh& mesh, Group& group) const {
  for_each_image(extent_of(mesh), [&](const Vec3& shift) {
    for (const auto& triangle : mesh.triangles) {
      const Corners corners = corners_of(mesh, triangle, shift);
      measure_near(extent_of(corners), group,
                   [&](const Vec3& from, const Vec3& along) { return meets(corners, from, along); });
    }
  });
}

// The fraction of a link up to the group's surfaces; more than 1: it meets none.
double Solids::distance(const Group& group, std::ptrdiff_t cell, int direction) {
  const auto cut = std::lower_bound(group.cut.begin(), group.cut.end(), cell,
                                    [](const CutCell& c, std::ptrdiff_t wanted) { return c.cell < wanted; });
  return cut == group.cut.end() || cut->cell != cell ? not_met : cut->distances[static_cast<std::size_t>(direction)];
}

std::vector<std::pair<int, int>> Solids::shortened_by(int moving_solid) const {
  CHECK(moves(moving_solid));
  std::vector<std::pair<int, int>> found;
  for (const CutCell& cut : group(moving_solid).cut)
    for (int i = 1; i < D3Q19::directions; ++i) {
      const std::int32_t body = cells_.body(cut.cell + cells_.indexing().offset(i));
      if (cut.distances[static_cast<std::size_t>(i)] > 1.0 || body < 0 || body >= count() || moves(body)) continue;
      const std::pair<int, int> place(body, tiles_.tile_of(cut.local[1], cut.local[2]));
      if (found.empty() || found.back() != place) found.push_back(place);
    }
  return found;
}

void Solids::find_links(int solid, int tile, const EnclosedCells& enclosed, std::vector<Link>& links,
                        std::vector<LinkCrossing>& crossings) const {
  const std::vector<CutCell>& all = group(solid).cut;
  const int block = tiles_.block_of(tile), z = tiles_.plane_of(tile);
  const auto before = [](const CutCell& c, std::ptrdiff_t cell) { return c.cell < cell; };
  const auto first = std::lower_bound(all.begin(), all.end(), index({0, tiles_.first_row(block), z}), before);
  const auto end = std::lower_bound(first, all.end(), index({0, tiles_.end_row(block), z}), before);
  for (auto cut = first; cut != end; ++cut) {
    const Index3& at = cut->local;
    if (!cells_.is_fluid(cut->cell)) continue;
    const Vec3 from = centre_of({block_.lower[0] + at[0], block_.lower[1] + at[1], block_.lower[2] + at[2]});
    const bool is_enclosed = enclosed.contains(at);
    for (int i = 1; i < D3Q19::directions; ++i) {
      if (cells_.body(cut->cell + cells_.indexing().offset(i)) != solid) continue;
      // A link can only miss a surface that touches its end, by round-off.
      double way = std::min(cut->distances[static_cast<std::size_t>(i)], 1.0);
      for (const Group& other : groups_)
        if (&other != &group(solid)) way = std::min(way, distance(other, cut->cell, i));
      const Vec3 arm = box_.difference(from + way * velocity_of(i), centre(solid));
      const std::int32_t upstream = cells_.body(cut->cell - cells_.indexing().offset(i));
      links.push_back({LinkXY::of(at[0], at[1]), LinkTag::of(i, upstream, is_enclosed)});
      crossings.push_back({static_cast<float>(way),
                           {static_cast<float>(arm[0]), static_cast<float>(arm[1]), static_cast<float>(arm[2])}});
    }
  }
}

}  // namespace thalweg::bodies
