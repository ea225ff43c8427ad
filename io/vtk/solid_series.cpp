#include "io/vtk/solid_series.hpp"

#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "io/files/atomic_file.hpp"
#include "io/vtk/vtk_xml_file.hpp"

#include <fmt/format.h>

#include <string>

namespace thalweg::io {
namespace {

constexpr const char* name = "solids";

struct Polygons {
  std::vector<double> points;
  std::vector<std::int64_t> corners, ends, solid;
};

Polygons joined(const std::vector<TriangleMesh>& solids) {
  Polygons all;
  for (std::size_t n = 0; n < solids.size(); ++n) {
    const auto first = static_cast<std::int64_t>(all.points.size() / 3);
    for (const Vec3& point : solids[n].points) all.points.insert(all.points.end(), point.data(), point.data() + 3);
    for (const std::array<int, 3>& triangle : solids[n].triangles) {
      for (const int corner : triangle) all.corners.push_back(first + corner);
      all.ends.push_back(static_cast<std::int64_t>(all.corners.size()));
      all.solid.push_back(static_cast<std::int64_t>(n));
    }
  }
  return all;
}

void write_polygons(const Polygons& all, double time, const std::filesystem::path& path) {
  const auto points = static_cast<std::int64_t>(all.points.size() / 3),
             triangles = static_cast<std::int64_t>(all.ends.size());
  VtkXmlFile picture(MPI_COMM_SELF, triangles);
  picture.add("CellData", "solid", 1, all.solid);
  picture.set_rows(points);
  picture.add("Points", "Points", 3, all.points);
  picture.set_rows(3 * triangles);
  picture.add("Polys", "connectivity", 1, all.corners);
  picture.set_rows(triangles);
  picture.add("Polys", "offsets", 1, all.ends);
  picture.write(path, time, "PolyData", "",
                fmt::format(" NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                            "NumberOfPolys=\"{}\"",
                            points, triangles));
}

}  // namespace

SolidSeries::SolidSeries(MPI_Comm communicator, const std::filesystem::path& folder,
                         std::optional<double> continue_from)
    : communicator_(communicator),
      folder_(folder),
      index_(communicator, folder / fmt::format("{}.pvd", name), continue_from) {}

bool SolidSeries::is_empty() const { return !any_rank(communicator_, !index_.entries().empty()); }

void SolidSeries::write(double time, std::int64_t step, const std::vector<TriangleMesh>& solids) {
  const auto file = std::filesystem::path(name) / fmt::format("{}_{:09d}.vtp", name, step);
  on_first_rank(communicator_, [&] {
    make_folder(folder_ / name);
    write_polygons(joined(solids), time, folder_ / file);
  });
  index_.add(time, file);
}

}  // namespace thalweg::io
