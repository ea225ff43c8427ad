#include "io/grain_series.hpp"

#include "core/contact_stress.hpp"
#include "core/mpi_session.hpp"
#include "core/on_first_rank.hpp"
#include "io/atomic_file.hpp"
#include "io/vtk_xml_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

namespace thalweg::io {
namespace {

// One grain on its way to the rank that writes it.
struct Row {
  std::int64_t id, clump;
  double radius, speed;
  double position[3], velocity[3], angular_velocity[3], fluid_force[3], contact_force[3], fluid_stress[9],
      contact_stress[9];
};

void copy(const Vec3& from, double* to) { std::copy(from.data(), from.data() + 3, to); }

void copy(const Mat3& from, double* to) {
  for (int k = 0; k < 9; ++k) to[k] = from(k / 3, k % 3);
}

std::vector<Row> rows_of(const Snapshot& snapshot) {
  const GrainView& grains = snapshot.grains;
  const std::vector<Mat3> contact_stress = contact_stresses(snapshot);
  std::vector<Row> rows(grains.id.size());
  for (std::size_t n = 0; n < rows.size(); ++n) {
    rows[n] = Row{};
    rows[n].id = grains.id[n];
    rows[n].clump = grains.is_member(n) ? grains.clump[n] : -1;
    rows[n].radius = grains.radius[n];
    copy(grains.position[n], rows[n].position);
    rows[n].speed = grains.velocity[n].norm();
    copy(grains.velocity[n], rows[n].velocity);
    copy(grains.angular_velocity[n], rows[n].angular_velocity);
    if (!grains.fluid_force.empty()) copy(grains.fluid_force[n], rows[n].fluid_force);
    if (!grains.fluid_stress.empty()) copy(grains.fluid_stress[n], rows[n].fluid_stress);
    copy(contact_stress[n], rows[n].contact_stress);
    if (!grains.contact_force.empty()) copy(grains.contact_force[n], rows[n].contact_force);
  }
  return rows;
}

// The columns of the rows that this rank writes.
class Columns {
public:
  Columns(const std::vector<Row>& rows, VtkXmlFile& file) : rows_(rows), file_(file) {}

  void add(const char* name, std::int64_t Row::*field) const {
    std::vector<std::int64_t> values;
    for (const Row& row : rows_) values.push_back(row.*field);
    file_.add("PointData", name, 1, values);
  }
  void add(const char* name, double Row::*field) const {
    std::vector<double> values;
    for (const Row& row : rows_) values.push_back(row.*field);
    file_.add("PointData", name, 1, values);
  }
  template <int components>
  void add(const char* name, double (Row::*field)[components], const char* section = "PointData") const {
    std::vector<double> values;
    for (const Row& row : rows_) values.insert(values.end(), row.*field, row.*field + components);
    file_.add(section, name, components, values);
  }
  // A point for ParaView is a cell of its own.
  void add_vertices() const {
    std::vector<std::int64_t> numbers(rows_.size());
    std::iota(numbers.begin(), numbers.end(), file_.first_row());
    file_.add("Verts", "connectivity", 1, numbers);
    std::iota(numbers.begin(), numbers.end(), file_.first_row() + 1);
    file_.add("Verts", "offsets", 1, numbers);
  }

private:
  const std::vector<Row>& rows_;
  VtkXmlFile& file_;
};

}  // namespace

GrainSeries::GrainSeries(MPI_Comm communicator, const std::filesystem::path& run_folder,
                         std::optional<double> continue_from)
    : communicator_(communicator), folder_(run_folder), index_(run_folder / "grains.pvd", continue_from) {}

void GrainSeries::write(const Snapshot& snapshot) {
  const bool with_fluid = any_rank(communicator_, !snapshot.grains.fluid_force.empty());
  const bool with_stress = any_rank(communicator_, !snapshot.grains.fluid_stress.empty());
  const std::int64_t count = snapshot.grains.global_count;
  VtkXmlFile picture(communicator_, count);
  const std::vector<Row> rows = rows_by_id(communicator_, rows_of(snapshot), picture.share());
  const Columns columns(rows, picture);
  columns.add("id", &Row::id);
  if (snapshot.grains.clump_count > 0) columns.add("clump", &Row::clump);
  columns.add("radius", &Row::radius);
  columns.add("speed", &Row::speed);
  columns.add("velocity", &Row::velocity);
  columns.add("angular_velocity", &Row::angular_velocity);
  columns.add("contact_force", &Row::contact_force);
  columns.add("contact_stress", &Row::contact_stress);
  if (with_fluid) columns.add("fluid_force", &Row::fluid_force);
  if (with_stress) columns.add("fluid_stress", &Row::fluid_stress);
  columns.add("Points", &Row::position, "Points");
  columns.add_vertices();

  const auto file = std::filesystem::path("grains") / fmt::format("grains_{:09d}.vtp", snapshot.step);
  on_first_rank(communicator_, [&] { make_folder(folder_ / "grains"); });
  picture.write(folder_ / file, "PolyData", "",
                fmt::format(" NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                            "NumberOfPolys=\"0\"",
                            count));
  on_first_rank(communicator_, [&] { index_.add(snapshot.time, file); });
}

}  // namespace thalweg::io
