#include "bodies/static_solids.hpp"

#include "bodies/lattice_vectors.hpp"
#include "core/sphere.hpp"
#include "lbm/for_each_cell.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::bodies {

using lbm::CellMap;
using lbm::D3Q19;

namespace {

constexpr double not_met = 2.0;

Corners corners_of(const TriangleMesh& mesh, const std::array<int, 3>& triangle, const Vec3& shift) {
  return {mesh.points[triangle[0]] + shift, mesh.points[triangle[1]] + shift, mesh.points[triangle[2]] + shift};
}

Extent extent_of(const Corners& t) { return {t[0].cwiseMin(t[1]).cwiseMin(t[2]), t[0].cwiseMax(t[1]).cwiseMax(t[2])}; }

// Cells along an axis whose centres lie in [lower, upper], widened and cut to [begin, end).
std::pair<int, int> range(double lower, double upper, int widened, int begin, int end) {
  const double first = std::max(std::ceil(lower - 0.5) - widened, static_cast<double>(begin));
  const double last = std::min(std::floor(upper - 0.5) + widened + 1.0, static_cast<double>(end));
  return first < last ? std::pair(static_cast<int>(first), static_cast<int>(last)) : std::pair(0, 0);
}

}  // namespace

StaticSolids::StaticSolids(const Decomposition& decomposition, const Block& block, const CellMap& cells,
                           const lbm::RowTiles& tiles, std::vector<SolidShape> shapes)
    : decomposition_(decomposition),
      block_(block),
      cells_(cells),
      tiles_(tiles),
      box_(decomposition.cell_box()),
      shapes_(std::move(shapes)),
      cut_(static_cast<std::size_t>(tiles.count())) {
  for (int a = 0; a < 3; ++a) {
    const int all = decomposition.cells()[a], ghosts = 1;
    places_[a].resize(all);
    for (int local = -ghosts; local < block_.size()[a] + ghosts; ++local) {
      const int global = block_.lower[a] + local;
      if (decomposition.periodic()[a])
        places_[a][(global % all + all) % all].push_back(local);
      else if (global >= 0 && global < all)
        places_[a][global].push_back(local);
    }
  }
}

Vec3 StaticSolids::centre(int solid) const {
  const Extent extent = extent_of(shapes_[static_cast<std::size_t>(solid)]);
  return 0.5 * (extent.lower + extent.upper);
}

void StaticSolids::visit_cells(const std::function<void(int, const Index3&)>& claim) {
  for (int s = 0; s < count(); ++s)
    std::visit([&](const auto& shape) { visit_inside(s, shape, claim); }, shapes_[static_cast<std::size_t>(s)]);
}

// The images of something on the periodic axes that reach the box, each by its shift.
template <typename Visit>
void StaticSolids::for_each_image(const Extent& extent, Visit visit) const {
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

void StaticSolids::visit_inside(int solid, const SolidSphere& sphere,
                                const std::function<void(int, const Index3&)>& claim) {
  const Extent whole = extent_of(sphere);
  for_each_image(whole, [&](const Vec3& shift) {
    const Vec3 centre = sphere.centre + shift;
    std::pair<int, int> cells[3];
    for (int a = 0; a < 3; ++a)
      cells[a] = range(whole.lower[a] + shift[a], whole.upper[a] + shift[a], 1, 0, decomposition_.cells()[a]);
    for (int z = cells[2].first; z < cells[2].second; ++z)
      for (int y = cells[1].first; y < cells[1].second; ++y)
        for (int x = cells[0].first; x < cells[0].second; ++x) {
          if (!Sphere{sphere.radius}.holds(centre_of({x, y, z}) - centre)) continue;
          for (const int lz : places_[2][z])
            for (const int ly : places_[1][y])
              for (const int lx : places_[0][x]) claim(solid, {lx, ly, lz});
        }
  });
}

// Row by row: the line of a row's centres is inside where it has entered more often than left. Rows are those of
// coordinates inside the box, so that owned cells and their ghosts elsewhere are judged by the same arithmetic.
void StaticSolids::visit_inside(int solid, const TriangleMesh& mesh,
                                const std::function<void(int, const Index3&)>& claim) {
  const Index3& n = decomposition_.cells();
  std::unordered_map<std::int64_t, std::vector<Crossing>> rows;
  for_each_image(extent_of(mesh), [&](const Vec3& shift) {
    for (const auto& triangle : mesh.triangles) {
      const Corners corners = corners_of(mesh, triangle, shift);
      const Extent extent = extent_of(corners);
      const auto [y_begin, y_end] = range(extent.lower[1], extent.upper[1], 1, 0, n[1]);
      const auto [z_begin, z_end] = range(extent.lower[2], extent.upper[2], 1, 0, n[2]);
      for (int z = z_begin; z < z_end; ++z)
        for (int y = y_begin; y < y_end; ++y) {
          if (places_[1][y].empty() || places_[2][z].empty()) continue;
          if (const auto hit = crossing(corners, y + 0.5, z + 0.5))
            rows[static_cast<std::int64_t>(z) * n[1] + y].push_back(*hit);
        }
    }
  });
  for (const auto& [row, hits] : rows) {
    const int y = static_cast<int>(row % n[1]), z = static_cast<int>(row / n[1]);
    for (int x = 0; x < n[0]; ++x) {
      if (places_[0][x].empty()) continue;
      int winding = 0;
      for (const Crossing& hit : hits) winding += hit.x < x + 0.5 ? hit.winding : 0;
      if (winding <= 0) continue;
      for (const int lz : places_[2][z])
        for (const int ly : places_[1][y])
          for (const int lx : places_[0][x]) claim(solid, {lx, ly, lz});
    }
  }
}

// Cells beside solid ones are measured whether they are fluid or covered by something that moves.
void StaticSolids::measure() {
  lbm::for_each_cell(cells_.indexing(), [&](std::ptrdiff_t cell, const Index3& local) {
    if (is_solid(cell)) return;
    for (int i = 1; i < D3Q19::directions; ++i)
      if (is_solid(cell + cells_.indexing().offset(i))) {
        CutCell& cut = cut_[static_cast<std::size_t>(tiles_.tile_of(local[1], local[2]))].emplace_back();
        cut.local = local;
        cut.distances.fill(not_met);
        break;
      }
  });
  for (std::vector<CutCell>& tile : cut_)
    for (CutCell& cut : tile)
      distances_of_[cells_.indexing().index(cut.local[0], cut.local[1], cut.local[2])] = &cut.distances;
  for (const SolidShape& any : shapes_) std::visit([&](const auto& shape) { measure(shape); }, any);
  distances_of_.clear();
}

// Shortens the links of the cut cells in and around an extent to where meets(from, along) says.
template <typename Meets>
void StaticSolids::measure_near(const Extent& extent, Meets meets) {
  std::pair<int, int> cells[3];
  for (int a = 0; a < 3; ++a) cells[a] = range(extent.lower[a], extent.upper[a], 2, block_.lower[a], block_.upper[a]);
  for (int z = cells[2].first; z < cells[2].second; ++z)
    for (int y = cells[1].first; y < cells[1].second; ++y)
      for (int x = cells[0].first; x < cells[0].second; ++x) {
        const std::ptrdiff_t cell =
            cells_.indexing().index(x - block_.lower[0], y - block_.lower[1], z - block_.lower[2]);
        const auto found = distances_of_.find(cell);
        if (found == distances_of_.end()) continue;
        for (int i = 1; i < D3Q19::directions; ++i) {
          if (!is_solid(cell + cells_.indexing().offset(i))) continue;
          const std::optional<double> way = meets(centre_of({x, y, z}), velocity_of(i));
          double& distance = (*found->second)[static_cast<std::size_t>(i)];
          if (way) distance = std::min(distance, *way);
        }
      }
}

void StaticSolids::measure(const SolidSphere& sphere) {
  const Extent whole = extent_of(sphere);
  for_each_image(whole, [&](const Vec3& shift) {
    const SolidSphere image{sphere.centre + shift, sphere.radius};
    measure_near({whole.lower + shift, whole.upper + shift},
                 [&](const Vec3& from, const Vec3& along) { return meets(image, from, along); });
  });
}

void StaticSolids::measure(const TriangleMesh& mesh) {
  for_each_image(extent_of(mesh), [&](const Vec3& shift) {
    for (const auto& triangle : mesh.triangles) {
      const Corners corners = corners_of(mesh, triangle, shift);
      measure_near(extent_of(corners),
                   [&](const Vec3& from, const Vec3& along) { return meets(corners, from, along); });
    }
  });
}

void StaticSolids::find_links(int solid, int tile, std::vector<Link>& links,
                              std::vector<LinkCrossing>& crossings) const {
  const Vec3 middle = centre(solid);
  for (const CutCell& cut : cut_[static_cast<std::size_t>(tile)]) {
    const Index3& at = cut.local;
    const std::ptrdiff_t cell = cells_.indexing().index(at[0], at[1], at[2]);
    if (!cells_.is_fluid(cell)) continue;
    const Vec3 place = centre_of({block_.lower[0] + at[0], block_.lower[1] + at[1], block_.lower[2] + at[2]});
    const bool enclosed = cells_.is_enclosed(at);
    for (int i = 1; i < D3Q19::directions; ++i) {
      if (cells_.body(cell + cells_.indexing().offset(i)) != solid) continue;
      // A link can only miss a surface that touches its end, by round-off.
      const double distance = std::min(cut.distances[static_cast<std::size_t>(i)], 1.0);
      const Vec3 arm = box_.difference(place + distance * velocity_of(i), middle);
      const std::int32_t upstream = cells_.body(cell - cells_.indexing().offset(i));
      links.push_back({LinkPlace::of(at[0], at[1]), LinkTag::of(i, upstream, enclosed)});
      crossings.push_back({static_cast<float>(distance),
                           {static_cast<float>(arm[0]), static_cast<float>(arm[1]), static_cast<float>(arm[2])}});
    }
  }
}

}  // namespace thalweg::bodies
