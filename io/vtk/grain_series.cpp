#include "io/vtk/grain_series.hpp"

#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "core/parallel/rows_by_id.hpp"
#include "core/state/contact_stress.hpp"
#include "io/files/atomic_file.hpp"
#include "io/vtk/vtk_xml_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::io {
namespace {

// One grain on its way to the rank that writes it.
struct Row {
  std::int64_t id, clump, population, held;
  double radius, speed, density;
  double position[3], velocity[3], angular_velocity[3], fluid_force[3], contact_force[3], fluid_stress[9],
      contact_stress[9], orientation[4];
};

void copy(const Vec3& from, double* to) { std::copy(from.data(), from.data() + 3, to); }

void copy(const Mat3& from, double* to) {
  for (int k = 0; k < 9; ++k) to[k] = from(k / 3, k % 3);
}

Row row_of(const GrainView& grains, std::size_t n, const PopulationIds& ends) {
  Row row{};
  row.id = grains.id[n];
  row.clump = grains.is_member(n) ? grains.clump[n] : -1;
  row.population = population_of(grains.id[n], ends);
  row.held = grains.held(n);
  row.radius = grains.radius[n];
  row.speed = grains.velocity[n].norm();
  row.density = density_of(grains, n);
  copy(grains.position[n], row.position);
  copy(grains.velocity[n], row.velocity);
  copy(grains.angular_velocity[n], row.angular_velocity);
  if (!grains.fluid_force.empty()) copy(grains.fluid_force[n], row.fluid_force);
  if (!grains.fluid_stress.empty()) copy(grains.fluid_stress[n], row.fluid_stress);
  if (!grains.contact_force.empty()) copy(grains.contact_force[n], row.contact_force);
  const std::array<double, 4> orientation = orientation_of(grains, n);
  std::copy(orientation.begin(), orientation.end(), row.orientation);
  return row;
}

bool contains(const std::vector<GrainField>& fields, GrainField field) {
  return std::find(fields.begin(), fields.end(), field) != fields.end();
}

std::vector<Row> selected_rows(const Snapshot& snapshot, const GrainSelection& selection, const PopulationIds& ends,
                               bool with_contact_stress) {
  const GrainView& grains = snapshot.grains;
  const std::vector<Mat3> stress = with_contact_stress ? contact_stresses(snapshot) : std::vector<Mat3>{};
  std::vector<Row> rows;
  if (selection.takes_all()) rows.reserve(grains.id.size());
  for (std::size_t n = 0; n < grains.id.size(); ++n) {
    if (!selection.has(grains.id[n], grains.position[n])) continue;
    rows.push_back(row_of(grains, n, ends));
    if (with_contact_stress) copy(stress[n], rows.back().contact_stress);
  }
  return rows;
}

// Redistributes rows, numbered in order of rank and this rank's from `first` on, by the share; keeps their order.
std::vector<Row> rows_by_place(MPI_Comm communicator, std::vector<Row> rows, std::int64_t first,
                               const BlockShare& share) {
  std::vector<int> home;
  home.reserve(rows.size());
  for (std::size_t n = 0; n < rows.size(); ++n) home.push_back(share.rank_of(first + static_cast<std::int64_t>(n)));
  return exchange_rows(communicator, std::move(rows), home);
}

// The columns of the rows that this rank writes.
class Columns {
public:
  Columns(const std::vector<Row>& rows, VtkXmlFile& file) : rows_(rows), file_(file) {}

  void add(const std::string& name, std::int64_t Row::*field) const {
    std::vector<std::int64_t> values;
    for (const Row& row : rows_) values.push_back(row.*field);
    file_.add("PointData", name, 1, values);
  }
  void add(const std::string& name, double Row::*field) const {
    std::vector<double> values;
    for (const Row& row : rows_) values.push_back(row.*field);
    file_.add("PointData", name, 1, values);
  }
  template <int components>
  void add(const std::string& name, double (Row::*field)[components], const char* section = "PointData") const {
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

void add_field(GrainField field, const std::string& name, const Columns& columns) {
  switch (field) {
    case GrainField::id:
      return columns.add(name, &Row::id);
    case GrainField::clump:
      return columns.add(name, &Row::clump);
    case GrainField::radius:
      return columns.add(name, &Row::radius);
    case GrainField::speed:
      return columns.add(name, &Row::speed);
    case GrainField::velocity:
      return columns.add(name, &Row::velocity);
    case GrainField::angular_velocity:
      return columns.add(name, &Row::angular_velocity);
    case GrainField::contact_force:
      return columns.add(name, &Row::contact_force);
    case GrainField::contact_stress:
      return columns.add(name, &Row::contact_stress);
    case GrainField::fluid_force:
      return columns.add(name, &Row::fluid_force);
    case GrainField::fluid_stress:
      return columns.add(name, &Row::fluid_stress);
    case GrainField::population:
      return columns.add(name, &Row::population);
    case GrainField::held:
      return columns.add(name, &Row::held);
    case GrainField::density:
      return columns.add(name, &Row::density);
    case GrainField::orientation:
      return columns.add(name, &Row::orientation);
  }
}

}  // namespace

GrainSeries::GrainSeries(MPI_Comm communicator, const std::filesystem::path& folder, std::string name,
                         GrainSelectionKeys selection, std::vector<GrainField> fields, PopulationIds population_ids,
                         std::optional<double> continue_from, const GrainFieldFacts& facts)
    : communicator_(communicator),
      folder_(folder),
      name_(std::move(name)),
      selection_(std::move(selection), population_ids),
      fields_(std::move(fields)),
      population_ids_(std::move(population_ids)),
      facts_(facts),
      index_(communicator, folder / (name_ + ".pvd"), continue_from) {}

bool GrainSeries::needs_grain_stress() const {
  return fields_.empty() ? facts_.fluid_stress : contains(fields_, GrainField::fluid_stress);
}

// Fields in the order of the arrays.
std::vector<NamedChoice<GrainField>> GrainSeries::fields_in(const Snapshot& snapshot) const {
  GrainFieldFacts facts;
  facts.clumps = facts_.clumps || snapshot.grains.clump_count > 0;
  facts.fluid_force = facts_.fluid_force || any_rank(communicator_, !snapshot.grains.fluid_force.empty());
  facts.fluid_stress = facts_.fluid_stress || any_rank(communicator_, !snapshot.grains.fluid_stress.empty());
  std::vector<NamedChoice<GrainField>> fields;
  for (const NamedChoice<GrainField>& field : grain_fields()) {
    const bool wanted = fields_.empty() ? there_is(field.value, facts) : contains(fields_, field.value);
    if (wanted || field.value == GrainField::radius) fields.push_back(field);
  }
  return fields;
}

void GrainSeries::write(const Snapshot& snapshot) {
  const std::vector<NamedChoice<GrainField>> fields = fields_in(snapshot);
  const bool with_contact_stress = std::any_of(fields.begin(), fields.end(), [](const NamedChoice<GrainField>& field) {
    return field.value == GrainField::contact_stress;
  });
  // Rows by id, of which some may be missing, then by their place in the file.
  std::vector<Row> selected =
      rows_by_id(communicator_, selected_rows(snapshot, selection_, population_ids_, with_contact_stress),
                 BlockShare(snapshot.grains.end_of_ids(), 1, size_of(communicator_)));
  const RowRange places = RowRange::of_rows(static_cast<std::int64_t>(selected.size()), communicator_);
  VtkXmlFile picture(communicator_, places.count);
  const std::vector<Row> rows = rows_by_place(communicator_, std::move(selected), places.first, picture.share());
  const Columns columns(rows, picture);
  for (const NamedChoice<GrainField>& field : fields) add_field(field.value, field.name, columns);
  columns.add("Points", &Row::position, "Points");
  columns.add_vertices();

  const auto file = std::filesystem::path(name_) / fmt::format("{}_{:09d}.vtp", name_, snapshot.step);
  on_first_rank(communicator_, [&] { make_folder(folder_ / name_); });
  picture.write(folder_ / file, snapshot.time, "PolyData", "",
                fmt::format(" NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                            "NumberOfPolys=\"0\"",
                            places.count));
  index_.add(snapshot.time, file);
}

}  // namespace thalweg::io
