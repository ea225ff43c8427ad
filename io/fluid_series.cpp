#include "io/fluid_series.hpp"

#include "core/error.hpp"
#include "core/mpi_session.hpp"
#include "io/atomic_file.hpp"
#include "io/vtk_file.hpp"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkTypeInt32Array.h>
#include <vtkXMLImageDataWriter.h>

#include <algorithm>
#include <bit>
#include <string>

namespace thalweg::io {
namespace {

const char* name_of(FluidField field) {
  switch (field) {
    case FluidField::velocity:
      return "velocity";
    case FluidField::pressure:
      return "pressure";
    case FluidField::grain_id:
      return "grain_id";
    case FluidField::density:
      return "density";
    case FluidField::shear_rate:
      return "shear_rate";
    case FluidField::eddy_viscosity:
      return "eddy_viscosity";
    case FluidField::vorticity:
      return "vorticity";
    case FluidField::q_criterion:
      return "q_criterion";
  }
  throw std::logic_error("unknown fluid field");
}

std::size_t volume(const Block& block) {
  const Index3 size = block.size();
  return static_cast<std::size_t>(std::max(size[0], 0)) * static_cast<std::size_t>(std::max(size[1], 0)) *
         static_cast<std::size_t>(std::max(size[2], 0));
}

Block intersection(Block a, const Block& b) {
  for (int axis = 0; axis < 3; ++axis) {
    a.lower[axis] = std::max(a.lower[axis], b.lower[axis]);
    a.upper[axis] = std::max(a.lower[axis], std::min(a.upper[axis], b.upper[axis]));
  }
  return a;
}

// The cells of the region, in global coordinates.
Block block_of(FluidRegion region, const Index3& cells) {
  Block block{{0, 0, 0}, cells};
  if (region == FluidRegion::whole) return block;
  const int axis = region == FluidRegion::slice_x ? 0 : region == FluidRegion::slice_y ? 1 : 2;
  block.lower[axis] = cells[axis] / 2;
  block.upper[axis] = block.lower[axis] + 1;
  return block;
}

// Place of a cell in the arrays of a block, x fastest.
std::size_t index_in(const Block& block, const Index3& cell) {
  const Index3 size = block.size();
  const auto plane = static_cast<std::size_t>(cell[2] - block.lower[2]) * static_cast<std::size_t>(size[1]);
  const auto row = (plane + static_cast<std::size_t>(cell[1] - block.lower[1])) * static_cast<std::size_t>(size[0]);
  return row + static_cast<std::size_t>(cell[0] - block.lower[0]);
}

// One component of a field in a cell on its way to rank 0; a grain id travels as its bits.
struct CellRow {
  Index3 cell;
  std::int32_t component;
  std::int32_t bits;
};

// One field of the region on rank 0, as bits; empty elsewhere.
std::vector<std::int32_t> gathered(MPI_Comm communicator, const std::int32_t* values, int components,
                                   const Block& block, const Block& region) {
  const Block part = intersection(block, region);
  std::vector<CellRow> rows;
  for (int k = part.lower[2]; k < part.upper[2]; ++k)
    for (int j = part.lower[1]; j < part.upper[1]; ++j)
      for (int i = part.lower[0]; i < part.upper[0]; ++i)
        for (int c = 0; c < components; ++c)
          rows.push_back({{i, j, k}, c, values[components * index_in(block, {i, j, k}) + c]});
  rows = exchange_rows(communicator, rows, std::vector<int>(rows.size(), 0));
  std::vector<std::int32_t> result;
  if (rank_of(communicator) != 0) return result;
  result.resize(components * volume(region));
  for (const CellRow& row : rows) result[components * index_in(region, row.cell) + row.component] = row.bits;
  return result;
}

// The region's fields on rank 0; empty elsewhere.
FluidFields gathered(MPI_Comm communicator, const FluidFields& fields, const Block& region,
                     const std::vector<FluidField>& wanted) {
  FluidFields result;
  result.block = region;
  for (const FluidField field : wanted) {
    const int components = components_of(field);
    if (field == FluidField::grain_id) {
      result.grain_id = gathered(communicator, fields.grain_id.data(), components, fields.block, region);
      continue;
    }
    const std::vector<float>& here = values_of(fields, field);
    std::vector<std::int32_t> bits(here.size());
    std::transform(here.begin(), here.end(), bits.begin(), std::bit_cast<std::int32_t, float>);
    bits = gathered(communicator, bits.data(), components, fields.block, region);
    std::vector<float>& there = values_of(result, field);
    there.resize(bits.size());
    std::transform(bits.begin(), bits.end(), there.begin(), std::bit_cast<float, std::int32_t>);
  }
  return result;
}

void write_image(const std::filesystem::path& path, const FluidFields& fields, double spacing,
                 const std::vector<FluidField>& wanted) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  const Block& block = fields.block;
  image->SetExtent(block.lower[0], block.upper[0], block.lower[1], block.upper[1], block.lower[2], block.upper[2]);
  image->SetSpacing(spacing, spacing, spacing);
  const auto count = static_cast<vtkIdType>(volume(block));
  for (const FluidField field : wanted) {
    if (field == FluidField::grain_id) {
      auto array = new_array<vtkTypeInt32Array>(name_of(field), 1, count);
      std::copy(fields.grain_id.begin(), fields.grain_id.end(), array->GetPointer(0));
      image->GetCellData()->AddArray(array);
    } else {
      const std::vector<float>& values = values_of(fields, field);
      auto array = new_array<vtkFloatArray>(name_of(field), components_of(field), count);
      std::copy(values.begin(), values.end(), array->GetPointer(0));
      image->GetCellData()->AddArray(array);
    }
  }
  auto writer = vtkSmartPointer<vtkXMLImageDataWriter>::New();
  writer->SetInputData(image);
  write_vtk_file(*writer, path);
}

std::string extent_text(const Block& block) {
  return fmt::format("{} {} {} {} {} {}", block.lower[0], block.upper[0], block.lower[1], block.upper[1],
                     block.lower[2], block.upper[2]);
}

std::string piece_name(int rank) { return fmt::format("piece_{}.vti", rank); }

// The .pvti that makes one image of the pieces.
std::string assembly(const Decomposition& decomposition, const std::string& piece_folder,
                     const std::vector<FluidField>& wanted) {
  const std::string spacing = fmt::format("{0} {0} {0}", decomposition.spacing());
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PImageData\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <PImageData WholeExtent=\"{}\" GhostLevel=\"0\" Origin=\"0 0 0\" Spacing=\"{}\">\n    <PCellData>\n",
      extent_text({{0, 0, 0}, decomposition.cells()}), spacing);
  for (const FluidField field : wanted) {
    text += fmt::format("      <PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n",
                        field == FluidField::grain_id ? "Int32" : "Float32", name_of(field), components_of(field));
  }
  text += "    </PCellData>\n";
  for (int rank = 0; rank < decomposition.ranks(); ++rank)
    text += fmt::format("    <Piece Extent=\"{}\" Source=\"{}/{}\"/>\n", extent_text(decomposition.block_of(rank)),
                        piece_folder, piece_name(rank));
  return text + "  </PImageData>\n</VTKFile>\n";
}

}  // namespace

FluidSeries::FluidSeries(MPI_Comm communicator, const std::filesystem::path& run_folder, FluidRegion region,
                         std::vector<FluidField> fields, std::optional<double> continue_from)
    : communicator_(communicator),
      folder_(run_folder),
      region_(region),
      fields_(std::move(fields)),
      index_(run_folder / "fluid.pvd", continue_from) {}

void FluidSeries::write(const Snapshot& snapshot) {
  if (!snapshot.fluid) return;
  const FluidFields fields = snapshot.fluid->sample(fields_);
  const bool whole = region_ == FluidRegion::whole;
  const bool in_pieces = whole && size_of(communicator_) > 1;
  const std::string name = fmt::format("fluid_{:09d}", snapshot.step);
  const std::filesystem::path pieces = folder_ / "fluid" / name;

  agree([&] {
    if (rank_of(communicator_) == 0) make_folder(in_pieces ? pieces : folder_ / "fluid");
  });
  FluidFields region;
  if (!whole) region = gathered(communicator_, fields, block_of(region_, snapshot.decomposition->cells()), fields_);
  agree([&] {
    const double spacing = snapshot.decomposition->spacing();
    if (in_pieces)
      write_image(pieces / piece_name(rank_of(communicator_)), fields, spacing, fields_);
    else if (rank_of(communicator_) == 0)
      write_image(folder_ / "fluid" / (name + ".vti"), whole ? fields : region, spacing, fields_);
  });
  agree([&] {
    if (rank_of(communicator_) != 0) return;
    const auto file = std::filesystem::path("fluid") / (name + (in_pieces ? ".pvti" : ".vti"));
    if (in_pieces) write_text_atomically(folder_ / file, assembly(*snapshot.decomposition, name, fields_));
    index_.add(snapshot.time, file);
  });
}

void FluidSeries::agree(const std::function<void()>& work) const {
  std::string failure;
  try {
    work();
  } catch (const RunError& error) {
    failure = error.what();
  }
  if (any_rank(communicator_, !failure.empty()))
    throw RunError(failure.empty() ? "the VTK output of the fluid cannot be written." : failure);
}

}  // namespace thalweg::io
