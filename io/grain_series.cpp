#include "io/grain_series.hpp"

#include "core/contact_stress.hpp"
#include "core/error.hpp"
#include "core/mpi_session.hpp"
#include "io/atomic_file.hpp"
#include "io/vtk_file.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt64Array.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <string>

namespace thalweg::io {
namespace {

// One grain on its way to rank 0.
struct Row {
  std::int64_t id, clump;
  double radius;
  double position[3], velocity[3], angular_velocity[3], fluid_force[3], contact_force[3], fluid_stress[9],
      contact_stress[9];
};

void copy(const Vec3& from, double* to) { std::copy(from.data(), from.data() + 3, to); }

void copy(const Mat3& from, double* to) {
  for (int k = 0; k < 9; ++k) to[k] = from(k / 3, k % 3);
}

std::vector<Row> gathered(MPI_Comm communicator, const Snapshot& snapshot) {
  const GrainView& grains = snapshot.grains;
  const std::vector<Mat3> contact_stress = contact_stresses(snapshot);
  std::vector<Row> rows(grains.id.size());
  for (std::size_t n = 0; n < rows.size(); ++n) {
    rows[n] = Row{};
    rows[n].id = grains.id[n];
    rows[n].clump = grains.is_member(n) ? grains.clump[n] : -1;
    rows[n].radius = grains.radius[n];
    copy(grains.position[n], rows[n].position);
    copy(grains.velocity[n], rows[n].velocity);
    copy(grains.angular_velocity[n], rows[n].angular_velocity);
    if (!grains.fluid_force.empty()) copy(grains.fluid_force[n], rows[n].fluid_force);
    if (!grains.fluid_stress.empty()) copy(grains.fluid_stress[n], rows[n].fluid_stress);
    copy(contact_stress[n], rows[n].contact_stress);
    if (!grains.contact_force.empty()) copy(grains.contact_force[n], rows[n].contact_force);
  }
  rows = exchange_rows(communicator, rows, std::vector<int>(rows.size(), 0));
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
  return rows;
}

template <int components>
void add_values(vtkPolyData& points, const std::vector<Row>& rows, const char* name,
                const double (Row::*field)[components]) {
  auto array = new_array<vtkDoubleArray>(name, components, static_cast<vtkIdType>(rows.size()));
  for (std::size_t n = 0; n < rows.size(); ++n) array->SetTuple(static_cast<vtkIdType>(n), rows[n].*field);
  points.GetPointData()->AddArray(array);
}

vtkSmartPointer<vtkPolyData> poly_data_of(const std::vector<Row>& rows, bool with_fluid, bool with_clumps,
                                          bool with_stress) {
  const auto count = static_cast<vtkIdType>(rows.size());
  auto frame = vtkSmartPointer<vtkPolyData>::New();
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(count);
  auto vertices = vtkSmartPointer<vtkCellArray>::New();
  auto id = new_array<vtkTypeInt64Array>("id", 1, count);
  auto radius = new_array<vtkDoubleArray>("radius", 1, count);
  auto speed = new_array<vtkDoubleArray>("speed", 1, count);
  for (vtkIdType n = 0; n < count; ++n) {
    const Row& row = rows[static_cast<std::size_t>(n)];
    points->SetPoint(n, row.position);
    vertices->InsertNextCell(1, &n);
    id->SetValue(n, row.id);
    radius->SetValue(n, row.radius);
    speed->SetValue(n, Vec3(row.velocity[0], row.velocity[1], row.velocity[2]).norm());
  }
  frame->SetPoints(points);
  frame->SetVerts(vertices);
  frame->GetPointData()->AddArray(id);
  if (with_clumps) {
    auto clump = new_array<vtkTypeInt64Array>("clump", 1, count);
    for (vtkIdType n = 0; n < count; ++n) clump->SetValue(n, rows[static_cast<std::size_t>(n)].clump);
    frame->GetPointData()->AddArray(clump);
  }
  frame->GetPointData()->AddArray(radius);
  frame->GetPointData()->AddArray(speed);
  add_values(*frame, rows, "velocity", &Row::velocity);
  add_values(*frame, rows, "angular_velocity", &Row::angular_velocity);
  add_values(*frame, rows, "contact_force", &Row::contact_force);
  add_values(*frame, rows, "contact_stress", &Row::contact_stress);
  if (with_fluid) add_values(*frame, rows, "fluid_force", &Row::fluid_force);
  if (with_stress) add_values(*frame, rows, "fluid_stress", &Row::fluid_stress);
  return frame;
}

}  // namespace

GrainSeries::GrainSeries(MPI_Comm communicator, const std::filesystem::path& run_folder,
                         std::optional<double> continue_from)
    : communicator_(communicator), folder_(run_folder), index_(run_folder / "grains.pvd", continue_from) {}

void GrainSeries::write(const Snapshot& snapshot) {
  const bool with_fluid = any_rank(communicator_, !snapshot.grains.fluid_force.empty());
  const bool with_stress = any_rank(communicator_, !snapshot.grains.fluid_stress.empty());
  const std::vector<Row> rows = gathered(communicator_, snapshot);
  std::string failure;
  if (rank_of(communicator_) == 0) {
    try {
      make_folder(folder_ / "grains");
      const auto file = std::filesystem::path("grains") / fmt::format("grains_{:09d}.vtp", snapshot.step);
      const auto frame = poly_data_of(rows, with_fluid, snapshot.grains.clump_count > 0, with_stress);
      auto writer = vtkSmartPointer<vtkXMLPolyDataWriter>::New();
      writer->SetInputData(frame);
      write_vtk_file(*writer, folder_ / file);
      index_.add(snapshot.time, file);
    } catch (const RunError& error) {
      failure = error.what();
    }
  }
  if (any_rank(communicator_, !failure.empty()))
    throw RunError(failure.empty() ? "the VTK output of the grains cannot be written." : failure);
}

}  // namespace thalweg::io
