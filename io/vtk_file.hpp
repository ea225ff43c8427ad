// What io's VTK sources share. Included by their .cpp files only.
#pragma once

#include <vtkSmartPointer.h>
#include <vtkXMLWriter.h>

#include <filesystem>
#include <string>

namespace thalweg::io {

// Writes through a temporary name, so that a viewer never opens half a file. Throws RunError.
void write_vtk_file(vtkXMLWriter& writer, const std::filesystem::path& path);

// An empty array of `tuples` tuples of `components` values each.
template <typename Array>
vtkSmartPointer<Array> new_array(const std::string& name, int components, vtkIdType tuples) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name.c_str());
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  return array;
}

}  // namespace thalweg::io
