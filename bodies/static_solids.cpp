#include "bodies/static_solids.hpp"

#include "bodies/lattice_vectors.hpp"
#include "core/error.hpp"
#include "core/mpi_session.hpp"
#include "core/sphere.hpp"
#include "core/wide_sums_over_ranks.hpp"
#include "lbm/for_each_cell.hpp"

#include <fmt/format.h>

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

StaticSolids::StaticSolids(const Decomposition& decomposition, MPI_Comm communicator, CellMap& cells,
                           const lbm::RowTiles& tiles, const std::vector<SolidShape>& shapes)
    : decomposition_(decomposition),
      communicator_(communicator),
      block_(decomposition.block_of(rank_of(communicator))),
      cells_(cells),
      links_(tiles.count()),
      bodies_(shapes.size()),
      covered_(shapes.size(), 0) {
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
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    const Extent extent = bodies::extent_of(shapes[s]);
    bodies_[s].turns = false;
    bodies_[s].centre = 0.5 * (extent.lower + extent.upper);
    std::visit([&](const auto& shape) { cover(static_cast<int>(s), shape); }, shapes[s]);
  }
  for (std::size_t s = 0; s < shapes.size(); ++s)
    if (sum_over_ranks(communicator, covered_[s]) == 0)
      throw InputError(
          fmt::format("solids.{} covers no cell: it lies outside the box, inside another solid, or between "
                      "the centres of the cells; check its place and its size in m.",
                      s));
  find_cut_cells();
  for (const SolidShape& any : shapes) std::visit([&](const auto& shape) { measure(shape); }, any);
  build_links(tiles);
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

void StaticSolids::claim(int solid, const Index3& local) {
  if (!cells_.is_fluid(cells_.indexing().index(local[0], local[1], local[2]))) return;
  cells_.assign(local[0], local[1], local[2], solid);
  if (cells_.indexing().owned(local[0], local[1], local[2])) ++covered_[static_cast<std::size_t>(solid)];
}

void StaticSolids::cover(int solid, const SolidSphere& sphere) {
  const Extent whole = bodies::extent_of(sphere);
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
void StaticSolids::cover(int solid, const TriangleMesh& mesh) {
  const Index3& n = decomposition_.cells();
  std::unordered_map<std::int64_t, std::vector<Crossing>> rows;
  for_each_image(bodies::extent_of(mesh), [&](const Vec3& shift) {
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

void StaticSolids::find_cut_cells() {
  lbm::for_each_fluid_cell(cells_, [&](std::ptrdiff_t cell, const Index3&) {
    for (int i = 1; i < D3Q19::directions; ++i)
      if (!cells_.is_fluid(cell + cells_.indexing().offset(i))) {
        cut_[cell].fill(not_met);
        break;
      }
  });
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
        const auto found = cut_.find(cell);
        if (found == cut_.end()) continue;
        for (int i = 1; i < D3Q19::directions; ++i) {
          if (cells_.is_fluid(cell + cells_.indexing().offset(i))) continue;
          const std::optional<double> way = meets(centre_of({x, y, z}), velocity_of(i));
          if (way) found->second[i] = std::min(found->second[i], *way);
        }
      }
}

void StaticSolids::measure(const SolidSphere& sphere) {
  const Extent whole = bodies::extent_of(sphere);
  for_each_image(whole, [&](const Vec3& shift) {
    const SolidSphere image{sphere.centre + shift, sphere.radius};
    measure_near({whole.lower + shift, whole.upper + shift},
                 [&](const Vec3& from, const Vec3& along) { return meets(image, from, along); });
  });
}

void StaticSolids::measure(const TriangleMesh& mesh) {
  for_each_image(bodies::extent_of(mesh), [&](const Vec3& shift) {
    for (const auto& triangle : mesh.triangles) {
      const Corners corners = corners_of(mesh, triangle, shift);
      measure_near(extent_of(corners),
                   [&](const Vec3& from, const Vec3& along) { return meets(corners, from, along); });
    }
  });
}

void StaticSolids::add_links_of_cell(const Index3& local, std::vector<SolidLinks>& links) const {
  const PeriodicBox box{Vec3(decomposition_.cells()[0], decomposition_.cells()[1], decomposition_.cells()[2]),
                        decomposition_.periodic()};
  const std::ptrdiff_t cell = cells_.indexing().index(local[0], local[1], local[2]);
  const auto found = cut_.find(cell);
  if (found == cut_.end()) return;
  const Vec3 centre = centre_of({block_.lower[0] + local[0], block_.lower[1] + local[1], block_.lower[2] + local[2]});
  const bool enclosed = cells_.is_enclosed(cell);
  for (int i = 1; i < D3Q19::directions; ++i) {
    const std::int32_t solid = cells_.body(cell + cells_.indexing().offset(i));
    if (solid == CellMap::fluid) continue;
    // A link can only miss a surface that touches its end, by round-off.
    const double distance = std::min(found->second[i], 1.0);
    const Vec3 arm = box.difference(centre + distance * velocity_of(i), bodies_[solid].centre);
    const std::int32_t upstream = cells_.body(cell - cells_.indexing().offset(i));
    links[solid].links.push_back({LinkPlace::of(local[0], local[1]), LinkTag::of(i, upstream, enclosed)});
    links[solid].crossings.push_back(
        {static_cast<float>(distance),
         {static_cast<float>(arm[0]), static_cast<float>(arm[1]), static_cast<float>(arm[2])}});
  }
}

// Tile by tile, and row by row in each, for every solid.
void StaticSolids::build_links(const lbm::RowTiles& tiles) {
  std::vector<SolidLinks> links(bodies_.size());
  std::vector<std::vector<Index3>> rows(static_cast<std::size_t>(tiles.count()));
  const Index3 n = block_.size();
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y) rows[tiles.tile_of(y, z)].push_back({0, y, z});
  for (int tile = 0; tile < tiles.count(); ++tile) {
    for (Index3 local : rows[tile])
      for (local[0] = 0; local[0] < n[0]; ++local[0]) add_links_of_cell(local, links);
    for (std::size_t s = 0; s < bodies_.size(); ++s) {
      links_.replace(static_cast<int>(s), tile, links[s].links, links[s].crossings);
      links[s].links.clear();
      links[s].crossings.clear();
    }
  }
  cut_.clear();
}

std::vector<LinkBody>& StaticSolids::begin_step() {
  loaded_.clear();
  for (LinkBody& body : bodies_) body.clear_sums();
  return bodies_;
}

// Force sums as integers, so that no order of ranks matters.
std::vector<std::int64_t> StaticSolids::summed() const {
  if (!loaded_.empty()) return loaded_;
  std::vector<std::int64_t> sums;
  for (const LinkBody& body : bodies_) sums.insert(sums.end(), {body.force.x, body.force.y, body.force.z});
  const std::vector<WideSum> totals = wide_sums_over_ranks(communicator_, sums);
  std::transform(totals.begin(), totals.end(), sums.begin(), [](const WideSum& total) { return total.narrowed(); });
  return sums;
}

std::vector<Vec3> StaticSolids::forces() const {
  const std::vector<std::int64_t> sums = summed();
  std::vector<Vec3> forces;
  for (std::size_t s = 0; s < bodies_.size(); ++s)
    forces.push_back(FixedVec3{sums[3 * s], sums[3 * s + 1], sums[3 * s + 2]}.to_vec3());
  return forces;
}

void StaticSolids::save(ArchiveWriter& archive) const {
  const std::vector<std::int64_t> sums = summed();
  const std::vector<std::uint64_t> shape{bodies_.size(), 3}, nothing{0, 0};
  const bool first = rank_of(communicator_) == 0;
  const std::span<const std::int64_t> values = sums;
  archive.write("solids/force", first ? values : values.first(0), {shape, nothing, first ? shape : nothing});
}

void StaticSolids::load(ArchiveReader& archive) {
  const std::vector<std::uint64_t> shape{bodies_.size(), 3};
  if (!archive.has("solids/force") || archive.shape("solids/force") != shape)
    throw InputError(fmt::format(
        "The checkpoint does not hold {} static solids as this case does; keep the list solids.", bodies_.size()));
  loaded_.assign(3 * bodies_.size(), 0);
  archive.read("solids/force", std::span<std::int64_t>(loaded_), {shape, {0, 0}, shape});
}

}  // namespace thalweg::bodies
