#include "io/vtk_file.hpp"

#include "core/error.hpp"
#include "io/atomic_file.hpp"

#include <fmt/format.h>
#include <vtkObject.h>

namespace thalweg::io {

void write_vtk_file(vtkXMLWriter& writer, const std::filesystem::path& path) {
  vtkObject::GlobalWarningDisplayOff();  // VTK would print the same failure in its own words
  std::filesystem::path partial = path;
  partial += ".partial";
  writer.SetFileName(partial.c_str());
  writer.SetDataModeToAppended();
  writer.EncodeAppendedDataOff();
  writer.SetCompressorTypeToZLib();  // which every reader knows
  writer.SetCompressionLevel(1);     // half the time of the default level 5, and half a per cent more bytes
  if (writer.Write() == 0 || writer.GetErrorCode() != 0) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);  // what is left of a full disk is needed for other files
    throw RunError(
        fmt::format("{}: cannot write the file; is the disk full or the folder write-protected?", path.string()));
  }
  rename_into_place(partial, path);
}

}  // namespace thalweg::io
