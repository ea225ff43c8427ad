#include "io/stl_file.hpp"

#include "core/error.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkObject.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>
#include <vtkSmartPointer.h>

namespace thalweg::io {

TriangleMesh read_stl(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw InputError(fmt::format("{}: there is no such file; give an STL file.", path.string()));
  vtkObject::GlobalWarningDisplayOff();  // the sentence below says it
  auto reader = vtkSmartPointer<vtkSTLReader>::New();
  reader->SetFileName(path.c_str());
  reader->MergingOn();
  reader->Update();
  vtkPolyData& surface = *reader->GetOutput();

  TriangleMesh mesh;
  for (vtkIdType p = 0; p < surface.GetNumberOfPoints(); ++p) {
    double at[3];
    surface.GetPoint(p, at);
    mesh.points.emplace_back(at[0], at[1], at[2]);
  }
  for (vtkIdType c = 0; c < surface.GetNumberOfCells(); ++c) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    surface.GetCellPoints(c, count, ids);
    if (count != 3) continue;
    const std::array<int, 3> corners{static_cast<int>(ids[0]), static_cast<int>(ids[1]), static_cast<int>(ids[2])};
    // Joined corners leave slivers without an area; they carry no surface.
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      mesh.triangles.push_back(corners);
  }
  if (mesh.triangles.empty())
    throw InputError(fmt::format("{}: this is not an STL file, or an empty one.", path.string()));
  const std::string open = what_is_open(mesh);
  if (!open.empty())
    throw InputError(
        fmt::format("{}: the surface is not closed: {}; repair it where it was made.", path.string(), open));
  if (signed_volume(mesh) < 0.0) turn_inside_out(mesh);
  return mesh;
}

}  // namespace thalweg::io
